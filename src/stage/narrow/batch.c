#include "stage/narrow/batch.h"

#include "stage/store/lists.h"

tl_batch_kind tl_batch_kind_of(const tl_header *h, uint32_t shape_a, uint32_t shape_b) {
    const talus_geometry *ga = &tl_shape_geometry(h)[shape_a], *gb = &tl_shape_geometry(h)[shape_b];
    talus_shape_type a = ga->type, b = gb->type;
    if (a == TALUS_SPHERE && (b == TALUS_SPHERE || b == TALUS_BOX)) {
        return b == TALUS_SPHERE ? TL_BATCH_BALLS : TL_BATCH_BALL_BOX;
    }
    if (a == TALUS_BOX && (b == TALUS_SPHERE || b == TALUS_BOX)) {
        return b == TALUS_SPHERE ? TL_BATCH_BOX_BALL : TL_BATCH_BOXES;
    }
    return tl_are_capsules(ga, gb) ? TL_BATCH_CAPSULES : TL_BATCH_OTHER;
}

void tl_batch_clear(tl_pair_batch *batch) { batch->count = batch->senses = batch->fixed_a = batch->fixed_b = 0; }

void tl_batches_begin(tl_pair_batch *batches, int touch) {
    for (uint32_t i = 0; i < TL_BATCH_KINDS; i++) {
        batches[i].kind = (tl_batch_kind)i;
        batches[i].touch = touch;
        tl_batch_clear(&batches[i]);
    }
}

int tl_batch_add(const tl_header *h, tl_pair_batch *batch, uint32_t item, uint32_t shape_a, uint32_t shape_b) {
    const tl_shape_meta *a = &tl_shapes(h)[shape_a], *b = &tl_shapes(h)[shape_b];
    uint32_t k = batch->count++;
    batch->item[k] = item;
    batch->body_a[k] = a->body, batch->body_b[k] = b->body;
    batch->shape_a[k] = shape_a, batch->shape_b[k] = shape_b;
    batch->senses |= (uint32_t)(((a->flags | b->flags) & TL_SHAPE_SENSOR) != 0) << k;
    batch->fixed_a |= (uint32_t)tl_body_is_fixed(h, a->body) << k;
    batch->fixed_b |= (uint32_t)tl_body_is_fixed(h, b->body) << k;
    return batch->count == TL_LANES;
}

void tl_batch_fill(tl_pair_batch *batch) {
    for (uint32_t k = batch->count; k < TL_LANES; k++) {
        batch->item[k] = batch->item[0];
        batch->body_a[k] = batch->body_a[0], batch->body_b[k] = batch->body_b[0];
        batch->shape_a[k] = batch->shape_a[0], batch->shape_b[k] = batch->shape_b[0];
    }
}

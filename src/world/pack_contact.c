#include "world/pack_contact.h"

#include "base/bits.h"
#include "base/bytes.h"
#include "world/reindex.h"

/* A contact begins with a word: count (3 bits), colour (7), flags (8), whether friction is at work (1), whether the
 * ids need more than 16 bits (1), which points press (4) and which words the cache holds (4). Then shapes, motion,
 * normal, and what of the rest is not nothing. */
enum { AT_COLOR = 3, AT_FLAGS = 10, AT_FRICTION = 18, AT_WIDE = 19, AT_PRESSED = 20, AT_CACHE = 24 };

static uint32_t word_of(float x) {
    uint32_t w;
    memcpy(&w, &x, 4);
    return w;
}

static uint32_t bit(uint32_t code, uint32_t at) { return code >> at & 1u; }

/* Shapes take half a word each as long as there are few. */
static int few_shapes(const tl_header *h) { return h->shapes.high <= 0x10000u; }

static uint32_t code_of(const tl_contact_meta *m, const tl_contact_head *head, const tl_contact_points *points,
                        const tl_pair_cache *cache) {
    uint32_t friction =
        word_of(head->friction[0]) | word_of(head->friction[1]) | word_of(head->friction[2]) | word_of(head->twist);
    uint32_t code = m->count | m->color << AT_COLOR | m->flags << AT_FLAGS | (uint32_t)(friction != 0) << AT_FRICTION;
    uint32_t ids = 0;
    for (uint32_t i = 0; i < m->count; i++) {
        ids |= points->p[i].id;
        code |= (uint32_t)(word_of(points->p[i].impulse) != 0) << (AT_PRESSED + i);
    }
    for (uint32_t i = 0; i < 4u; i++) {
        code |= (uint32_t)(cache->word[i] != 0) << (AT_CACHE + i);
    }
    return code | (uint32_t)(ids > 0xffffu) << AT_WIDE;
}

unsigned char *tl_pack_contact(unsigned char *p, const tl_header *h, uint32_t contact) {
    const tl_contact_meta *m = &tl_contacts(h)[contact];
    const tl_contact_head *head = &tl_heads(h)[contact];
    const tl_contact_points *points = &tl_points(h)[contact];
    const tl_pair_cache *cache = &tl_contact_caches(h)[contact];
    uint32_t code = code_of(m, head, points, cache);
    p = tl_put_word(p, code);
    if (few_shapes(h)) {
        p = tl_put_word(p, m->shape_a | m->shape_b << 16);
    } else {
        p = tl_put_word(tl_put_word(p, m->shape_a), m->shape_b);
    }
    p = tl_put_word(p, m->motion);
    p = tl_put_words(p, head->normal, 3);
    tl_put_words(p, head->friction, 4); /* and the twist */
    p += 16u * bit(code, AT_FRICTION);
    for (uint32_t i = 0; i < 4u; i++) {
        if (bit(code, AT_CACHE + i)) {
            p = tl_put_word(p, cache->word[i]);
        }
    }
    size_t id = bit(code, AT_WIDE) ? 4u : 2u;
    for (uint32_t i = 0; i < m->count; i++) {
        const tl_contact_point_record *r = &points->p[i];
        tl_put_words(p, r->a, 7); /* and b and the impulse */
        p += 24u + 4u * bit(code, AT_PRESSED + i);
        tl_put_word(p, r->id);
        p += id;
    }
    return p;
}

static size_t bytes_of(const tl_header *h, uint32_t code) {
    uint32_t count = code & 7u;
    return 8u + (few_shapes(h) ? 4u : 8u) + 12u + 16u * bit(code, AT_FRICTION) +
           4u * tl_bit_count(code >> AT_PRESSED & 255u) + count * (24u + (bit(code, AT_WIDE) ? 4u : 2u));
}

const unsigned char *tl_unpack_contact(const unsigned char *p, const unsigned char *end, tl_header *h,
                                       uint32_t contact) {
    unsigned char last[TL_PACK_CONTACT_MOST];
    const unsigned char *from = p;
    if ((size_t)(end - p) < sizeof last) { /* as many are read whatever it takes */
        memset(last, 0, sizeof last);
        memcpy(last, p, (size_t)(end - p));
        p = last;
    }
    uint32_t code = tl_get_word(p), count = code & 7u;
    size_t bytes = bytes_of(h, code);
    if (count > TL_MANIFOLD_POINTS || (code >> AT_PRESSED & 15u) >> count || (size_t)(end - from) < bytes) {
        return NULL;
    }
    tl_contact_meta *m = &tl_contacts(h)[contact];
    tl_contact_head *head = &tl_heads(h)[contact];
    tl_contact_points *points = &tl_points(h)[contact];
    tl_pair_cache *cache = &tl_contact_caches(h)[contact];
    uint32_t shape_a = tl_get_word(p + 4), shape_b = shape_a >> 16;
    if (few_shapes(h)) {
        shape_a &= 0xffffu;
        p += 8;
    } else {
        shape_b = tl_get_word(p + 8);
        p += 12;
    }
    uint32_t color = code >> AT_COLOR & 127u, flags = code >> AT_FLAGS & 255u;
    if (!(flags & TL_CONTACT_ALIVE) || color > TL_COLORS) {
        return NULL;
    }
    if ((m->shape_a ^ shape_a) | (m->shape_b ^ shape_b) | (m->color ^ color) |
        ((m->flags ^ flags) & (TL_CONTACT_ALIVE | TL_CONTACT_COLORED))) {
        tl_reindex_part_contact(h, contact);
    }
    for (uint32_t i = count; i < m->count && i < TL_MANIFOLD_POINTS; i++) {
        memset(&points->p[i], 0, sizeof points->p[i]);
    }
    m->count = count, m->color = color, m->flags = flags;
    m->shape_a = shape_a, m->shape_b = shape_b;
    m->motion = tl_get_word(p);
    tl_get_words(p + 4, head->normal, 3);
    p += 16;
    memset(head->friction, 0, 16);
    if (bit(code, AT_FRICTION)) {
        tl_get_words(p, head->friction, 4);
        p += 16;
    }
    memset(cache, 0, sizeof *cache);
    for (uint32_t i = 0; i < 4u; i++) {
        if (bit(code, AT_CACHE + i)) {
            cache->word[i] = tl_get_word(p);
            p += 4;
        }
    }
    uint32_t wide = bit(code, AT_WIDE);
    for (uint32_t i = 0; i < count; i++) {
        tl_contact_point_record *r = &points->p[i];
        uint32_t pressed = bit(code, AT_PRESSED + i), impulse = tl_get_word(p + 24) & (0u - pressed);
        tl_get_words(p, r->a, 6);
        memcpy(&r->impulse, &impulse, 4);
        p += 24u + 4u * pressed;
        r->id = tl_get_word(p) & (wide ? ~(uint32_t)0 : 0xffffu);
        p += wide ? 4 : 2;
    }
    return from + bytes;
}

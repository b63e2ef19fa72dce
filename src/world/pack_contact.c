/* For each word of contact_alive the word, then the contacts that it says are there. A contact begins with its code:
 * how many points it has, colour, flags, what of the rest there is, and the signs of friction and twist. Then shapes,
 * motion, normal; friction and twist, if any is more than a sign; its lift, if any; the words of its cache up to the
 * last that is not 0; its points, each with the id last.
 *
 * Which contact has how many points and what of the rest is as good as random. A branch on it would be guessed wrong
 * every other time, and that cost more than all else here: so the most that a contact may have is copied, and stepped
 * over as far as it is there. */
#include "world/pack_contact.h"

#include "base/bits.h"
#include "base/bytes.h"
#include "base/prefetch.h"
#include "collide/lanes.h"

/* Where the parts of a code are: count (3 bits), colour (7), flags (8), whether friction or twist are not 0 (1), words
 * of the cache (3), whether ids need 4 bytes and not 3 (1), signs (4), whether there is a lift (1). */
enum { AT_COLOR = 3, AT_FLAGS = 10, AT_RUBS = 18, AT_CACHE = 19, AT_WIDE = 22, AT_SIGNS = 23, AT_LIFT = 27 };

#define POINTS TL_MANIFOLD_POINTS
#define POINT 32u                                              /* bytes of a point at most */
#define MOST (4u + 8u + 16u + 16u + 4u + 16u + POINT * POINTS) /* bytes of a contact */
#define AHEAD 2048u                                            /* bytes that are asked for early */

/* Where the third and the fourth point are copied from: where there is neither, the first two in their stead, and
 * half of the memory stays out of it. */
static uint32_t more_of(uint32_t count) { return count > 2u ? 2u : 0; }

#define SIGNS 0x8000000080000000u

/* The kind of an id is its two highest bits (tl_point_id). With them lowest three bytes are enough for most. */
static uint32_t turned(uint32_t id) { return id << 2 | id >> 30; }
static uint32_t turned_back(uint32_t id) { return id >> 2 | id << 30; }

/* The columns. */
typedef struct slots {
    tl_contact_meta *metas;
    tl_contact_head *heads;
    tl_contact_points *points;
    tl_pair_cache *caches;
    int few_shapes; /* then they take half a word each */
} slots;

static slots slots_of(const tl_header *h) {
    slots s = {tl_contacts(h), tl_heads(h), tl_points(h), tl_contact_caches(h), h->shapes.high <= 0x10000u};
    return s;
}

size_t tl_pack_contacts_bound(const tl_header *h) {
    return 8u * (size_t)tl_bit_words(h->contacts.high) + (size_t)h->contacts.used * MOST;
}

/* --- packing ---------------------------------------------------------------------------------- */

static uint32_t cache_words(const tl_pair_cache *cache) {
    uint32_t words = cache->word[0] != 0;
    words = cache->word[1] ? 2u : words;
    words = cache->word[2] ? 3u : words;
    return cache->word[3] ? 4u : words;
}

/* The signs of two floats of a pair. */
static uint32_t signs_of(uint64_t pair) { return (uint32_t)(((pair & SIGNS) | (pair & SIGNS) << 31) >> 62); }

/* Friction and twist as two pairs of floats, the first of each lowest. */
static uint64_t pair_of(const uint32_t *words) { return words[0] | (uint64_t)words[1] << 32; }

static void put_point(unsigned char *p, const tl_contact_point_record *r, uint32_t id) {
    tl_put_words(p, r->a, 7); /* and b and the impulse */
    tl_put_word(p + 28, id);
}

/* Two points and two more, `point` bytes from each to the next: in this order, as an id may end in the next point. */
static void put_points(unsigned char *p, const tl_contact_point_record *r, const tl_contact_point_record *more,
                       const uint32_t *ids, size_t point) {
    put_point(p, &r[0], ids[0]);
    put_point(p + point, &r[1], ids[1]);
    put_point(p + 2u * point, &more[0], ids[2]);
    put_point(p + 3u * point, &more[1], ids[3]);
}

static unsigned char *put_contact(unsigned char *p, const slots *s, uint32_t contact) {
    const tl_contact_meta *m = &s->metas[contact];
    const tl_contact_head *head = &s->heads[contact];
    const tl_pair_cache *cache = &s->caches[contact];
    uint32_t count = m->count, cached = cache_words(cache), friction[5];
    const tl_contact_point_record *r = s->points[contact].p, *more = r + more_of(count);
    uint32_t ids[POINTS] = {turned(r[0].id), turned(r[1].id), turned(more[0].id), turned(more[1].id)};
    uint32_t wide = (ids[0] | ids[1] | ids[2] | ids[3]) >> 24 != 0;
    memcpy(friction, head->friction, 20); /* and the twist and the lift */
    uint64_t f = pair_of(friction), g = pair_of(friction + 2);
    uint32_t rubs = ((f | g) & ~SIGNS) != 0, lift = friction[4], lifted = lift != 0;
    p = tl_put_word(p, count | m->color << AT_COLOR | m->flags << AT_FLAGS | rubs << AT_RUBS | cached << AT_CACHE |
                           wide << AT_WIDE | (signs_of(f) | signs_of(g) << 2) << AT_SIGNS | lifted << AT_LIFT);
    if (s->few_shapes) {
        p = tl_put_word(p, m->shape_a | m->shape_b << 16);
    } else {
        p = tl_put_word(tl_put_word(p, m->shape_a), m->shape_b);
    }
    p = tl_put_word(p, m->motion);
    tl_put_words(p, head->normal, 7); /* and friction and twist */
    p += 12u + 16u * rubs;
    tl_put_word(p, lift);
    p += 4u * lifted;
    tl_put_words(p, cache->word, 4);
    p += 4u * cached;
    if (wide) { /* seldom */
        put_points(p, r, more, ids, 32);
        return p + 32u * count;
    }
    put_points(p, r, more, ids, 31);
    return p + 31u * count;
}

unsigned char *tl_pack_contacts(unsigned char *p, const tl_header *h) {
    const slots s = slots_of(h);
    const uint64_t *alive = tl_contact_alive(h);
    for (uint32_t w = 0, words = tl_bit_words(h->contacts.high); w < words; w++) {
        p = tl_put_word(tl_put_word(p, (uint32_t)alive[w]), (uint32_t)(alive[w] >> 32));
        for (uint64_t word = alive[w]; word; word &= word - 1u) {
            tl_prefetch((const void *)((uintptr_t)p + AHEAD)); /* what is written has to be fetched, too */
            tl_prefetch((const void *)((uintptr_t)p + AHEAD + 64u));
            p = put_contact(p, &s, 64u * w + tl_bit_lowest(word));
        }
    }
    return p;
}

/* --- unpacking -------------------------------------------------------------------------------- */

/* From the entry of `count` on backwards: all bits for each point that is there, none for the others. */
#define ALL ~(uint32_t)0
#define ALL_8                                                                                                          \
    { ALL, ALL, ALL, ALL, ALL, ALL, ALL, ALL }
static const uint32_t THERE[2u * POINTS][8] = {{0}, {0}, {0}, {0}, ALL_8, ALL_8, ALL_8, ALL_8};

static tl_i8 words_from(const unsigned char *p) {
    int32_t words[8];
    if (!tl_high_byte_first()) {
        return tl_i8_loadu((const int32_t *)(const void *)p);
    }
    tl_get_words(p, words, 8);
    return tl_i8_loadu(words);
}

/* All four points, as put_points put them. */
static void get_points(const unsigned char *p, tl_contact_point_record *r, uint32_t count, size_t point,
                       uint32_t id_mask) {
    for (uint32_t k = 0; k < POINTS; k++, p += point) {
        const uint32_t *there = THERE[count + POINTS - 1u - k];
        tl_i8 mask = tl_i8_loadu((const int32_t *)(const void *)there);
        tl_i8_storeu((int32_t *)(void *)r[k].a, tl_i8_and(words_from(p), mask));
        r[k].id = turned_back(tl_get_word(p + 28) & id_mask & there[7]);
    }
}

#define S 0x80000000u
static const uint32_t SIGNED[16][4] = {
    {0, 0, 0, 0}, {S, 0, 0, 0}, {0, S, 0, 0}, {S, S, 0, 0}, {0, 0, S, 0}, {S, 0, S, 0}, {0, S, S, 0}, {S, S, S, 0},
    {0, 0, 0, S}, {S, 0, 0, S}, {0, S, 0, S}, {S, S, 0, S}, {0, 0, S, S}, {S, 0, S, S}, {0, S, S, S}, {S, S, S, S}};

/* Friction and twist, of which there is nothing but the signs if the contact does not rub. */
static void get_friction(const unsigned char *p, float *friction, uint32_t signs, uint32_t rubs) {
    uint32_t words[4];
    tl_get_words(p, words, 4);
    for (uint32_t i = 0; i < 4u; i++) {
        words[i] = (words[i] & (0u - rubs)) | SIGNED[signs][i];
    }
    memcpy(friction, words, 16);
}

static const uint32_t FIRST_WORDS[5][4] = {
    {0, 0, 0, 0}, {~0u, 0, 0, 0}, {~0u, ~0u, 0, 0}, {~0u, ~0u, ~0u, 0}, {~0u, ~0u, ~0u, ~0u}};

/* Puts down which contact it is; what stood in its slot goes if that was another. */
static void get_meta(tl_contact_meta *m, const tl_contact_meta *is, tl_header *h, uint32_t contact,
                     tl_changes *changes) {
    if ((m->shape_a ^ is->shape_a) | (m->shape_b ^ is->shape_b) | (m->color ^ is->color) |
        ((m->flags ^ is->flags) & (TL_CONTACT_ALIVE | TL_CONTACT_COLORED))) {
        tl_reindex_part_contact(h, contact);
        tl_contact_order(h)[changes->contacts++] = contact;
    }
    m->flags = is->flags, m->count = is->count, m->shape_a = is->shape_a, m->shape_b = is->shape_b;
    m->motion = is->motion, m->color = is->color;
}

/* A contact's bytes from p on, MOST of which can be read. Returns where they end, or null if they are no contact. */
static const unsigned char *get_contact(const unsigned char *p, const slots *s, tl_header *h, uint32_t contact,
                                        tl_changes *changes) {
    uint32_t code = tl_get_word(p), count = code & 7u, cached = code >> AT_CACHE & 7u;
    tl_contact_meta is;
    is.flags = code >> AT_FLAGS & 255u, is.count = count, is.color = code >> AT_COLOR & 127u;
    if (count > POINTS || cached > 4u || !(is.flags & TL_CONTACT_ALIVE) || is.color > TL_COLORS) {
        return NULL;
    }
    is.shape_a = tl_get_word(p + 4), is.shape_b = is.shape_a >> 16;
    if (s->few_shapes) {
        is.shape_a &= 0xffffu;
        p += 8;
    } else {
        is.shape_b = tl_get_word(p + 8);
        p += 12;
    }
    is.motion = tl_get_word(p);
    get_meta(&s->metas[contact], &is, h, contact, changes);
    uint32_t rubs = code >> AT_RUBS & 1u, lifted = code >> AT_LIFT & 1u, words[4];
    tl_get_words(p + 4, s->heads[contact].normal, 3);
    get_friction(p + 16, s->heads[contact].friction, code >> AT_SIGNS & 15u, rubs);
    p += 16u + 16u * rubs;
    uint32_t lift = tl_get_word(p) & (0u - lifted);
    memcpy(&s->heads[contact].lift, &lift, 4);
    p += 4u * lifted;
    tl_get_words(p, words, 4);
    for (uint32_t i = 0; i < 4u; i++) {
        words[i] &= FIRST_WORDS[cached][i];
    }
    memcpy(s->caches[contact].word, words, 16);
    p += 4u * cached;
    if (code >> AT_WIDE & 1u) { /* seldom */
        get_points(p, s->points[contact].p, count, 32, ALL);
        return p + 32u * count;
    }
    get_points(p, s->points[contact].p, count, 31, ALL >> 8);
    return p + 31u * count;
}

/* The same where the bytes may end before the contact does: null then. */
static const unsigned char *get_last_contact(const unsigned char *p, size_t left, const slots *s, tl_header *h,
                                             uint32_t contact, tl_changes *changes) {
    unsigned char last[MOST] = {0};
    memcpy(last, p, left);
    const unsigned char *to = get_contact(last, s, h, contact, changes);
    return to && (size_t)(to - last) <= left ? p + (to - last) : NULL;
}

/* The contacts of one word of contact_alive, which was `was`. */
static const unsigned char *get_word(const unsigned char *p, const unsigned char *end, const slots *s, tl_header *h,
                                     uint32_t w, tl_changes *changes) {
    uint64_t *alive = &tl_contact_alive(h)[w];
    uint32_t high = h->contacts.high - 64u * w;
    uint64_t all = high < 64u ? ((uint64_t)1 << high) - 1u : ~(uint64_t)0;
    if (end - p < 8 || (tl_get_long_word(p) & ~all)) {
        return NULL;
    }
    uint64_t gone = *alive & all & ~tl_get_long_word(p);
    *alive = tl_get_long_word(p);
    p += 8;
    for (; gone; gone &= gone - 1u) {
        uint32_t contact = 64u * w + tl_bit_lowest(gone);
        tl_reindex_part_contact(h, contact);
        tl_contact_clear(h, contact);
    }
    for (uint64_t word = *alive; word; word &= word - 1u) {
        uint32_t contact = 64u * w + tl_bit_lowest(word);
        size_t left = (size_t)(end - p);
        if (left < MOST) {
            p = get_last_contact(p, left, s, h, contact, changes);
        } else {
            p = get_contact(p, s, h, contact, changes);
        }
        if (!p) {
            return NULL;
        }
    }
    return p;
}

const unsigned char *tl_unpack_contacts(const unsigned char *p, const unsigned char *end, tl_header *h,
                                        tl_changes *changes) {
    const slots s = slots_of(h);
    uint64_t *alive = tl_contact_alive(h);
    uint32_t words = tl_bit_words(h->contacts.high), used = 0;
    for (uint32_t w = 0; w < words && p; w++) {
        p = get_word(p, end, &s, h, w, changes);
        used += tl_bit_count(alive[w]);
    }
    memset(alive + words, 0, (h->capacity[TL_COUNT_CONTACTBIT] - words) * sizeof *alive);
    return used == h->contacts.used && tl_bit_end(alive, 64u * words) == h->contacts.high ? p : NULL;
}

/* Recordings: what is recorded is replayed to the bit, up to a cut; damage is found where it is. */
#include "record_kit.h"

#define THINGS 10u

typedef struct play {
    uint32_t seed;
    talus_world world;
    talus_body body[THINGS];
    talus_shape shape[THINGS];
    talus_joint joint[THINGS];
    uint32_t seen[TALUS_COMMAND_COUNT]; /* how often a kind was done */
} play;

static uint32_t draw(play *p, uint32_t below) {
    p->seed = p->seed * 1664525u + 1013904223u;
    return (p->seed >> 8) % below;
}
static float between(play *p, float low, float high) { return low + (high - low) * (float)draw(p, 4096) / 4096.0f; }
static talus_vec3 any(play *p, float most) {
    talus_vec3 v;
    v.x = between(p, -most, most), v.y = between(p, -most, most), v.z = between(p, -most, most);
    return v;
}

static void open_play(play *p, uint32_t seed, const void *hull, size_t hull_bytes) {
    talus_world_def def = kit_small();
    def.sleep_time = 0.1f;
    memset(p, 0, sizeof *p);
    p->seed = seed;
    p->world = kit_world(&def);
    kit_busy(&p->world, hull, hull_bytes);
}

static talus_status make(play *p, talus_command_kind kind, uint32_t i) {
    if (kind == TALUS_COMMAND_BODY_CREATE) {
        talus_body_def def = talus_body_def_default();
        def.type = draw(p, 3) ? TALUS_DYNAMIC : draw(p, 2) ? TALUS_KINEMATIC : TALUS_STATIC;
        def.pose.position = any(p, 3.0f);
        def.pose.position.y += 5.0f;
        def.user_data = p->seed;
        return talus_body_create(&p->world, &def, &p->body[i]);
    }
    if (kind == TALUS_COMMAND_SHAPE_CREATE) {
        talus_shape_def def = kit_box_def(0.2f, 0.3f, 0.25f);
        def.geometry.type = draw(p, 2) ? TALUS_HULL : TALUS_BOX;
        return talus_shape_create(&p->world, p->body[draw(p, THINGS)], &def, &p->shape[i]);
    }
    talus_joint_def def = talus_joint_def_default();
    talus_joint_make_distance(&def, 0.5f, 2.0f);
    def.a = p->body[draw(p, THINGS)], def.b = p->body[draw(p, THINGS)];
    return talus_joint_create(&p->world, &def, &p->joint[i]);
}

static talus_status push(play *p, talus_command_kind kind, talus_body body) {
    talus_world *w = &p->world;
    talus_pose pose = kit_pose(between(p, -2.0f, 2.0f), between(p, 1.0f, 4.0f), 0.0f);
    switch (kind) {
    case TALUS_COMMAND_BODY_SET_POSE:
        return talus_body_set_pose(w, body, &pose);
    case TALUS_COMMAND_BODY_MOVE_TO:
        return talus_body_move_to(w, body, &pose, 0.5f);
    case TALUS_COMMAND_BODY_SET_VELOCITY:
        return talus_body_set_velocity(w, body, any(p, 3.0f), any(p, 3.0f));
    case TALUS_COMMAND_BODY_APPLY_FORCE:
        return talus_body_apply_force(w, body, any(p, 900.0f), any(p, 3.0f));
    case TALUS_COMMAND_BODY_APPLY_TORQUE:
        return talus_body_apply_torque(w, body, any(p, 90.0f));
    case TALUS_COMMAND_BODY_APPLY_IMPULSE:
        return talus_body_apply_impulse(w, body, any(p, 90.0f), any(p, 3.0f));
    default:
        return talus_body_apply_angular_impulse(w, body, any(p, 9.0f));
    }
}

static talus_status set(play *p, talus_command_kind kind, uint32_t i) {
    talus_world *w = &p->world;
    talus_material material = {between(p, 0.0f, 1.0f), 0.25f, between(p, 0.0f, 1.0f), 0.01f, TALUS_COMBINE_MAXIMUM,
                               TALUS_COMBINE_MULTIPLY};
    talus_filter filter = {1u, draw(p, 3) ? ~(uint64_t)0 : 2u, 0};
    talus_mass mass = {between(p, 1.0f, 50.0f), {0.0f, 0.1f, 0.0f}, {{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}};
    talus_drive drive = {1, 0, 0.5f, 1.0f, 10.0f, 1.0f, 100.0f};
    talus_accuracy accuracy = {draw(p, 3) ? 1e-3f : 0.0f, 2u + draw(p, 3), 16};
    switch (kind) {
    case TALUS_COMMAND_WORLD_SET_ACCURACY:
        return talus_world_set_accuracy(w, &accuracy);
    case TALUS_COMMAND_WORLD_SET_GRAVITY:
        return talus_world_set_gravity(w, kit_vec(0.0f, between(p, -11.0f, -8.0f), 0.0f));
    case TALUS_COMMAND_BODY_SET_MASS:
        return talus_body_set_mass(w, p->body[i], &mass);
    case TALUS_COMMAND_BODY_SET_DAMPING:
        return talus_body_set_damping(w, p->body[i], 0.1f, 0.2f);
    case TALUS_COMMAND_BODY_SET_GRAVITY_SCALE:
        return talus_body_set_gravity_scale(w, p->body[i], between(p, 0.5f, 1.5f));
    case TALUS_COMMAND_BODY_SET_LOCKS:
        return talus_body_set_locks(w, p->body[i], draw(p, 64));
    case TALUS_COMMAND_SHAPE_SET_MATERIAL:
        return talus_shape_set_material(w, p->shape[i], &material);
    case TALUS_COMMAND_SHAPE_SET_FILTER:
        return talus_shape_set_filter(w, p->shape[i], &filter);
    default:
        return draw(p, 2) ? talus_joint_set_linear_drive(w, p->joint[i], (int)draw(p, 3), &drive)
                          : talus_joint_set_angular_drive(w, p->joint[i], (int)draw(p, 3), &drive);
    }
}

static talus_status flip(play *p) {
    talus_command c;
    c.kind = TALUS_COMMAND_WORLD_FLIP;
    c.as.flip.column = 2; /* the poses of bodies: low bits of a coordinate */
    c.as.flip.row = 1, c.as.flip.bit = draw(p, 8);
    return talus_world_apply(&p->world, &c);
}

/* Tries a command of a kind on random things; many are refused. */
static void act(play *p, talus_command_kind kind) {
    uint32_t i = draw(p, THINGS);
    talus_world *w = &p->world;
    talus_status status;
    switch (kind) {
    case TALUS_COMMAND_BODY_CREATE:
    case TALUS_COMMAND_SHAPE_CREATE:
    case TALUS_COMMAND_JOINT_CREATE:
        status = make(p, kind, i);
        break;
    case TALUS_COMMAND_BODY_DESTROY:
        status = draw(p, 3) ? TALUS_OK : talus_body_destroy(w, p->body[i]);
        break;
    case TALUS_COMMAND_SHAPE_DESTROY:
        status = talus_shape_destroy(w, p->shape[i]);
        break;
    case TALUS_COMMAND_JOINT_DESTROY:
        status = talus_joint_destroy(w, p->joint[i]);
        break;
    case TALUS_COMMAND_BODY_MASS_FROM_SHAPES:
        status = talus_body_mass_from_shapes(w, p->body[i]);
        break;
    case TALUS_COMMAND_BODY_WAKE:
        status = talus_body_wake(w, p->body[i]);
        break;
    case TALUS_COMMAND_BODY_SLEEP:
        status = talus_body_sleep(w, p->body[i]);
        break;
    case TALUS_COMMAND_WORLD_FLIP:
        status = flip(p);
        break;
    case TALUS_COMMAND_WORLD_STEP:
        return;
    case TALUS_COMMAND_BODY_SET_POSE:
    case TALUS_COMMAND_BODY_MOVE_TO:
    case TALUS_COMMAND_BODY_SET_VELOCITY:
    case TALUS_COMMAND_BODY_APPLY_FORCE:
    case TALUS_COMMAND_BODY_APPLY_TORQUE:
    case TALUS_COMMAND_BODY_APPLY_IMPULSE:
    case TALUS_COMMAND_BODY_APPLY_ANGULAR_IMPULSE:
        status = push(p, kind, p->body[i]);
        break;
    default:
        status = set(p, kind, i);
        break;
    }
    p->seen[kind] += status == TALUS_OK;
}

/* Records `steps` steps with `most` random commands in each; *hashes, if it is not null, receives the state's hash
 * before and after each. */
static void record(play *p, tape *t, uint32_t steps, uint32_t most, uint64_t *hashes) {
    tape_begin(t, &p->world, 1u << 16);
    t->recorder.keyframe_work = 300;
    for (uint32_t s = 0; s < steps; s++) {
        if (hashes) {
            hashes[s] = talus_world_hash(&p->world);
        }
        for (uint32_t k = draw(p, most + 1u); k > 0; k--) {
            act(p, (talus_command_kind)draw(p, TALUS_COMMAND_COUNT));
        }
        tape_step(t, &p->world);
    }
    if (hashes) {
        hashes[steps] = talus_world_hash(&p->world);
    }
}

/* Replays to the end; every state must be the recorded one. */
static void replay_all(player *p, const uint64_t *hashes, uint32_t from) {
    talus_replayed done;
    uint32_t step = from;
    assert_true(talus_world_hash(&p->world) == hashes[from]);
    while ((done = talus_replay_step(&p->replay, &p->world)) != TALUS_REPLAYED_END) {
        assert_true(done == TALUS_REPLAYED || done == TALUS_REPLAYED_GAP);
        assert_true(talus_replay_compare(&p->replay, &p->world) == 0);
        step++;
        assert_int_equal(p->replay.step, step);
        assert_true(talus_world_hash(&p->world) == hashes[step]);
    }
    assert_int_equal(step, p->replay.steps);
}

#define STEPS 240u

static void every_command_is_replayed(void **state) {
    (void)state;
    size_t hull_bytes;
    void *hull = kit_hull_region(&hull_bytes);
    play p;
    tape t;
    uint64_t hashes[STEPS + 1];
    print_message("seed %u\n", 4711u);
    open_play(&p, 4711u, hull, hull_bytes);
    record(&p, &t, STEPS, 12, hashes);
    tape_end(&t, &p.world);
    assert_null(p.world.log);
    for (int kind = 1; kind < TALUS_COMMAND_COUNT; kind++) {
        if (p.seen[kind] == 0) {
            fail_msg("%s was never done", talus_command_name((talus_command_kind)kind));
        }
    }
    for (int isa = TALUS_ISA_SCALAR; isa < TALUS_ISA_COUNT; isa++) {
        player q;
        if (!talus_isa_available((talus_isa)isa)) {
            continue;
        }
        OK(player_open(&q, t.bytes, t.size));
        OK(talus_world_set_isa(&q.world, (talus_isa)isa));
        assert_int_equal(q.replay.steps, STEPS);
        assert_int_equal(q.replay.cut, 0);
        assert_true(q.replay.keyframes > 5);
        replay_all(&q, hashes, 0);
        for (uint32_t k = 0; k < 12; k++) { /* from any keyframe on */
            uint32_t step = draw(&p, STEPS + 1u);
            OK(talus_replay_seek(&q.replay, &q.world, step));
            assert_true(q.replay.step <= step && step - q.replay.step < 40u);
            replay_all(&q, hashes, q.replay.step);
        }
        player_close(&q);
    }
    tape_free(&t);
    kit_end(&p.world);
    kit_free(hull);
}

/* Steps whose commands did not fit, and restored worlds, are recorded by their outcome. */
static void gaps_are_bridged(void **state) {
    (void)state;
    size_t hull_bytes, size;
    void *hull = kit_hull_region(&hull_bytes);
    play p;
    tape t;
    uint64_t hashes[61];
    open_play(&p, 99u, hull, hull_bytes);
    size = talus_world_save_size(&p.world) + 65536u;
    void *snapshot = malloc(size);
    OK(talus_world_save(&p.world, snapshot, size, &size));
    tape_begin(&t, &p.world, 64);
    for (uint32_t s = 0; s < 60; s++) {
        hashes[s] = talus_world_hash(&p.world);
        if (s == 20) {
            OK(talus_world_restore(&p.world, snapshot, size));
        }
        if (s == 40) {
            for (uint32_t k = 0; k < 30; k++) {
                act(&p, TALUS_COMMAND_BODY_CREATE);
            }
        }
        tape_step(&t, &p.world);
    }
    hashes[60] = talus_world_hash(&p.world);
    tape_end(&t, &p.world);
    assert_int_equal(t.recorder.gaps, 2);
    player q;
    OK(player_open(&q, t.bytes, t.size));
    replay_all(&q, hashes, 0);
    player_close(&q);
    tape_free(&t);
    free(snapshot);
    kit_end(&p.world);
    kit_free(hull);
}

/* Hulls that are added while recording are in the recording too. */
static void hulls_come_later(void **state) {
    (void)state;
    size_t hull_bytes;
    void *hull = kit_hull_region(&hull_bytes);
    unsigned char *region = kit_alloc(4u * hull_bytes);
    memset(region, 0, 4u * hull_bytes);
    memcpy(region, hull, hull_bytes);
    play p;
    tape t;
    uint64_t hashes[41];
    open_play(&p, 5u, region, hull_bytes);
    tape_begin(&t, &p.world, 1u << 16);
    for (uint32_t s = 0; s < 40; s++) {
        hashes[s] = talus_world_hash(&p.world);
        if (s == 10) {
            memcpy(region + 3u * hull_bytes, hull, hull_bytes);
            p.world.geometry_bytes = 4u * hull_bytes;
            talus_shape_def def = talus_shape_def_default();
            def.geometry.type = TALUS_HULL;
            def.geometry.hull = (uint32_t)(3u * hull_bytes);
            kit_shape(&p.world, kit_body(&p.world, TALUS_DYNAMIC, kit_vec(0.0f, 3.0f, 0.0f)), &def);
        }
        tape_step(&t, &p.world);
    }
    hashes[40] = talus_world_hash(&p.world);
    tape_end(&t, &p.world);
    /* Where there is no room for them the step is told to have failed. */
    tape narrow;
    const void *bytes;
    size_t size;
    p.world.geometry_bytes = hull_bytes;
    tape_begin(&narrow, &p.world, 64);
    p.world.geometry_bytes = 4u * hull_bytes;
    OK(talus_world_step(&p.world, 0.01f, NULL, NULL));
    assert_int_equal(talus_recorder_step(&narrow.recorder, &p.world, &bytes, &size), TALUS_SMALL_BLOCK);
    tape_free(&narrow);
    player q;
    OK(player_open(&q, t.bytes, t.size));
    assert_int_equal(q.replay.geometry_bytes, 4u * hull_bytes);
    replay_all(&q, hashes, 0);
    assert_memory_equal((unsigned char *)q.geometry + 3u * hull_bytes, hull, hull_bytes);
    player_close(&q);
    tape_free(&t);
    kit_end(&p.world);
    kit_free(region);
    kit_free(hull);
}

/* A small recording: few bodies, a hull, some commands. */
static void record_small(play *p, tape *t, uint32_t steps, uint64_t *hashes, void **hull) {
    size_t hull_bytes;
    talus_world_def def = kit_small();
    *hull = kit_hull_region(&hull_bytes);
    def.body_capacity = 4, def.shape_capacity = 4, def.joint_capacity = 2, def.contact_capacity = 8;
    memset(p, 0, sizeof *p);
    p->seed = 1;
    p->world = kit_world(&def);
    p->world.geometry = *hull;
    p->world.geometry_bytes = hull_bytes;
    kit_floor(&p->world);
    talus_shape_def shape = talus_shape_def_default();
    shape.geometry.type = TALUS_HULL;
    p->body[0] = kit_body(&p->world, TALUS_DYNAMIC, kit_vec(0.0f, 0.6f, 0.0f));
    kit_shape(&p->world, p->body[0], &shape);
    record(p, t, steps, 3, hashes);
    tape_end(t, &p->world);
}

static void cut_anywhere(void **state) {
    (void)state;
    play p;
    tape t;
    void *hull;
    uint64_t hashes[25];
    record_small(&p, &t, 24, hashes, &hull);
    uint32_t last = 0, whole = 0;
    for (size_t cut = 0; cut < t.size; cut++) {
        unsigned char *bytes = malloc(cut + 1u); /* so that a sanitizer sees the end */
        memcpy(bytes, t.bytes, cut);
        player q;
        talus_status status = player_open(&q, bytes, cut);
        if (status == TALUS_OK) {
            assert_true(q.replay.cut && q.replay.offset <= cut && q.replay.steps >= last);
            last = q.replay.steps;
            whole++;
            replay_all(&q, hashes, 0);
        } else {
            assert_int_equal(status, TALUS_BAD_BLOB);
            assert_int_equal(q.replay.fault, TALUS_FAULT_TOO_SHORT);
            assert_true(whole == 0 && q.replay.offset == cut);
        }
        player_close(&q);
        free(bytes);
    }
    assert_int_equal(last, 24);
    tape_free(&t);
    kit_end(&p.world);
    kit_free(hull);
}

/* Where the chunk begins in which a byte stands: 0 to 15 are the head. */
static size_t chunk_of(const tape *t, size_t byte) {
    size_t at = 16;
    while (byte >= 16u && at < t->size) {
        const unsigned char *p = t->bytes + at + 4;
        size_t end = at + 20u + ((size_t)p[0] | (size_t)p[1] << 8 | (size_t)p[2] << 16);
        if (byte < end) {
            return at;
        }
        at = end;
    }
    return 0;
}

static void damage_is_found_where_it_is(void **state) {
    (void)state;
    play p;
    tape t;
    void *hull;
    record_small(&p, &t, 24, NULL, &hull);
    for (size_t i = 0; i < t.size; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            unsigned char was = t.bytes[i];
            t.bytes[i] ^= (unsigned char)(k == 0 ? 1u : k == 1u ? 0x80u : 1u + draw(&p, 255));
            talus_replay r;
            assert_int_equal(talus_replay_open(&r, t.bytes, t.size), TALUS_BAD_BLOB);
            if (i < 16u) {
                assert_int_equal(r.fault, i < 8    ? TALUS_FAULT_NO_RECORDING
                                          : i < 12 ? TALUS_FAULT_OTHER_VERSION
                                                   : TALUS_FAULT_OTHER_LAYOUT);
            } else {
                assert_int_equal(r.fault, TALUS_FAULT_DAMAGED);
                t.bytes[i] = was;
                assert_int_equal(r.offset, chunk_of(&t, i));
            }
            t.bytes[i] = was;
        }
    }
    talus_replay r;
    OK(talus_replay_open(&r, t.bytes, t.size));
    for (int f = 0; f <= TALUS_FAULT_COUNT; f++) {
        assert_true(strlen(talus_fault_text((talus_fault)f)) > 3);
    }
    tape_free(&t);
    kit_end(&p.world);
    kit_free(hull);
}

/* A state or command that is another than when recorded is told with the columns that differ. */
static void other_runs_are_told(void **state) {
    (void)state;
    size_t hull_bytes;
    void *hull = kit_hull_region(&hull_bytes);
    play p;
    tape t;
    open_play(&p, 8u, hull, hull_bytes);
    record(&p, &t, 29, 4, NULL);
    const talus_body first = {1, 1};
    OK(talus_body_set_velocity(&p.world, first, kit_vec(0.0f, 0.0f, 0.0f), kit_vec(0.0f, 0.0f, 0.0f)));
    tape_step(&t, &p.world);
    tape_end(&t, &p.world);
    player q;
    OK(player_open(&q, t.bytes, t.size));
    for (int s = 0; s < 10; s++) {
        assert_int_equal(talus_replay_step(&q.replay, &q.world), TALUS_REPLAYED);
    }
    talus_command c;
    c.kind = TALUS_COMMAND_WORLD_FLIP;
    c.as.flip.column = 4, c.as.flip.row = 2, c.as.flip.bit = 3;
    OK(talus_world_apply(&q.world, &c));
    assert_true(talus_replay_compare(&q.replay, &q.world) == (uint64_t)1 << 4);
    OK(talus_body_destroy(&q.world, first));
    while (q.replay.step < 29u) {
        talus_replay_step(&q.replay, &q.world);
        assert_true(talus_replay_compare(&q.replay, &q.world) != 0);
    }
    assert_int_equal(talus_replay_step(&q.replay, &q.world), TALUS_REPLAYED_REFUSED);
    assert_int_equal(q.replay.refused, TALUS_STALE_HANDLE);
    player_close(&q);
    tape_free(&t);
    kit_end(&p.world);
    kit_free(hull);
}

static void bad_arguments(void **state) {
    (void)state;
    talus_world_def def = kit_small();
    talus_world world = kit_world(&def), none = {NULL, NULL, 0, NULL};
    size_t room = talus_recorder_size(&world, 0), size;
    const void *bytes;
    void *memory = malloc(room);
    talus_recorder r;
    talus_replay replay;
    assert_int_equal(talus_recorder_size(&none, 0), 0);
    assert_int_equal(talus_recorder_begin(&r, &world, memory, room - 1u, &bytes, &size), TALUS_SMALL_BLOCK);
    assert_int_equal(talus_recorder_begin(NULL, &world, memory, room, &bytes, &size), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_recorder_begin(&r, &none, memory, room, &bytes, &size), TALUS_BAD_ARGUMENT);
    OK(talus_recorder_begin(&r, &world, memory, room, &bytes, &size));
    OK(talus_replay_open(&replay, bytes, size));
    assert_int_equal(talus_replay_begin(&replay, &none, NULL, 0, NULL, 0), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_replay_seek(&replay, &none, 0), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_replay_step(&replay, &none), TALUS_REPLAYED_END);
    assert_int_equal(talus_replay_next(NULL), 0);
    OK(talus_recorder_end(&r, &world, &bytes, &size));
    assert_int_equal(talus_recorder_step(&r, &world, &bytes, &size), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_recorder_end(&r, &world, &bytes, &size), TALUS_BAD_ARGUMENT);
    assert_int_equal(talus_replay_open(&replay, NULL, 0), TALUS_BAD_ARGUMENT);
    free(memory);
    kit_end(&world);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_command_is_replayed),
        cmocka_unit_test(gaps_are_bridged),
        cmocka_unit_test(hulls_come_later),
        cmocka_unit_test(cut_anywhere),
        cmocka_unit_test(damage_is_found_where_it_is),
        cmocka_unit_test(other_runs_are_told),
        cmocka_unit_test(bad_arguments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

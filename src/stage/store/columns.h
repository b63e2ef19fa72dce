/* The column table: every array of the block, in the order in which they lie in it.
 *
 * X(name, type, count, stage, life, word): `count` names a capacity, `stage` the one stage that writes the column
 * during a step, `life` whether it is part of the state (STATE: hashed, compared, saved), an index that makes steps
 * fast and never shows in the state's bits (INDEX: trees, pairs, lists) or is what steps leave behind (STEP), `word`
 * the bytes of its members, which are all of one size so that the hash does not depend on the byte order. */
#ifndef TL_COLUMNS_H
#define TL_COLUMNS_H

#include "stage/store/records.h"
#include "stage/store/rows.h"

#define TL_COLUMNS(X)                                                                                                  \
    X(definitions, uint32_t, DEFINITION, COMMANDS, INDEX, 4)                                                           \
    /* bodies */                                                                                                       \
    X(body_pose, tl_row8, BODY, COMMIT, STATE, 4)                                                                      \
    X(body_velocity, tl_row8, BODY, COMMIT, STATE, 4)                                                                  \
    X(body_momentum, tl_row8, BODY, COMMIT, STATE, 4)                                                                  \
    X(body_inertias, tl_body_inertia, BODY, COMMANDS, STATE, 4)                                                        \
    X(body_frame, tl_row8, BODY, COMMANDS, STATE, 4)                                                                   \
    X(body_force, tl_row8, BODY, COMMANDS, STATE, 4)                                                                   \
    X(body_motion, uint32_t, BODY, COMMIT, STATE, 4)                                                                   \
    X(bodies, tl_body_meta, BODY, COMMANDS, STATE, 4)                                                                  \
    X(body_quiets, tl_body_quiet, BODY, SLEEP, STATE, 4)                                                               \
    X(body_efforts, tl_body_effort, BODY, COMMIT, STATE, 4)                                                            \
    X(body_colors, uint64_t, BODY, ISLANDS, INDEX, 8)                                                                  \
    X(body_mass, talus_mass, BODY, COMMANDS, STATE, 4)                                                                 \
    X(body_user, uint64_t, BODY, COMMANDS, STATE, 8)                                                                   \
    X(body_previous, tl_row8, BODY, COMMIT, INDEX, 4)                                                                  \
    X(body_links, tl_body_link, BODY, SLEEP, INDEX, 4)                                                                 \
    X(body_row, uint32_t, BODY, SLEEP, INDEX, 4)                                                                       \
    X(awake_body, uint32_t, BODY, SLEEP, INDEX, 4)                                                                     \
    X(body_way, uint32_t, BODY, NARROW, INDEX, 4)                                                                      \
    X(body_room, uint32_t, BODY, REFIT, INDEX, 4)                                                                      \
    /* shapes */                                                                                                       \
    X(shape_place, tl_row8, SHAPE, COMMANDS, STATE, 4)                                                                 \
    X(shape_geometry, talus_geometry, SHAPE, COMMANDS, STATE, 4)                                                       \
    X(shapes, tl_shape_meta, SHAPE, COMMANDS, STATE, 4)                                                                \
    X(shape_material, tl_material, SHAPE, COMMANDS, STATE, 4)                                                          \
    X(shape_category, uint64_t, SHAPE, COMMANDS, STATE, 8)                                                             \
    X(shape_mask, uint64_t, SHAPE, COMMANDS, STATE, 8)                                                                 \
    X(shape_pose, talus_pose, SHAPE, COMMANDS, STATE, 4)                                                               \
    X(shape_user, uint64_t, SHAPE, COMMANDS, STATE, 8)                                                                 \
    X(shape_tracks, tl_shape_track, SHAPE, REFIT, INDEX, 4)                                                            \
    X(shape_bounds, talus_aabb, SHAPE, REFIT, INDEX, 4)                                                                \
    X(nodes, tl_tree_node, NODE, REFIT, INDEX, 4)                                                                      \
    X(moved_shape, uint32_t, SHAPE, REFIT, INDEX, 4)                                                                   \
    /* pairs */                                                                                                        \
    X(pairs, tl_pair, PAIR, PAIRS, INDEX, 4)                                                                           \
    X(pair_links, tl_pair_link, PAIR, PAIRS, INDEX, 4)                                                                 \
    X(pair_hints, tl_pair_cache, PAIR, NARROW, INDEX, 4)                                                               \
    X(pair_slot, uint32_t, SLOT, PAIRS, INDEX, 4)                                                                      \
    X(awake_pair, uint32_t, PAIR, PAIRS, INDEX, 4)                                                                     \
    X(new_touch, uint64_t, CONTACT, NARROW, STEP, 8)                                                                   \
    /* contacts */                                                                                                     \
    X(heads, tl_contact_head, CONTACT, NARROW, STATE, 4)                                                               \
    X(points, tl_contact_points, CONTACT, NARROW, STATE, 4)                                                            \
    X(contacts, tl_contact_meta, CONTACT, NARROW, STATE, 4)                                                            \
    X(contact_caches, tl_pair_cache, CONTACT, NARROW, STATE, 4)                                                        \
    X(contact_materials, tl_contact_material, CONTACT, NARROW, INDEX, 4)                                               \
    X(contact_pair, uint32_t, CONTACT, NARROW, INDEX, 4)                                                               \
    X(contact_alive, uint64_t, CONTACTBIT, NARROW, INDEX, 8)                                                           \
    X(contact_awake, uint64_t, CONTACTBIT, NARROW, INDEX, 8)                                                           \
    X(awake_contact, uint32_t, CONTACT, NARROW, STEP, 4)                                                               \
    /* joints */                                                                                                       \
    X(joints, tl_joint_record, JOINT, COMMANDS, STATE, 4)                                                              \
    X(joint_states, tl_joint_state, JOINT, COMMIT, STATE, 4)                                                           \
    X(joint_user, uint64_t, JOINT, COMMANDS, STATE, 8)                                                                 \
    X(joint_awake, uint64_t, JOINTBIT, SLEEP, INDEX, 8)                                                                \
    X(awake_joint, uint32_t, JOINT, NARROW, STEP, 4)                                                                   \
    /* one step's rows */                                                                                              \
    X(row_velocity, tl_row8, ROW, VELOCITY, STEP, 4)                                                                   \
    X(row_before, tl_row8, ROW, VELOCITY, STEP, 4)                                                                     \
    X(row_moved, tl_row8, ROW, POSITION, STEP, 4)                                                                      \
    X(row_momentum, tl_row8, ROW, POSITION, STEP, 4)                                                                   \
    X(row_push, tl_row8, ROW, POSITION, STEP, 4)                                                                       \
    X(row_pose, tl_row8, ROW, POSITION, STEP, 4)                                                                       \
    X(row_frame, tl_row8, ROW, ROWS, STEP, 4)                                                                          \
    X(row_force, tl_row8, ROW, ROWS, STEP, 4)                                                                          \
    X(island_parent, uint32_t, BODY, ISLANDS, STEP, 4)                                                                 \
    X(island_quiet, float, BODY, ISLANDS, STEP, 4)                                                                     \
    X(island_unlifted, float, BODY, ISLANDS, STEP, 4)                                                                  \
    X(contact_order, uint32_t, CONTACT, ROWS, STEP, 4)                                                                 \
    X(row_planes, uint32_t, ROW, ROWS, STEP, 4)                                                                        \
    X(contact_plane, uint32_t, CONTACT, ROWS, STEP, 4)                                                                 \
    X(group_pool, tl_contact_group, GROUP, ROWS, STEP, 4)                                                              \
    X(joint_order, uint32_t, JOINT, ROWS, STEP, 4)                                                                     \
    X(joint_group_pool, tl_joint_group, JOINTGROUP, ROWS, STEP, 4)                                                     \
    X(joint_row_pool, tl_joint_row, JOINTROW, ROWS, STEP, 4)                                                           \
    X(linkages, tl_linkage, JOINT, ROWS, STEP, 4)                                                                      \
    X(linkage_shapes, tl_linkage_shape, JOINT, ROWS, STEP, 4)                                                          \
    X(linkage_nodes, tl_block_node, LINKNODE, ROWS, STEP, 4)                                                           \
    X(linkage_blocks, tl_block, LINKBLOCK, ROWS, STEP, 4)                                                              \
    X(linkage_values, float, LINKVALUE, ROWS, STEP, 4)                                                                 \
    X(linkage_places, uint32_t, JOINT, ROWS, STEP, 4)                                                                  \
    X(linkage_live, uint32_t, JOINT, SOLVE, STEP, 4)                                                                   \
    X(linkage_order, uint32_t, JOINT, ROWS, STEP, 4)                                                                   \
    X(linkage_of, uint32_t, JOINT, ROWS, STEP, 4)                                                                      \
    X(linkage_rows, uint32_t, ROW, ROWS, STEP, 4)                                                                      \
    X(row_stiffness, float, ROW, SOLVE, STEP, 4)                                                                       \
    X(linkage_queue, uint32_t, ROW, ROWS, STEP, 4)                                                                     \
    X(linkage_scratch, uint32_t, LINKSCRATCH, ROWS, STEP, 4)                                                           \
    X(presses, tl_press, PRESSED, ROWS, STEP, 4)                                                                       \
    X(pressed_pool, tl_pressed, PRESSED, ROWS, STEP, 4)                                                                \
    X(press_nodes, tl_block_node, PRESSED, ROWS, STEP, 4)                                                              \
    X(press_blocks, tl_block, PRESSBLOCK, ROWS, STEP, 4)                                                               \
    X(press_values, float, PRESSVALUE, SOLVE, STEP, 4)                                                                 \
    /* what a step tells */                                                                                            \
    X(event_begin, talus_contact_event, EVENT, EVENTS, STEP, 4)                                                        \
    X(event_end, talus_contact_event, EVENT, EVENTS, STEP, 4)                                                          \
    X(event_hit, talus_hit_event, EVENT, EVENTS, STEP, 4)                                                              \
    X(event_sensor_begin, talus_sensor_event, EVENT, EVENTS, STEP, 4)                                                  \
    X(event_sensor_end, talus_sensor_event, EVENT, EVENTS, STEP, 4)                                                    \
    X(event_broken, talus_joint_event, EVENT, EVENTS, STEP, 4)                                                         \
    /* the profiler */                                                                                                 \
    X(row_island, uint32_t, TALLY, COMMIT, STEP, 4)                                                                    \
    X(tallies, tl_island_tally, TALLY, COMMIT, STEP, 4)                                                                \
    X(ring, talus_frame, FRAME, EVENTS, STEP, 4)

#endif

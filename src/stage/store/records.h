/* The records of the block's state columns. Every member has the same size, so that a hash by members is the same in
 * either byte order; nothing is a pointer. */
#ifndef TL_RECORDS_H
#define TL_RECORDS_H

#include "collide/collide.h"
#include "dynamics/block_ldlt.h"
#include "stage/store/rows.h"
#include "talus/body.h"
#include "talus/events.h"
#include "talus/joint.h"
#include "talus/profile.h"
#include "talus/shape.h"

#define TL_NONE 0xffffffffu

/* body_meta.flags; the low two bits are the type */
enum {
    TL_BODY_TYPE = 3,
    TL_BODY_ALIVE = 4,
    TL_BODY_AWAKE = 8,
    TL_BODY_CAN_SLEEP = 16,
    TL_BODY_MASS_SET = 32, /* by the caller */
    TL_BODY_GYRO = 64,     /* its principal inertias differ */
    TL_BODY_FORCE = 128,   /* body_force is not zero */
    TL_BODY_LOCKS = 8      /* the shift of the locks */
};

typedef struct tl_body_meta {
    uint32_t flags, generation;
    uint32_t first_shape, first_joint; /* joint links: twice the index, plus the side */
    uint32_t island;                   /* asleep: the lowest body of those that it fell asleep with, else TL_NONE */
    uint32_t free_next;
    uint32_t moves; /* kinematic: its velocity is not zero */
} tl_body_meta;

typedef struct tl_body_link {
    uint32_t first_pair; /* pair links: twice the index, plus the side */
    uint32_t sleep_next; /* ring of an island that sleeps */
} tl_body_link;

typedef struct tl_body_inertia {
    float inverse_mass;
    float s[3]; /* square roots of the principal inverse inertias */
    float gravity_scale, linear_damping, angular_damping;
    float reach; /* m: no point of its shapes is further from the centre of mass */
} tl_body_inertia;

typedef struct tl_body_quiet {
    float time;  /* s below the sleep speed */
    float speed; /* m/s, when half of the time was over */
} tl_body_quiet;

/* What the body's island gets under an error budget. */
typedef struct tl_body_effort {
    uint32_t level; /* sub-steps: the settings' times two to the level */
    float calm;     /* s: that the errors were far below the budget; below 0: until more is given again */
} tl_body_effort;

/* shape_meta.flags */
enum { TL_SHAPE_ALIVE = 1, TL_SHAPE_SENSOR = 2, TL_SHAPE_EVENTS = 4 };

typedef struct tl_shape_meta {
    uint32_t flags, generation, body, next; /* next in the body, or in the free list */
    int32_t group;
    float density;
} tl_shape_meta;

/* Where the broad phase has a shape. */
typedef struct tl_shape_track {
    talus_aabb fat;  /* as in the tree */
    uint32_t node;   /* the leaf plus one, 0 if it is in no tree */
    uint32_t still;  /* it is in the tree of what does not move */
    uint32_t moved;  /* its place in moved_shape plus one, 0 if it is not there */
    uint32_t motion; /* the body's count when the box was last looked at */
    float free;      /* m: how far it was within the fat box then, beside the speculative margin */
    uint32_t stale;  /* neither says anything: look at the box; it is in moved_shape until that was done */
} tl_shape_track;

typedef struct tl_material {
    float static_friction, dynamic_friction, restitution, rolling_resistance;
    uint32_t friction_combine, restitution_combine;
} tl_material;

typedef struct tl_tree_node {
    talus_aabb box;
    uint32_t parent;   /* in the free list: the next one */
    uint32_t child[2]; /* child[0] TL_NONE: a leaf, child[1] then is the shape */
    uint32_t height;   /* 0 for a leaf */
} tl_tree_node;

typedef struct tl_contact_head {
    float normal[3];   /* in the mass frame of body a, from a to b */
    float friction[3]; /* N s, impulse of friction on b, world axes */
    float twist;       /* N m s about the normal */
    float lift;        /* m: as how much deeper what has long borne a load counts */
} tl_contact_head;

typedef struct tl_contact_point_record {
    float a[3], b[3]; /* m: the touching points of the two surfaces, each in its body's mass frame */
    float impulse;    /* N s, of the last sub-step */
    uint32_t id;
} tl_contact_point_record;

typedef struct tl_contact_points {
    tl_contact_point_record p[TL_MANIFOLD_POINTS];
} tl_contact_points;

/* contact_meta.flags */
enum {
    TL_CONTACT_ALIVE = 1,
    TL_CONTACT_SENSOR = 4,
    TL_CONTACT_EVENTS = 8,
    TL_CONTACT_COLORED = 16,
    TL_CONTACT_CLOSE = 32, /* surfaces overlap or meet: what begin and end events tell */
    TL_CONTACT_FRESH = 64  /* to be looked at whether its bodies moved or not */
};

/* Two shapes that touch, or may within the step. */
typedef struct tl_contact_meta {
    uint32_t flags, count; /* points */
    uint32_t shape_a, shape_b;
    uint32_t body_a, body_b;
    uint32_t motion; /* sum of both bodies' motion counts (micrometres) when the manifold was made */
    uint32_t color;
} tl_contact_meta;

/* Two shapes whose fat boxes overlap. */
typedef struct tl_pair {
    uint32_t shape_a, shape_b; /* a < b; both 0 for a pair that is not in use */
    uint32_t body_a, body_b;
    uint32_t contact;     /* or TL_NONE while they are apart */
    uint32_t awake_index; /* in awake_pair, or TL_NONE */
    uint32_t motion;      /* sum of both bodies' motion counts (micrometres) when they were last looked at */
    uint32_t clear;       /* micrometres that they were apart beyond the speculative margin then */
} tl_pair;

/* In body_way of an awake body: more than any `clear`, so that the next narrow stage looks at all its pairs. */
#define TL_WAY_DOUBTED 0x80000000u

/* The lists of a body's pairs: links hold twice the pair's index plus the side (0: a, 1: b). */
typedef struct tl_pair_link {
    uint32_t next[2], previous[2];
} tl_pair_link;

typedef struct tl_contact_material {
    float static_friction, dynamic_friction, restitution, rolling;
} tl_contact_material;

/* What a row of a joint holds; the code of a row is type + TL_ROW_TYPES * mode. */
enum {
    TL_ROW_LINEAR = 0,  /* + axis */
    TL_ROW_ANGULAR = 3, /* + axis: the twist about it */
    TL_ROW_SWING = 6,   /* + axis: one of two locked axes beside a free one */
    TL_ROW_CONE = 9,    /* + axis */
    TL_ROW_DISTANCE = 12,
    TL_ROW_TYPES = 16
};
enum { TL_ROW_EQUAL = 0, TL_ROW_RANGE = 1, TL_ROW_DRIVE = 2 };

enum { TL_JOINT_ALIVE = 1, TL_JOINT_COLLIDE = 2 };

typedef struct tl_joint_param {
    float lower, upper, stiffness, damping, speed, most, per_mass;
} tl_joint_param;

typedef struct tl_joint_axis_record {
    uint32_t mode;
    float lower, upper, stiffness, damping;
} tl_joint_axis_record;

typedef struct tl_joint_drive_record {
    uint32_t enabled, acceleration;
    float position, speed, stiffness, damping, most;
} tl_joint_drive_record;

typedef struct tl_joint_record {
    uint32_t flags, generation, body_a, body_b;
    uint32_t next[2], previous[2]; /* links: twice the joint's index plus the side */
    uint32_t color, free_next;
    uint32_t rows, fixed, code[TL_JOINT_ROWS];
    uint32_t free_axis;          /* the one angular axis beside two locked ones, or TL_NONE */
    talus_pose place_a, place_b; /* the frames in the mass frames */
    talus_pose frame_a, frame_b; /* as the caller gave them */
    tl_joint_axis_record axis[6];
    tl_joint_drive_record drive[6];
    uint32_t cone_axis; /* TL_NONE: none */
    float cone_angle, cone_stiffness, cone_damping;
    uint32_t distance_enabled;
    float distance_lower, distance_upper, distance_stiffness, distance_damping;
    float break_force, break_torque;
    tl_joint_param param[TL_JOINT_ROWS];
} tl_joint_record;

typedef struct tl_joint_state {
    float impulse[TL_JOINT_ROWS]; /* N s, N m s, of the last sub-step */
    float force[3], torque[3];    /* N, N m on b over the last step */
    float linear_error, angular_error;
} tl_joint_state;

/* What an island holds, at the row of its root; of all islands at row 0. */
typedef struct tl_island_tally {
    uint32_t bodies, contacts, joints, rows; /* as in talus_frame_island */
    uint32_t held;                           /* of the row's body alone: how many contacts and joints hold on to it */
    uint32_t busiest;                        /* the row of the island in which that is most */
} tl_island_tally;

#endif

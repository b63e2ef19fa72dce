/* What the solver streams: body rows of 32 bytes and constraint groups eight lanes wide.
 *
 * Angular velocities are whitened: with the inverse inertia I^-1 = K^T K a body's row holds u, where w = K^T u. An
 * angular Jacobian is then j = K (r x n), used alike to read a velocity (j . u) and to apply an impulse (u += j
 * lambda), so that no inertia is needed in the solver's loop. K = diag(s) R^T with R the frame's rotation. */
#ifndef TL_ROWS_H
#define TL_ROWS_H

#include "talus/types.h"

#define TL_LANES 8u
#define TL_COLORS 64u

typedef struct tl_row8 {
    float f[8];
} tl_row8;

/* Members of a row8, by column:
 *   body_pose, row_pose      centre of mass x y z (m), rotation of the principal axes x y z w, 0
 *   body_velocity            v x y z (m/s), w x y z (rad/s), 0, 0
 *   body_momentum            angular momentum x y z (kg m^2/s) where the gyroscopic term counts, 0 0 0 0, 1 if it holds
 *   body_frame               the mass frame in the body's frame: centre x y z, rotation x y z w, 0
 *   body_force               force x y z (N), torque x y z (N m), 0, 0
 *   row_velocity, row_before v x y z, u x y z, inverse mass (1/kg), 1 if impulses turn it and 0 if not
 *   row_moved                since the step began: way of the centre x y z, sum of h u x y z, 0, 0
 *   row_push                 displacements that close joints and part what overlaps, as row_velocity
 *   row_momentum             angular momentum x y z (kg m^2/s), u that goes with it, 1 if it is slender, 0
 *   row_frame                rotation of K's frame x y z w, s x y z, 1 if the gyroscopic term counts
 *   row_force                acceleration x y z, whitened angular acceleration x y z, damping factors of v and of u
 *   shape_place              the shape in the mass frame: x y z, rotation x y z w, largest reach from the centre (m) */

typedef struct tl_contact_lane_point {
    float ja[3][TL_LANES], jb[3][TL_LANES]; /* whitened angular Jacobians */
    float gap[TL_LANES];                    /* m, separation when the step began */
    float mass[TL_LANES];                   /* kg, effective */
    float impulse[TL_LANES];                /* N s, accumulated over a sub-step */
    float approach[TL_LANES]; /* m/s, the speed at which the surfaces will meet; 0 if they do not bounce */
    float peak[TL_LANES];     /* N s, the largest impulse of the step */
} tl_contact_lane_point;

/* contact_group.depth: some point is so deep that it is pushed; some manifold has a lift. */
enum { TL_DEPTH_PUSHED = 1, TL_DEPTH_LIFTED = 2 };

typedef struct tl_contact_group {
    uint32_t a[TL_LANES], b[TL_LANES]; /* body rows */
    uint32_t contact[TL_LANES];
    uint32_t lanes, points;     /* how many are in use */
    uint32_t bounces, rolls;    /* whether any lane has restitution, rolling resistance */
    uint32_t heard;             /* whether any lane has events to tell */
    uint32_t depth;             /* TL_DEPTH_* */
    uint32_t struck;            /* whether any lane bounced in the last sweep */
    uint32_t pressed, met;      /* bits of lanes that are in a press, and in one whose rows all are met */
    uint32_t plane;             /* the axis across which all bodies stay, plus one; 0 if they need not */
    uint32_t reserved[6];       /* lanes are aligned */
    float deepest[TL_LANES];    /* m: overlap when the step began, of a lane's deepest point */
    float normal[3][TL_LANES];  /* from a to b */
    float tangent[3][TL_LANES]; /* the second tangent is normal x tangent */
    float ja1[3][TL_LANES], jb1[3][TL_LANES], ja2[3][TL_LANES], jb2[3][TL_LANES];
    float jan[3][TL_LANES], jbn[3][TL_LANES];          /* about the normal */
    float k11[TL_LANES], k12[TL_LANES], k22[TL_LANES]; /* inverse of the tangents' 2 x 2 matrix */
    float twist_mass[TL_LANES], lever[TL_LANES];       /* m: of the friction about the normal */
    float slid[2][TL_LANES]; /* m: how far b has slid on a since the manifold was made, when the step began */
    float held[TL_LANES];    /* 1: it did not slide in the last step; else 0 */
    float lift[TL_LANES];    /* m: as how much deeper than they are the points count */
    float over[TL_LANES];    /* how far the normals' pass after the move goes: 1, or more where a face rests */
    float static_friction[TL_LANES], dynamic_friction[TL_LANES], restitution[TL_LANES], rolling[TL_LANES];
    float stiff[TL_LANES]; /* in a plane: how much stiffer the springs of points are */
    float tangent_impulse[2][TL_LANES], twist_impulse[TL_LANES], rolling_impulse[2][TL_LANES];
    float roll_mass[TL_LANES];
    tl_contact_lane_point point[4];
} tl_contact_group;

/* contact_plane: how a contact is solved, in a world that has bodies locked to a plane. Where both of its bodies stay
 * in one plane, records of its manifold that lie behind one another make one point. */
static inline uint32_t tl_plane_of(uint32_t w) { return w & 3u; } /* the axis across the plane plus one; 0: none */
static inline uint32_t tl_plane_points(uint32_t w) { return w >> 2 & 7u; }
static inline uint32_t tl_plane_point_of(uint32_t w, uint32_t record) { return w >> (8u + 2u * record) & 3u; }
static inline uint32_t tl_plane_first(uint32_t w, uint32_t point) { return w >> (16u + 2u * point) & 3u; }

#define TL_JOINT_ROWS 12u
#define TL_LINK_ROWS 6u

/* One scalar row of eight joints: what is made of the poses, then what stays. */
typedef struct tl_joint_row {
    float n[3][TL_LANES];                   /* linear direction or angular axis */
    float ja[3][TL_LANES], jb[3][TL_LANES]; /* whitened */
    float error[TL_LANES];                  /* m or rad */
    float curve[TL_LANES];    /* m/s: half of what the bodies' turning adds to the error's rate in a sub-step */
    float mass[TL_LANES];     /* of ranges and drives */
    float at_lower[TL_LANES]; /* 1: the lower side of the range is the near one; of ranges */
    float lower[TL_LANES], upper[TL_LANES]; /* of the position, or target twice for a drive */
    float stiffness[TL_LANES], damping[TL_LANES];
    float speed[TL_LANES];    /* target of a drive */
    float most[TL_LANES];     /* N or N m: bound of the force */
    float per_mass[TL_LANES]; /* 1: stiffness and damping are per effective mass */
    float impulse[TL_LANES];
} tl_joint_row;

/* joint_group.needs: what its rows are made of. */
enum {
    TL_JOINT_POINT = 1, /* the first three rows hold a point and are along the world's axes; their impulses are kept
                         * along frame a, as others are */
    TL_JOINT_AXES = 2,  /* others are along frame a or tell how it stands to frame b */
    TL_JOINT_A = 4,     /* some body a has a row, */
    TL_JOINT_B = 8,     /* some body b; a side on which none has is left out, unless the group is linked */
    TL_JOINT_TURN = 16, /* some tell how frame b is turned in frame a */
    TL_JOINT_PLAIN = 32 /* its equalities are three along axes, and then angles alone */
};

/* joint_group.far: an error is so large that taking it back leaves one; the group is pushed again; errors are so small
 * that they wait. */
enum { TL_FAR_NOW = 1, TL_FAR_AGAIN = 2, TL_FAR_NOT = 4 };

typedef struct tl_joint_group {
    uint32_t a[TL_LANES], b[TL_LANES], joint[TL_LANES];
    uint32_t lanes, rows, fixed; /* joints, rows, and how many of the first rows are equalities */
    uint32_t first_row;          /* in joint_row_pool */
    uint32_t free_axis;          /* beside two locked angular ones */
    uint32_t linked;             /* how many rows are solved with the linkage: the equalities, then hard ranges */
    uint32_t stale;              /* bits of lanes: their linkage is to be factored anew */
    uint32_t stiff;              /* linked: one pulls so hard that its bodies are to be looked at */
    uint32_t far;                /* linked: TL_FAR_* */
    uint32_t exact;              /* one solve of its velocities in a sub-step leaves nothing to solve */
    uint32_t needs;              /* TL_JOINT_* */
    uint32_t gives;              /* linked: some lane has `soft`; else: equalities are springs, for they are loose */
    uint32_t code[TL_JOINT_ROWS];
    float pa[3][TL_LANES], qa[4][TL_LANES]; /* the joint's frame in a's mass frame */
    float pb[3][TL_LANES], qb[4][TL_LANES];
    float mass[2][TL_LANES], turns[2][TL_LANES]; /* of a and b: inverse mass, 1 if impulses turn it */
    float active[TL_LINK_ROWS][TL_LANES];        /* linked: 1 for a row that holds now */
    float give[2][TL_LANES]; /* m / (kg m^2): |arm| over the least moment of inertia across it, of a and b */
    float pull[TL_LANES];    /* N s: the linear impulse of a sub-step */
    float soft[TL_LANES];    /* linked: by how many of its sub-step's free ways an impulse stretches its row */
    float k[2][9][TL_LANES]; /* K of a and b, by rows */
    /* The matrix of the first rows, the lower half by rows. Of linked joints it takes in their hard ranges; of others
     * it is the equalities' and stands as L D L^T with D inverted. */
    float matrix[21][TL_LANES];
    float x[TL_LINK_ROWS][TL_LANES]; /* linked: speeds or errors to be met, then impulses */
} tl_joint_group;

/* A structure that linkages have in common. */
typedef struct tl_linkage_shape {
    uint32_t first_node, nodes, ends;
    uint32_t first_joint; /* in linkage_order: the joints of the first of them, others as `next` has it */
    uint32_t members, values, planned;
    uint32_t wide, open; /* members still to be put side by side, and the linkage that takes them, or TL_NONE */
} tl_linkage_shape;

/* Joints that hang together through bodies that can be moved, to be solved at once: one set of them, or eight alike
 * side by side. */
typedef struct tl_linkage {
    uint32_t shape, first_joint; /* in linkage_shapes, linkage_order */
    uint32_t first_node, nodes;  /* in linkage_nodes; linkages alike share them */
    uint32_t first_place;        /* in linkage_places: a node's group times eight, plus its lane */
    uint32_t values;             /* in linkage_values */
    uint32_t lanes, wide;        /* sets in it; 1 if it is solved eight wide */
    uint32_t far;                /* 1 if it is to be pushed again */
    uint32_t near;               /* 1 if its errors wait */
    uint32_t exact;              /* 1 if nothing but equalities holds its bodies */
    /* Of one that is cut into pieces: joints of a piece, cuts (0: it is not cut), groups from, nodes of a piece and
     * then of the cuts, values of the cuts behind those of the pieces */
    uint32_t inner, cuts, first_group, cut, cut_values;
    uint32_t even; /* as it was factored: rows of each node, if all hold a point and then angles, and no more; else 0 */
} tl_linkage;

#define TL_MOST_PRESSED 128u

/* A contact that is solved at once with others; a lane is a row: of its points, then of its tangents. */
typedef struct tl_pressed {
    uint32_t place;          /* its contact group times eight, plus its lane */
    uint32_t row[2], points; /* body rows */
    uint32_t rows;           /* of the points, then of the tangents */
    uint32_t holds;          /* bits of the rows that are equalities now */
    uint32_t slides;         /* friction had to give way in this solve */
    uint32_t barred;         /* bits of rows that would have pulled at once */
    float mass[2], turns[2]; /* of a and b: inverse mass, 1 if impulses turn it */
    float held, hold, slide; /* as in the group: 1 if it did not slide, static and dynamic friction */
    uint32_t fresh;          /* it bore nothing, and this is the first round */
    float n[3][TL_LANES];    /* directions of the rows, */
    float j[2][3][TL_LANES]; /* whitened angular Jacobians of a and b */
    float gap[TL_LANES];     /* m: separation of points, what tangents have slid, when the step began */
    float bias[TL_LANES];    /* m/s: what the speeds are to be met beside */
    float impulse[TL_LANES]; /* N s */
    float from[TL_LANES];    /* N s, where a round began, */
    float speed[TL_LANES];   /* m/s, and what it had to meet */
    float x[TL_LANES];       /* m/s or m: what is to be solved for; then the solution: N s or kg m */
} tl_pressed;

/* Contacts that hang together through bodies that can be moved. */
typedef struct tl_press {
    uint32_t first, count; /* in pressed_pool and press_nodes */
    uint32_t values;       /* in press_values */
    uint32_t stale;        /* it is to be factored anew */
    uint32_t alike;        /* its masses are: it is of towers */
    uint32_t rings;        /* its contacts are more than its bodies: some bear what others could */
    uint32_t met;          /* it is, and its rows are met: sweeps have nothing to do but friction about normals */
    float soft;            /* by what share its diagonal is raised */
    float load;            /* m/s: the most that a contact bore in the last sub-step, as a speed of the lighter body */
    float at_rest, rest;   /* m/s: rows that all are slower are met, at the most and now */
} tl_press;

#endif

/* A model with a strain measure for level 0 of its mesh and another for the finest one.

   The energy is E_fine(u; R) + E_coarse(L u) - E_linear(L u); see corot/model.h. Each term is that
   of a set of tets under one measure: the fine one is the model's own, with frames handed down; the
   others are parts, models of the tets of a coarser level without masses, loads and supports, whose
   nodes are all free. They see the model's fields through L of coarsening.h, by the coupling's
   choice, and their forces act on the model's nodes through L'.

   With R from the tet t, P_i = R sigma_i and A_i = R' F_i of its descendants i, E_fine changes by
   sum V_i vee(A_i sigma_i) . w when the frame turns by dR = R [w]x. For a polar frame
   w = G^-1 vee(R' dF_t), so the gradient has one more stress on t,
     V_t P_t = R [G^-1 sum V_i vee(A_i sigma_i)]x.
   It is zero where the descendants deform as t does, for A sigma is symmetric there; for the same
   reason E_linear has no such part.

   One way, the rows of level 0's nodes are those of E_coarse alone. */
#ifndef COROT_CORE_SYSTEM_LEVELS_H
#define COROT_CORE_SYSTEM_LEVELS_H

#include <corot/ode.h>

#include "coarsening.h"
#include "core/model/model.h"
#include "core/ode/state.h"

typedef struct levels {
  int nlevel, frame_level;
  corot_coupling coupling;
  bool same;            /* coarse and linear have one measure and cancel: neither is evaluated */
  bool turning;         /* the force has the part by which polar frames turn */
  char name[32];        /* both strain measures */
  corot_model *coarse;  /* level 0, the coarse measure */
  corot_model *linear;  /* level 0, the model's measure */
  corot_model *framer;  /* the frame level, the model's measure: `linear` if it is level 0 */
  coarsening to_coarse; /* and to `linear` */
  coarsening to_framer; /* if it is not `linear` */
  int *above; /* [tets.nblock] the framer's tet over those of a block, as block * W + lane; NULL:
                 its tets are the model's */
  int *place; /* [coarse->pattern.nblock] where its blocks are in the pattern; NULL: they are not
                 in the matrices */
} levels;

/* A part's view of the model's fields, and its forces. */
typedef struct level_fields {
  double *u, *v, *du, *dv; /* [3 nnode] */
  double *sum;             /* [3 nnode] force */
} level_fields;

/* What the evaluations of one run need for the parts. */
typedef struct levels_state {
  corot_frames frames; /* of the model; the state's own kernels always see held ones */
  corot_state *coarse, *linear, *framer; /* as in levels */
  level_fields on_coarse;                /* of coarse and linear */
  level_fields on_framer;                /* the same arrays if the framer is linear */
  double *r;                             /* [3 nnode] force of coarse or linear */
  double (*nodal)[4];                    /* [the model's nnode] the parts' force */
  double *kept;                          /* [the model's body_ndof] one way: r on level 0 */
  double (*K)[9], (*D)[9];               /* [coarse->pattern.nblock] of a part; NULL, see place */
  size_t bytes;                          /* of these arrays */
} levels_state;

/* Nodal masses or loads of the finest level become, on the nodes of level 0, those of level 0 if it
   has its own: T' of corot/hierarchy.h. */
corot_status corot_levels_own(const corot_model_def *def, int nnode, double (*nodal)[3]);

/* The number of nodes that E is of: all, or one way those of level 0. */
int corot_levels_body(const corot_model *m);

/* Whether the definition is sound, and the mesh the refined one. */
corot_status corot_levels_check(const corot_hierarchy_def *def, const corot_mesh *mesh);

/* So many of the mesh's tets, from the first one on, have one frame. The definition may be NULL. */
int corot_levels_together(const corot_hierarchy_def *def);

/* m->levels, once strain, materials and tets are known; of_tet [ntet] says what each is made of. */
corot_status corot_levels_create(const corot_hierarchy_def *def, const int *of_tet, corot_model *m);

/* What its matrices add to those of the finest level, level 0's pattern; NULL: nothing. */
const pattern *corot_levels_pattern(const corot_model *m);

/* The rest of it, once the pattern is known. */
corot_status corot_levels_place(corot_model *m);

/* Takes NULL. */
void corot_levels_destroy(levels *l);

size_t corot_levels_bytes(const corot_model *m);

corot_status corot_levels_state_create(const corot_model *m, levels_state **state);

/* Takes NULL. */
void corot_levels_state_destroy(levels_state *ls);

size_t corot_levels_state_bytes(const levels_state *ls);

void corot_levels_use(levels_state *ls, corot_frames frames);

/* No velocities from now on. */
void corot_levels_stand_still(levels_state *ls);

/* --- Evaluations; s->u and, where it matters, s->v are set ----------------------------------- */

/* A nodal field as the parts see it. */
void corot_levels_coarsen(const levels *l, const double (*field)[4], double *on_coarse,
                          double *on_framer);

/* The displacement as the parts see it, and the frames of time t into s->R. */
corot_status corot_levels_hand_down(const corot_model *m, corot_state *s, double t);

/* s->r += elastic and viscous force. */
corot_status corot_levels_force(const corot_model *m, corot_state *s, double t, bool damped);

/* s->r += its change for s->du and s->dv. */
corot_status corot_levels_derivative(const corot_model *m, corot_state *s, double t,
                                     corot_tangent tangent);

/* f [nnode] = elastic and viscous force on all nodes. */
corot_status corot_levels_nodal_force(const corot_model *m, corot_state *s, double t, bool damped,
                                      double (*f)[4]);

/* K and D, either of which may be NULL, += those of the parts. */
corot_status corot_levels_add_matrices(const corot_model *m, corot_state *s, double t,
                                       corot_tangent tangent, double (*K)[9], double (*D)[9]);

corot_status corot_levels_energy(const corot_model *m, corot_state *s, double t, bool damped,
                                 double *elastic, double *power);

/* As corot_frames_drift, corot_frames_update and corot_frames_spin. */
corot_status corot_levels_frames_drift(const corot_model *m, corot_state *s, double t,
                                       corot_frames_change *drift);
corot_status corot_levels_frames_update(const corot_model *m, corot_state *s, double t,
                                        corot_frames_change *change);
corot_status corot_levels_frames_spin(const corot_model *m, corot_state *s, double t,
                                      double *spin_max);

#endif

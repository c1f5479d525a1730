/* One body of elements under one strain measure: its forces, their changes, its matrices, energy
   and frames, as functions of nodal fields. It knows no time, no supports and no loads; core/system
   adds such bodies up.

   A nodal field has a row of four for each node, of which three are used: the kernels gather whole
   rows. A velocity of NULL stands for a body whose viscous forces are not asked for. */
#ifndef COROT_CORE_SOLID_SOLID_H
#define COROT_CORE_SOLID_SOLID_H

#include <corot/ode.h>

#include "core/base/team.h"
#include "core/element/strain.h"
#include "ranges.h"

typedef const double (*nodal_field)[4];

typedef struct material {
  double lambda, mu, damping_lambda, damping_mu, damping_mass, density;
  double lambda_local; /* what of lambda acts on each tet's own dilatation */
  double own_share;    /* and as a part of it; 1 where lambda is zero */
} material;

typedef struct solid {
  const corot_mesh *mesh;
  const corot_mesh *order_of; /* its elements stand in the order that its tets would have in this
                                 mesh of as many; NULL: its own */
  const material *material;   /* of the blocks' numbers */
  int strain;                 /* index into strain_measures */
  bool damped;                /* some viscous coefficient is not zero */
  bool objective;             /* viscous law on the stretch's own rate */
  bool by_element;            /* averages are those of each element, not at corners */
  int together;               /* so many elements may have one tet of a coarser level above them */
  element_set elements;
  dilatation dilatation; /* averages, where some material has them */
  pattern pattern;
} solid;

/* Arrays [points] have an entry for each point of each block, [elements.nblock][kind->npoint]:
   frames are found at each. Where the frames of an evaluation come from: from F, by the measure's
   own rule; or they are given, as those that are held, or handed down by another body; or given and
   turned on since then.
 */
typedef struct frame_source {
  corot_frames kind;      /* EXACT: own; HELD: given; EXTRAPOLATED: turned on */
  const block_mat3 *R;    /* [points] */
  const block_vec3 *spin; /* [points] [rad/s] */
  double age;             /* for so long [s] */
} frame_source;

/* Of the angles between two sets of frames, in a chunk. */
typedef struct chunk_angles {
  double sum, most;
  int element; /* W times block plus lane */
} chunk_angles;

/* What the evaluations of one run write to, and the frames that are held between them. */
typedef struct solid_state {
  team *team;                  /* who works on them; NULL: who calls */
  solid_ranges ranges;         /* and how they share the elements out */
  frame_source frames;         /* of the evaluations */
  int inverted;                /* tet number in the mesh, or -1 */
  block_mat3 *R;               /* [points] the held frames */
  block_vec3 *spin;            /* [points] their angular velocity [rad/s] */
  block_mat3 *now_R;           /* [points] those in use, to compare with or to hand down */
  block_mat3 *new_R;           /* [points] those of an update, until it is known to succeed */
  block_vd *dilatation;        /* [points] means in place of tr(e_p); NULL, as the next, where there
                            are none: see dilatation.h */
  block_vd *dilatation_change; /* [points] the same of a derivative */
  double *pool;                /* [dilatation.npool] */
  block_vd (*slope)[3];        /* [points][kind->nnode] weight times d tr(e_p) / du */
  block_vd (*force)[3];        /* [window][kind->nnode] element forces, see pattern.h */
  double (*chunk_sum)[2];      /* [nchunk] of energies, in the order of the elements */
  chunk_angles *chunk_angles;  /* [nchunk] */
} solid_state;

/* Where the forces on nodes are added up. */
typedef struct force_sum {
  const int (*row)[3]; /* [nnode] rows of the components in r, -1: nowhere; NULL: all of them, and r
                          is a nodal field */
  double *r;
  double sign;  /* 1 or -1, of what is added */
  int from;     /* nodes before this one take no part */
  double check; /* of all that a range has added to: finite only if they are */
} force_sum;

/* What is done chunk by chunk, as the kernels are: `own` is the state, with the window of the range
   that the chunk is in. */
typedef int chunk_work(const void *of, solid_state *own, int chunk);

/* --- Making one ------------------------------------------------------------------------------ */

/* `of_tet` [ntet] says what each tet is made of, 0 <= of_tet < nmaterial; `together` as in tets.h;
   volumes count `volume` times; `more` (or NULL) as in pattern.h. The mesh, the materials and the
   strain are set; what is half made is cleared by the caller. */
corot_status corot_solid_fill(solid *body, int nmaterial, const int *of_tet, int together,
                              double volume, const pattern *more);
void corot_solid_clear(solid *body);
size_t corot_solid_bytes(const solid *body);

/* The held frames are those of the body at rest, the frames of evaluations the measure's own. What
   is half made is cleared by the caller. */
corot_status corot_solid_state_fill(const solid *body, solid_state *s);
void corot_solid_state_clear(solid_state *s);

/* The elements shared out among n, to be put in the place of s->ranges. */
corot_status corot_solid_share(const solid *body, int n, const solid_state *s, solid_ranges *r);
size_t corot_solid_state_bytes(const solid *body, const solid_state *s);

/* --- Evaluations ----------------------------------------------------------------------------- */

/* All return COROT_RETRY where a tet is inverted, s->inverted, or where forces exceed double
   precision, s->inverted being -1. */

/* s->dilatation = the means that stand in for those of u; nothing where there are none. */
void corot_solid_average(const solid *body, solid_state *s, nodal_field u);

/* Adds minus the internal and viscous forces to the sum. */
corot_status corot_solid_force(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                               force_sum *sum);

/* Their change for du and dv; `exact`: with that of the frames. */
corot_status corot_solid_derivative(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                                    nodal_field du, nodal_field dv, bool exact, force_sum *sum);

/* K and D [pattern.nblock], either of which may be NULL, += the element matrices. */
corot_status corot_solid_matrices(const solid *body, solid_state *s, nodal_field u,
                                  corot_tangent tangent, double (*K)[9], double (*D)[9]);

/* Elastic energy [J] and the power of the viscous forces [W]. */
corot_status corot_solid_energy(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                                double *elastic, double *power);

/* Adds minus the internal force of any measure, index `strain`, in its own frames and with the
   coefficients times the factors given. */
corot_status corot_solid_internal(const solid *body, solid_state *s, nodal_field u, int strain,
                                  double lambda_part, double mu_part, force_sum *sum);

/* R [points] = the frames of u by the measure's rule. */
corot_status corot_solid_frames(const solid *body, solid_state *s, nodal_field u, block_mat3 *R);

/* s->spin = the angular velocity of these, for v; *spin_max = the largest of it [rad/s]. */
corot_status corot_solid_spin(const solid *body, solid_state *s, nodal_field u, nodal_field v,
                              double *spin_max);

/* R [points] = the frames in use. */
corot_status corot_solid_frames_in_use(const solid *body, solid_state *s, nodal_field u,
                                       block_mat3 *R);

/* Largest and mean angle between two sets of frames. */
void corot_solid_compare_frames(const solid *body, solid_state *s, const block_mat3 *A,
                                const block_mat3 *B, corot_frames_change *change);

/* --- For the kernels' callers ---------------------------------------------------------------- */

/* Remembers the tet that a kernel returned; COROT_RETRY if there is one. */
corot_status corot_solid_check(solid_state *s, int tet);

/* All chunks, by the team; each must write elsewhere than the others. COROT_RETRY: a tet is
   inverted, the first of them being s->inverted. */
corot_status corot_solid_each(const solid *body, solid_state *s, chunk_work *work, const void *of);

/* The same, where `work` leaves element forces in own->force: adds them up on the nodes, each
   node's in the order of the elements. COROT_RETRY, too, where a sum is not finite. */
corot_status corot_solid_sum(const solid *body, solid_state *s, chunk_work *work, const void *of,
                             force_sum *sum);

#endif

/* A sum of solids, each of which sees the displacement of the mesh's nodes through a linear map:

     E(u) = sum_k s_k E_k(L_k u; R_k),   f(u, v) = sum_k s_k L_k' f_k(L_k u, L_k v; R_k)

   The first term is the solid on the mesh itself, L the identity; a plain model has no other. That
   of a hierarchy (corot/model.h) is

     E_fine(u; R) + E_coarse(L u) - E_linear(L u)

   where the fine term's frames are handed down to it by the tets of a coarser level: by E_linear's,
   if that is level 0, else by a term of sign zero, which is there for its frames alone. L is that
   of coarsening.h, by the coupling's choice. Where coarse and linear have one measure, they cancel
   and are left out. The finest level may be that of ten-node tets, on the tets of the level before:
   then each of their points has the frame of the tet, whose displacement is linear.

   With R from the tet t, P_i = R sigma_i and A_i = R' F_i at the points i of its descendants,
   E_fine changes by sum V_i vee(A_i sigma_i) . w when the frame turns by dR = R [w]x. For a polar
   frame w = G^-1 vee(R' dF_t), so the gradient has one more stress on t, V_t P_t = R [G^-1 sum V_i
   vee(A_i sigma_i)]x. It is zero where the descendants deform as t does, for A sigma is symmetric
   there; for the same reason E_linear has no such part.

   One way, the fine term has no forces on the nodes of level 0, nor an energy, and E_linear is not
   there. */
#ifndef COROT_CORE_SYSTEM_SYSTEM_H
#define COROT_CORE_SYSTEM_SYSTEM_H

#include "coarsening.h"
#include "core/base/sisters.h"
#include "core/solid/solid.h"

enum { TERMS = 4, MAPS = 2 }; /* at most */

typedef struct term {
  solid body;
  int sign;        /* 1, -1; 0: it is there for its frames */
  int map;         /* through which it sees the fields; -1: as they are */
  int level;       /* of the refinement that its tets are of */
  int below;       /* so many tets of the finest level descend from each of them */
  int frames_from; /* the term that hands its frames down to this one; -1: they are its own */
  int *above; /* [elements.nblock] the tet of that term over those of a block, as block * W + lane;
                 NULL: its tets are these, in the same lanes */
  int *place; /* [pattern.nblock] where the blocks of its matrices are in those of the first term;
                 NULL: they are not in them */
  int from;   /* one way: the first node it has forces on; else 0 */
} term;

/* A coarser level as the terms see it. */
typedef struct level_map {
  coarsening map;
  corot_mesh *mesh;
} level_map;

typedef struct solid_system {
  int nterm;
  term term[TERMS];
  int nmap;
  level_map map[MAPS];
  int leader;    /* the term that hands down its frames; -1: none does */
  bool turning;  /* the force has the part by which polar frames turn */
  char name[32]; /* of the strain measures */
} solid_system;

/* What a system is made from. Mesh and materials must outlive it. */
typedef struct system_def {
  const corot_mesh *mesh;
  int strain;                         /* of the first term */
  bool damped, objective, by_element; /* as of a solid */
  int nmaterial;
  const material *material;
  const int *of_tet;                    /* [ntet] the material that fills each tet */
  const corot_hierarchy_def *hierarchy; /* or NULL */
} system_def;

/* COROT_EINVAL: what the hierarchy does not provide for. What is half made is cleared by the
 * caller. */
corot_status corot_system_create(const system_def *def, solid_system *y);
void corot_system_clear(solid_system *y);
size_t corot_system_bytes(const solid_system *y);

/* Whether the hierarchy's definition is sound, and the mesh the refined one. */
corot_status corot_system_check(const corot_hierarchy_def *def, const corot_mesh *mesh);

/* Whether the matrices of terms beside the first are in those of the system. */
bool corot_system_adds_matrices(const solid_system *y);

/* Whether the stress is linear in the displacement. */
COROT_SISTERS bool corot_system_is_linear(const solid_system *y);

/* --- State ----------------------------------------------------------------------------------- */

/* The fields on the nodes of a map. */
typedef struct map_fields {
  double (*u)[4], (*v)[4], (*du)[4], (*dv)[4];
  double (*sum)[4]; /* of the forces of its terms */
} map_fields;

/* What turns the frames of the leader, and what it hands down in a derivative; see above. */
typedef struct handing {
  block_mat3 *dR;               /* [elements.nblock] change of its frames */
  block_vec3 *moment, *dmoment; /* [elements.nblock] from all descendants [J], and their change */
} handing;

typedef struct system_state {
  team *team;          /* who works on the evaluations; NULL: who calls */
  corot_frames frames; /* in use, of the terms that have their own */
  int inverted;        /* tet number in the mesh, or -1; of a coarser level its first descendant */
  solid_state of[TERMS];
  map_fields on[MAPS];
  double (*nodal)[4];      /* [nnode] forces of the maps' terms; NULL without maps */
  handing lead;            /* of the leader */
  double (*K)[9], (*D)[9]; /* [the most blocks of a term with a place]; else NULL */
} system_state;

/* What is half made is cleared by the caller. */
corot_status corot_system_state_create(const solid_system *y, system_state *s);
void corot_system_state_clear(system_state *s);
size_t corot_system_state_bytes(const solid_system *y, const system_state *s);

/* From now on a team shares the evaluations out; NULL: nobody does. Where that fails, all is as it
   was. */
corot_status corot_system_state_share(const solid_system *y, team *by, system_state *s);

/* --- Evaluations ----------------------------------------------------------------------------- */

/* u and v are those of the mesh's nodes; v of NULL leaves out the viscous forces. `age` is the time
   since the held frames were found [s]. COROT_RETRY where a tet is inverted, s->inverted, or where
   forces exceed double precision, s->inverted being -1. */

/* r -= internal and viscous forces: `row` [nnode] says where, -1 nowhere; NULL: on all components,
   r being a nodal field. */
corot_status corot_system_force(const solid_system *y, system_state *s, double age, nodal_field u,
                                nodal_field v, const int (*row)[3], double *r);

/* r += their change for du and dv; dv may be NULL if v is. */
corot_status corot_system_derivative(const solid_system *y, system_state *s, double age,
                                     nodal_field u, nodal_field v, nodal_field du, nodal_field dv,
                                     corot_tangent tangent, const int (*row)[3], double *r);

/* K and D [pattern.nblock of the first term], either of which may be NULL, += the matrices. */
corot_status corot_system_matrices(const solid_system *y, system_state *s, double age,
                                   nodal_field u, corot_tangent tangent, double (*K)[9],
                                   double (*D)[9]);

corot_status corot_system_energy(const solid_system *y, system_state *s, double age, nodal_field u,
                                 nodal_field v, double *elastic, double *power);

/* The frames that evaluations of the first term use, for who looks at its tets: in s->of[0].frames.
 */
corot_status corot_system_settle(const solid_system *y, system_state *s, double age, nodal_field u);

/* --- Held frames ------------------------------------------------------------------------------ */

/* From the frames in use to those of u, which are not taken. `change` may be NULL; the largest
   angle is that of the leader, named by the first descendant of its tet. */
corot_status corot_system_drift(const solid_system *y, system_state *s, double age, nodal_field u,
                                corot_frames_change *change);

/* They are taken, at rest. */
corot_status corot_system_update_frames(const solid_system *y, system_state *s, double age,
                                        nodal_field u, corot_frames_change *change);

/* The spin of the frames from v; *spin_max the largest [rad/s]. */
corot_status corot_system_spin(const solid_system *y, system_state *s, double age, nodal_field u,
                               nodal_field v, double *spin_max);

/* --- Shared by its files --- */

/* The fields as a term sees them. */
typedef struct term_fields {
  nodal_field u, v, du, dv;
} term_fields;

/* Before an evaluation: every field onto the maps, and the frames in use. */
void corot_system_begin(const solid_system *y, system_state *s, double age, const term_fields *all);
term_fields corot_system_seen(const solid_system *y, const system_state *s, int k,
                              const term_fields *all);

/* The status of an evaluation of term k, with its inverted tet by level. */
corot_status corot_system_told(const solid_system *y, system_state *s, int k, corot_status status);

/* The energy with the frames as the terms have them. */
corot_status corot_system_sum_energy(const solid_system *y, system_state *s, const term_fields *all,
                                     double *elastic, double *power);

#endif

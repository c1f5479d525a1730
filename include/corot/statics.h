/* Equilibria by KINSOL: the u with r(u) = 0 where nothing moves, reached by load stepping.

   The load factor s grows from 0 to 1. At s the loads are s times those of time t, and the supports
   stand where they are at time s t. Each step of s is a Newton iteration with the exact tangent,
   which squares the error from one iteration to the next (under a pressure, whose turning with the
   surface the symmetric tangent leaves out, for warp, whose frames' variation it leaves out, and
   for a hierarchy the error shrinks by a factor). A step that finds no equilibrium, or an unstable
   one, is tried again at half the length, the shortest with a line search, too; easy steps are
   followed by longer ones.

   With warp that factor comes close to one where a body of ten-node tets bends far, for the four
   frames of a tet vary with its few edges: the bar of models/bar at order 2 creeps from a third of
   its load on, and from a half of it with max_iterations 100. The failure names warp, and what was
   reached is an equilibrium; polar takes all of that load in one step of six iterations.

   An equilibrium is stable if the stiffness K is positive definite. (Under a pressure this speaks
   of the elastic part alone.) Load stepping ends where that is lost, as where a column buckles.

   A complete program: tests/examples/statics.c. */
#ifndef COROT_STATICS_H
#define COROT_STATICS_H

#include <corot/inputs.h>
#include <corot/solve.h>
#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct corot_statics_def {
  size_t bytes; /* sizeof of this, as the defaults set it: see corot/base.h */
  corot_linear_def linear; /* its role is taken to be static */
  corot_frames frames;     /* EXACT; or HELD: the paper's linear systems, solved for frames that are
                              held, found anew, and so on until nothing changes: the same
                              equilibrium, approached by a factor an iteration */
  double tolerance;        /* of the residual: its largest component over the largest force on a
                              node (internal, a load, or a support's), > 0. What double precision
                              cannot reach is not asked for: see corot_load_step.rounding */
  int max_iterations;      /* in a load step, > 0; of held frames: that they are found anew */
  double first_step;       /* of the load factor, > 0, at most 1: the whole load at once */
  double min_step;         /* give up where a shorter one is needed, > 0 */
  double max_step;         /* > 0, at most 1. Where there are several equilibria, as beyond a load
                              that buckles, only short steps are sure to find the one that the path
                              of the load leads to */
  bool follow_unstable; /* go on along the path of the load where stability is lost, by full Newton
                           steps: the linear solver is taken to be klu, and no equilibrium is judged */
  bool (*stop)(void *data); /* asked in every iteration; true: end with COROT_EINTEGRATE. Or NULL */
  void *stop_data;
  corot_inputs *inputs; /* seen by all evaluations, and must outlive the solver; NULL: none. Forces and
                           factors of loads are those of time t, scaled as loads are; feedback is not
                           scaled, and may hold a body that no support holds */
  int threads; /* that share the work out, as of corot_state_threads(); 0: one */
} corot_statics_def;

/* Everything about the linear solver "auto", frames exact, tolerance 1e-10, 20 iterations, the
   whole load at once, min_step 1e-4, max_step 1, one thread. */
COROT_API void corot_statics_set_defaults(corot_statics_def *def, size_t bytes);
static inline corot_statics_def corot_statics_defaults(void) {
  corot_statics_def def;
  corot_statics_set_defaults(&def, sizeof def);
  return def;
}

typedef struct corot_statics corot_statics;

/* Starts at load factor 0 from u0 [n] (NULL: at rest), a guess of the equilibrium there. The model
   must outlive it; nothing else is kept.
   COROT_EINVAL: the definition makes no sense, t or u0 is not finite, or as for corot_pencil_create.
   COROT_ENOMEM. COROT_ESINGULAR: nothing holds the body, or a part
   of it, against some rigid motion, which the message names. */
COROT_API corot_status corot_statics_create(const corot_statics_def *def, const corot_model *model,
                                            double t, const double *u0, corot_statics **statics);

/* Takes NULL. */
COROT_API void corot_statics_destroy(corot_statics *statics);

typedef enum corot_stability {
  COROT_STABILITY_UNKNOWN, /* K of a hierarchy does not tell, nor an iteration that fails */
  COROT_STABLE,
  COROT_UNSTABLE,
} corot_stability;

/* One load step. */
typedef struct corot_load_step {
  double factor;  /* reached */
  double length;  /* of the step */
  int iterations; /* Newton's */
  int rejected;   /* longer steps that were tried before and found no equilibrium */
  double force;   /* largest force on a node [N] */
  int nresidual;
  const double *residual; /* [nresidual] largest component of r [N] where each iteration begins, and
                             last that of the equilibrium; the solver's, until the next step */
  bool rounding;          /* the last is above the tolerance, and mere rounding */
  corot_stability stability; /* stable or unknown: at an unstable one the step fails */
} corot_load_step;

/* Goes on by one load step, at most to load factor 1.
   COROT_EINTEGRATE: there is no way on; the message says how far the load got and why: KINSOL's own
   reason, or that the equilibrium becomes unstable, and where, to one part in 1000 or 2 min_step.
   What was last reached remains readable. COROT_EINVAL: the full load was reached before.
   COROT_ENOMEM. */
COROT_API corot_status corot_statics_step(corot_statics *statics, corot_load_step *step);

/* Load steps to the end. Failures as of corot_statics_step. */
COROT_API corot_status corot_statics_solve(corot_statics *statics);

/* The equilibrium reached: its load factor, and u [n] (or NULL). */
COROT_API double corot_statics_at(const corot_statics *statics, double *u);

/* Where stability was lost: between these load factors; NaN: nowhere so far. */
COROT_API void corot_statics_critical(const corot_statics *statics, double *stable,
                                      double *unstable);

/* Counts of all load steps, refused ones included; the first five under KINSOL's names. */
typedef struct corot_statics_counts {
  long nni;                  /* Newton iterations */
  long nfe;                  /* evaluations of r */
  long nje;                  /* assemblies of K */
  long nbcfails;             /* line searches without the curvature condition met */
  long nbacktrack;           /* steps back in line searches */
  long nstep;                /* load steps */
  long nrejected;            /* refused */
  long nframes;              /* updates of held frames */
  long nfactor, nsolve, nli; /* of the pencil; nli: linear iterations */
  long nlsfail;              /* linear solves that failed */
  long nindefinite; /* factorisations that showed that K is not positive definite; the iteration
                       went on with the clamped tangent, or the equilibrium was unstable */
  /* Wall time by phase [s]; `other_s` is what these leave of all steps. */
  double force_s, assembly_s, combine_s, factor_s, solve_s, other_s;
} corot_statics_counts;

COROT_API corot_statics_counts corot_statics_statistics(const corot_statics *statics);

/* The linear solver in use. */
COROT_API const char *corot_statics_solver(const corot_statics *statics);

/* Bytes of the evaluations' scratch (corot_state_bytes). */
COROT_API size_t corot_statics_bytes(const corot_statics *statics);

#ifdef __cplusplus
}
#endif
#endif

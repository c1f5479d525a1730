/* Linear algebra of an implicit step, and how it is carried through a stock SUNDIALS integrator.

   Eliminating du from the Newton system of u' = v, M v' = r leaves one n x n matrix, the pencil

     S = a M + b D + c K,   K = -dr/du, D = -dr/dv

   with (a, b, c) = (1, g, g^2) for CVODE and ARKODE (g: their gamma). The 2n x 2n system is never
   formed. Nothing here refers to an integrator: a host links the CVODE (or CVODES) it likes.

   A complete program: tests/examples/solve.c (models/embedding/host_cvode.c: with a CVODE of your own). */
#ifndef COROT_SOLVE_H
#define COROT_SOLVE_H

#include <corot/ode.h>
#include <sundials/sundials_config.h>
#ifndef SUNDIALS_DOUBLE_PRECISION
#error "corot needs a SUNDIALS of double precision: its sunrealtype is corot's double"
#endif
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nvector.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whose matrix it is: the mass helps an iterative solver in a time step, not in statics. */
typedef enum corot_role { COROT_ROLE_DYNAMIC, COROT_ROLE_STATIC } corot_role;

/* What the parts of a solution cost on one core of a machine [ns]: "auto" chooses by their ratios. An
   entry is one of the triangle of the matrix, but where it is said to be of the factor. */
typedef struct corot_linear_costs {
  double operation;  /* of a direct factorisation, a multiplication in it, */
  double made;       /* and besides an entry of the factor */
  double solved;     /* of a direct solution, an entry of the factor */
  double incomplete; /* of an incomplete Cholesky factorisation, an entry */
  double iterated;   /* of an iteration with it, an entry */
  double aggregated; /* of the set-up of amg, an entry */
  double cycled;     /* of an iteration with it, an entry */
} corot_linear_costs;

/* Those of a Xeon with AVX-512 and 2 MB of cache a core, from which others differ most in
   `operation`. */
COROT_API corot_linear_costs corot_linear_costs_usual(void);

/* Measures them in some seconds, on cubes of 6000 and 27 000 unknowns, as the least of several
   passes; the machine should have nothing else to do. COROT_ENOMEM. */
COROT_API corot_status corot_linear_costs_measure(corot_linear_costs *costs);

/* How linear systems are solved. Each "auto" is decided by the operations it would take, and by the
   role: in a time step of a length that resolves the slow motion (at much shorter ones, where the
   mass outweighs the stiffness, "pcg" may be several times faster on compact bodies); in statics for
   solutions as accurate as Newton's iteration asks for. Rules:
   src/solve/linsol/linsol_choose.c. A direct solver is not chosen where the run would need more than
   a third of the machine's memory with it, as the entries of its factor are counted before it is
   made: "pcg" is. */
typedef struct corot_linear_def {
  const char *solver;         /* "auto", "klu", "cholmod" (if built in), "pcg" */
  const char *ordering;       /* of klu and cholmod: "auto", "amd", "metis" (if built in) */
  const char *factor;         /* of cholmod: "auto", "simplicial", "supernodal" */
  const char *preconditioner; /* of pcg: "auto", "block-jacobi", "incomplete-cholesky", "amg",
                                 V-cycles through aggregates of nodes, whose iterations hardly grow
                                 with the mesh; on a refined mesh also "hierarchical", its
                                 hierarchical basis, or "multigrid", V-cycles through its levels,
                                 both with a factor of level 0, or aggregates where that has more
                                 than 30 000 unknowns. "auto": in statics of 1500 unknowns and more
                                 "amg", if it costs less, else "incomplete-cholesky" */
  double tolerance; /* of pcg: residual relative to the right-hand side, > 0; in statics the smallest
                       that Newton's iteration asks for */
  corot_role role;
  const corot_refinement *refinement; /* of the model's mesh, for these two; only read while the
                                         solver is being created. Else NULL will do */
  const corot_linear_costs *costs;    /* that "auto" chooses by; only read like that, too. NULL: the
                                         usual ones */
} corot_linear_def;

/* All "auto", 1e-10, dynamic, no refinement. */
COROT_API void corot_linear_set_defaults(corot_linear_def *def, size_t bytes);
static inline corot_linear_def corot_linear_defaults(void) {
  corot_linear_def def;
  corot_linear_set_defaults(&def, sizeof def);
  return def;
}

/* K, D, S and a factor of S: one for each run. */
typedef struct corot_pencil corot_pencil;

/* `linear` NULL: the defaults. Model and state must outlive the pencil. COROT_EINVAL: there is no
   model or no state, or the state is another model's; there is no solver, ordering ... of that name,
   or not in this build; the tolerance is not positive; the refinement is not there, or not of the
   model's mesh; the matrix has more entries than an int counts. COROT_ENOMEM; and before anything is
   factored where a direct solver is asked for whose factor does not fit into the memory of the
   machine or RLIMIT_AS, with the numbers. */
COROT_API corot_status corot_pencil_create(const corot_model *model, corot_state *state,
                                 const corot_linear_def *linear, corot_pencil **pencil);

/* Takes NULL. */
COROT_API void corot_pencil_destroy(corot_pencil *pencil);

/* The linear solver chosen, with what it was chosen with: "cholmod supernodal, metis", "klu, amd",
   "pcg, incomplete-cholesky". */
COROT_API const char *corot_pencil_solver(const corot_pencil *pencil);

/* Which derivative of the frames K uses; held at first. */
COROT_API void corot_pencil_use(corot_pencil *pencil, corot_tangent tangent);

/* K and D at (t, u, v). COROT_RETRY when a tet is inverted: there is nothing to combine then. */
COROT_API corot_status corot_pencil_assemble(corot_pencil *pencil, double t, const double *u,
                                             const double *v);

/* S = a M + b D + c K of the matrices that were assembled last; then it has no factor until the next
   corot_pencil_factor. The order is: assemble, combine, factor, solve. */
COROT_API void corot_pencil_combine(corot_pencil *pencil, double a, double b, double c);

/* Factors S. cholmod and pcg need it positive definite. Where it is not, in a time step, K is made
   again with the clamped tangent, and stays so until the next assembly; if that is no help (or was
   there already), klu factors S as it is, and solves until the next factorisation. The counts
   tell; klu is made when first needed, with memory asked for after creation.
   COROT_RETRY: not positive definite, in statics, where the loss of stability must be seen.
   COROT_ESINGULAR: no pivot; the message names the degree of freedom and its node.
   COROT_ENOMEM; COROT_EINVAL: there is no S, or the solver's library refuses, for a reason in the
   message. */
COROT_API corot_status corot_pencil_factor(corot_pencil *pencil);

/* x = S^-1 b; x may be b. COROT_EINVAL: S has no factor, because factoring it failed or was not
   asked for since it was combined. COROT_ENOMEM. COROT_RETRY: pcg met a direction in which S is not positive, or did not
   converge. If it was not asked for by name, and a direct solver fits into memory, that takes its
   place instead, now and for the rest of the run (see corot_pencil_solver), with memory asked for then; and so it does, at a
   factorisation, where the iterations have cost twice as much as it would have. */
COROT_API corot_status corot_pencil_solve(corot_pencil *pencil, const double *b, double *x);

/* Newton's system of 2n unknowns at the g of the last combination, S = M + g D + g^2 K, by one
   solution of n. Of y' = f, y = (u, v): x [2n] = (I - g J)^-1 r for r [2n],

     dv = S^-1 (M r_v - g K r_u),   du = r_u + g dv,

   and _dae of F(t, y, y') = (u' - v, M v' - r): x = (dF/dy + dF/dy' / g)^-1 F. x may be r, or F.
   COROT_EINVAL: S is of another combination; else as corot_pencil_solve. */
COROT_API corot_status corot_pencil_newton(corot_pencil *pencil, const double *r, double *x);
COROT_API corot_status corot_pencil_newton_dae(corot_pencil *pencil, const double *F, double *x);

/* What the pencil is made of, for a host that solves, preconditions or couples by itself: read it
   only, until the pencil changes it or is destroyed. */
typedef struct corot_pencil_parts {
  const double (*K)[9], (*D)[9]; /* [corot_model_nblock()] of the last assembly: see corot/ode.h */
  const corot_csc *csc;          /* pattern of S: all of it with klu, else its lower triangle */
  const double *S;               /* [csc->nnz] of the last combination */
} corot_pencil_parts;

/* The solver may change in a run where it was left to choose, and the pattern with it. */
COROT_API corot_pencil_parts corot_pencil_view(const corot_pencil *pencil);

/* Marks K and D as out of date, so that the next set-up reassembles them whatever the integrator
   thinks. For a host that has called corot_frames_update. */
COROT_API void corot_pencil_invalidate(corot_pencil *pencil);

typedef struct corot_pencil_counts {
  long nassembly, ncombine, nfactor, nsolve; /* done, those of a fallback included */
  long nlsfail;    /* solves that failed: an iterative solver did not converge or found S not positive
                      definite, memory ran out */
  long nfresh;     /* factorisations that chose their pivots anew */
  long niteration;  /* of an iterative solver */
  long nindefinite; /* factorisations refused because S was not positive definite, of which */
  long nclamped;    /* the clamped tangent helped */
  long nfallback;   /* klu had to help */
  double assembly_s, combine_s, factor_s, solve_s; /* wall time [s] */
} corot_pencil_counts;

COROT_API corot_pencil_counts corot_pencil_statistics(const corot_pencil *pencil);

/* --- Mass ------------------------------------------------------------------------------------ */

/* M^-1: a division where M is lumped, a factor computed once where it is consistent. */
typedef struct corot_mass_solver corot_mass_solver;

/* The model must outlive it. COROT_ENOMEM; a lumped mass needs hardly any. COROT_EINVAL: no model. */
COROT_API corot_status corot_mass_solver_create(const corot_model *model, corot_mass_solver **solver);

/* Takes NULL. */
COROT_API void corot_mass_solver_destroy(corot_mass_solver *solver);

/* x = M^-1 b [n]; x may be b. Where the mass is lumped it cannot fail, else for want of memory only:
   COROT_ENOMEM. */
COROT_API corot_status corot_mass_solve(corot_mass_solver *solver, const double *b, double *x);

/* --- SUNDIALS ------------------------------------------------------------------------------- */

/* The version of the SUNDIALS library in use, "MAJOR.MINOR.PATCH"; "" if it does not tell. */
COROT_API const char *corot_sundials_version(void);

/* A SUNMatrix (SUNMATRIX_CUSTOM) and a SUNLinearSolver (SUNLINEARSOLVER_DIRECT) that stand for the
   Newton matrix I - gamma J of y = (u, v) [2n] by way of the pencil. Give both to
   CVodeSetLinearSolver, and corot_sun_linsys to CVodeSetLinSysFn; free them by SUNMatDestroy and
   SUNLinSolFree. NULL where memory ran out or pencil or ctx is NULL. The pencil must outlive them. */
COROT_API SUNMatrix corot_sun_matrix(corot_pencil *pencil, SUNContext ctx);
COROT_API SUNLinearSolver corot_sun_linsol(corot_pencil *pencil, SUNContext ctx);

/* What the functions below return to an integrator: 0, or as its manual asks a number > 0 where a
   shorter step may help (a tet is inverted, the matrix has no factor), or a corot_status < 0 where
   nothing helps (COROT_ENOMEM, COROT_EINVAL: user_data is NULL, or has a state of another model; a
   vector is of another length, or has no array in this process's memory; the matrix is none of
   corot_sun_matrix). corot_error() tells more.

   A CVLsLinSysFn. Its user_data is not looked at: the pencil comes from A. */
COROT_API int corot_sun_linsys(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix A,
                               sunbooleantype jok, sunbooleantype *jcur, sunrealtype gamma,
                               void *user_data, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3);

/* The same as an ARKLsLinSysFn of ARKODE, whose mass matrix is the identity: corot_sun_rhs divides by
   the mass. */
COROT_API int corot_sun_linsys_ark(sunrealtype t, N_Vector y, N_Vector fy, SUNMatrix A, SUNMatrix M,
                                   sunbooleantype jok, sunbooleantype *jcur, sunrealtype gamma,
                                   void *user_data, N_Vector tmp1, N_Vector tmp2, N_Vector tmp3);

/* The same for F(t, y, y') = (u' - v, M v' - r), the residual form of IDA (or IDAS): the solver,
   NULL where memory ran out, stands for dF/dy + cj dF/dy'. corot_sun_jacobian_dae is an IDALsJacFn;
   its user_data is not looked at. */
COROT_API SUNLinearSolver corot_sun_linsol_dae(corot_pencil *pencil, SUNContext ctx);
COROT_API int corot_sun_jacobian_dae(sunrealtype t, sunrealtype cj, N_Vector y, N_Vector yp,
                                     N_Vector F, SUNMatrix A, void *user_data, N_Vector tmp1,
                                     N_Vector tmp2, N_Vector tmp3);

/* Model, state and mass in one pointer: the user_data of corot_sun_rhs. Fields may be added at its
   end: zero is what they are if nothing is said. */
typedef struct corot_sun_data {
  const corot_model *model;
  corot_state *state;
  corot_mass_solver *mass; /* may be NULL where the mass is lumped */
  /* For corot/host.h; else zero: */
  corot_pencil *pencil; /* the preconditioner of a Krylov method, the matrix of an equilibrium */
  double rtol, atol_displacement, atol_velocity; /* of corot_sun_weights */
} corot_sun_data;

/* A CVRhsFn: ydot = (v, M^-1 r). user_data is a corot_sun_data. y is a serial vector [2n]. Without a
   mass solver where one is needed it returns COROT_EINVAL. */
COROT_API int corot_sun_rhs(sunrealtype t, N_Vector y, N_Vector ydot, void *user_data);

/* An IDAResFn: F = (u' - v, M v' - r), for lumped and consistent mass alike. user_data is a
   corot_sun_data, of which the mass solver is not used. */
COROT_API int corot_sun_residual(sunrealtype t, N_Vector y, N_Vector yp, N_Vector F,
                                 void *user_data);

#ifdef __cplusplus
}
#endif
#endif

/* A host whose integrators are PETSc's: TSALPHA2, the generalized-alpha method for M a = r, takes
   second-order systems as they are, F(t, u, v, a) = M a - r = 0. Its Newton matrix K + V D + A M,
   with V and A of the method, is a combination of the pencil, which factors and solves it as
   PETSc's preconditioner; no PETSc matrix is filled. On one process. */
#include <corot/solve.h>
#include <petscts.h>

#include "bar.h"

typedef struct solid {
  corot_model *model;
  corot_state *state;
  corot_pencil *pencil;
} solid;

/* What PETSc is told of a status: a state that cannot be evaluated is a matter of the step. */
static PetscErrorCode tell(TS ts, corot_status status) {
  SNES snes;
  if (status == COROT_OK) return 0;
  if (status < 0) SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "corot: %s", corot_error());
  PetscCall(TSGetSNES(ts, &snes));
  return SNESSetFunctionDomainError(snes);
}

static PetscErrorCode residual(TS ts, PetscReal t, Vec U, Vec V, Vec A, Vec F, void *context) {
  const solid *s = context;
  const double *u, *v, *a;
  double *f;
  int n = corot_model_ndof(s->model);
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(VecGetArrayRead(V, &v));
  PetscCall(VecGetArrayRead(A, &a));
  PetscCall(VecGetArray(F, &f));
  double *r = malloc((size_t)n * sizeof *r);
  if (!r) SETERRQ(PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory");
  corot_status status = corot_residual(s->model, s->state, t, u, v, r);
  corot_mass_multiply(s->model, a, f);
  for (int i = 0; i < n; i++) f[i] -= r[i];
  free(r);
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscCall(VecRestoreArrayRead(V, &v));
  PetscCall(VecRestoreArrayRead(A, &a));
  PetscCall(VecRestoreArray(F, &f));
  return tell(ts, status);
}

static PetscErrorCode jacobian(TS ts, PetscReal t, Vec U, Vec V, Vec A, PetscReal shiftV,
                               PetscReal shiftA, Mat J, Mat P, void *context) {
  const solid *s = context;
  const double *u, *v;
  (void)A, (void)J, (void)P;
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(VecGetArrayRead(V, &v));
  corot_status status = corot_pencil_assemble(s->pencil, t, u, v);
  if (!status) corot_pencil_combine(s->pencil, shiftA, shiftV, 1);
  if (!status) status = corot_pencil_factor(s->pencil);
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscCall(VecRestoreArrayRead(V, &v));
  return tell(ts, status);
}

static PetscErrorCode apply(PC pc, Vec b, Vec x) {
  solid *s;
  const double *from;
  double *to;
  PetscCall(PCShellGetContext(pc, &s));
  PetscCall(VecGetArrayRead(b, &from));
  PetscCall(VecGetArray(x, &to));
  corot_status status = corot_pencil_solve(s->pencil, from, to);
  PetscCall(VecRestoreArrayRead(b, &from));
  PetscCall(VecRestoreArray(x, &to));
  if (status) SETERRQ(PETSC_COMM_SELF, PETSC_ERR_LIB, "corot: %s", corot_error());
  return 0;
}

/* Newton's iteration by full steps, each solved by the pencil and nothing else. */
static PetscErrorCode set_solver(TS ts, solid *s) {
  SNES snes;
  SNESLineSearch search;
  KSP ksp;
  PC pc;
  PetscCall(TSGetSNES(ts, &snes));
  PetscCall(SNESSetTolerances(snes, 1e-12, 1e-8, 1e-10, 20, 1000));
  PetscCall(SNESGetLineSearch(snes, &search));
  PetscCall(SNESLineSearchSetType(search, SNESLINESEARCHBASIC));
  PetscCall(SNESGetKSP(snes, &ksp));
  PetscCall(KSPSetType(ksp, KSPPREONLY));
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(PCSetType(pc, PCSHELL));
  PetscCall(PCShellSetContext(pc, s));
  return PCShellSetApply(pc, apply);
}

int main(int argc, char **argv) {
  PetscCall(PetscInitialize(&argc, &argv, NULL, NULL));
  solid s = {.model = bar_create()};
  check(corot_state_create(s.model, &s.state));
  check(corot_pencil_create(s.model, s.state, NULL, &s.pencil));
  int n = corot_model_ndof(s.model);

  TS ts;
  Vec U, V, F;
  Mat J;
  PetscCall(VecCreateSeq(PETSC_COMM_SELF, n, &U));
  PetscCall(VecDuplicate(U, &V));
  PetscCall(VecDuplicate(U, &F));
  PetscCall(MatCreateShell(PETSC_COMM_SELF, n, n, n, n, NULL, &J));
  PetscCall(TSCreate(PETSC_COMM_SELF, &ts));
  PetscCall(TSSetType(ts, TSALPHA2));
  PetscCall(TSAlpha2SetRadius(ts, 0.9));
  PetscCall(TSSetI2Function(ts, F, residual, &s));
  PetscCall(TSSetI2Jacobian(ts, J, J, jacobian, &s));
  PetscCall(set_solver(ts, &s));
  PetscCall(TSSetTimeStep(ts, 4e-3)); /* a whole number of steps to the load's kink at 1 s */
  PetscCall(TSSetMaxTime(ts, T_END));
  PetscCall(TSSetMaxSteps(ts, 100000));
  PetscCall(TSSetExactFinalTime(ts, TS_EXACTFINALTIME_MATCHSTEP));
  PetscCall(TSSetFromOptions(ts));
  PetscCall(TS2SetSolution(ts, U, V));
  PetscCall(TSSolve(ts, U));

  const double *u;
  PetscCall(VecGetArrayRead(U, &u));
  bar_print(s.model, u);
  PetscCall(VecRestoreArrayRead(U, &u));

  PetscCall(TSDestroy(&ts));
  PetscCall(MatDestroy(&J));
  PetscCall(VecDestroy(&U));
  PetscCall(VecDestroy(&V));
  PetscCall(VecDestroy(&F));
  corot_pencil_destroy(s.pencil);
  corot_state_destroy(s.state);
  corot_model_destroy(s.model);
  return PetscFinalize();
}

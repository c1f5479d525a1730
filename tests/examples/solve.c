/* The linear algebra of an implicit step: assemble, factor, solve. Here a Newton iteration for an
   equilibrium, whose error squares. (For a CVODE of your own see models/embedding/host_cvode.c.)
   Needs corot::solve. */
#include <corot/solve.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

static corot_model *create_bar(void) {
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 6}};
  const corot_material rubber = {.lambda = 1e5, .mu = 1e4, .density = 1000};
  const corot_fix base = {"zmin", {true, true, true}};
  const corot_load pull = {
      .kind = COROT_TRACTION, .group = "zmax", .value = {50, 0, 500}}; /* [Pa] */
  corot_mesh *mesh;
  corot_model *model;
  check(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.nmaterial = 1, def.material = &rubber;
  def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = &pull;
  check(corot_model_create(&def, &model));
  corot_mesh_destroy(mesh);
  return model;
}

static double largest(int n, const double *x) {
  double most = 0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(x[i]));
  return most;
}

int main(void) {
  corot_model *model = create_bar();
  corot_state *state;
  corot_pencil *pencil;
  corot_linear_def linear = corot_linear_defaults(); /* which solver: "auto" */
  linear.role = COROT_ROLE_STATIC;
  check(corot_state_create(model, &state));
  check(corot_pencil_create(model, state, &linear, &pencil));
  corot_pencil_use(pencil, COROT_TANGENT_EXACT);
  int n = corot_model_ndof(model);
  double *u = calloc(3 * (size_t)n, sizeof *u), *v = u + n, *r = u + 2 * n; /* v stays zero */
  if (!u) return 1;

  for (int iteration = 0; iteration < 8; iteration++) {
    check(corot_residual(model, state, 0, u, v, r));
    printf("largest residual %.3e N\n", largest(n, r));
    if (largest(n, r) < 1e-12) break;
    check(corot_pencil_assemble(pencil, 0, u, v));
    corot_pencil_combine(pencil, 0, 0, 1); /* S = a M + b D + c K; in a time step 1, g, g^2 */
    check(corot_pencil_factor(pencil));    /* COROT_RETRY: K is not positive definite */
    check(corot_pencil_solve(pencil, r, r));
    for (int i = 0; i < n; i++) u[i] += r[i];
  }
  corot_pencil_counts counts = corot_pencil_statistics(pencil);
  printf("%s: %ld factorisations, %ld solutions\n", corot_pencil_solver(pencil), counts.nfactor,
         counts.nsolve);

  free(u);
  corot_pencil_destroy(pencil);
  corot_state_destroy(state);
  corot_model_destroy(model);
}

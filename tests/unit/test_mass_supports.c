/* A consistent mass with supports that move: what it hands on to the free nodes, and that momenta
   and the ledger of energy know it. */
#include <corot/integrate.h>
#include <corot/solve.h>

#include "solid.h"

/* Supports that start and stop at once. */
static const corot_motion jolted[] = {
    {COROT_ROTATE, "zmin", {1, 2, 3}, {0.1, -0.2, 0.05}, 2, {0}, 0.05, 0.3},
    {COROT_TRANSLATE, "zmin", {0}, {0}, 0, {0.3, -0.4, 0.2}, 0.05, 0.3},
};
enum { NJOLTED = sizeof jolted / sizeof *jolted };

static const double fall[3] = {0.7, -2, 9.81};

/* Two materials with mass damping, in a body of unlike tets one end of which moves. */
static body moved(corot_mesh *mesh, const char *strain, const corot_motion *motion, int nload,
                  const corot_load *load) {
  double low[3] = {-10, -10, -10}, high[3] = {10, 10, 10};
  high[2] = mesh->x[mesh->nnode / 2][2];
  assert_ok(corot_mesh_group_box(mesh, "lower", low, high, 0));
  corot_material material[2] = {soft, soft};
  material[0].group = "lower", material[0].damping_mass = 0.3;
  material[1].density *= 3, material[1].damping_mass = 2;
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 2, def.material = material;
  def.nmotion = motion != NULL, def.motion = motion, def.nload = nload, def.load = load;
  def.mass = COROT_MASS_CONSISTENT;
  return make_body(mesh, def);
}

/* Of a support at rest, under gravity: M a = r for the acceleration a of all of the body. */
static void a_body_at_rest_begins_to_fall_as_one(void **state) {
  (void)state;
  for (int k = 0; k < NJOLTED; k++) {
    corot_load gravity = {COROT_GRAVITY, NULL, {fall[0], fall[1], fall[2]}, {0}};
    body b = moved(crooked_box(2, 3, 4), "polar", &jolted[k], 1, &gravity);
    double *u = calloc(4 * b.n, sizeof *u), *r = u + 2 * b.n, *a = r + b.n;
    const int(*dof)[3] = corot_model_dof(b.model);
    corot_mass_solver *solver;
    assert_ok(corot_mass_solver_create(b.model, &solver));
    assert_ok(corot_residual(b.model, b.state, 0, u, u + b.n, r));
    assert_ok(corot_mass_solve(solver, r, a));
    for (int i = 0; i < 3 * b.mesh->nnode; i++)
      if (dof[i / 3][i % 3] >= 0) assert_close(a[dof[i / 3][i % 3]], fall[i % 3], 0, 1e-13 * 10);
    corot_mass_solver_destroy(solver);
    free(u), drop_body(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_body_at_rest_begins_to_fall_as_one),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

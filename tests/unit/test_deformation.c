/* How far a body is deformed, and how its stress jumps between tets. */
#include <corot/ode.h>

#include "alloc.h"
#include "solid.h"

/* A crooked box, free, whose upper half is of a stiffer material if `two`. */
static body block(const char *strain, bool two) {
  corot_mesh *mesh = crooked_box(2, 2, 2);
  double min[3] = {-2, -2, 0.6}, max[3] = {2, 2, 2};
  assert_ok(corot_mesh_group_box(mesh, "upper", min, max, 0));
  corot_material material[] = {soft, soft};
  material[1].group = "upper", material[1].lambda *= 3, material[1].mu *= 5;
  corot_model_def def = corot_model_defaults();
  def.strain = strain;
  def.nmaterial = two ? 2 : 1, def.material = material;
  return make_body(mesh, def);
}

/* u = F X - X. */
static double *map(const body *b, const double F[9]) {
  double *u = malloc(b->n * sizeof *u), (*nodal)[3] = malloc(b->mesh->nnode * sizeof *nodal);
  for (int n = 0; n < b->mesh->nnode; n++) {
    apply(F, b->mesh->x[n], nodal[n]);
    for (int c = 0; c < 3; c++) nodal[n][c] -= b->mesh->x[n][c];
  }
  to_dofs(b, (const double(*)[3])nodal, u);
  free(nodal);
  return u;
}

static corot_deformation measure(const double F[9], double strain_limit, double turn_limit) {
  body b = block("polar", false);
  double *u = map(&b, F);
  corot_deformation d;
  corot_deformation_measure(b.model, b.state, 0, u, strain_limit, turn_limit, &d);
  free(u);
  drop_body(&b);
  return d;
}

static const double about[3] = {1, -2, 3};

/* F = Q diag(1.3, 0.9, 0.7): the stretches are its own, whatever turns it. */
static void stretches_are_found(void **state) {
  (void)state;
  const double U[9] = {1.3, 0, 0, 0, 0.9, 0, 0, 0, 0.7};
  for (double angle = 0; angle < 3; angle += 0.7) {
    double Q[9], F[9];
    rotation(about, angle, Q);
    multiply(Q, U, F);
    corot_deformation d = measure(F, 0.2, INFINITY);
    assert_close(d.strained, 1, 1e-12, 0);
    assert_close(d.stretch_max, 1.3, 1e-12, 0);
    assert_close(d.stretch_min, 0.7, 1e-12, 0);
    assert_close(d.det_min, 1.3 * 0.9 * 0.7, 1e-12, 0);
    assert_int_equal(d.ninverted, 0);
    assert_close(d.turn_max, 0, 0, 0);
    d = measure(F, 0.4, INFINITY); /* and what is below the limit does not count */
    assert_close(d.strained, 0, 0, 0);
    assert_close(d.stretch_max, 1, 0, 0);
  }
}

static void the_limit_holds_both_ways(void **state) {
  (void)state;
  for (double limit = 0.05; limit < 0.6; limit += 0.1)
    for (int sign = -1; sign < 2; sign += 2)
      for (int beyond = 0; beyond < 2; beyond++) {
        double stretch = 1 + sign * limit * (beyond ? 1.001 : 0.999);
        const double F[9] = {1, 0, 0, 0, stretch, 0, 0, 0, 1};
        assert_close(measure(F, limit, INFINITY).strained, beyond, 1e-12, 0);
      }
}

static void turns_are_found(void **state) {
  (void)state;
  const double U[9] = {1.02, 0, 0, 0, 0.99, 0.01, 0, 0.01, 0.98};
  for (double angle = 0.11; angle < 3.1; angle += 0.3) {
    double Q[9], F[9];
    rotation(about, angle, Q);
    multiply(Q, U, F);
    corot_deformation d = measure(F, 0.2, 0.1);
    assert_close(d.turned, 1, 1e-12, 0);
    assert_close(d.turn_max, angle, 1e-9, 0);
    assert_close(d.strained, 0, 0, 0);
    assert_close(measure(F, 0.2, angle + 0.01).turned, 0, 0, 0);
  }
}

static void an_inverted_tet_is_counted(void **state) {
  (void)state;
  const double mirror[9] = {1, 0, 0, 0, 1, 0, 0, 0, -0.5};
  corot_deformation d = measure(mirror, 0.2, 0.1);
  assert_int_equal(d.ninverted, 48);
  assert_close(d.det_min, -0.5, 1e-12, 0);
  assert_true(d.det_tet >= 0 && d.det_tet < 48);
  assert_close(d.strained + d.turned, 0, 0, 0);
}

static double jumps(const body *b, const double *u) {
  double share = -1;
  assert_ok(corot_stress_jumps(b->model, b->state, 0, u, &share));
  return share;
}

/* One strain everywhere is one stress in each material, which does not jump; nor does rest. */
static void an_even_strain_does_not_jump(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int two = 0; two < 2; two++) {
      body b = block(measures[m], two);
      const double F[9] = {1.1, 0.2, 0, 0, 0.95, 0.1, 0, 0, 1};
      double *u = map(&b, F);
      assert_below(jumps(&b, u), 1e-7); /* the root of rounding */
      memset(u, 0, b.n * sizeof *u);
      assert_close(jumps(&b, u), 0, 0, 0);
      free(u);
      drop_body(&b);
    }
}

/* Far away, and turned: what rounding leaves of no strain is no stress. */
static void a_rigid_motion_does_not_jump(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    if (corot_strain_traits(m)->linear) continue;
    body b = block(measures[m], true);
    double Q[9];
    rotation(about, 0.9, Q);
    double *u = map(&b, Q);
    assert_close(jumps(&b, u), 0, 0, 0);
    for (int i = 0; i < b.n; i++) u[i] += 1e4;
    assert_close(jumps(&b, u), 0, 0, 0);
    free(u);
    drop_body(&b);
  }
}

/* u_x = z^2 size, or z^3 with ten-node tets, which have the stress of z^2: bent. Turned as a whole
   it jumps as much, but in cauchy's eyes; and at small sizes the share does not depend on the size.
 */
static void a_bent_block_jumps_however_it_is_turned(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    body b = block(measures[m], false);
    double(*x)[3] = malloc(b.mesh->nnode * sizeof *x), Q[9], share[3];
    double *u = malloc(b.n * sizeof *u);
    rotation(about, corot_strain_traits(m)->linear ? 0 : 1.3, Q);
    for (int k = 0; k < 3; k++) {
      double size = k == 1 ? 1e-4 : 1e-5;
      for (int n = 0; n < b.mesh->nnode; n++) {
        const double *X = b.mesh->x[n];
        double bent[3] = {X[0] + size * pow(X[2], order_of_test() + 1), X[1], X[2]};
        apply(k == 2 ? Q : identity, bent, x[n]);
        for (int c = 0; c < 3; c++) x[n][c] -= X[c];
      }
      to_dofs(&b, (const double(*)[3])x, u);
      share[k] = jumps(&b, u);
    }
    assert_above(share[0], 1e4 * 1e-7); /* far above what rounding leaves of none */
    assert_below(share[0], 0.9);
    assert_close(share[1], share[0], 1e-2, 0);
    assert_close(share[2], share[0], 1e-6, 0);
    free(x);
    free(u);
    drop_body(&b);
  }
}

/* The same bend in boxes of n cells a side, none curved: the share of the jumps. */
static double bent_share(const char *strain, int n) {
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.nmaterial = 1, def.material = &soft;
  body b = make_body(straight_box(n, n, n), def);
  double *u = calloc(b.n, sizeof *u);
  for (int k = 0; k < b.mesh->nnode; k++)
    u[3 * k] = 1e-5 * pow(b.mesh->x[k][2], order_of_test() + 1);
  double share = jumps(&b, u);
  free(u), drop_body(&b);
  return share;
}

/* The stress errs, and jumps, with the order of the elements: slopes 1.00 and 2.02 from 4 to 8
   cells, 0.88 and 1.81 from 2 to 4, where all tets are at the boundary. */
static void jumps_fall_with_the_order_of_the_elements(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    double coarse = bent_share(measures[m], 4), fine = bent_share(measures[m], 8);
    assert_close(log(coarse / fine) / log(2.0), order_of_test(), 0.05, 0);
  }
}

static corot_status find_jumps(void *of) {
  body *b = of;
  double share, *u = calloc(b->n, sizeof *u);
  if (!u) return corot_fail(COROT_ENOMEM, "the test itself");
  corot_status status = corot_stress_jumps(b->model, b->state, 0, u, &share);
  free(u);
  return status;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  body b = block("polar", false);
  assert_survives_failed_allocations(find_jumps, &b);
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stretches_are_found),
      cmocka_unit_test(the_limit_holds_both_ways),
      cmocka_unit_test(turns_are_found),
      cmocka_unit_test(an_inverted_tet_is_counted),
      cmocka_unit_test(an_even_strain_does_not_jump),
      cmocka_unit_test(a_rigid_motion_does_not_jump),
      cmocka_unit_test(a_bent_block_jumps_however_it_is_turned),
      cmocka_unit_test(jumps_fall_with_the_order_of_the_elements),
      cmocka_unit_test(failed_allocations_are_survived),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

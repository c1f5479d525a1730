/* Every build of the kernels that this processor can run gives what the widest one gives, to
   rounding: vectors of 8, 4 and 2 lanes, a lane a tet, on the same blocks of tets. */
#include "core/lanes/widths.h"
#include "hierarchical.h"

static const int widths[] = {8, 4, 2};
static const char *const width_names[] = {"8 lanes", "4 lanes", "2 lanes"};
enum { NWIDTH = 3, MOST_QUANTITIES = 40 };

/* What the kernels compute of one solid, a quantity after the other. */
typedef struct record {
  int count;
  const char *name[MOST_QUANTITIES];
  int n[MOST_QUANTITIES];
  double *value[MOST_QUANTITIES];
} record;

static double *quantity(record *r, const char *name, int n) {
  assert_true(r->count < MOST_QUANTITIES);
  r->name[r->count] = name, r->n[r->count] = n;
  return r->value[r->count++] = calloc(n, sizeof(double));
}

static void drop_record(record *r) {
  for (int k = 0; k < r->count; k++) free(r->value[k]);
}

typedef struct fields {
  double *u, *v, *du, *dv;
} fields;

static void record_forces(const solid *s, const fields *f, const char *name, record *r) {
  corot_energies e;
  assert_ok(corot_residual(s->model, s->state, 0, f->u, f->v, quantity(r, name, s->n)));
  assert_ok(corot_energy(s->model, s->state, 0, f->u, f->v, &e));
  double *energies = quantity(r, "energies", 3);
  energies[0] = e.elastic, energies[1] = e.power_dissipated, energies[2] = e.kinetic;
}

static void record_derivatives(const solid *s, const fields *f, bool exact_product, record *r) {
  int n = corot_model_nblock(s->model);
  const corot_tangent tangents[] = {COROT_TANGENT_HELD, COROT_TANGENT_EXACT, COROT_TANGENT_CLAMPED};
  for (int k = 0; k < 3; k++) {
    double *K = quantity(r, "K", 9 * n), *D = quantity(r, "D", 9 * n);
    assert_ok(corot_jacobian(s->model, s->state, 0, f->u, f->v, tangents[k], (double(*)[9])K,
                             (double(*)[9])D));
  }
  for (int k = 0; k < 1 + exact_product; k++)
    assert_ok(corot_jvp(s->model, s->state, 0, f->u, f->v, tangents[k], f->du, f->dv,
                        quantity(r, "product", s->n)));
}

/* Frames exact, then held, then turned on. */
static void record_all(const solid *s, const fields *f, bool plain, record *r) {
  corot_state_use(s->state, COROT_FRAMES_EXACT);
  record_forces(s, f, "force", r);
  record_derivatives(s, f, true, r);
  for (int k = 0; k < NMEASURE && plain; k++) {
    double *internal = quantity(r, "internal force", 3 * s->mesh->nnode);
    assert_ok(corot_internal_force(s->model, s->state, 0, f->u, measures[k], 0.7, 1.2,
                                   (double(*)[3])internal));
  }
  corot_state_use(s->state, COROT_FRAMES_HELD);
  assert_ok(corot_frames_update(s->model, s->state, 0, f->u, NULL));
  record_forces(s, f, "force in held frames", r);
  record_derivatives(s, f, false, r);
  if (!plain) return;
  double spin;
  corot_state_use(s->state, COROT_FRAMES_EXTRAPOLATED);
  assert_ok(corot_frames_spin(s->model, s->state, 0, f->u, f->v, &spin));
  assert_ok(corot_residual(s->model, s->state, 1e-3, f->u, f->v,
                           quantity(r, "force in frames turned on", s->n)));
}

/* Sums of some hundred terms that are rounded otherwise, where one set of instructions has fused
   multiply-adds and another has not: 1e-11 of the largest. */
static void compare(const char *what, const record *a, const record *b, const char *width) {
  assert_int_equal(a->count, b->count);
  for (int k = 0; k < a->count; k++) {
    double scale = norm_max(a->n[k], a->value[k]);
    for (int i = 0; i < a->n[k]; i++)
      if (!(fabs(a->value[k][i] - b->value[k][i]) <= 1e-11 * scale))
        fail_msg("%s, %s, with %s: %s[%d] = %.17g, not %.17g; the largest is %.3g", what,
                 a->name[k], width, a->name[k], i, b->value[k][i], a->value[k][i], scale);
  }
}

/* All widths, of which some are the same where the processor has no more. */
static void compare_widths(const char *what, const solid *s, bool plain) {
  double *x = vectors(4, s->n);
  fields f = {x, x + s->n, x + 2 * s->n, x + 3 * s->n};
  bend(s, 0.6, 0.01, f.u);
  fill_noise(s->n, 3, 100, f.v);
  fill_noise(s->n, 4, 1, f.du);
  fill_noise(s->n, 6, 100, f.dv);
  record widest = {0};
  for (int k = 0; k < NWIDTH; k++) {
    record r = {0};
    corot_lanes_limit(widths[k]);
    record_all(s, &f, plain, &r);
    if (k == 0) {
      widest = r;
      continue;
    }
    compare(what, &widest, &r, width_names[k]);
    drop_record(&r);
  }
  corot_lanes_limit(0);
  drop_record(&widest);
  free(x);
}

/* Of each measure, 88 tets and more, so that the last block is not full. */
static void test_plain(void **state) {
  (void)state;
  static const corot_fix fix = {"zmin", {true, true, true}};
  const corot_viscosity laws[] = {COROT_COROTATED, COROT_OBJECTIVE};
  for (int measure = 0; measure < NMEASURE; measure++)
    for (int k = 0; k < 3; k++) {
      corot_model_def def = corot_model_defaults();
      def.strain = measures[measure], def.viscosity = laws[k % 2 && is_polar(measure)];
      def.dilatation = k == 2 ? COROT_DILATATION_NODAL : COROT_DILATATION_LOCAL;
      def.nmaterial = 1, def.material = &soft, def.nfix = 1, def.fix = &fix;
      body b = make_body(crooked_box(2, 3, 3), def);
      assert_int_not_equal(b.mesh->ntet % 8, 0);
      solid s = {.mesh = b.mesh, .model = b.model, .state = b.state, .n = b.n};
      compare_widths(measures[measure], &s, true);
      drop_body(&b);
    }
}

static void test_hierarchical(void **state) {
  const choice choices[] = {{"green", "polar", 2, 0, true},
                            {"hybrid", "polar", 1, 1, true},
                            {"green", "warp", 2, 0, false},
                            {"polar", "cauchy", 1, 0, true},
                            {"green", "polar", 0, 0, true, .raised = true},
                            {"green", "polar", 1, 0, true, .raised = true}};
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) {
    solid s = make_solid(&choices[k], coupling_of(state), &soft, true);
    compare_widths(choices[k].fine, &s, false);
    drop_solid(&s);
  }
}

/* The first inverted tet is the same, wherever in a block it is. */
static void test_inverted(void **state) {
  (void)state;
  corot_model_def def = corot_model_defaults();
  def.strain = "polar", def.nmaterial = 1, def.material = &soft;
  body b = make_body(crooked_box(2, 2, 2), def);
  double *u = calloc(2 * b.n, sizeof *u), *r = u + b.n;
  int ninverted = 0;
  for (int i = 0; i < b.n; i++) {
    int tet[NWIDTH];
    u[i] = i % 2 ? 3 : -3;
    for (int k = 0; k < NWIDTH; k++) {
      corot_lanes_limit(widths[k]);
      corot_status status = corot_residual(b.model, b.state, 0, u, u, r);
      tet[k] = status == COROT_RETRY ? corot_state_inverted(b.state) : -1;
      assert_int_equal(tet[k], tet[0]);
    }
    ninverted += tet[0] >= 0;
    u[i] = 0;
  }
  assert_true(ninverted > b.n / 3); /* most tips are pushed through, others out */
  corot_lanes_limit(0);
  free(u);
  drop_body(&b);
}

/* A limit is kept to, and taken back. */
static void test_limit(void **state) {
  (void)state;
  int most = corot_lanes_in_use();
  corot_lanes_limit(2);
  bool several = corot_lanes_in_use() < most; /* or the build has only one */
  corot_lanes_limit(0);
  for (int k = 0; k < NWIDTH; k++) {
    corot_lanes_limit(widths[k]);
    assert_true(corot_lanes_in_use() <= most);
    if (several) assert_int_equal(corot_lanes_in_use(), widths[k] < most ? widths[k] : most);
    corot_lanes_limit(0);
    assert_int_equal(corot_lanes_in_use(), most);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_plain),
                                     each_coupling_unit_test(test_hierarchical),
                                     cmocka_unit_test(test_inverted), cmocka_unit_test(test_limit)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* A solid's forces as functions of nodal fields: where they are added up, where the frames come
   from, and what fails. What they are is tested through the model (test_chunks, test_derivatives).
 */
#include <stdlib.h>

#include "core/ode/state.h"
#include "core/solid/measures.h"
#include "solid.h"

typedef struct sample {
  body b;
  const solid *solid;
  solid_state *state;
  int nnode;
  double (*u)[4], (*v)[4]; /* [nnode] */
  double (*f)[4];          /* [nnode] zero */
} sample;

static sample make(const char *strain) {
  static const corot_fix fix = {"zmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.strain = strain;
  def.nmaterial = 1, def.material = &soft;
  def.nfix = 1, def.fix = &fix;
  sample s = {.b = make_body(crooked_box(3, 2, 3), def)};
  uint64_t seed = 11;
  s.solid = solid_of(s.b.model);
  s.state = &s.b.state->system.of[0];
  s.nnode = s.b.mesh->nnode;
  s.u = corot_vector_calloc(s.nnode, sizeof *s.u);
  s.v = corot_vector_calloc(s.nnode, sizeof *s.v);
  s.f = corot_vector_calloc(s.nnode, sizeof *s.f);
  for (int n = 0; n < s.nnode; n++)
    for (int c = 0; c < 3; c++) s.u[n][c] = 0.02 * noise(&seed), s.v[n][c] = noise(&seed);
  return s;
}

static void drop(sample *s) {
  free(s->u), free(s->v), free(s->f);
  drop_body(&s->b);
}

static corot_status force(const sample *s, force_sum *sum) {
  return corot_solid_force(s->solid, s->state, (nodal_field)s->u, (nodal_field)s->v, sum);
}

/* On rows, of which held components have none, stands what stands on the nodes. */
static void rows_and_nodes_have_the_same(void **state) {
  (void)state;
  for (int k = 0; k < NMEASURE; k++) {
    sample s = make(measures[k]);
    const int(*dof)[3] = corot_model_dof(s.b.model);
    double *r = calloc(s.b.n, sizeof *r);
    force_sum nodes = {.r = s.f[0], .sign = 1}, rows = {.row = dof, .r = r, .sign = 1};
    assert_ok(force(&s, &nodes));
    assert_ok(force(&s, &rows));
    assert_above(norm_max(s.b.n, r), 0);
    for (int n = 0; n < s.nnode; n++)
      for (int c = 0; c < 3; c++)
        if (dof[n][c] >= 0) assert_true(r[dof[n][c]] == s.f[n][c]);
    free(r);
    drop(&s);
  }
}

/* What is added and taken off again leaves nothing, to the last bit. */
static void a_sign_takes_off_what_the_other_adds(void **state) {
  (void)state;
  for (int k = 0; k < NMEASURE; k++) {
    sample s = make(measures[k]);
    force_sum add = {.r = s.f[0], .sign = 1}, subtract = {.r = s.f[0], .sign = -1};
    assert_ok(force(&s, &add));
    assert_above(norm_max(4 * s.nnode, s.f[0]), 0);
    assert_ok(force(&s, &subtract));
    assert_true(norm_max(4 * s.nnode, s.f[0]) == 0);
    drop(&s);
  }
}

/* Nodes before `from` take no part, and the others feel nothing of that. */
static void the_first_nodes_may_be_left_out(void **state) {
  (void)state;
  for (int k = 0; k < NMEASURE; k++) {
    sample s = make(measures[k]);
    double(*all)[4] = corot_vector_calloc(s.nnode, sizeof *all);
    for (int from = 1; from <= s.nnode; from += 7) {
      force_sum whole = {.r = all[0], .sign = 1}, part = {.r = s.f[0], .sign = 1, .from = from};
      memset(all, 0, s.nnode * sizeof *all), memset(s.f, 0, s.nnode * sizeof *s.f);
      assert_ok(force(&s, &whole));
      assert_ok(force(&s, &part));
      for (int n = 0; n < s.nnode; n++)
        for (int c = 0; c < 3; c++) assert_true(s.f[n][c] == (n < from ? 0 : all[n][c]));
    }
    free(all);
    drop(&s);
  }
}

/* Frames that are given are used as they are: those of u give the forces of u; and a rigid turn of
   the given ones after so long is the turn of their spin. Both to rounding. */
static void frames_come_from_where_they_are_said_to(void **state) {
  (void)state;
  for (int k = 0; k < NMEASURE; k++) {
    sample s = make(measures[k]);
    int npoint = points_of(&s.solid->elements);
    double(*own)[4] = corot_vector_calloc(s.nnode, sizeof *own);
    force_sum first = {.r = own[0], .sign = 1}, given = {.r = s.f[0], .sign = 1};
    assert_ok(force(&s, &first));
    assert_ok(corot_solid_frames(s.solid, s.state, (nodal_field)s.u, s.state->new_R));

    /* turned back by a spin about z, and on again */
    const double age = 0.25, rate = 1.5;
    vec3 back = {{vd_all(0), vd_all(0), vd_all(-rate)}};
    for (int b = 0; b < npoint; b++) {
      s.state->R[b] = rotate_by(back, age, s.state->new_R[b]);
      s.state->spin[b] = (vec3){{vd_all(0), vd_all(0), vd_all(rate)}};
    }
    const frame_source sources[] = {
        {.kind = COROT_FRAMES_HELD, .R = s.state->new_R},
        {.kind = COROT_FRAMES_EXTRAPOLATED, .R = s.state->R, .spin = s.state->spin, .age = age}};
    for (int i = 0; i < 2; i++) {
      s.state->frames = sources[i];
      memset(s.f, 0, s.nnode * sizeof *s.f);
      assert_ok(force(&s, &given));
      for (int n = 0; n < s.nnode; n++)
        for (int c = 0; c < 3; c++)
          assert_close(s.f[n][c], own[n][c], 0, 1e-12 * norm_max(4 * s.nnode, own[0]));
    }
    free(own);
    drop(&s);
  }
}

/* An inverted tet is named; forces beyond double precision are of no tet. Cauchy strain is linear:
   there nothing inverts. */
static void failures_say_whose_they_are(void **state) {
  (void)state;
  for (int k = 0; k < NMEASURE; k++) {
    sample s = make(measures[k]);
    force_sum sum = {.r = s.f[0], .sign = 1};
    int node = s.b.mesh->tet[5][0];
    double before = s.u[node][0];
    s.u[node][0] += 100;
    if (corot_strain_traits(k)->linear) {
      assert_ok(force(&s, &sum));
    } else {
      assert_fails(force(&s, &sum), COROT_RETRY, "is inverted");
      assert_true(s.state->inverted >= 0);
    }
    s.u[node][0] = before;
    for (int n = 0; n < s.nnode; n++)
      for (int c = 0; c < 3; c++) s.v[n][c] *= 1e308;
    sum.check = 0;
    assert_fails(force(&s, &sum), COROT_RETRY, "the forces exceed double precision");
    assert_int_equal(s.state->inverted, -1);
    drop(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_and_nodes_have_the_same),
      cmocka_unit_test(a_sign_takes_off_what_the_other_adds),
      cmocka_unit_test(the_first_nodes_may_be_left_out),
      cmocka_unit_test(frames_come_from_where_they_are_said_to),
      cmocka_unit_test(failures_say_whose_they_are),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

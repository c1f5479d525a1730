/* What is claimed of a mesh by order: between which bounds, and in which words. */
#define TEST_NAME "test_claim"
#include "check.h"
#include "scenario_text.h"
#include "study/measure/claim.h"

/* The displacement `size` in every free component of MINIMAL, at one time. */
static trajectory state_of(const yardstick *y, double size) {
  int n = corot_model_ndof(y->model), k = 0;
  const int(*dof)[3] = corot_model_dof(y->model);
  trajectory t = {.n = n, .count = 1};
  t.place = malloc((size_t)n * sizeof *t.place);
  t.record = calloc(1 + 2 * (size_t)n, sizeof *t.record);
  assert_true(t.place && t.record);
  for (int i = 0; i < 3 * y->mesh->nnode; i++)
    if (dof[i / 3][i % 3] >= 0) t.place[k++] = i;
  t.record[0] = 1;
  for (int i = 0; i < n; i++) t.record[1 + i] = size;
  return t;
}

/* With a mesh that moves by 1, ten-node tets on it by `raised`, finer ones by `finer`, 0: there are
   none. Errors are relative to the last of them, which is known to 1e-6. */
static void bounds_and_words(void **state) {
  (void)state;
  static const struct {
    double raised, finer;
    claim_kind kind;
    double value, low, high;
    const char *words;
  } cases[] = {
      {1.9, 2, CLAIM_ABOUT, 0.5, 0.45, 0.55,
       "against finer tets of ten nodes, between 4.5e-01 and 5.5e-01"},
      {2.1, 2, CLAIM_ABOUT, 0.5, 0.45, 0.55,
       "against finer tets of ten nodes, between 4.5e-01 and 5.5e-01"},
      {1.1, 1.25, CLAIM_AT_LEAST, 0.2, 0.2, NAN,
       "at least 2.0e-01; tets of ten nodes still change by 1.2e-01 when refined"},
      {1.25, 0, CLAIM_AT_LEAST, 0.2, 0.2, NAN,
       "at least 2.0e-01; tets of ten nodes show it, and finer ones to check them were "
       "left out (for a test)"},
      {0, 0, CLAIM_MISSING, NAN, NAN, NAN, "not known, as a run failed"},
  };
  scenario *s = accept(MINIMAL);
  yardstick *y;
  assert_ok(yardstick_create(s, &y));
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double last = cases[i].finer > 0 ? cases[i].finer : fmax(cases[i].raised, 1);
    trajectory before = state_of(y, 1), raised = state_of(y, cases[i].raised);
    trajectory finer = state_of(y, cases[i].finer), best = state_of(y, last),
               near = state_of(y, last * (1 + 1e-6));
    claim c = {.before = &before};
    char words[512];
    assert_ok(claim_distance(y, &near, &best, &c.known));
    assert_ok(claim_by_order(y, cases[i].raised > 0 ? &raised : NULL,
                             cases[i].finer > 0 ? &finer : NULL, &c));
    claim_bound b = claim_bounds(&c, ERROR_DISPLACEMENT, false);
    claim_verdict(&c, "for a test", sizeof words, words);
    assert_int_equal(b.kind, cases[i].kind);
    assert_string_equal(words, cases[i].words);
    double found[] = {b.value, b.low, b.high};
    double expected[] = {cases[i].value, cases[i].low, cases[i].high};
    for (int k = 0; k < 3; k++) {
      assert_int_equal(isnan(found[k]), isnan(expected[k]));
      if (!isnan(expected[k])) assert_close(found[k], expected[k], 0, 3e-6);
    }
    claim_free(&c);
    states_free(&before), states_free(&raised), states_free(&finer);
    states_free(&best), states_free(&near);
  }
  yardstick_destroy(y);
  scenario_destroy(s);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(bounds_and_words)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

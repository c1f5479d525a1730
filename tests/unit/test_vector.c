/* The vector operations are replaced by ones that mean the same. */
#include "solve/sundials/vector.h"

#include <nvector/nvector_serial.h>

#include "check.h"
#include "solid.h"
#include "solve/sundials/sun_compat.h"

enum { NVECTOR = 4 };

typedef struct pair {
  SUNContext ctx;
  N_Vector own[NVECTOR], quick[NVECTOR];
} pair;

static pair pair_create(long n) {
  pair p;
  assert_int_equal(sun_context_create(&p.ctx), 0);
  uint64_t seed = 3;
  for (int k = 0; k < NVECTOR; k++) {
    p.own[k] = N_VNew_Serial(n, p.ctx);
    if (k == 0) {
      p.quick[0] = N_VNew_Serial(n, p.ctx);
      corot_vector_quicken(p.quick[0]);
    } else {
      p.quick[k] = N_VClone(p.quick[0]); /* has the operations, too */
    }
    for (long i = 0; i < n; i++) NV_Ith_S(p.own[k], i) = NV_Ith_S(p.quick[k], i) = noise(&seed);
  }
  return p;
}

static void pair_destroy(pair *p) {
  for (int k = 0; k < NVECTOR; k++) N_VDestroy(p->own[k]), N_VDestroy(p->quick[k]);
  SUNContext_Free(&p->ctx);
}

/* To a few roundings: products may be fused with sums. */
static void compare(const pair *p) {
  for (int k = 0; k < NVECTOR; k++)
    for (long i = 0; i < NV_LENGTH_S(p->own[k]); i++)
      assert_close(NV_Ith_S(p->quick[k], i), NV_Ith_S(p->own[k], i), 0, 1e-14);
}

static void operations(N_Vector *x) {
  sunrealtype c[] = {0.3, -1.7, 0.9, 2.5};
  N_VLinearSum(0.7, x[0], -1.3, x[1], x[2]);
  N_VLinearSum(0.7, x[0], -0.7, x[1], x[1]); /* in place, as a difference */
  N_VLinearSum(1, x[0], 1, x[1], x[0]);
  N_VScale(-0.4, x[3], x[3]);
  N_VScale(2, x[0], x[3]);
  N_VLinearCombination(4, c, x, x[0]);
  N_VLinearCombination(1, c, &x[1], x[3]);
  N_VLinearCombination(2, c, &x[2], x[2]);
  N_VScaleAddMulti(3, c, x[0], &x[1], &x[1]);
}

static void mean_the_same(void **state) {
  (void)state;
  const long lengths[] = {1, 7, 8, 15, 16, 17, 33, 1001};
  for (int k = 0; k < 8; k++) {
    pair p = pair_create(lengths[k]);
    operations(p.own);
    operations(p.quick);
    compare(&p);
    assert_close(N_VWrmsNorm(p.quick[0], p.quick[1]), N_VWrmsNorm(p.own[0], p.own[1]), 1e-14, 0);
    pair_destroy(&p);
  }
}

static void all_entries_are_set(void **state) {
  (void)state;
  for (long n = 1; n < 40; n++) {
    pair p = pair_create(n);
    N_VConst(-0.3, p.quick[1]);
    N_VConst(-0.3, p.own[1]);
    compare(&p);
    pair_destroy(&p);
  }
}

static void huge_factors_leave_differences_alone(void **state) {
  (void)state;
  pair p = pair_create(40);
  N_VLinearSum(1e308, p.quick[0], -1e308, p.quick[0], p.quick[1]);
  for (int i = 0; i < 40; i++) assert_true(NV_Ith_S(p.quick[1], i) == 0);
  NV_Ith_S(p.quick[2], 3) = INFINITY;
  assert_true(isinf(N_VWrmsNorm(p.quick[2], p.quick[0])));
  pair_destroy(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(mean_the_same),
      cmocka_unit_test(all_entries_are_set),
      cmocka_unit_test(huge_factors_leave_differences_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

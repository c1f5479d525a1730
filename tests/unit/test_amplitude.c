/* Factors in time: jumps, splines and sines; what a model says of them, and how far a step may go.
 */
#include "core/model/amplitude.h"
#include "solid.h"

static const double pi = 3.14159265358979323846;

static amplitude made(corot_amplitude def) {
  amplitude a;
  assert_ok(corot_amplitude_create(&def, "load", 0, &a));
  return a;
}

static corot_amplitude smooth(int n, const double *time, const double *value) {
  return (corot_amplitude){.n = n, .time = time, .value = value, .curve = COROT_CURVE_SMOOTH};
}

static double now(const amplitude *a, double t) { return corot_amplitude_at(a, NAN, t); }

static void nothing_given_is_one(void **state) {
  (void)state;
  amplitude a = made((corot_amplitude){0}), b = made(smooth(0, NULL, NULL));
  for (double t = -1; t < 2; t++) {
    assert_true(now(&a, t) == 1 && now(&b, t) == 1);
    assert_true(corot_amplitude_rate(&a, NAN, t) == 0);
  }
  assert_int_equal(corot_amplitude_nkink(&a), 0);
  assert_true(corot_amplitude_horizon(&a, 3) == INFINITY);
  corot_amplitude_clear(&a), corot_amplitude_clear(&b);
}

/* Left of a jump its first value, from its time on the second; in a phase the law goes on. */
static void two_points_at_one_time_are_a_jump(void **state) {
  (void)state;
  const double time[] = {0, 0, 1, 1, 3}, value[] = {5, 0, 1, -2, 2};
  amplitude a = made((corot_amplitude){5, time, value});
  const struct {
    double phase, t, value, rate;
  } at[] = {{NAN, -1, 5, 0}, {NAN, -1e-300, 5, 0}, {NAN, 0, 0, 1},     {NAN, 0.5, 0.5, 1},
            {NAN, 1, -2, 2}, {0, 1, 1, 1},         {0.9, 1, 1, 1},     {1, 1, -2, 2},
            {-1, 0, 5, 0},   {-1, 0.5, 5, 0},      {0, 1.25, 1.25, 1}, {1, 0.5, -3, 2},
            {1, 3.5, 3, 2},  {3, 2.5, 2, 0},       {NAN, 3, 2, 0},     {NAN, 9, 2, 0}};
  for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
    assert_close(corot_amplitude_at(&a, at[k].phase, at[k].t), at[k].value, 1e-15, 0);
    assert_close(corot_amplitude_rate(&a, at[k].phase, at[k].t), at[k].rate, 1e-15, 0);
  }
  assert_true(corot_amplitude_jump(&a) == 0);
  corot_amplitude_clear(&a);
}

/* A search by halves finds the same piece as one from the front. */
static void long_tables_are_searched_right(void **state) {
  (void)state;
  enum { N = 1001 };
  double time[N], value[N];
  uint64_t seed = 3;
  for (int i = 0; i < N; i++) {
    time[i] = (i ? time[i - 1] : 0) + (i % 7 ? 0.5 * (1.5 + noise(&seed)) : 0);
    value[i] = noise(&seed);
  }
  amplitude a = made((corot_amplitude){N, time, value});
  for (int i = 0; i < 5000; i++) {
    double t = 0.5 * (1 + noise(&seed)) * time[N - 1];
    int k = 1;
    while (time[k] <= t) k++;
    double s = (t - time[k - 1]) / (time[k] - time[k - 1]);
    assert_close(now(&a, t), (1 - s) * value[k - 1] + s * value[k], 1e-15, 1e-15);
  }
  corot_amplitude_clear(&a);
}

static void a_sine_is_a_sine(void **state) {
  (void)state;
  amplitude a = made(
      (corot_amplitude){.curve = COROT_CURVE_SINE, .frequency = 2.5, .phase = 0.3, .offset = -0.7});
  for (double t = -1; t < 3; t += 0.13) {
    double h = 1e-5, x = 5 * pi * t + 0.3;
    assert_close(now(&a, t), -0.7 + sin(x), 0, 1e-14);
    assert_close(corot_amplitude_rate(&a, NAN, t), 5 * pi * cos(x), 0, 1e-13);
    /* central differences: h^2/6 of the third derivative and rounding over h */
    assert_close((now(&a, t + h) - now(&a, t - h)) / (2 * h), corot_amplitude_rate(&a, NAN, t), 0,
                 pow(5 * pi, 3) * h * h / 6 + 2e-15 / h);
    assert_close(corot_amplitude_horizon(&a, t), t + 0.1, 1e-15, 1e-15); /* a quarter period */
  }
  assert_int_equal(corot_amplitude_nkink(&a), 0);
  corot_amplitude_clear(&a);
}

/* Between two points: 3 s^2 - 2 s^3. Between three at equal distances of a pulse, by hand: the
   slope in the middle is zero by symmetry, and so the halves are such steps. */
static void few_points_make_smooth_steps(void **state) {
  (void)state;
  const double time[] = {1, 3, 5}, value[] = {2, 4, 2};
  amplitude step = made(smooth(2, time, value)), pulse = made(smooth(3, time, value));
  amplitude one = made(smooth(1, time, value));
  for (double t = 0; t < 7; t += 0.125) {
    double s = fmin(fmax((t - 1) / 2, 0), 1), back = fmin(fmax((t - 3) / 2, 0), 1);
    double rise = 2 * s * s * (3 - 2 * s), fall = 2 * back * back * (3 - 2 * back);
    assert_close(now(&step, t), 2 + rise, 1e-15, 0);
    assert_close(now(&pulse, t), 2 + rise - fall, 1e-15, 0);
    assert_close(corot_amplitude_rate(&pulse, NAN, t), 6 * s * (1 - s) - 6 * back * (1 - back), 0,
                 1e-15);
    assert_true(now(&one, t) == 2);
  }
  corot_amplitude_clear(&step), corot_amplitude_clear(&pulse), corot_amplitude_clear(&one);
}

/* At uneven points, inside and at the ends: value and slope are the same from both sides, and
   inside the second derivative, by differences of slopes one-sided to second order, whose error is
   h^2/3 of the fourth derivative, zero in a cubic, and rounding over h. */
static void a_spline_bends_without_a_kink(void **state) {
  (void)state;
  enum { N = 9 };
  double time[N], value[N];
  uint64_t seed = 11;
  for (int i = 0; i < N; i++) {
    time[i] = (i ? time[i - 1] + 1 + 0.8 * noise(&seed) : -2);
    value[i] = noise(&seed);
  }
  amplitude a = made(smooth(N, time, value));
  for (int i = 0; i < N; i++) {
    double t = time[i], h = 1e-3, tiny = 1e-12;
    assert_close(now(&a, t), value[i], 1e-14, 1e-15);
    assert_close(now(&a, t - tiny), value[i], 0, 1e-10);
    double slope = corot_amplitude_rate(&a, NAN, t);
    assert_close(corot_amplitude_rate(&a, NAN, t - tiny), slope, 0, 1e-10);
    if (i == 0 || i == N - 1) {
      assert_true(slope == 0);
      continue;
    }
    double side[2];
    for (int k = 0; k < 2; k++) {
      double d = k ? h : -h, m1 = corot_amplitude_rate(&a, NAN, t + d);
      side[k] = (4 * m1 - 3 * slope - corot_amplitude_rate(&a, NAN, t + 2 * d)) / (2 * d);
    }
    assert_close(side[0], side[1], 1e-9, 1e-9);
  }
  for (double t = -1.9; t < time[N - 1]; t += 0.1) {
    double h = 1e-5;
    assert_close((now(&a, t + h) - now(&a, t - h)) / (2 * h), corot_amplitude_rate(&a, NAN, t), 0,
                 1e-7);
  }
  assert_int_equal(corot_amplitude_nkink(&a), 0);
  corot_amplitude_clear(&a);
}

/* Of the second derivative: by differences of the slope. A spline has it from its first point to
   its last, where it jumps, and the state knows which side is meant; a sine always; what is linear
   between points never. */
static void smooth_curves_have_a_second_derivative(void **state) {
  (void)state;
  const double time[] = {0, 1, 1.5, 3}, value[] = {0, 1, 0.5, 2};
  amplitude linear = made((corot_amplitude){4, time, value}), spline = made(smooth(4, time, value));
  amplitude sine =
      made((corot_amplitude){.curve = COROT_CURVE_SINE, .frequency = 0.7, .phase = 1, .offset = 3});
  const amplitude *both[] = {&spline, &sine};
  for (double t = -0.55; t < 4; t += 0.1) {
    double h = 1e-5; /* its error: some 100 h^2, and rounding over h */
    for (int k = 0; k < 2; k++)
      assert_close(
          (corot_amplitude_rate(both[k], NAN, t + h) - corot_amplitude_rate(both[k], NAN, t - h)) /
              (2 * h),
          corot_amplitude_second(both[k], NAN, t), 0, 1e-8);
    assert_true(corot_amplitude_second(&linear, NAN, t) == 0);
  }
  const double phase[] = {-1, 0, 2, 3}, at[] = {0, 0, 3, 3};
  for (int k = 0; k < 4; k++) {
    double inside = corot_amplitude_second(&spline, NAN, k < 2 ? 1e-9 : 3 - 1e-9);
    double expected = k == 1 || k == 2 ? inside : 0;
    assert_above(fabs(inside), 1);
    assert_close(corot_amplitude_second(&spline, phase[k], at[k]), expected, 1e-7, 0);
  }
  assert_true(corot_amplitude_second(&spline, NAN, 0) != 0);
  assert_true(corot_amplitude_second(&spline, NAN, 3) == 0);
  corot_amplitude_clear(&linear), corot_amplitude_clear(&spline), corot_amplitude_clear(&sine);
}

static double error_of_spline(int n) {
  double *time = malloc(2 * (size_t)n * sizeof *time), *value = time + n, worst = 0;
  for (int i = 0; i < n; i++) time[i] = 2.0 * i / (n - 1), value[i] = cos(pi * time[i]);
  amplitude a = made(smooth(n, time, value));
  for (int i = 0; i <= 1000; i++) {
    double t = 0.002 * i;
    worst = fmax(worst, fabs(now(&a, t) - cos(pi * t)));
  }
  corot_amplitude_clear(&a), free(time);
  return worst;
}

/* A function that is flat at both ends. The leading error is 1/384 h^4 of the fourth derivative
   (Hall & Meyer 1976 give 5/384 as the bound). */
static void splines_converge_with_the_fourth_power(void **state) {
  (void)state;
  for (int n = 10; n <= 80; n *= 2) {
    double h = 2.0 / n, error = error_of_spline(n + 1);
    assert_below(error, 5. / 384 * pow(pi * h, 4));
    assert_close(log2(error / error_of_spline(2 * n + 1)), 4, 0, 0.15);
  }
}

/* Sampled 40 times a period, a step goes a quarter of it; at rest, to where the spline sets out;
   and no step goes past a bump that is shorter than itself. */
static void no_step_passes_over_what_a_spline_does(void **state) {
  (void)state;
  double time[81], value[81];
  for (int i = 0; i <= 80; i++) time[i] = 10 + 0.05 * i, value[i] = cos(pi * (time[i] - 10));
  amplitude a = made(smooth(81, time, value));
  assert_true(corot_amplitude_horizon(&a, 0) < 10.05); /* it sets out a little after 10 */
  assert_true(corot_amplitude_horizon(&a, 0) >= 10);
  assert_close(corot_amplitude_horizon(&a, 11.4), 11.9, 0, 0.06);
  assert_true(corot_amplitude_horizon(&a, 14) == INFINITY);
  corot_amplitude_clear(&a);

  const double hit[][2] = {{0, 0},    {1, 1},   {2, 1}, {3, 1},   {3.5, 1},
                           {3.75, 1}, {3.9, 1}, {4, 1}, {4.1, 9}, {4.2, 1}};
  double t[10], v[10];
  for (int i = 0; i < 10; i++) t[i] = hit[i][0], v[i] = hit[i][1];
  a = made(smooth(10, t, v));
  for (double from = -1; from < 4.2;) {
    double next = corot_amplitude_horizon(&a, from);
    assert_true(next > from);
    if (from < 4) assert_true(next <= 4.06);
    from = next;
  }
  corot_amplitude_clear(&a);

  /* noise of a thousandth is no reason for short steps */
  uint64_t seed = 1;
  for (int i = 0; i <= 80; i++) value[i] += 2e-4 * noise(&seed);
  a = made(smooth(81, time, value));
  assert_close(corot_amplitude_horizon(&a, 11.4), 11.9, 0, 0.1);
  corot_amplitude_clear(&a);
}

static void refuses_what_makes_no_sense(void **state) {
  (void)state;
  const double flat[] = {0, 1, 2, 3}, thrice[] = {0, 1, 1, 1}, back[] = {0, 1, 0.5, 2};
  const double twice[] = {0, 1, 1, 2}, v[] = {0, 1, 0, 2}, rest[] = {0, 100, 100.005, 100.01};
  const double pulse[] = {0, 0, 1, 0};
  const struct {
    corot_amplitude def;
    const char *words;
  } bad[] = {
      {{4, thrice, v}, "load 7: the amplitude has more than two points at t = 1"},
      {{4, back, v}, "load 7: the amplitude's times do not increase at point 2"},
      {{4, twice, v, COROT_CURVE_SMOOTH}, "two points at t = 1: a smooth one has no jumps"},
      {{4, rest, pulse, COROT_CURVE_SMOOTH}, "far beyond them, 0 to 1: give more points"},
      {{.curve = COROT_CURVE_SINE}, "frequency = 0 is not positive"},
      {{.curve = COROT_CURVE_SINE, .frequency = NAN}, "frequency = nan is not positive"},
      {{.curve = COROT_CURVE_SINE, .frequency = INFINITY}, "frequency = inf is not positive"},
      {{.curve = COROT_CURVE_SINE, .frequency = 1, .phase = NAN}, "phase or offset is not finite"},
      {{.curve = COROT_CURVE_SINE, .frequency = 1, .offset = INFINITY}, "or offset is not finite"},
      {{4, flat, v, (corot_curve)3}, "no kind of amplitude has the number 3"},
  };
  for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
    amplitude a;
    assert_fails(corot_amplitude_create(&bad[k].def, "load", 7, &a), COROT_EINVAL, bad[k].words);
  }
}

/* Sum of the forces of gravity on a block at rest. */
static double pull(body *b, double phase, double t) {
  double *u = calloc(3 * (size_t)b->n, sizeof *u), *v = u + b->n, *r = v + b->n, sum = 0;
  corot_state_enter(b->state, phase);
  assert_ok(corot_residual(b->model, b->state, t, u, v, r));
  for (int i = 0; i < b->n; i += 3) sum += r[i];
  free(u);
  return sum / 990; /* mass */
}

/* A model of all kinds: kinks of those that have any, each once; the state says which side. */
static void a_state_knows_which_side_of_a_jump_is_meant(void **state) {
  (void)state;
  const double time[] = {0, 1, 1, 2}, value[] = {0, 1, 0, 1}, three[] = {0.25, 0.75, 1.25};
  corot_load load[] = {
      {COROT_GRAVITY, NULL, {1, 0, 0}, {4, time, value}},
      {COROT_GRAVITY, NULL, {0, 1, 0}, {3, three, value, COROT_CURVE_SMOOTH}},
      {COROT_GRAVITY, NULL, {0, 0, 1}, {.curve = COROT_CURVE_SINE, .frequency = 0.1}}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.nload = 3, def.load = load;
  corot_box box = {.size = {1, 0.9, 1.1}, .cells = {1, 1, 1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  body b = make_body(mesh, def);
  assert_close(pull(&b, NAN, 1), 0, 0, 1e-14);
  assert_close(pull(&b, 0, 1), 1, 1e-14, 0);
  assert_close(pull(&b, 1, 1), 0, 0, 1e-14);
  assert_close(pull(&b, 0, 1.5), 1.5, 1e-14, 0);
  double kink[8];
  assert_int_equal(corot_model_kinks(b.model, -1, 9, 8, kink), 3);
  for (int k = 0; k < 3; k++) assert_true(kink[k] == k);
  assert_close(corot_model_horizon(b.model, 0), 0.5, 0, 0.02);  /* on the spline's way up */
  assert_close(corot_model_horizon(b.model, 5), 7.5, 1e-15, 0); /* a quarter of 10 s */
  drop_body(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nothing_given_is_one),
      cmocka_unit_test(two_points_at_one_time_are_a_jump),
      cmocka_unit_test(long_tables_are_searched_right),
      cmocka_unit_test(a_sine_is_a_sine),
      cmocka_unit_test(few_points_make_smooth_steps),
      cmocka_unit_test(a_spline_bends_without_a_kink),
      cmocka_unit_test(smooth_curves_have_a_second_derivative),
      cmocka_unit_test(splines_converge_with_the_fourth_power),
      cmocka_unit_test(no_step_passes_over_what_a_spline_does),
      cmocka_unit_test(refuses_what_makes_no_sense),
      cmocka_unit_test(a_state_knows_which_side_of_a_jump_is_meant),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Damping and period of the methods of constant step on one mode without damping: a regular tet
   that breathes, x = s X, is a harmonic oscillator at any amplitude, s'' = -omega^2 (s - 1),
   omega^2 = V (2 mu + 3 lambda) / j,  j I = sum m X X', which is 3 (2 mu + 3 lambda) / (density
   a^2) for corners at the distance a from the centre. */
#include <complex.h>

#include "solution.h"

/* Of omega = 1/s. */
static body regular_tet(void) {
  static const double corner[4][3] = {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}};
  static const int tet[1][4] = {{0, 1, 2, 3}};
  double a = sqrt(3 * (2 * elastic.mu + 3 * elastic.lambda) / elastic.density), x[4][3];
  for (int n = 0; n < 4; n++)
    for (int c = 0; c < 3; c++) x[n][c] = corner[n][c] * a / sqrt(3);
  corot_mesh *mesh;
  assert_ok(corot_mesh_create(4, (const double(*)[3])x, 1, tet, &mesh));
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &elastic;
  return make_body(mesh, def);
}

typedef struct sample {
  double s, v; /* s - 1 and its rate */
} sample;

/* n steps of theta from s - 1 = amplitude at rest; out [n + 1]. Frames are held: they stay I. */
static void breathe(const char *method, double rho, double theta, double amplitude, int n,
                    sample *out) {
  body b = regular_tet();
  double u[24] = {0}, *v = u + 12, X = b.mesh->x[0][0];
  for (int i = 0; i < 12; i++) u[i] = amplitude * b.mesh->x[i / 3][i % 3];
  corot_integrator_def def = corot_integrator_defaults();
  def.method = method, def.step = theta, def.solution = COROT_SOLUTION_LINEAR;
  def.spectral_radius = rho;
  corot_state_use(b.state, COROT_FRAMES_HELD);
  corot_integrator *integrator = start(&b, &def, u, v);
  out[0] = (sample){u[0] / X, 0};
  for (int k = 1; k <= n; k++) {
    corot_step step;
    assert_ok(corot_integrator_step(integrator, 1e9, &step));
    assert_ok(corot_integrator_at(integrator, step.t, u, v));
    out[k] = (sample){u[0] / X, v[0] / X};
    /* it breathes and does nothing else, to the rounding of a solution with h^2 K against M */
    for (int i = 0; i < 12; i++)
      assert_close(u[i] / b.mesh->x[i / 3][i % 3], out[k].s, 0,
                   1e-10 * (1 + theta * theta) * amplitude);
  }
  corot_integrator_destroy(integrator), drop_body(&b);
}

/* y = s - i v solves y' = i omega y, and BDF and midpoint turn it by their principal root each
   step, once what the start left of the other roots has gone. */
static double complex root_of(const char *method, double theta) {
  enum { N = 60 };
  sample y[N + 1];
  breathe(method, 0.8, theta, 0.3, N, y);
  return (y[N].s - I * y[N].v) / (y[N - 1].s - I * y[N - 1].v);
}

/* The principal root of sum a_j z^j = i theta b z^k, by Newton's method from exp(i theta). */
static double complex principal_root(int k, const double *a, double b, double theta) {
  double complex z = cexp(I * theta);
  for (int iteration = 0; iteration < 20; iteration++) {
    double complex p = 0, dp = 0;
    for (int j = k; j >= 0; j--) {
      double complex c = a[j] - (j == k ? I * theta * b : 0);
      dp = dp * z + p;
      p = p * z + c;
    }
    z -= p / dp;
  }
  return z;
}

static const struct {
  const char *name;
  int k;
  double a[4], b;
  double damping; /* damping ratio over theta^power to leading order */
  int power;
  double period; /* relative lengthening of the period over theta^2 */
} bdf[] = {
    {"backward-euler", 1, {-1, 1}, 1, 0.5, 1, 1. / 3},
    {"bdf2", 2, {1. / 3, -4. / 3, 1}, 2. / 3, 0.25, 3, 1. / 3},
    {"bdf3", 3, {-2. / 11, 9. / 11, -18. / 11, 1}, 6. / 11, -0.25, 3, 0},
};

/* The root itself, and its damping ratio -log |z| / theta and period as they are for small steps:
   theta/2, theta^3/4, and for BDF3 -theta^3/4, a growth. */
static void bdf_damps_as_its_root_says(void **state) {
  (void)state;
  for (int m = 0; m < 3; m++)
    for (double theta = 0.05; theta < 0.5; theta *= 2) {
      double complex z = root_of(bdf[m].name, theta);
      double complex expected = principal_root(bdf[m].k, bdf[m].a, bdf[m].b, theta);
      assert_close(cabs(z - expected), 0, 0, 1e-9);
      double damping = -log(cabs(z)) / theta, longer = theta / carg(z) - 1;
      assert_close(damping, bdf[m].damping * pow(theta, bdf[m].power), 6 * theta * theta, 0);
      assert_close(longer, bdf[m].period * theta * theta, 0, 2 * pow(theta, 4));
    }
}

/* Over a hundred periods or so: backward Euler has lost everything, BDF2 some, BDF3 gained. */
static void bdf3_grows_where_bdf2_decays(void **state) {
  (void)state;
  enum { N = 2000 };
  static sample y[N + 1];
  double theta = 0.3, left[3];
  for (int m = 0; m < 3; m++) {
    breathe(bdf[m].name, 0.8, theta, 5e-3, N, y);
    left[m] = hypot(y[N].s, y[N].v) / 5e-3;
  }
  assert_below(left[0], 1e-9);                              /* rounding */
  assert_close(left[1], exp(-N * pow(theta, 4) / 4), 1, 0); /* e^-4 */
  assert_below(left[1], 0.1);
  assert_above(left[2], 5); /* of e^4 to leading order */
}

/* Energy s^2 + v^2, to a rounding of 1e-12 a step; the period is longer by theta^2/12. */
static void midpoint_and_newmark_conserve(void **state) {
  (void)state;
  enum { N = 1000 };
  static sample y[N + 1];
  static const struct {
    const char *method;
    double rho;
  } kase[] = {{"midpoint", 0.8}, {"newmark", 0.8}, {"hht", 1}};
  for (int m = 0; m < 3; m++)
    for (double theta = 0.05; theta < 10; theta *= 4) {
      breathe(kase[m].method, kase[m].rho, theta, 0.3, N, y);
      for (int k = 0; k <= N; k++)
        assert_close(y[k].s * y[k].s + y[k].v * y[k].v, 0.09, N * 1e-12, 0);
      double complex z = (y[N].s - I * y[N].v) / (y[N - 1].s - I * y[N - 1].v);
      assert_close(cabs(z - (1 + 0.5 * I * theta) / (1 - 0.5 * I * theta)), 0, 0, 1e-8);
    }
}

/* s_{n+3} = c[2] s_{n+2} + c[1] s_{n+1} + c[0] s_n of the Newmark family, by the equations of
   Chung & Hulbert 1993 for one unknown: the characteristic polynomial of (s, h v, h^2 a). */
typedef struct alpha_method {
  double am, af, beta, gamma;
} alpha_method;

static alpha_method method_of(const char *name, double rho) {
  alpha_method m = {0};
  if (strcmp(name, "hht") == 0) m.af = (1 - rho) / (1 + rho);
  if (strcmp(name, "generalized-alpha") == 0)
    m.am = (2 * rho - 1) / (rho + 1), m.af = rho / (rho + 1);
  m.gamma = 0.5 - m.am + m.af;
  m.beta = 0.25 * (1 - m.am + m.af) * (1 - m.am + m.af);
  return m;
}

static void published(const alpha_method *m, double theta, double amplitude, int n, sample *out) {
  double s = amplitude, v = 0, a = -theta * theta * amplitude; /* v, a: times h, h^2 */
  out[0] = (sample){s, 0};
  for (int k = 1; k <= n; k++) {
    double s0 = s + v + (0.5 - m->beta) * a, square = theta * theta;
    double next = -(m->am * a + square * (m->af * s + (1 - m->af) * s0)) /
                  (1 - m->am + square * (1 - m->af) * m->beta);
    s = s0 + m->beta * next;
    v += (1 - m->gamma) * a + m->gamma * next;
    a = next;
    out[k] = (sample){s, v / theta};
  }
}

static void alpha_methods_are_as_published(void **state) {
  (void)state;
  enum { N = 50 };
  sample y[N + 1], z[N + 1];
  static const char *const name[] = {"newmark", "hht", "generalized-alpha"};
  static const double rho[] = {0, 0.5, 0.8, 1};
  for (int m = 0; m < 3; m++)
    for (int r = m == 2 ? 0 : 1; r < 4; r++)
      for (double theta = 0.1; theta < 20; theta *= 4) {
        alpha_method of = method_of(name[m], rho[r]);
        breathe(name[m], rho[r], theta, 0.01, N, y);
        published(&of, theta, 0.01, N, z);
        for (int k = 0; k <= N; k++) {
          assert_close(y[k].s, z[k].s, 0, 1e-11);
          assert_close(y[k].v, z[k].v, 0, 1e-11 * (1 + theta));
        }
      }
}

/* Solves the 3 x 3 system with columns A[j] by Cramer's rule. */
static void solve3(double A[9], const double b[3], double c[3]) {
  double det = determinant(A);
  for (int j = 0; j < 3; j++) {
    double B[9];
    memcpy(B, A, sizeof B);
    for (int i = 0; i < 3; i++) B[3 * i + j] = b[i];
    c[j] = determinant(B) / det;
  }
}

/* At steps of a hundred radians the recurrence s_{n+3} = c2 s_{n+2} + c1 s_{n+1} + c0 s_n has the
   three roots -rho for generalized-alpha: c = -(rho^3, 3 rho^2, 3 rho). HHT has -rho twice, and
   -alpha/(1 - alpha) with rho = (1 - alpha)/(1 + alpha). */
static void spectral_radius_is_as_asked_for(void **state) {
  (void)state;
  static const double rho[] = {0.5, 0.7, 0.9};
  sample y[7];
  for (int m = 0; m < 2; m++)
    for (int r = 0; r < 3; r++) {
      double p = rho[r], alpha = (1 - p) / (1 + p), q = m ? p : alpha / (1 - alpha), c[3];
      breathe(m ? "generalized-alpha" : "hht", p, 100, 1e-3, 6, y);
      double A[9], b[3];
      for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) A[3 * i + j] = y[i + j].s;
        b[i] = y[i + 3].s;
      }
      solve3(A, b, c);
      assert_close(c[0], -p * p * q, 0, 5e-3);
      assert_close(c[1], -(p * p + 2 * p * q), 0, 5e-3);
      assert_close(c[2], -(2 * p + q), 0, 5e-3);
    }
}

/* Largest error of s against cos t over one period. */
static double error_of(const char *method, int steps) {
  sample *y = malloc((steps + 1) * sizeof *y);
  double theta = 2 * pi / steps, worst = 0;
  breathe(method, 0.8, theta, 0.1, steps, y);
  for (int k = 0; k <= steps; k++) worst = fmax(worst, fabs(y[k].s - 0.1 * cos(k * theta)));
  free(y);
  return worst / 0.1;
}

/* Two steps of backward Euler are off by h^2 each, which an undamped body never forgets: BDF3 begun
   so is of second order. */
static void a_start_by_backward_euler_costs_bdf3_an_order(void **state) {
  (void)state;
  assert_close(order_of(error_of("backward-euler", 800), error_of("backward-euler", 1600), 2), 1, 0,
               0.05);
  assert_close(order_of(error_of("bdf2", 400), error_of("bdf2", 800), 2), 2, 0, 0.05);
  assert_close(order_of(error_of("bdf3", 400), error_of("bdf3", 800), 2), 2, 0, 0.1);
  assert_close(order_of(error_of("midpoint", 400), error_of("midpoint", 800), 2), 2, 0, 0.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bdf_damps_as_its_root_says),
      cmocka_unit_test(bdf3_grows_where_bdf2_decays),
      cmocka_unit_test(midpoint_and_newmark_conserve),
      cmocka_unit_test(alpha_methods_are_as_published),
      cmocka_unit_test(spectral_radius_is_as_asked_for),
      cmocka_unit_test(a_start_by_backward_euler_costs_bdf3_an_order),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

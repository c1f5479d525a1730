#include <stdio.h>
#include "solution.h"

static const corot_material rod_material = {.mu = 1e4, .density = 1000, .damping_mu = 1000};

typedef struct path {
  double omega, k2;
  int power;
} law;

/* shoot: Green: (q^3 - q)' mu = -rho w^2 x ; x' = q. polar: 2 mu q' = - rho w^2 x */
static double end_stretch(bool green, double s, double L, double q0, int n, double *x) {
  double X = 0, q = q0, h = L / n;
  *x = 0;
  (void)X;
  for (int i = 0; i < n; i++) {
    double kx[4], kq[4];
    for (int j = 0; j < 4; j++) {
      double c = j == 0 ? 0 : j == 3 ? 1 : 0.5;
      double xx = *x + (j ? c * h * kx[j - 1] : 0), qq = q + (j ? c * h * kq[j - 1] : 0);
      kx[j] = qq;
      kq[j] = -s * xx / (green ? 3 * qq * qq - 1 : 2);
    }
    *x += h / 6 * (kx[0] + 2 * kx[1] + 2 * kx[2] + kx[3]);
    q += h / 6 * (kq[0] + 2 * kq[1] + 2 * kq[2] + kq[3]);
  }
  return q;
}
static double centre(bool green, double s, double L) {
  double lo = 1, hi = 3, x;
  for (int i = 0; i < 60; i++) {
    double mid = 0.5 * (lo + hi);
    if (end_stretch(green, s, L, mid, 100, &x) > 1) hi = mid; else lo = mid;
  }
  return lo;
}
static double position(bool green, double s, double L, double X) {
  double x;
  if (X == 0) return 0;
  end_stretch(green, s, fabs(X), centre(green, s, L), 100, &x);
  return X > 0 ? x : -x;
}

static void probe(void **state) {
  (void)state;
  double omega = 9, s = rod_material.density * omega * omega / rod_material.mu, k = sqrt(s / 2), L = 0.3;
  printf("polar tip %.12g closed %.12g; green %.12g\n", position(false, s, L, L), tan(k * L) / k, position(true, s, L, L));
  for (int m = 2; m < 5; m+=2)
    for (int r = 1; r <= 3; r++) {
      corot_box box = {.size = {0.6, 0.2, 0.05}, .cells = {6 * r, 2*r, r}, .origin = {-0.3, -0.1, -0.025}};
      corot_mesh *mesh;
      assert_ok(corot_mesh_box(&box, &mesh));
      corot_model_def def = corot_model_defaults();
      def.viscosity = m == 2 || m == 3; def.strain = measures[m], def.nmaterial = 1, def.material = &rod_material;
      body b = make_body(mesh, def);
      double *u = calloc(2 * b.n, sizeof *u), *v = u + b.n;
      bool green = m == 4;
      double *radius = calloc(mesh->nnode, sizeof *radius);
      for (int n = 0; n < mesh->nnode; n++) {
        double x = position(green, s, L, mesh->x[n][0]), y = position(green, s, 0.1, mesh->x[n][1]);
        u[3 * n] = x - mesh->x[n][0], u[3 * n + 1] = y - mesh->x[n][1];
        v[3 * n] = -omega * y, v[3 * n + 1] = omega * x;
        radius[n] = hypot(hypot(x, y), mesh->x[n][2]);
      }
      corot_integrator_def d = corot_integrator_defaults();
      d.rtol = 1e-5;
      corot_integrator *it = start(&b, &d, u, v);
      double T = 2 * pi / omega, dev = 0, tip = 0;
      for (int i = 1; i <= 50; i++) {
        advance(it, T * i / 50);
        assert_ok(corot_integrator_at(it, T * i / 50, u, v));
        tip = 0;double last=0, tips=0;
        for (int n = 0; n < mesh->nnode; n++) {
          double rr = hypot(mesh->x[n][0] + u[3 * n], mesh->x[n][1] + u[3 * n + 1]);rr = hypot(rr, mesh->x[n][2] + u[3 * n + 2]);
          dev = fmax(dev, fabs(rr - radius[n]) / L);
          tip = fmax(tip, rr / L);last+=pow((rr - radius[n]) / L,2)/mesh->nnode; if (fabs(mesh->x[n][0])>0.2999) tips+= (rr-radius[n])/L/(r+1)/(2*r+1)/2;
        }
 if (i%10==0) printf("%g %g;", sqrt(last), tips);     }
      printf("%s %d: dev %.4g tip %.5g steps %ld\n", measures[m], r, dev, tip, corot_integrator_statistics(it).nst);
      corot_integrator_destroy(it), free(u), free(radius), drop_body(&b);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(probe),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

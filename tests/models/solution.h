/* Whole solutions: a body integrated in time, its modes, its equilibria. */
#ifndef SOLUTION_H
#define SOLUTION_H

#include <corot/integrate.h>
#include <corot/solve.h>

#include "solid.h"

static const double pi = 3.14159265358979323846;

/* The paper's material without its damping. */
static const corot_material elastic = {.lambda = 1.0e5, .mu = 1.0e4, .density = 1000};

static inline corot_integrator *start(const body *b, const corot_integrator_def *def,
                                      const double *u, const double *v) {
  corot_integrator *integrator;
  assert_ok(corot_integrator_create(def, b->model, b->state, 0, u, v, &integrator));
  return integrator;
}

/* Steps until t, exactly. */
static inline void advance(corot_integrator *integrator, double t) {
  corot_step step = {0};
  while (step.t != t) assert_ok(corot_integrator_step(integrator, t, &step));
}

/* The mode of lowest frequency about the rest position by inverse iteration from x [n], which
   decides between modes of like frequency: K x = omega^2 M x. On return x' M x = 1; the value is
   omega [1/s], right to 1e-10. */
static inline double lowest_mode(const body *b, double *x) {
  double *zero = calloc(4 * b->n, sizeof *zero), *y = zero + 2 * b->n, *My = y + b->n;
  double square = 0, last = 1;
  corot_pencil *pencil;
  assert_ok(corot_pencil_create(b->model, b->state, NULL, &pencil));
  assert_ok(corot_pencil_assemble(pencil, 0, zero, zero + b->n));
  corot_pencil_combine(pencil, 0, 0, 1);
  assert_ok(corot_pencil_factor(pencil));
  for (int k = 0; fabs(square - last) > 1e-11 * square; k++) {
    assert_true(k < 500);
    corot_mass_multiply(b->model, x, y);
    double size = sqrt(inner(b->n, x, y));
    for (int i = 0; i < b->n; i++) x[i] /= size, y[i] /= size;
    assert_ok(corot_pencil_solve(pencil, y, y));
    corot_mass_multiply(b->model, y, My);
    last = square;
    square = 1 / inner(b->n, x, My); /* Rayleigh quotient of K^-1: its error is that of x squared */
    memcpy(x, y, b->n * sizeof *x);
  }
  corot_mass_multiply(b->model, x, My);
  double size = sqrt(inner(b->n, x, My));
  for (int i = 0; i < b->n; i++) x[i] /= size;
  corot_pencil_destroy(pencil);
  free(zero);
  return sqrt(square);
}

/* Slope of log(error) over log(h). */
static inline double order_of(double coarse, double fine, double ratio) {
  return log(coarse / fine) / log(ratio);
}

#endif

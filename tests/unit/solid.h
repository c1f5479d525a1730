/* Small solids and states for the tests of the physics. */
#ifndef SOLID_H
#define SOLID_H

#include <corot/ode.h>
#include <stdint.h>

#include "check.h"

/* A generator that is the same everywhere: splitmix64, uniform in [-1, 1). */
static inline double noise(uint64_t *seed) {
  uint64_t z = (*seed += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)(int64_t)(z ^ (z >> 31)) / 9223372036854775808.0;
}

/* Row-major rotation by `angle` about an axis (Rodrigues). */
static inline void rotation(const double axis[3], double angle, double Q[9]) {
  double n = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  double a[3] = {axis[0] / n, axis[1] / n, axis[2] / n}, c = cos(angle), s = sin(angle);
  double skew[9] = {0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      Q[3 * i + j] = (i == j) * c + s * skew[3 * i + j] + (1 - c) * a[i] * a[j];
}

static inline void apply(const double A[9], const double x[3], double y[3]) {
  for (int i = 0; i < 3; i++) y[i] = A[3 * i] * x[0] + A[3 * i + 1] * x[1] + A[3 * i + 2] * x[2];
}

/* A unit-size box whose inner nodes are moved, so that no two tets are alike. */
static inline corot_mesh *crooked_box(int nx, int ny, int nz) {
  corot_box box = {.size = {1.0, 0.9, 1.1}, .cells = {nx, ny, nz}, .origin = {-0.3, 0.2, 0.1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  uint64_t seed = 7;
  double h = 0.08 / (nx > nz ? nx : nz);
  for (int n = 0; n < mesh->nnode; n++)
    for (int c = 0; c < 3; c++) mesh->x[n][c] += h * noise(&seed);
  return mesh;
}

static const corot_material soft = {
    .lambda = 1.0e5, .mu = 1.0e4, .density = 1000, .damping_lambda = 10, .damping_mu = 1};

static const char *const measures[] = {"cauchy", "warp", "polar", "hybrid", "green"};
enum { NMEASURE = 5 };

#endif

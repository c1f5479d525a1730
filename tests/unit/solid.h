/* Small solids and states for the tests of the physics. */
#ifndef SOLID_H
#define SOLID_H

#include <corot/ode.h>
#include <stdint.h>
#include <stdlib.h>

#include "check.h"
#include "core/element/strain.h"

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

/* C = A B and C = A' B, row-major; C is neither. */
static inline void multiply(const double A[9], const double B[9], double C[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

static inline void multiply_transposed(const double A[9], const double B[9], double C[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] = A[i] * B[j] + A[3 + i] * B[3 + j] + A[6 + i] * B[6 + j];
}

static inline double determinant(const double A[9]) {
  return A[0] * (A[4] * A[8] - A[5] * A[7]) + A[1] * (A[5] * A[6] - A[3] * A[8]) +
         A[2] * (A[3] * A[7] - A[4] * A[6]);
}

/* Largest |A_ij - B_ij|; NaN if any entry is. */
static inline double distance(const double A[9], const double B[9]) {
  double d = 0;
  for (int k = 0; k < 9; k++) {
    double e = fabs(A[k] - B[k]);
    if (!(e <= d)) d = e;
    if (isnan(e)) break;
  }
  return d;
}

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

/* A rotation about a random axis by up to pi. */
static inline void random_rotation(uint64_t *seed, double Q[9]) {
  double axis[3] = {noise(seed), noise(seed), noise(seed)};
  rotation(axis, 3.14159 * noise(seed), Q);
}

/* I + size times noise. */
static inline void random_gradient(uint64_t *seed, double size, double F[9]) {
  for (int k = 0; k < 9; k++) F[k] = identity[k] + size * noise(seed);
}

/* The order of the elements that a test is about: the programs of the physics run for each (see
   tests/CMakeLists.txt). */
static inline int order_of_test(void) {
  const char *order = getenv("COROT_TEST_ORDER");
  return order ? atoi(order) : 1;
}

/* The mesh given up for one of that order, with straight edges. */
static inline corot_mesh *given_order(corot_mesh *mesh, int order) {
  corot_mesh *out;
  assert_ok(corot_mesh_change_order(mesh, order, &out));
  corot_mesh_destroy(mesh);
  return out;
}

/* The mesh of the order that is asked for, with straight edges; takes the mesh. */
static inline corot_mesh *of_order(corot_mesh *mesh) {
  return order_of_test() == 1 ? mesh : given_order(mesh, order_of_test());
}

static inline corot_mesh *box_of_order(const corot_box *box) {
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(box, &mesh));
  return of_order(mesh);
}

/* Moves the nodes on the edges, if there are any, by up to h. */
static inline void bend_edges(corot_mesh *mesh, double h) {
  uint64_t seed = 11;
  char *corner = calloc(mesh->nnode, 1);
  for (int k = 0; k < 4 * mesh->ntet; k++) corner[mesh->tet[k / 4][k % 4]] = 1;
  for (int n = 0; n < mesh->nnode; n++)
    for (int c = 0; c < 3 && !corner[n]; c++) mesh->x[n][c] += h * noise(&seed);
  free(corner);
}

static inline double crookedness(int nx, int nz) { return 0.08 / (nx > nz ? nx : nz); }

/* A unit-size box whose corners are moved, so that no two tets are alike, of order 1. */
static inline corot_mesh *linear_box(int nx, int ny, int nz) {
  corot_box box = {.size = {1.0, 0.9, 1.1}, .cells = {nx, ny, nz}, .origin = {-0.3, 0.2, 0.1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  uint64_t seed = 7;
  double h = crookedness(nx, nz);
  for (int n = 0; n < mesh->nnode; n++)
    for (int c = 0; c < 3; c++) mesh->x[n][c] += h * noise(&seed);
  return mesh;
}

/* The same of the order that is asked for. */
static inline corot_mesh *straight_box(int nx, int ny, int nz) {
  return of_order(linear_box(nx, ny, nz));
}

/* The same with curved edges, where the order has any. */
static inline corot_mesh *crooked_box(int nx, int ny, int nz) {
  corot_mesh *mesh = straight_box(nx, ny, nz);
  bend_edges(mesh, 0.3 * crookedness(nx, nz));
  return mesh;
}

/* Rest gradients g of the shape functions at point q of a tet, of the nodes node [4 or 10] in the
   mesh's own order; returns the volume that the point stands for. Written anew from the formulas,
   to hold the kernels against. */
static inline double point_gradients(const corot_mesh *mesh, int e, int q, int node[10],
                                     double g[10][3]) {
  static const int edge[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  int order = corot_mesh_order(mesh), nnode = order == 1 ? 4 : 10;
  double root = sqrt(5), L[4], by_L[10][4] = {{0}}, D[9] = {0}, inverse[9];
  for (int i = 0; i < 4; i++) {
    L[i] = order == 1 ? 0.25 : (5 + (i == q ? 3 : -1) * root) / 20;
    by_L[i][i] = order == 1 ? 1 : 4 * L[i] - 1;
    node[i] = mesh->tet[e][i];
  }
  for (int k = 0; k < nnode - 4; k++) {
    by_L[4 + k][edge[k][0]] = 4 * L[edge[k][1]], by_L[4 + k][edge[k][1]] = 4 * L[edge[k][0]];
    node[4 + k] = mesh->mid[e][k];
  }
  for (int a = 0; a < nnode; a++)
    for (int c = 0; c < 3; c++)
      for (int j = 0; j < 3; j++)
        D[3 * c + j] += mesh->x[node[a]][c] * (by_L[a][j + 1] - by_L[a][0]);
  double det = determinant(D);
  for (int j = 0; j < 3; j++)
    for (int c = 0; c < 3; c++) {
      int j1 = (j + 1) % 3, j2 = (j + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      inverse[3 * j + c] =
          (D[3 * c1 + j1] * D[3 * c2 + j2] - D[3 * c1 + j2] * D[3 * c2 + j1]) / det;
    }
  for (int a = 0; a < nnode; a++)
    for (int c = 0; c < 3; c++) {
      g[a][c] = 0;
      for (int j = 0; j < 3; j++) g[a][c] += (by_L[a][j + 1] - by_L[a][0]) * inverse[3 * j + c];
    }
  return fabs(det) / (order == 1 ? 6 : 24);
}

static inline int points_of_tets(const corot_mesh *mesh) {
  return corot_mesh_order(mesh) == 1 ? 1 : 4;
}

static const corot_material soft = {
    .lambda = 1.0e5, .mu = 1.0e4, .density = 1000, .damping_lambda = 10, .damping_mu = 1};

/* A model with its mesh and a state, exact frames. */
typedef struct body {
  corot_mesh *mesh;
  corot_model *model;
  corot_state *state;
  int n; /* degrees of freedom */
} body;

/* Takes the mesh, which is `def`'s from now on. */
static inline body make_body(corot_mesh *mesh, corot_model_def def) {
  body b = {.mesh = mesh};
  def.mesh = mesh;
  assert_ok(corot_model_create(&def, &b.model));
  assert_ok(corot_state_create(b.model, &b.state));
  b.n = corot_model_ndof(b.model);
  return b;
}

static inline void drop_body(body *b) {
  corot_state_destroy(b->state);
  corot_model_destroy(b->model);
  corot_mesh_destroy(b->mesh);
}

/* Nodal values [nnode][3] to degrees of freedom [n]; held components are left out. */
static inline void to_dofs(const body *b, const double (*nodal)[3], double *free_values) {
  const int(*dof)[3] = corot_model_dof(b->model);
  for (int n = 0; n < b->mesh->nnode; n++)
    for (int c = 0; c < 3; c++)
      if (dof[n][c] >= 0) free_values[dof[n][c]] = nodal[n][c];
}

static inline double norm_max(int n, const double *a) {
  double largest = 0;
  for (int i = 0; i < n; i++)
    if (!(fabs(a[i]) <= largest)) largest = fabs(a[i]);
  return largest;
}

static inline double inner(int n, const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

/* The names of all strain measures. */
#define MEASURE_NAME(index, name, ...) name,
static const char *const measures[] = {STRAIN_MEASURES(MEASURE_NAME)};
enum { NMEASURE = NSTRAIN };

static inline bool is_polar(int measure) { return corot_strain_traits(measure)->polar; }

/* Those whose forces are those of an energy that no rotation changes. */
static inline bool conserves(int measure) {
  const corot_strain_kind *kind = corot_strain_traits(measure);
  return kind->polar || (!kind->frames && !kind->linear);
}

#endif

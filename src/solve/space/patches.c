/* Least squares in a patch, by the normal equations of coordinates that are of the size of one
   there. A patch that has too few points, as at an edge of the body, takes in the tets around it.
 */
#include "patches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/element/element.h"
#include "core/mesh/mesh.h"

/* So many tets make a patch of enough points; of no more than so many. */
enum { FEW = 8, MANY = 400 };

/* A point counts by 1 / (this + square of its distance as a part of the patch's): near ones the
   more, so that a boundary's polynomial is not ruled by what is inside. */
#define NEAR 0.05

/* A pivot of less than this part of its diagonal: the points lie in a plane, or on a quadric. */
#define PIVOT 1e-7

void corot_patches_clear(patches *p) {
  free(p->point), free(p->first), free(p->around);
  free(p->list), free(p->stamp), free(p->corner), free(p->scale), free(p->fitted);
  *p = (patches){0};
}

/* --- Places --- */

void corot_tet_place(const corot_mesh *mesh, int tet, const double at[4], double x[3]) {
  const int *v = mesh->tet[tet];
  for (int c = 0; c < 3; c++) x[c] = 0;
  for (int a = 0; a < 4; a++) {
    double weight = mesh->mid ? at[a] * (2 * at[a] - 1) : at[a];
    for (int c = 0; c < 3; c++) x[c] += weight * mesh->x[v[a]][c];
  }
  for (int k = 0; k < 6 && mesh->mid; k++) {
    double weight = 4 * at[corot_tet_edge[k][0]] * at[corot_tet_edge[k][1]];
    for (int c = 0; c < 3; c++) x[c] += weight * mesh->x[mesh->mid[tet][k]][c];
  }
}

void corot_patch_point(const corot_mesh *mesh, int q, double at[4]) {
  for (int a = 0; a < 4; a++) at[a] = !mesh->mid ? 0.25 : a == q ? TET10_A : TET10_B;
}

static void place_points(patches *p) {
  int n = points_in_tet(p->mesh);
  for (int e = 0; e < p->mesh->ntet; e++)
    for (int q = 0; q < n; q++) {
      double at[4];
      corot_patch_point(p->mesh, q, at);
      corot_tet_place(p->mesh, e, at, p->point[e * n + q]);
    }
}

/* How many corners there are. */
static int number_corners(patches *p) {
  int count = 0;
  for (int n = 0; n < p->mesh->nnode; n++)
    p->corner[n] = p->first[n + 1] > p->first[n] ? count++ : -1;
  return count;
}

corot_status corot_patches_create(patches *p) {
  int ntet = p->mesh->ntet, nnode = p->mesh->nnode;
  p->nterm = p->mesh->mid ? 10 : 4, p->ncolumn = 6 * p->nfield;
  COROT_TRY(COROT_ALLOC(p->point, ntet * points_in_tet(p->mesh)));
  COROT_TRY(COROT_ALLOC(p->first, nnode + 1));
  COROT_TRY(COROT_ALLOC(p->around, 4 * (size_t)ntet));
  COROT_TRY(COROT_ALLOC(p->list, ntet));
  COROT_TRY(COROT_ALLOC(p->stamp, ntet));
  COROT_TRY(COROT_ALLOC(p->corner, nnode));
  place_points(p);
  corot_corner_tets(p->mesh, p->first, p->around);
  size_t ncorner = (size_t)number_corners(p);
  COROT_TRY(COROT_ALLOC(p->scale, ncorner));
  return COROT_ALLOC(p->fitted, ncorner * (size_t)(p->nterm * p->ncolumn));
}

/* --- A patch --- */

/* Adds the tets of a material at a corner to the n of the patch; returns how many there are. */
static int add_tets(patches *p, int material, int corner, int n) {
  for (int i = p->first[corner]; i < p->first[corner + 1]; i++) {
    int e = p->around[i];
    if (p->of_tet[e] != material || p->stamp[e] == p->nstamp) continue;
    p->stamp[e] = p->nstamp;
    p->list[n++] = e;
  }
  return n;
}

/* Adds those around it. */
static int grow(patches *p, int material, int n) {
  int before = n;
  for (int i = 0; i < before; i++)
    for (int k = 0; k < 4; k++) n = add_tets(p, material, p->mesh->tet[p->list[i]][k], n);
  return n;
}

/* --- Polynomials --- */

/* 1, x, y, z, xx, yy, zz, xy, yz, zx of coordinates about a corner. */
static void terms_at(const patches *p, int corner, const double x[3], double term[PATCH_TERMS]) {
  double d[3];
  for (int c = 0; c < 3; c++) d[c] = (x[c] - p->mesh->x[corner][c]) / p->scale[p->corner[corner]];
  term[0] = 1;
  for (int c = 0; c < 3; c++) {
    term[1 + c] = d[c];
    term[4 + c] = d[c] * d[c];
    term[7 + c] = d[c] * d[(c + 1) % 3];
  }
}

/* The largest distance of a point of the patch. */
static double reach(const patches *p, int corner, int n) {
  double square = 0;
  int per = points_in_tet(p->mesh);
  for (int i = 0; i < n * per; i++) {
    const double *x = p->point[p->list[i / per] * per + i % per], *o = p->mesh->x[corner];
    double dx = x[0] - o[0], dy = x[1] - o[1], dz = x[2] - o[2];
    square = fmax(square, dx * dx + dy * dy + dz * dz);
  }
  return sqrt(square);
}

typedef struct normal_equations {
  int nterm, ncolumn;
  double A[PATCH_TERMS][PATCH_TERMS]; /* lower triangle */
  double b[PATCH_TERMS][PATCH_COLUMNS];
} normal_equations;

static void add_point(const patches *p, const double term[PATCH_TERMS], int at,
                      normal_equations *s) {
  double square = term[4] + term[5] + term[6], weight = 1 / (NEAR + square);
  for (int i = 0; i < s->nterm; i++) {
    double part = weight * term[i];
    for (int j = 0; j <= i; j++) s->A[i][j] += part * term[j];
    for (int k = 0; k < s->ncolumn; k++) s->b[i][k] += part * p->field[k / 6][at][k % 6];
  }
}

/* Cholesky's factor in place; false: some pivot is next to nothing. */
static bool factor(normal_equations *s) {
  for (int j = 0; j < s->nterm; j++) {
    double pivot = s->A[j][j], diagonal = pivot;
    for (int k = 0; k < j; k++) pivot -= s->A[j][k] * s->A[j][k];
    if (!(pivot > PIVOT * diagonal)) return false;
    s->A[j][j] = sqrt(pivot);
    for (int i = j + 1; i < s->nterm; i++) {
      for (int k = 0; k < j; k++) s->A[i][j] -= s->A[i][k] * s->A[j][k];
      s->A[i][j] /= s->A[j][j];
    }
  }
  return true;
}

/* L L' x = b for all columns. */
static void substitute(normal_equations *s) {
  for (int i = 0; i < s->nterm; i++)
    for (int k = 0; k < s->ncolumn; k++) {
      for (int j = 0; j < i; j++) s->b[i][k] -= s->A[i][j] * s->b[j][k];
      s->b[i][k] /= s->A[i][i];
    }
  for (int i = s->nterm - 1; i >= 0; i--)
    for (int k = 0; k < s->ncolumn; k++) {
      for (int j = i + 1; j < s->nterm; j++) s->b[i][k] -= s->A[j][i] * s->b[j][k];
      s->b[i][k] /= s->A[i][i];
    }
}

static double *fitted_at(const patches *p, int corner) {
  return p->fitted + (size_t)p->corner[corner] * (size_t)(p->nterm * p->ncolumn);
}

/* Whether the patch of n tets has a polynomial of so many terms; then that is the corner's. */
static bool fit(patches *p, int corner, int n, int nterm) {
  normal_equations s = {.nterm = nterm, .ncolumn = p->ncolumn};
  int per = points_in_tet(p->mesh);
  p->scale[p->corner[corner]] = reach(p, corner, n);
  for (int i = 0; i < n * per; i++) {
    double term[PATCH_TERMS];
    int at = p->list[i / per] * per + i % per;
    terms_at(p, corner, p->point[at], term);
    add_point(p, term, at, &s);
  }
  if (!factor(&s)) return false;
  substitute(&s);
  double *to = fitted_at(p, corner);
  for (int i = 0; i < p->nterm; i++) /* zero beyond its terms */
    for (int k = 0; k < p->ncolumn; k++) to[i * p->ncolumn + k] = s.b[i][k];
  return true;
}

/* Of a body of too few tets for the degree of its elements, one of less. */
static void fit_corner(patches *p, int material, int corner) {
  p->nstamp++;
  int n = add_tets(p, material, corner, 0);
  if (n == 0) return;
  for (int before = 0; n > before && before < MANY;) {
    if (n >= FEW && fit(p, corner, n, p->nterm)) return;
    before = n;
    n = grow(p, material, n);
  }
  if (fit(p, corner, n, p->nterm) || fit(p, corner, n, 4)) return;
  fit(p, corner, n, 1);
}

void corot_patches_fit(patches *p, int material) {
  for (int n = 0; n < p->mesh->nnode; n++)
    if (p->first[n + 1] > p->first[n]) fit_corner(p, material, n);
}

void corot_patches_value(const patches *p, int tet, const double at[4], double *value) {
  double x[3], term[PATCH_TERMS];
  corot_tet_place(p->mesh, tet, at, x);
  for (int k = 0; k < p->ncolumn; k++) value[k] = 0;
  for (int a = 0; a < 4; a++) {
    int corner = p->mesh->tet[tet][a];
    const double *fitted = fitted_at(p, corner);
    terms_at(p, corner, x, term);
    for (int i = 0; i < p->nterm; i++)
      for (int k = 0; k < p->ncolumn; k++) value[k] += at[a] * term[i] * *fitted++;
  }
}

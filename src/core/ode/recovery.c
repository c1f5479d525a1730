/* The stress recovered at the nodes, and how far that of the tets is from it (Zienkiewicz & Zhu,
   "A simple error estimator and adaptive procedure for practical engineering analysis", 1987).

   In material axes, by Green's strain (cauchy: its own), so that turns do not count as jumps. Two
   stresses are multiplied by the energy they stand for,

     S : C^-1 : T = (S : T - nu/(1 + nu) tr S tr T) / (2 mu),  nu/(1 + nu) = lambda/(3 lambda + 2
   mu)

   and the recovered stress is linear in a tet, S* = sum_a L_a S_a. So is S, constant in a linear
   tet, so that the integral of |S* - S|^2 is V/20 (|sum_a d_a|^2 + sum_a |d_a|^2), d_a = S_a - S at
   corner a. */
#include <float.h>
#include <stdlib.h>

#include "core/solid/kernel.h"
#include "state.h"

/* Symmetric: xx yy zz xy yz xz. */
typedef struct stress6 {
  double s[6];
} stress6;

typedef struct recovery {
  const solid *body;
  nodal_field u;
  bool linear;    /* the stress is, in the displacement */
  stress6 *sum;   /* [nnode] of volume times stress, of one material */
  double *volume; /* [nnode] around each node, of that material */
  double moved;   /* the largest displacement */
} recovery;

/* Squares of norms, summed over the tets. */
typedef struct norms {
  double apart, whole; /* of S* - S and of S */
  double rounding;     /* of what may be left of S where there is none */
} norms;

COROT_INLINE stress6 stress_of(const recovery *r, int b, int l, mat3 F) {
  static const int ij[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  const solid *body = r->body;
  const material *mat = &body->material[body->elements.block[b].material];
  bool linear = r->linear, deviator = body->dilatation.npool > 0;
  double e[6], trace = 0;
  for (int k = 0; k < 6; k++) {
    int i = ij[k][0], j = ij[k][1];
    double gram = 0;
    for (int c = 0; c < 3; c++) gram += F.m[c][i][l] * F.m[c][j][l];
    e[k] = linear ? 0.5 * (F.m[i][j][l] + F.m[j][i][l]) - (i == j) : 0.5 * (gram - (i == j));
    if (k < 3) trace += e[k];
  }
  stress6 s;
  for (int k = 0; k < 6; k++) {
    double pressure = deviator ? -2 * mat->mu * trace / 3 : mat->lambda * trace;
    s.s[k] = 2 * mat->mu * e[k] + (k < 3 ? pressure : 0);
  }
  return s;
}

static double energy_of(const material *mat, const stress6 *a) {
  double square = 0, trace = 0;
  for (int k = 0; k < 6; k++) {
    square += (k < 3 ? 1 : 2) * a->s[k] * a->s[k];
    if (k < 3) trace += a->s[k];
  }
  double pressure = mat->lambda / (3 * mat->lambda + 2 * mat->mu) * trace * trace;
  return 0.5 * (square - pressure) / mat->mu;
}

/* Of each lane of a block the stresses at the corners, in the order of corot_tets_nodes: those of
   its point or, where there is one near each corner, of the linear field through all four. */
COROT_INLINE void stresses_of(const element_kind *kind, const recovery *r, int b,
                              stress6 (*corner)[4]) {
  const element_set *t = &r->body->elements;
  differences of_u = differences_of(point_at(kind, t, b, 0), r->u);
  for (int q = 0; q < kind->npoint; q++) {
    mat3 F = deformation(point_at(kind, t, b, q), &of_u);
    for (int l = 0; l < t->block[b].n; l++) corner[l][q] = stress_of(r, b, l, F);
  }
  for (int l = 0; l < t->block[b].n; l++) {
    stress6 *s = corner[l], sum = {{0}};
    if (kind->npoint == 1) {
      s[1] = s[2] = s[3] = s[0];
      continue;
    }
    for (int k = 0; k < 6; k++) {
      for (int q = 0; q < 4; q++) sum.s[k] += s[q].s[k];
      for (int q = 0; q < 4; q++)
        s[q].s[k] = (s[q].s[k] - TET10_B * sum.s[k]) / (TET10_A - TET10_B);
    }
  }
}

static void find_stresses(const recovery *r, int b, stress6 (*corner)[4]) {
  OF_KIND(&r->body->elements, stresses_of, r, b, corner);
}

/* Adds the stresses of a material's tets to their corners. */
static void gather(const recovery *r, int which) {
  const element_set *t = &r->body->elements;
  for (int n = 0; n < r->body->mesh->nnode; n++) r->sum[n] = (stress6){{0}}, r->volume[n] = 0;
  for (int b = 0; b < t->nblock; b++) {
    if (t->block[b].material != which) continue;
    stress6 corner[W][4];
    find_stresses(r, b, corner);
    for (int l = 0; l < t->block[b].n; l++) {
      double volume = volume_at(t, b, l);
      int node[KIND_NODES];
      corot_tets_nodes(r->body->mesh, t->number[b * W + l], node);
      for (int a = 0; a < 4; a++) {
        for (int k = 0; k < 6; k++) r->sum[node[a]].s[k] += volume * corner[l][a].s[k];
        r->volume[node[a]] += volume;
      }
    }
  }
}

/* Strains are differences of displacements, and of F'F from the identity: a hundred times what
   double precision leaves of either. */
COROT_INLINE double rounding_of(const recovery *r, int b, int l) {
  const element_set *t = &r->body->elements;
  point_lanes at = point_at(t->kind, t, b, 0);
  double square = 0;
  for (int a = 1; a < t->kind->nnode; a++)
    for (int c = 0; c < 3; c++) square += slope_of(at, a, c)[l] * slope_of(at, a, c)[l];
  double e = 100 * DBL_EPSILON * (1 + r->moved * sqrt(square));
  return volume_at(t, b, l) * 2 * r->body->material[material_of(at)].mu * e * e;
}

/* The integral over a tet of the energy of a linear field, given at the corners. */
static double energy_of_linear(const material *mat, double volume, const stress6 corner[4]) {
  stress6 all = {{0}};
  double each = 0;
  for (int a = 0; a < 4; a++) {
    for (int k = 0; k < 6; k++) all.s[k] += corner[a].s[k];
    each += energy_of(mat, &corner[a]);
  }
  return volume / 20 * (energy_of(mat, &all) + each);
}

/* Adds what a material's tets differ by, and what their stresses amount to. */
static void compare(const recovery *r, int which, norms *sum) {
  const element_set *t = &r->body->elements;
  const material *mat = &r->body->material[which];
  for (int b = 0; b < t->nblock; b++) {
    if (t->block[b].material != which) continue;
    stress6 corner[W][4];
    find_stresses(r, b, corner);
    for (int l = 0; l < t->block[b].n; l++) {
      double volume = volume_at(t, b, l);
      const stress6 *s = corner[l];
      stress6 apart[4];
      int node[KIND_NODES];
      corot_tets_nodes(r->body->mesh, t->number[b * W + l], node);
      for (int a = 0; a < 4; a++)
        for (int k = 0; k < 6; k++)
          apart[a].s[k] = r->sum[node[a]].s[k] / r->volume[node[a]] - s[a].s[k];
      sum->apart += energy_of_linear(mat, volume, apart);
      sum->whole +=
          t->kind->npoint == 1 ? volume * energy_of(mat, s) : energy_of_linear(mat, volume, s);
      sum->rounding += rounding_of(r, b, l);
    }
  }
}

static double largest_displacement(int nnode, nodal_field u) {
  double largest = 0;
  for (int n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++) largest = fmax(largest, fabs(u[n][c]));
  return largest;
}

corot_status corot_stress_jumps(const corot_model *m, corot_state *s, double t, const double *u,
                                double *share) {
  size_t nnode = (size_t)m->mesh->nnode;
  recovery r = {.body = body_of(m, s),
                .linear = corot_system_is_linear(system_of(m, s)),
                .sum = malloc(nnode * sizeof *r.sum),
                .volume = malloc(nnode * sizeof *r.volume)};
  const instant now = corot_state_at(s, t);
  norms n = {0};
  if (r.sum && r.volume) {
    r.u = corot_state_displace(m, s, &now, u);
    r.moved = largest_displacement(m->mesh->nnode, r.u);
    for (int k = 0; k < m->nmaterial; k++) {
      gather(&r, k);
      compare(&r, k, &n);
    }
  }
  bool done = r.sum && r.volume;
  free(r.sum);
  free(r.volume);
  if (!done) return corot_fail(COROT_ENOMEM, "no memory for the stresses at %zu nodes", nnode);
  *share = n.whole > n.rounding ? sqrt(n.apart / (n.apart + n.whole)) : 0;
  return COROT_OK;
}

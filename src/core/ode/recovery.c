/* The stress recovered at the nodes, and how far that of the tets is from it (Zienkiewicz & Zhu,
   "A simple error estimator and adaptive procedure for practical engineering analysis", 1987).

   In material axes, by Green's strain (cauchy: its own), so that turns do not count as jumps. Two
   stresses are multiplied by the energy they stand for,

     S : C^-1 : T = (S : T - nu/(1 + nu) tr S tr T) / (2 mu),  nu/(1 + nu) = lambda/(3 lambda + 2
   mu)

   and the recovered stress is linear in a tet, S* = sum_a N_a S_a, so that the integral of
   |S* - S|^2 is V/20 (|sum_a d_a|^2 + sum_a |d_a|^2), d_a = S_a - S. */
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

/* Adds the stresses of a material's tets to their nodes. */
static void gather(const recovery *r, int which) {
  const element_set *t = &r->body->elements;
  for (int n = 0; n < r->body->mesh->nnode; n++) r->sum[n] = (stress6){{0}}, r->volume[n] = 0;
  for (int b = 0; b < t->nblock; b++) {
    if (t->block[b].material != which) continue;
    mat3 F = deformation(point_of(r->body, b, 0), r->u);
    for (int l = 0; l < t->block[b].n; l++) {
      double volume = volume_at(t, b, l);
      stress6 s = stress_of(r, b, l, F);
      for (int a = 0; a < t->kind->nnode; a++) {
        int n = nodes_at(t, b, a)[l];
        for (int k = 0; k < 6; k++) r->sum[n].s[k] += volume * s.s[k];
        r->volume[n] += volume;
      }
    }
  }
}

/* Strains are differences of displacements, and of F'F from the identity: a hundred times what
   double precision leaves of either. */
COROT_INLINE double rounding_of(const recovery *r, int b, int l) {
  const element_set *t = &r->body->elements;
  point_lanes at = point_of(r->body, b, 0);
  double square = 0;
  for (int a = 1; a < t->kind->nnode; a++)
    for (int c = 0; c < 3; c++) square += slope_of(at, a, c)[l] * slope_of(at, a, c)[l];
  double e = 100 * DBL_EPSILON * (1 + r->moved * sqrt(square));
  return volume_at(t, b, l) * 2 * r->body->material[material_of(at)].mu * e * e;
}

/* Adds what a material's tets differ by, and what their stresses amount to. */
static void compare(const recovery *r, int which, norms *sum) {
  const element_set *t = &r->body->elements;
  const material *mat = &r->body->material[which];
  for (int b = 0; b < t->nblock; b++) {
    if (t->block[b].material != which) continue;
    mat3 F = deformation(point_of(r->body, b, 0), r->u);
    for (int l = 0; l < t->block[b].n; l++) {
      double volume = volume_at(t, b, l);
      stress6 s = stress_of(r, b, l, F), all = {{0}};
      double each = 0;
      for (int a = 0; a < t->kind->nnode; a++) {
        int n = nodes_at(t, b, a)[l];
        stress6 d;
        for (int k = 0; k < 6; k++) {
          d.s[k] = r->sum[n].s[k] / r->volume[n] - s.s[k];
          all.s[k] += d.s[k];
        }
        each += energy_of(mat, &d);
      }
      sum->apart += volume / 20 * (energy_of(mat, &all) + each);
      sum->whole += volume * energy_of(mat, &s);
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
  recovery r = {.body = solid_of(m),
                .linear = corot_system_is_linear(&m->system),
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

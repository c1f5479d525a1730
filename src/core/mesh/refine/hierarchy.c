/* T = T_L ... T_1, one factor a level, in which the nodes do not depend on each other. A node's
   parents have lower numbers, so T takes the nodes upwards and T^-1 downwards; the transposes go
   the other way. */
#include <corot/hierarchy.h>

static int fine_count(const corot_refinement *r) { return r->nnode[r->nlevel] - r->nnode[0]; }

void corot_hierarchy_apply(const corot_refinement *refinement, double (*v)[3]) {
  const int(*parent)[2] = (const int(*)[2])refinement->parent;
  int n = fine_count(refinement);
  double(*fine)[3] = v + refinement->nnode[0];
  for (int i = 0; i < n; i++) {
    const double *p = v[parent[i][0]], *q = v[parent[i][1]];
    for (int k = 0; k < 3; k++) fine[i][k] += (p[k] + q[k]) / 2;
  }
}

void corot_hierarchy_solve(const corot_refinement *refinement, double (*v)[3]) {
  const int(*parent)[2] = (const int(*)[2])refinement->parent;
  int n = fine_count(refinement);
  double(*fine)[3] = v + refinement->nnode[0];
  for (int i = n - 1; i >= 0; i--) {
    const double *p = v[parent[i][0]], *q = v[parent[i][1]];
    for (int k = 0; k < 3; k++) fine[i][k] -= (p[k] + q[k]) / 2;
  }
}

void corot_hierarchy_apply_transposed(const corot_refinement *refinement, double (*v)[3]) {
  const int(*parent)[2] = (const int(*)[2])refinement->parent;
  int n = fine_count(refinement);
  const double(*fine)[3] = (const double(*)[3])v + refinement->nnode[0];
  for (int i = n - 1; i >= 0; i--) {
    double *p = v[parent[i][0]], *q = v[parent[i][1]];
    for (int k = 0; k < 3; k++) {
      p[k] += fine[i][k] / 2;
      q[k] += fine[i][k] / 2;
    }
  }
}

void corot_hierarchy_solve_transposed(const corot_refinement *refinement, double (*v)[3]) {
  const int(*parent)[2] = (const int(*)[2])refinement->parent;
  int n = fine_count(refinement);
  const double(*fine)[3] = (const double(*)[3])v + refinement->nnode[0];
  for (int i = 0; i < n; i++) {
    double *p = v[parent[i][0]], *q = v[parent[i][1]];
    for (int k = 0; k < 3; k++) {
      p[k] -= fine[i][k] / 2;
      q[k] -= fine[i][k] / 2;
    }
  }
}

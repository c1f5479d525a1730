/* The hierarchical basis of a refined mesh: what is smooth on the coarse mesh has no detail, and
   forces on fine nodes become forces on coarse ones. Needs corot::core. */
#include <corot/hierarchy.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

int main(void) {
  corot_box box = {.size = {1, 1, 1}, .cells = {1, 1, 1}};
  corot_mesh *coarse, *fine;
  corot_refinement *refinement;
  check(corot_mesh_box(&box, &coarse));
  check(corot_mesh_refine(coarse, 2, COROT_DIAGONAL_CONSISTENT, &fine, &refinement));
  int ncoarse = refinement->nnode[0], nfine = refinement->nnode[2];
  double(*v)[3] = malloc((size_t)nfine * sizeof *v);
  if (!v) return 1;

  /* A displacement with a constant gradient, and a bump at one fine node on top of it. */
  for (int i = 0; i < nfine; i++)
    for (int k = 0; k < 3; k++) v[i][k] = 0.1 * fine->x[i][(k + 1) % 3];
  v[nfine - 1][0] += 0.5;
  corot_hierarchy_solve(refinement, v); /* from values at the nodes to differences */
  int ndetail = 0;
  for (int i = ncoarse; i < nfine; i++) ndetail += fabs(v[i][0]) > 1e-12;
  printf("fine nodes with detail %d of %d, the last %.12g\n", ndetail, nfine - ncoarse,
         v[nfine - 1][0]);
  corot_hierarchy_apply(refinement, v); /* and back */
  printf("value at the last node %.12g, was %.12g\n", v[nfine - 1][0],
         0.1 * fine->x[nfine - 1][1] + 0.5);

  /* A unit force on every node: together the coarse nodes feel all of it. */
  for (int i = 0; i < nfine; i++) v[i][0] = 1, v[i][1] = v[i][2] = 0;
  corot_hierarchy_apply_transposed(refinement, v);
  double sum = 0;
  for (int i = 0; i < ncoarse; i++) sum += v[i][0];
  printf("force on %d nodes %d N, on %d coarse ones %.12g N\n", nfine, nfine, ncoarse, sum);

  free(v);
  corot_refinement_destroy(refinement);
  corot_mesh_destroy(fine);
  corot_mesh_destroy(coarse);
}

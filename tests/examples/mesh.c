/* A mesh: a box that is cut into tets, given a group of its own, refined, written and read again.
   Needs corot::core. usage: mesh FILE.msh, which is written */
#include <corot/mesh.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

int main(int argc, char **argv) {
  if (argc != 2) return 2;

  /* 2 x 2 x 12 cells of a bar. Its six sides are groups already; one more holds the upper end. */
  corot_box box = corot_box_defaults();
  box.size[0] = 0.1, box.size[1] = 0.1, box.size[2] = 0.6; /* [m] */
  box.cells[0] = 2, box.cells[1] = 2, box.cells[2] = 12;
  corot_mesh *coarse, *fine, *again;
  check(corot_mesh_box(&box, &coarse));
  check(corot_mesh_group_box(coarse, "upper", (double[]){0, 0, 0.5}, (double[]){0.1, 0.1, 0.6}, 0));

  /* Every tet in eight; nodes and groups of the coarse mesh keep their numbers and their order. */
  corot_refinement *refinement;
  check(corot_mesh_refine(coarse, 1, COROT_DIAGONAL_CONSISTENT, &fine, &refinement));
  corot_mesh_quality quality = corot_mesh_measure(fine);
  printf("tets %d of %d\n", fine->ntet, coarse->ntet);
  printf("nodes %d of %d\n", refinement->nnode[1], refinement->nnode[0]);
  printf("volume %.12g m^3, worst shape %.3f\n", quality.volume, quality.shape_min);

  int ntri, (*tri)[3];
  check(corot_mesh_boundary(fine, &ntri, &tri));
  printf("faces of the boundary %d\n", ntri);
  free(tri);

  check(corot_mesh_write(fine, argv[1]));
  check(corot_mesh_read(argv[1], &again));
  const corot_group *upper = corot_mesh_find_group(again, "upper");
  printf("read again: tets %d, of which %d are in upper\n", again->ntet, upper ? upper->ntet : 0);

  corot_refinement_destroy(refinement);
  corot_mesh_destroy(again);
  corot_mesh_destroy(fine);
  corot_mesh_destroy(coarse);
}

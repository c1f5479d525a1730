/* The box, each cell cut into Kuhn's six tets. */
#include "core/mesh.h"

#include <limits.h>
#include <math.h>

/* Corners of the six tets of a cell, corner bits 1, 2, 4 standing for x, y, z: each goes from
   corner 0 to corner 7 by one axis after the other. Odd orders of the axes have two corners
   swapped, so that all are right-handed. */
static const int kuhn[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                               {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

static corot_status check_box(const corot_box *box) {
  double nnode = 1, ncell = 1;
  for (int k = 0; k < 3; k++) {
    if (!(box->size[k] > 0) || !isfinite(box->size[k]))
      return corot_fail(COROT_EINVAL, "box: size is %g along %c, not positive", box->size[k],
                        "xyz"[k]);
    if (box->cells[k] <= 0)
      return corot_fail(COROT_EINVAL, "box: %d cells along %c, not positive", box->cells[k],
                        "xyz"[k]);
    if (!isfinite(box->origin[k]))
      return corot_fail(COROT_EINVAL, "box: origin is %g along %c", box->origin[k], "xyz"[k]);
    nnode *= box->cells[k] + 1.0;
    ncell *= box->cells[k];
  }
  if (3 * nnode > INT_MAX || 4 * 6 * ncell > INT_MAX)
    return corot_fail(COROT_EINVAL, "box: %d x %d x %d cells are too many: %.3g tets, at most %d",
                      box->cells[0], box->cells[1], box->cells[2], 6 * ncell, INT_MAX / 4);
  return COROT_OK;
}

static void place_nodes(const corot_box *box, double (*x)[3]) {
  const int *n = box->cells;
  for (int k = 0; k <= n[2]; k++)
    for (int j = 0; j <= n[1]; j++)
      for (int i = 0; i <= n[0]; i++, x++) {
        (*x)[0] = box->origin[0] + box->size[0] * i / n[0];
        (*x)[1] = box->origin[1] + box->size[1] * j / n[1];
        (*x)[2] = box->origin[2] + box->size[2] * k / n[2];
      }
}

static void place_tets(const corot_box *box, int (*tet)[4]) {
  const int *n = box->cells, row = n[0] + 1, layer = row * (n[1] + 1);
  for (int k = 0; k < n[2]; k++)
    for (int j = 0; j < n[1]; j++)
      for (int i = 0; i < n[0]; i++)
        for (int t = 0; t < 6; t++, tet++)
          for (int c = 0; c < 4; c++) {
            int corner = kuhn[t][c];
            (*tet)[c] =
                i + (corner & 1) + row * (j + (corner >> 1 & 1)) + layer * (k + (corner >> 2 & 1));
          }
}

static void mark_side(const corot_box *box, int axis, int layer, char *mark) {
  const int *n = box->cells;
  for (int k = 0; k <= n[2]; k++)
    for (int j = 0; j <= n[1]; j++)
      for (int i = 0; i <= n[0]; i++) *mark++ = (int[]){i, j, k}[axis] == layer;
}

static corot_status add_sides(const corot_box *box, const corot_face *face, corot_mesh *mesh) {
  static const char *const name[3][2] = {{"xmin", "xmax"}, {"ymin", "ymax"}, {"zmin", "zmax"}};
  int ntri, (*tri)[3];
  char *mark;
  COROT_TRY(COROT_ALLOC(mark, mesh->nnode));
  corot_status status =
      corot_faces_boundary(4 * mesh->ntet, face, (const int(*)[4])mesh->tet, &ntri, &tri);
  if (status) {
    free(mark);
    return status;
  }
  for (int s = 0; s < 6 && !status; s++) {
    mark_side(box, s / 2, s % 2 ? box->cells[s / 2] : 0, mark);
    status = corot_mesh_group_marked(mesh, name[s / 2][s % 2], mark, ntri, (const int(*)[3])tri);
  }
  free(tri);
  free(mark);
  return status;
}

static corot_status fill(const corot_box *box, corot_mesh *mesh) {
  const corot_mesh_names names = {.tet = "tet"};
  const int *n = box->cells;
  corot_mesh_place place;
  corot_face *face;
  mesh->nnode = (n[0] + 1) * (n[1] + 1) * (n[2] + 1);
  mesh->ntet = 6 * n[0] * n[1] * n[2];
  COROT_TRY(COROT_ALLOC(mesh->x, mesh->nnode));
  COROT_TRY(COROT_ALLOC(mesh->tet, mesh->ntet));
  place_nodes(box, mesh->x);
  place_tets(box, mesh->tet);
  COROT_TRY(corot_mesh_check(mesh, &names, &place, &face)); /* cells may be flat in rounding */
  corot_status status = add_sides(box, face, mesh);
  free(face);
  return status;
}

corot_status corot_mesh_box(const corot_box *box, corot_mesh **mesh) {
  corot_mesh *m;
  COROT_TRY(check_box(box));
  COROT_TRY(COROT_ALLOC(m, 1));
  corot_status status = fill(box, m);
  if (status)
    corot_mesh_destroy(m);
  else
    *mesh = m;
  return status;
}

/* A box of cells, each cut along Kuhn's six paths, which may alternate from cell to cell. */
#include <limits.h>
#include <math.h>

#include "core/mesh/refine/mesh_refine.h"

/* The cells along axis k that are cut into tets: one more than asked for where the middle cell is
   halved. */
static double count_along(const corot_box *box, int k) {
  bool halved = box->split == COROT_BOX_SYMMETRIC && box->cells[k] % 2 == 1;
  return box->cells[k] + (halved ? 1.0 : 0.0);
}

/* Corners of the six tets of a cell, corner bits 1, 2, 4 standing for x, y, z: each is the path
   from corner 0 to corner 7 by one axis after the other. Every second one is left-handed. */
static const int path[6][4] = {{0, 1, 3, 7}, {0, 2, 3, 7}, {0, 2, 6, 7},
                               {0, 4, 6, 7}, {0, 4, 5, 7}, {0, 1, 5, 7}};

static corot_status check_box(const corot_box *box) {
  double nnode = 1, ncell = 1;
  if ((unsigned)box->split > COROT_BOX_SYMMETRIC)
    return corot_fail(COROT_EINVAL, "box: there is no split %d", (int)box->split);
  for (int k = 0; k < 3; k++) {
    if (!(box->size[k] > 0) || !isfinite(box->size[k]))
      return corot_fail(COROT_EINVAL, "box: size is %g along %c, not positive", box->size[k],
                        "xyz"[k]);
    if (box->cells[k] <= 0)
      return corot_fail(COROT_EINVAL, "box: %d cells along %c, not positive", box->cells[k],
                        "xyz"[k]);
    if (!isfinite(box->origin[k]))
      return corot_fail(COROT_EINVAL, "box: origin is %g along %c", box->origin[k], "xyz"[k]);
    nnode *= count_along(box, k) + 1;
    ncell *= count_along(box, k);
  }
  if (3 * nnode > INT_MAX || 4 * 6 * ncell > INT_MAX)
    return corot_fail(COROT_EINVAL, "box: %d x %d x %d cells are too many: %.3g tets, at most %d",
                      box->cells[0], box->cells[1], box->cells[2], 6 * ncell, INT_MAX / 4);
  return COROT_OK;
}

/* Where plane i across axis k lies among n. */
static double plane(const corot_box *box, int k, int n, int i) {
  int cells = box->cells[k], middle = n / 2;
  if (n == cells || i < middle) return box->origin[k] + box->size[k] * i / cells;
  if (i == middle) return box->origin[k] + box->size[k] / 2;
  return box->origin[k] + box->size[k] * (i - 1) / cells;
}

static void place_nodes(const corot_box *box, const int n[3], double (*x)[3]) {
  for (int k = 0; k <= n[2]; k++)
    for (int j = 0; j <= n[1]; j++)
      for (int i = 0; i <= n[0]; i++, x++) {
        const int at[3] = {i, j, k};
        for (int c = 0; c < 3; c++) (*x)[c] = plane(box, c, n[c], at[c]);
      }
}

/* Puts the nodes of a path in a right-handed order in which octasection along the consistent
   diagonal finds the pairs 0 2 and 1 3 of the path, so that it makes paths again. */
static void order_path(const int v[4], bool right_handed, int tet[4]) {
  static const int order[2][2][4] = {{{0, 2, 1, 3}, {0, 3, 2, 1}}, {{0, 1, 2, 3}, {0, 2, 3, 1}}};
  const int *o = order[right_handed][corot_tet_is_odd(v)];
  for (int c = 0; c < 4; c++) tet[c] = v[o[c]];
}

/* Cells with an odd index along an axis are mirrored in it, unless all are to be the same: `mirror`
   has the bits of these axes. */
static void place_tets(const corot_box *box, const int n[3], int (*tet)[4]) {
  int row = n[0] + 1, layer = row * (n[1] + 1);
  for (int k = 0; k < n[2]; k++)
    for (int j = 0; j < n[1]; j++)
      for (int i = 0; i < n[0]; i++) {
        int mirror = box->split == COROT_BOX_KUHN ? 0 : i % 2 | j % 2 << 1 | k % 2 << 2;
        bool turned = (i + j + k) % 2 && mirror;
        for (int t = 0; t < 6; t++, tet++) {
          int v[4];
          for (int c = 0; c < 4; c++) {
            int corner = path[t][c] ^ mirror;
            v[c] =
                i + (corner & 1) + row * (j + (corner >> 1 & 1)) + layer * (k + (corner >> 2 & 1));
          }
          order_path(v, (t % 2 == 0) != turned, *tet);
        }
      }
}

static void mark_side(const int n[3], int axis, int layer, char *mark) {
  for (int k = 0; k <= n[2]; k++)
    for (int j = 0; j <= n[1]; j++)
      for (int i = 0; i <= n[0]; i++) *mark++ = (int[]){i, j, k}[axis] == layer;
}

static corot_status add_sides(const int n[3], const corot_face *face, corot_mesh *mesh) {
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
    mark_side(n, s / 2, s % 2 ? n[s / 2] : 0, mark);
    status = corot_mesh_group_marked(mesh, name[s / 2][s % 2], mark, ntri, (const int(*)[3])tri);
  }
  free(tri);
  free(mark);
  return status;
}

static corot_status fill(const corot_box *box, corot_mesh *mesh) {
  const corot_mesh_names names = {.tet = "tet"};
  corot_mesh_faults faults = {0};
  corot_face *face;
  int n[3];
  for (int k = 0; k < 3; k++) n[k] = (int)count_along(box, k);
  mesh->nnode = (n[0] + 1) * (n[1] + 1) * (n[2] + 1);
  mesh->ntet = 6 * n[0] * n[1] * n[2];
  COROT_TRY(COROT_ALLOC(mesh->x, mesh->nnode));
  COROT_TRY(COROT_ALLOC(mesh->tet, mesh->ntet));
  place_nodes(box, n, mesh->x);
  place_tets(box, n, mesh->tet);
  COROT_TRY(corot_mesh_check(mesh, &names, &faults, &face)); /* cells may be flat in rounding */
  COROT_TRY(corot_faults_fail(&faults, COROT_EINVAL));
  corot_status status = add_sides(n, face, mesh);
  free(face);
  return status;
}

corot_box corot_box_defaults(void) { return (corot_box){.split = COROT_BOX_SYMMETRIC}; }

corot_status corot_mesh_box(const corot_box *box, corot_mesh **mesh) {
  corot_mesh *m;
  COROT_TRY(COROT_GIVEN(box));
  COROT_TRY(COROT_GIVEN(mesh));
  COROT_TRY(check_box(box));
  COROT_TRY(COROT_ALLOC(m, 1));
  corot_status status = fill(box, m);
  if (status)
    corot_mesh_destroy(m);
  else
    *mesh = m;
  return status;
}

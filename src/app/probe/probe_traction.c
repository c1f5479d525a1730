/* Tractions on faces: t = sigma n of Cauchy's stress and the normal of the face where it is now; of
   the linear measure, whose stress knows no turned faces, where it is at rest. Of `warp`, whose
   stress is not symmetric, it is that of the symmetric part. */
#include <corot/model.h>
#include <math.h>
#include <string.h>

#include "core/mesh/mesh.h"
#include "probe_parts.h"

void side_normal(const corot_mesh *mesh, const double (*displacement)[3], int side,
                 const double at[4], double normal[3]) {
  static const int own[10] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
  const int e = side / 4, *corner = corot_tet_face[side % 4], *v = mesh->tet[e];
  double x[10][3], slope[4][3], a[3], b[3];
  /* the nodes of the tet, where they are */
  for (int k = 0; k < (mesh->mid ? 10 : 4); k++) {
    int node = k < 4 ? v[k] : mesh->mid[e][k - 4];
    for (int i = 0; i < 3; i++)
      x[k][i] = displacement ? mesh->x[node][i] + displacement[node][i] : mesh->x[node][i];
  }
  /* two tangents, whose product is twice the area */
  memcpy(slope, x, sizeof slope);
  if (mesh->mid) corot_curved_slopes((const double(*)[3])x, own, own + 4, at, slope);
  for (int i = 0; i < 3; i++) {
    a[i] = slope[corner[1]][i] - slope[corner[0]][i];
    b[i] = slope[corner[2]][i] - slope[corner[0]][i];
  }
  for (int i = 0; i < 3; i++)
    normal[i] = 0.5 * (a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3]);
}

/* A row of the library's: xx, yy, zz, xy, yz, xz. */
static void multiply(const double stress[6], const double n[3], double t[3]) {
  t[0] = stress[0] * n[0] + stress[3] * n[1] + stress[5] * n[2];
  t[1] = stress[3] * n[0] + stress[1] * n[1] + stress[4] * n[2];
  t[2] = stress[5] * n[0] + stress[4] * n[1] + stress[2] * n[2];
}

void samples_find_tractions(samples *s, const corot_model *model, const double (*displacement)[3]) {
  const corot_mesh *mesh = corot_model_mesh(model);
  if (corot_strain_find(corot_model_strain(model))->linear) displacement = NULL;
  for (int i = 0; i < s->n; i++) {
    double n[3];
    side_normal(mesh, displacement, s->side[i], s->place[i].at, n);
    double area = hypot(hypot(n[0], n[1]), n[2]);
    multiply(s->at.stress[i], n, s->traction[i]);
    for (int c = 0; c < 3; c++) s->traction[i][c] /= area;
    s->weight[i] = area / (mesh->mid ? 3 : 1);
  }
}

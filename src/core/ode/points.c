/* Fields at places between nodes and points of integration, W of them at a time. */
#include <stdlib.h>

#include "core/base/sized.h"
#include "core/mesh/mesh.h"
#include "core/solid/kernel.h"
#include "shown.h"
#include "state.h"

/* A place: the lane of a block, and what the shape functions are there. */
typedef struct place {
  int block, lane;
  double slope[KIND_NODES][3]; /* rest gradients of the shape functions, in the block's order */
  double part[KIND_POINTS]; /* of the points of integration in the linear function through them */
} place;

struct corot_points {
  const corot_model *model;
  int n;
  place *place; /* [n] */
};

/* --- Shape functions --- */

/* dN[k] = dN_k / dl of the tet's nodes, corners first. */
static void derive_shapes(int nnode, const double l[4], double dN[KIND_NODES][4]) {
  memset(dN, 0, KIND_NODES * sizeof *dN);
  for (int a = 0; a < 4; a++) dN[a][a] = nnode == 4 ? 1 : 4 * l[a] - 1;
  for (int k = 4; k < nnode; k++) {
    const int *end = corot_tet_edge[k - 4];
    dN[k][end[0]] = 4 * l[end[1]];
    dN[k][end[1]] = 4 * l[end[0]];
  }
}

/* J[k] = dX / dl_k at dl_0 = -dl_k, k = 1, 2, 3. */
static void find_jacobian(const corot_mesh *mesh, const int *node, int nnode,
                          const double dN[KIND_NODES][4], double J[3][3]) {
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3; i++) {
      J[k][i] = 0;
      for (int a = 1; a < nnode; a++)
        J[k][i] += (dN[a][k + 1] - dN[a][0]) * (mesh->x[node[a]][i] - mesh->x[node[0]][i]);
    }
}

/* g[a] = dN_a / dX, solved from J g = dN / dl. */
static void find_gradients(const double J[3][3], int nnode, const double dN[KIND_NODES][4],
                           double g[KIND_NODES][3]) {
  double cofactor[3][3];
  for (int k = 0; k < 3; k++) {
    const double *b = J[(k + 1) % 3], *c = J[(k + 2) % 3];
    for (int i = 0; i < 3; i++)
      cofactor[k][i] = b[(i + 1) % 3] * c[(i + 2) % 3] - b[(i + 2) % 3] * c[(i + 1) % 3];
  }
  double det = J[0][0] * cofactor[0][0] + J[0][1] * cofactor[0][1] + J[0][2] * cofactor[0][2];
  for (int a = 0; a < nnode; a++)
    for (int i = 0; i < 3; i++) {
      g[a][i] = 0;
      for (int k = 0; k < 3; k++) g[a][i] += cofactor[k][i] * (dN[a][k + 1] - dN[a][0]) / det;
    }
}

static void fill_place(const corot_model *m, int tet, const double l[4], place *p) {
  const corot_mesh *mesh = m->mesh;
  const element_set *set = &solid_of(m)->elements;
  int nnode = set->kind->nnode, node[KIND_NODES];
  double dN[KIND_NODES][4], J[3][3], g[KIND_NODES][3];
  for (int k = 0; k < nnode; k++) node[k] = k < 4 ? mesh->tet[tet][k] : mesh->mid[tet][k - 4];
  derive_shapes(nnode, l, dN);
  find_jacobian(mesh, node, nnode, (const double(*)[4])dN, J);
  find_gradients((const double(*)[3])J, nnode, (const double(*)[4])dN, g);

  /* in the order of the block, and of its points: that of the corners as they ascend */
  for (int a = 0; a < nnode; a++)
    for (int k = 0; k < nnode; k++)
      if (nodes_at(set, p->block, a)[p->lane] == node[k])
        memcpy(p->slope[a], g[k], sizeof p->slope[a]);
  p->part[0] = 1;
  for (int k = 0; k < 4 && set->kind->npoint > 1; k++) {
    int rank = 0;
    for (int j = 0; j < 4; j++) rank += node[j] < node[k];
    p->part[rank] = (l[k] - TET10_B) / (TET10_A - TET10_B);
  }
}

/* where [ntet] = block * W + lane of each tet. */
static void find_lanes(const element_set *set, int *where) {
  for (int b = 0; b < set->nblock; b++)
    for (int l = 0; l < set->block[b].n; l++) where[set->number[b * W + l]] = b * W + l;
}

static corot_status fill(const int *tet, const double (*at)[4], corot_points *p) {
  const corot_mesh *mesh = p->model->mesh;
  int *where = malloc((size_t)mesh->ntet * sizeof *where);
  p->place = calloc((size_t)p->n + 1, sizeof *p->place);
  if (!where || !p->place) {
    free(where);
    return corot_fail(COROT_ENOMEM, "no memory for %d points", p->n);
  }
  find_lanes(&solid_of(p->model)->elements, where);
  corot_status status = COROT_OK;
  for (int i = 0; i < p->n && !status; i++) {
    if (tet[i] < 0 || tet[i] >= mesh->ntet) {
      status = corot_fail(COROT_EINVAL, "point %d: tet %d; there are %d", i, tet[i], mesh->ntet);
    } else {
      p->place[i].block = where[tet[i]] / W, p->place[i].lane = where[tet[i]] % W;
      fill_place(p->model, tet[i], at[i], &p->place[i]);
    }
  }
  free(where);
  return status;
}

corot_status corot_points_create(const corot_model *m, int n, const int *tet, const double (*at)[4],
                                 corot_points **points) {
  COROT_TRY(COROT_GIVEN_AS(m, "model"));
  COROT_TRY(COROT_GIVEN(points));
  corot_points *p = calloc(1, sizeof *p);
  if (!p) return corot_fail(COROT_ENOMEM, "no memory for %d points", n);
  p->model = m;
  p->n = n;
  corot_status status = fill(tet, at, p);
  if (status == COROT_OK)
    *points = p;
  else
    corot_points_destroy(p);
  return status;
}

void corot_points_destroy(corot_points *p) {
  if (!p) return;
  free(p->place);
  free(p);
}

/* --- Evaluation --- */

/* Up to W places at once, and what their elements have of their own. */
typedef struct batch {
  const solid *body;
  const solid_state *state;
  const place *place;
  int n;
} batch;

/* F = I + sum_a (u_a - u_0) g_a'; lanes without a place are at rest. */
COROT_INLINE mat3 gradients_of(const batch *b, nodal_field u) {
  const element_set *set = &b->body->elements;
  mat3 F = mat3_identity();
  for (int l = 0; l < b->n; l++) {
    const place *p = &b->place[l];
    const double *first = u[nodes_at(set, p->block, 0)[p->lane]];
    for (int a = 1; a < set->kind->nnode; a++) {
      const double *here = u[nodes_at(set, p->block, a)[p->lane]];
      EACH_IJ F.m[i][j][l] += (here[i] - first[i]) * p->slope[a][j];
    }
  }
  return F;
}

/* Where a point q of a place's element stands in arrays of points. */
COROT_INLINE int point_of(const batch *b, const place *p, int q) {
  return p->block * b->body->elements.kind->npoint + q;
}

/* The frames that are given, at point q of each element, turned on if need be. */
COROT_INLINE mat3 given_frames(const batch *b, int q) {
  const frame_source *from = &b->state->frames;
  mat3 R = mat3_identity();
  vec3 spin = {{vd_all(0), vd_all(0), vd_all(0)}};
  for (int l = 0; l < b->n; l++) {
    const place *p = &b->place[l];
    EACH_IJ R.m[i][j][l] = from->R[point_of(b, p, q)].m[i][j][p->lane];
    if (from->kind != COROT_FRAMES_EXTRAPOLATED) continue;
    for (int i = 0; i < 3; i++) spin.v[i][l] = from->spin[point_of(b, p, q)].v[i][p->lane];
  }
  return from->kind == COROT_FRAMES_EXTRAPOLATED ? rotate_by(spin, from->age, R) : R;
}

/* The linear function through the frames of the points of integration, and the rotation next to it.
 */
COROT_INLINE mat3 mean_frames(const batch *b) {
  int npoint = b->body->elements.kind->npoint;
  mat3 R = given_frames(b, 0), sum = mat3_scale(vd_all(0), R);
  if (npoint == 1) return R;
  for (int q = 0; q < npoint; q++) {
    vd part = vd_all(0.25); /* where there is no place, of the identity */
    for (int l = 0; l < b->n; l++) part[l] = b->place[l].part[q];
    sum = mat3_add(sum, mat3_scale(part, given_frames(b, q)));
  }
  vi bad;
  return polar(sum, &bad);
}

/* As frame_in_use of kernel.h has it of the points of integration. */
COROT_INLINE mat3 frames_of(const batch *b, mat3 F, vi *inverted) {
  const strain_measure *s = &strain_measures[b->body->strain];
  if (strain_is_linear(s)) return mat3_identity();
  *inverted = ~(mat3_det(F, mat3_cofactor(F)) > vd_all(0));
  if (b->state->frames.kind != COROT_FRAMES_EXACT && s->frame != FRAME_IDENTITY)
    return mean_frames(b);
  mat3 Q0 = mat3_identity();
  for (int l = 0; s->frame == FRAME_WARP && l < b->n; l++)
    EACH_IJ Q0.m[i][j][l] =
        b->body->elements.rest_basis[b->place[l].block].m[i][j][b->place[l].lane];
  return frame_of(s->frame, F, &Q0, inverted);
}

COROT_INLINE shown show_batch(const batch *b, nodal_field u, vi *inverted) {
  const element_set *set = &b->body->elements;
  vd lambda = vd_all(0), mu = vd_all(0), average = vd_all(0);
  for (int l = 0; l < b->n; l++) {
    const place *p = &b->place[l];
    const material *mat = &b->body->material[set->block[p->block].material];
    lambda[l] = mat->lambda, mu[l] = mat->mu;
    for (int q = 0; b->body->dilatation.npool && q < set->kind->npoint; q++)
      average[l] += p->part[q] * b->state->dilatation[point_of(b, p, q)][p->lane];
  }
  mat3 F = gradients_of(b, u), R = frames_of(b, F, inverted);
  return show(&strain_measures[b->body->strain], lambda, mu,
              b->body->dilatation.npool ? &average : NULL, F, R);
}

COROT_INLINE void store(const corot_point_fields *f, int i, int l, const shown *s,
                        const eigen3 *principal) {
  if (f->frame) mat3_store(s->R, l, f->frame[i]);
  if (f->strain) store_symmetric(s->e, l, f->strain[i]);
  if (f->stress) store_symmetric(s->stress, l, f->stress[i]);
  if (f->principal) store_eigenvalues(principal, l, f->principal[i]);
  if (f->von_mises) f->von_mises[i] = s->mises[l];
  if (f->det) f->det[i] = s->det[l];
}

/* The number in the mesh of the first tet that is inverted at a point; -1: none is. */
static int show_places(const corot_points *points, const solid *body, const solid_state *state,
                       nodal_field u, const corot_point_fields *fields) {
  int first = -1;
  for (int i = 0; i < points->n; i += W) {
    const batch b = {body, state, points->place + i, points->n - i < W ? points->n - i : W};
    vi inverted = {0};
    eigen3 principal = {0};
    shown s = show_batch(&b, u, &inverted);
    if (fields->principal) principal = eigen_of(s.stress);
    for (int l = 0; l < b.n; l++) {
      store(fields, i + l, l, &s, &principal);
      if (inverted[l] && first < 0)
        first = body->elements.number[b.place[l].block * W + b.place[l].lane];
    }
  }
  return first;
}

corot_status corot_points_evaluate(const corot_points *points, corot_state *s, double t,
                                   const double *u, const corot_point_fields *fields) {
  const corot_model *m = points->model;
  nodal_field all_u;
  corot_status above = corot_show_begin(m, s, t, u, &all_u);
  if (above && above != COROT_RETRY) return above;
  int first = show_places(points, body_of(m, s), &s->system.of[0], all_u, fields);
  return corot_show_end(m, s, first, above);
}

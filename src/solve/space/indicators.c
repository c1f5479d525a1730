/* Where the mesh leaves out most: the strain of the state, and of what the goal is most sensitive
   to, against what is recovered of either (patches.h). corot/space.h says what it means. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/sized.h"
#include "core/mesh/mesh.h"
#include "core/model/model.h"
#include "core/ode/state.h"
#include "patches.h"
#include "raised.h"
#include "rigid_modes.h"
#include "solve/pencil/pencil.h"

typedef struct indication {
  const corot_model *model;
  const corot_space_moment *at;
  const double *goal; /* [ndof] or NULL */
  corot_state *state;
  int *of_tet;             /* [ntet] material */
  bool linear;             /* strains are those of small displacements */
  double (*u)[3], (*z)[3]; /* [nnode] displacement [m], and the dual state */
  double (*strain[2])[6];  /* [ntet times points] of the two */
  double *dual, *load;     /* [ndof] */
  double (*x)[3];          /* [nnode] where the nodes are now [m] */
  double moved;            /* the largest displacement [m] */
  rigid_modes modes;
  patches patches;
  corot_space_total total;
} indication;

/* --- The dual state: K z = goal --- */

/* What nothing holds moves as in corot_space_error: goal and z have no rigid motion. */
static corot_status try_dual(indication *s, const corot_linear_def *linear, corot_tangent tangent) {
  double frequency = corot_model_frequency(s->model), tie = SPACE_TIE * frequency * frequency;
  corot_pencil *p = NULL;
  COROT_TRY(corot_pencil_create(s->model, s->state, linear, &p));
  corot_pencil_use(p, tangent);
  corot_status status = corot_pencil_assemble(p, s->at->t, s->at->u, s->at->v);
  corot_pencil_combine(p, s->modes.any ? tie : 0, 0, 1);
  if (!status) status = corot_pencil_factor_definite(p);
  if (!status) status = corot_pencil_solve(p, s->load, s->dual);
  s->total.niteration += corot_pencil_statistics(p).niteration;
  corot_pencil_destroy(p);
  return status;
}

/* Where the stiffness is not positive definite, with what is left of it when that is cut off. */
static corot_status find_dual(indication *s, const corot_linear_def *given) {
  static const corot_tangent tangent[] = {COROT_TANGENT_EXACT, COROT_TANGENT_CLAMPED,
                                          COROT_TANGENT_HELD};
  corot_linear_def linear = given ? *given : corot_linear_defaults();
  linear.role = COROT_ROLE_STATIC;
  for (int i = 0; i < corot_model_ndof(s->model); i++) s->load[i] = s->goal[i];
  corot_rigid_modes_balance(&s->modes, s->load);
  corot_status status = COROT_RETRY;
  for (int k = 0; k < 3 && (status == COROT_RETRY || status == COROT_ESINGULAR); k++) {
    status = try_dual(s, &linear, tangent[k]);
    s->total.indefinite |= k > 0;
  }
  if (!status) corot_rigid_modes_leave(&s->modes, s->dual);
  return status;
}

/* --- Tets --- */

/* What a difference of strains, or two, amounts to: e : C : f; with averaged dilatations of the
   deviators alone. */
static double energy_of(const material *mat, bool deviator, const double *e, const double *f) {
  double product = 0, traces = (e[0] + e[1] + e[2]) * (f[0] + f[1] + f[2]);
  for (int k = 0; k < 6; k++) product += (k < 3 ? 1 : 2) * e[k] * f[k];
  return 2 * mat->mu * product + (deviator ? -2 * mat->mu / 3 : mat->lambda) * traces;
}

/* A rule of degree five (N. J. Walkington, 2000), of more points than the strain is sampled at:
   there it is better than elsewhere. */
enum { NRULE = 14 };
static void rule_point(int i, double at[4], double *weight) {
  static const double at_corner[2] = {0.31088591926330060980, 0.092735250310891226402};
  static const double weights[3] = {0.11268792571801585080, 0.073493043116361949544,
                                    0.042546020777081466438};
  const double on_edge = 0.045503704125649649492;
  int kind = i / 4;
  *weight = weights[kind < 2 ? kind : 2];
  for (int a = 0; a < 4; a++) at[a] = kind < 2 ? at_corner[kind] : on_edge;
  if (kind < 2) {
    at[i % 4] = 1 - 3 * at_corner[kind];
  } else {
    at[corot_tet_edge[i - 8][0]] = at[corot_tet_edge[i - 8][1]] = 0.5 - on_edge;
  }
}

/* Derivatives of a nodal field by the volume coordinates 1, 2, 3 of a tet, at 0 = 1 - their sum:
   slope[j][i] of component i. */
static void slopes_of(const corot_mesh *mesh, const double (*field)[3], int tet, const double at[4],
                      double slope[3][3]) {
  double by[4][3];
  if (mesh->mid)
    corot_curved_slopes(field, mesh->tet[tet], mesh->mid[tet], at, by);
  else
    for (int a = 0; a < 4; a++) memcpy(by[a], field[mesh->tet[tet][a]], sizeof by[a]);
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 3; i++) slope[j][i] = by[j + 1][i] - by[0][i];
}

/* H = grad of the field, from its derivatives and those of the places, X. */
static void nodal_gradient(const double X[3][3], const double slope[3][3], double H[3][3]) {
  double cofactor[3][3];
  for (int j = 0; j < 3; j++) {
    const double *a = X[(j + 1) % 3], *b = X[(j + 2) % 3];
    for (int c = 0; c < 3; c++)
      cofactor[j][c] = a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3];
  }
  double det = X[0][0] * cofactor[0][0] + X[0][1] * cofactor[0][1] + X[0][2] * cofactor[0][2];
  for (int i = 0; i < 3; i++)
    for (int c = 0; c < 3; c++)
      H[i][c] = (slope[0][i] * cofactor[0][c] + slope[1][i] * cofactor[1][c] +
                 slope[2][i] * cofactor[2][c]) /
                det;
}

/* e = sym(G + part H'G). */
static void tensor_of(const double H[3][3], const double G[3][3], double part, double e[6]) {
  static const int ij[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  for (int k = 0; k < 6; k++) {
    int i = ij[k][0], j = ij[k][1];
    double twice = G[i][j] + G[j][i];
    for (int c = 0; c < 3; c++) twice += part * (H[c][i] * G[c][j] + G[c][i] * H[c][j]);
    e[k] = 0.5 * twice;
  }
}

/* Of the state Green's strain sym(H) + H'H / 2, H = grad u; of the dual its change sym(G) +
   sym(H'G), G = grad z; e [2]. */
static void strains_at(const indication *s, int tet, const double at[4], double (*e)[6]) {
  const corot_mesh *mesh = corot_model_mesh(s->model);
  double X[3][3], slope[3][3], H[3][3], G[3][3];
  slopes_of(mesh, (const double(*)[3])mesh->x, tet, at, X);
  slopes_of(mesh, (const double(*)[3])s->u, tet, at, slope);
  nodal_gradient((const double(*)[3])X, (const double(*)[3])slope, H);
  tensor_of((const double(*)[3])H, (const double(*)[3])H, s->linear ? 0 : 0.5, e[0]);
  if (!s->goal) return;
  slopes_of(mesh, (const double(*)[3])s->z, tet, at, slope);
  nodal_gradient((const double(*)[3])X, (const double(*)[3])slope, G);
  tensor_of((const double(*)[3])H, (const double(*)[3])G, s->linear ? 0 : 1, e[1]);
}

/* Sums over a tet. */
typedef struct sums {
  double apart[3]; /* of both differences and of their product */
  double whole;    /* of the strain itself */
} sums;

static sums compare(const indication *s, int tet) {
  const solid *body = solid_of(s->model);
  const material *mat = &s->model->material[s->of_tet[tet]];
  bool deviator = body->dilatation.npool > 0;
  double volume = corot_mesh_volume_of(s->patches.mesh, tet);
  sums sum = {{0}, 0};
  for (int i = 0; i < NRULE; i++) {
    double at[4], weight, apart[PATCH_COLUMNS] = {0}, e[2][6];
    rule_point(i, at, &weight);
    weight *= volume;
    corot_patches_value(&s->patches, tet, at, apart);
    strains_at(s, tet, at, e);
    sum.whole += weight * energy_of(mat, deviator, e[0], e[0]);
    for (int k = 0; k < s->patches.ncolumn; k++) apart[k] -= e[k / 6][k % 6];
    sum.apart[0] += weight * energy_of(mat, deviator, apart, apart);
    sum.apart[1] += weight * energy_of(mat, deviator, apart + 6, apart + 6);
    sum.apart[2] += weight * energy_of(mat, deviator, apart, apart + 6);
  }
  return sum;
}

/* What double precision leaves of differences of displacements, in the strain of a tet: a hundred
   times as much. */
static double rounding_of(const indication *s, int tet) {
  double volume = corot_mesh_volume_of(s->patches.mesh, tet);
  double e = 100 * DBL_EPSILON * s->moved / cbrt(volume);
  return volume * 2 * s->model->material[s->of_tet[tet]].mu * e * e;
}

static void find_indicators(indication *s, double *indicator) {
  corot_space_total *total = &s->total;
  double whole = 0, rounding = 0;
  for (int m = 0; m < s->model->nmaterial; m++) {
    corot_patches_fit(&s->patches, m);
    for (int e = 0; e < s->patches.mesh->ntet; e++) {
      if (s->of_tet[e] != m) continue;
      sums of = compare(s, e);
      indicator[e] = s->goal ? sqrt(of.apart[0] * of.apart[1]) : 0.5 * of.apart[0];
      total->energy += 0.5 * of.apart[0], whole += 0.5 * of.whole;
      total->goal += of.apart[2];
      total->bound += s->goal ? indicator[e] : 0;
      rounding += rounding_of(s, e);
    }
  }
  total->relative = whole > rounding ? sqrt(total->energy / (total->energy + whole)) : 0;
}

/* --- All of it --- */

static corot_status allocate(indication *s) {
  const corot_mesh *mesh = corot_model_mesh(s->model);
  int npoint = mesh->ntet * points_in_tet(mesh), n = corot_model_ndof(s->model);
  COROT_TRY(COROT_ALLOC(s->of_tet, mesh->ntet));
  COROT_TRY(COROT_ALLOC(s->u, mesh->nnode));
  COROT_TRY(COROT_ALLOC(s->x, mesh->nnode));
  COROT_TRY(COROT_ALLOC(s->strain[0], npoint));
  if (!s->goal) return COROT_OK;
  COROT_TRY(COROT_ALLOC(s->strain[1], npoint));
  COROT_TRY(COROT_ALLOC(s->z, mesh->nnode));
  COROT_TRY(COROT_ALLOC(s->dual, n));
  return COROT_ALLOC(s->load, n);
}

/* Where the nodes are, and how far that is from rest. */
static void find_places(indication *s) {
  const corot_mesh *mesh = corot_model_mesh(s->model);
  instant now = corot_state_at(s->state, s->at->t);
  corot_model_displacement(s->model, &now, s->at->u, s->u[0], 3);
  for (int i = 0; i < mesh->nnode; i++)
    for (int c = 0; c < 3; c++) {
      s->moved = fmax(s->moved, fabs(s->u[i][c]));
      s->x[i][c] = mesh->x[i][c] + s->u[i][c];
    }
}

static void find_materials(indication *s) {
  const element_set *set = &solid_of(s->model)->elements;
  for (int b = 0; b < set->nblock; b++)
    for (int l = 0; l < set->block[b].n; l++)
      s->of_tet[set->number[b * W + l]] = set->block[b].material;
}

/* At the points that patches are fitted to. */
static void find_strains(indication *s) {
  const corot_mesh *mesh = corot_model_mesh(s->model);
  int npoint = points_in_tet(mesh);
  for (int i = 0; i < npoint * mesh->ntet; i++) {
    double at[4], e[2][6];
    corot_patch_point(mesh, i % npoint, at);
    strains_at(s, i / npoint, at, e);
    for (int f = 0; f < 2 && s->strain[f]; f++) memcpy(s->strain[f][i], e[f], sizeof e[f]);
  }
}

static corot_status indicate(indication *s, const corot_linear_def *linear, double *indicator) {
  COROT_TRY(allocate(s));
  COROT_TRY(corot_state_create(s->model, &s->state));
  corot_space_enter(s->at, s->state);
  find_places(s);
  find_materials(s);
  if (s->goal) {
    COROT_TRY(corot_rigid_modes_create(s->model, (const double(*)[3])s->x, &s->modes));
    COROT_TRY(find_dual(s, linear));
    corot_model_spread(s->model, s->dual, s->z[0], 3);
  }
  find_strains(s);
  s->patches = (patches){.mesh = corot_model_mesh(s->model), .of_tet = s->of_tet};
  s->patches.nfield = s->goal ? 2 : 1;
  for (int f = 0; f < 2; f++) s->patches.field[f] = (const double(*)[6])s->strain[f];
  COROT_TRY(corot_patches_create(&s->patches));
  find_indicators(s, indicator);
  if (isfinite(s->total.energy) && isfinite(s->total.bound)) return COROT_OK;
  return corot_fail(COROT_RETRY, "space indicators: the strain, or its dual, is not finite");
}

corot_status corot_space_indicators(const corot_model *model, const corot_space_moment *at,
                                    const double *goal, const corot_linear_def *linear,
                                    double *indicator, corot_space_total *total) {
  COROT_TRY(COROT_GIVEN(model));
  COROT_TRY(COROT_GIVEN(at));
  COROT_TRY(COROT_GIVEN(indicator));
  if (!at->u) return corot_fail(COROT_EINVAL, "space indicators: the state has no u");
  if (model->system.nterm > 1)
    return corot_fail(COROT_EINVAL, "space indicators: not of a hierarchy of two strain measures");
  indication s = {.model = model, .at = at, .goal = goal};
  s.linear = corot_system_is_linear(&model->system);
  corot_status status = indicate(&s, linear, indicator);
  if (!status && total) *total = s.total;
  corot_rigid_modes_clear(&s.modes);
  corot_patches_clear(&s.patches);
  corot_state_destroy(s.state);
  free(s.of_tet), free(s.u), free(s.z), free(s.x), free(s.dual), free(s.load);
  free(s.strain[0]), free(s.strain[1]);
  return status;
}

/* Paths: supports on polynomials in time that come in while a run goes on. */
#include <stdlib.h>
#include <string.h>

#include "definition.h"
#include "inputs.h"

static bool is_held(const corot_model *m, int node) {
  return m->dof[node][0] < 0 || m->dof[node][1] < 0 || m->dof[node][2] < 0;
}

/* A path for each node of which something is held, not in use yet, and room for what is where. */
corot_status corot_paths_reserve(corot_inputs *in) {
  const corot_model *m = in->model;
  size_t nnode = m->mesh->nnode;
  if (in->path) return COROT_OK;
  int nheld = 0;
  for (size_t n = 0; n < nnode; n++) nheld += is_held(m, (int)n);
  for (int k = 0; k < 3; k++)
    if (!in->law[k]) in->law[k] = malloc(nnode * sizeof **in->law);
  node_path *path = calloc((size_t)nheld + 1, sizeof *path);
  if (!path || !in->law[0] || !in->law[1] || !in->law[2]) {
    free(path);
    return corot_fail(COROT_ENOMEM, "no memory for the paths of %d nodes", nheld);
  }
  for (size_t n = 0; n < nnode; n++)
    if (is_held(m, (int)n)) path[in->nheld++].node = (int)n;
  in->path = path;
  in->bytes += ((size_t)nheld + 1) * sizeof *path + 3 * nnode * sizeof **in->law;
  return COROT_OK;
}

/* That of a node; NULL: nothing of it is held. */
static node_path *path_of(const corot_inputs *in, int node) {
  int low = 0, high = in->nheld;
  while (low < high) {
    int mid = (low + high) / 2;
    if (in->path[mid].node < node)
      low = mid + 1;
    else
      high = mid;
  }
  return low < in->nheld && in->path[low].node == node ? &in->path[low] : NULL;
}

/* --- Where supports are ------------------------------------------------------------------------
 */

/* The k-th derivative of the polynomial, by Horner's rule. */
static void evaluate(const node_path *p, double t, int k, double value[3]) {
  static const double factor[3][6] = {{1, 1, 1, 1, 1, 1}, {0, 1, 2, 3, 4, 5}, {0, 0, 2, 6, 12, 20}};
  double s = t - p->t;
  for (int c = 0; c < 3; c++) {
    double sum = 0;
    for (int j = 5; j >= k; j--) sum = sum * s + factor[k][j] * p->c[j][c];
    value[c] = sum;
  }
}

void corot_paths_place(const instant *now, int k, double *nodal, int stride) {
  const corot_inputs *in = now->inputs;
  for (int i = 0; i < in->nheld; i++) {
    const node_path *p = &in->path[i];
    double value[3];
    if (!p->on) continue;
    evaluate(p, now->t, k, value);
    for (int c = 0; c < 3; c++)
      if (in->model->dof[p->node][c] < 0) nodal[(size_t)p->node * stride + c] = value[c];
  }
}

/* in->law = what the supports do at an instant: by the model alone, and on their paths. */
static void find_law(corot_inputs *in, const instant *now) {
  const corot_model *m = in->model;
  for (int k = 0; k < 3; k++) memset(in->law[k], 0, m->mesh->nnode * sizeof **in->law);
  corot_motions_displace(m, now, in->law[0][0], 3);
  corot_motions_move(m, now, in->law[1][0], 3);
  corot_motions_accelerate(m, now, in->law[2][0], 3);
  for (int k = 0; k < 3 && now->inputs; k++) corot_paths_place(now, k, in->law[k][0], 3);
}

void corot_paths_drag(const instant *now, double *f) {
  corot_inputs *in = now->inputs;
  const corot_model *m = in->model;
  const pattern *p = &solid_of(m)->pattern;
  instant plain = *now;
  if (!now->moving || !m->mass_pair) return;

  /* what the paths have above the model's motions; elsewhere nothing */
  plain.inputs = NULL;
  find_law(in, &plain);
  for (int k = 1; k < 3; k++) {
    double(*own)[3] = in->law[0], (*more)[3] = in->law[k];
    memcpy(own, more, m->mesh->nnode * sizeof *own);
    corot_paths_place(now, k, more[0], 3);
    for (int n = 0; n < m->mesh->nnode; n++)
      for (int c = 0; c < 3; c++) more[n][c] -= own[n][c];
  }

  /* times the mass between them and free nodes */
  for (int b = 0; b < p->nnode; b++)
    for (int k = p->colptr[b]; k < p->colptr[b + 1]; k++) {
      double mass = m->mass_pair[k], damping = m->damping_pair ? m->damping_pair[k] : 0;
      int a = p->row[k];
      for (int c = 0; c < 3 && mass != 0; c++) {
        int i = m->dof[a][c], j = m->dof[b][c];
        if (i >= 0) f[i] -= mass * in->law[2][b][c] + damping * in->law[1][b][c];
        if (j >= 0 && a != b) f[j] -= mass * in->law[2][a][c] + damping * in->law[1][a][c];
      }
    }
}

/* --- New paths ---------------------------------------------------------------------------------
 */

/* The group of a path, some node of which is held. */
static corot_status find_group(const corot_inputs *in, const char *name,
                               const corot_group **group) {
  *group = name ? corot_mesh_find_group(in->model->mesh, name) : NULL;
  if (!*group)
    return corot_fail(COROT_EINVAL, "inputs: there is no group '%s' for a path", name ? name : "");
  for (int i = 0; i < (*group)->nnode; i++)
    if (is_held(in->model, (*group)->node[i])) return COROT_OK;
  return corot_fail(COROT_EINVAL, "inputs: the model holds nothing of group '%s': no path for it",
                    name);
}

static corot_status check(const corot_inputs *in, const corot_path *path,
                          const corot_group **group) {
  const double(*const field[])[3] = {path->x, path->v, path->a};
  const char *const what[] = {"displacement", "velocity", "acceleration"};
  COROT_TRY(find_group(in, path->group, group));
  if (path->n != 1 && path->n != (*group)->nnode)
    return corot_fail(COROT_EINVAL, "inputs: a path of %d rows, but group '%s' has %d nodes",
                      path->n, path->group, (*group)->nnode);
  if (!path->x || !isfinite(path->t))
    return corot_fail(COROT_EINVAL, "inputs: the path of group '%s' has no %s", path->group,
                      path->x ? "time" : "displacement");
  for (int k = 0; k < 3; k++)
    if (field[k]) COROT_TRY(corot_inputs_check(what[k], "row", path->n, field[k]));
  return COROT_OK;
}

/* Whether a node of the group would jump to x at t from where it is by in->law. */
static corot_status check_jump(const corot_inputs *in, const corot_group *group, int node, double t,
                               const double x[3]) {
  const corot_model *m = in->model;
  for (int c = 0; c < 3; c++) {
    double off = x[c] - in->law[0][node][c];
    if (m->dof[node][c] < 0 && !(fabs(off) <= 1e-6 * m->length))
      return corot_fail(COROT_EINVAL,
                        "inputs: the path of group '%s' jumps by %g m in %c at node %d, t = %g s: "
                        "let it take a time",
                        group->name, off, "xyz"[c], node, t);
  }
  return COROT_OK;
}

/* What the supports do at t, by the law in force so far. */
static void find_present(corot_inputs *in, double t) {
  const instant now = {
      .t = t, .load_t = t, .load_factor = 1, .side = NAN, .moving = true, .inputs = in};
  find_law(in, &now);
}

/* Takes the way of a group's i-th node in use. */
static node_path *take(corot_inputs *in, const corot_group *group, int i, double t) {
  node_path *p = path_of(in, group->node[i]);
  if (!p) return NULL;
  in->npath += !p->on;
  *p = (node_path){.node = p->node, .on = true, .t = t};
  return p;
}

static void start(corot_inputs *in, const corot_path *path, const corot_group *group) {
  for (int i = 0; i < group->nnode; i++) {
    node_path *p = take(in, group, i, path->t);
    int row = path->n == 1 ? 0 : i;
    for (int c = 0; p && c < 3; c++) {
      p->c[0][c] = path->x[row][c];
      p->c[1][c] = path->v ? path->v[row][c] : 0;
      p->c[2][c] = path->a ? 0.5 * path->a[row][c] : 0;
    }
  }
  in->paths++;
}

corot_status corot_inputs_start_path(corot_inputs *in, const corot_path *path) {
  const corot_group *group;
  COROT_TRY(COROT_GIVEN_AS(in, "inputs"));
  COROT_TRY(COROT_GIVEN(path));
  COROT_TRY(check(in, path, &group));
  COROT_TRY(corot_paths_reserve(in));
  start(in, path, group);
  return COROT_OK;
}

corot_status corot_inputs_set_path(corot_inputs *in, const corot_path *path) {
  const corot_group *group;
  COROT_TRY(COROT_GIVEN_AS(in, "inputs"));
  COROT_TRY(COROT_GIVEN(path));
  COROT_TRY(check(in, path, &group));
  COROT_TRY(corot_paths_reserve(in));
  find_present(in, path->t);
  for (int i = 0; i < group->nnode; i++)
    COROT_TRY(check_jump(in, group, group->node[i], path->t, path->x[path->n == 1 ? 0 : i]));
  start(in, path, group);
  return COROT_OK;
}

/* Coefficients of the polynomial in s that begins with x0, v0, a0 at 0 and ends with x1 at h, with
   v1 if there is one, and with a1 if there is: in s / h, Hermite's. */
static void join(double h, double x0, double v0, double a0, double x1, const double *v1,
                 const double *a1, double c[6]) {
  double d = x1 - x0, p = h * v0, q = v1 ? h * *v1 : 0, a = 0.5 * h * h * a0;
  double b = a1 ? 0.5 * h * h * *a1 : 0;
  double w[6] = {x0, d};
  if (v1 && !a1) w[1] = p, w[2] = 3 * d - 2 * p - q, w[3] = p + q - 2 * d;
  if (v1 && a1) {
    w[1] = p, w[2] = a;
    w[3] = 10 * d - 6 * p - 4 * q - 3 * a + b;
    w[4] = -15 * d + 8 * p + 7 * q + 3 * a - 2 * b;
    w[5] = 6 * d - 3 * p - 3 * q - a + b;
  }
  for (int k = 0; k < 6; k++) c[k] = w[k] / pow(h, k);
}

corot_status corot_inputs_reach(corot_inputs *in, double t0, const corot_path *path) {
  const corot_group *group;
  COROT_TRY(COROT_GIVEN_AS(in, "inputs"));
  COROT_TRY(COROT_GIVEN(path));
  double h = path->t - t0;
  COROT_TRY(check(in, path, &group));
  if (!(h > 0 && isfinite(h)))
    return corot_fail(COROT_EINVAL, "inputs: a window from t = %g to t = %g s has no length", t0,
                      path->t);
  if (path->a && !path->v)
    return corot_fail(COROT_EINVAL, "inputs: a path to reach has an acceleration, but no velocity");
  COROT_TRY(corot_paths_reserve(in));
  find_present(in, t0);
  for (int i = 0; i < group->nnode; i++) {
    node_path *p = take(in, group, i, t0);
    int row = path->n == 1 ? 0 : i;
    for (int c = 0; p && c < 3; c++) {
      double w[6];
      join(h, in->law[0][p->node][c], in->law[1][p->node][c], in->law[2][p->node][c],
           path->x[row][c], path->v ? &path->v[row][c] : NULL, path->a ? &path->a[row][c] : NULL,
           w);
      for (int k = 0; k < 6; k++) p->c[k][c] = w[k];
    }
  }
  in->paths++;
  return COROT_OK;
}

corot_status corot_inputs_release(corot_inputs *in, const char *name, double t) {
  const instant now = {.t = t, .load_t = t, .load_factor = 1, .side = NAN, .moving = true};
  const corot_group *group;
  COROT_TRY(COROT_GIVEN_AS(in, "inputs"));
  COROT_TRY(COROT_GIVEN(name));
  COROT_TRY(find_group(in, name, &group));
  if (in->npath == 0) return COROT_OK;
  find_present(in, t);
  double(*back)[3] = in->law[1]; /* where the model has them */
  memset(back, 0, in->model->mesh->nnode * sizeof *back);
  corot_motions_displace(in->model, &now, back[0], 3);
  for (int i = 0; i < group->nnode; i++)
    COROT_TRY(check_jump(in, group, group->node[i], t, back[group->node[i]]));
  for (int i = 0; i < group->nnode; i++) {
    node_path *p = path_of(in, group->node[i]);
    if (!p || !p->on) continue;
    p->on = false;
    in->npath--;
  }
  in->paths++;
  return COROT_OK;
}

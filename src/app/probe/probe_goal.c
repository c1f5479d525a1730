/* The derivative of a column by the displacement, where few nodes have a part in it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/probe_location.h"
#include "probe.h"
#include "probe_parts.h"

/* Of differences, as a part of a tet's edge: strains of that size are far above what rounding
   leaves of them, and below those that matter. */
#define STEP 1e-8

static corot_status no_room(void) { return corot_fail(COROT_ENOMEM, "the probes: out of memory"); }

static bool is_extreme(const probe *p) {
  return p->def->take == TAKE_MAX || p->def->take == TAKE_MIN;
}

/* --- Vectors at nodes --- */

/* The vector that a probe of nodes has at one. */
static const double *vector_at(const probes *all, const probe *p, const probe_moment *now, int n) {
  if (p->def->of == PROBE_DISPLACEMENT) return now->displacement[n];
  const probe_fields *f = &all->fields;
  return p->def->of == PROBE_VELOCITY ? f->velocity[n] : f->acceleration[n];
}

/* Which of the nodes of a probe is number i, and its weight in column c: an extreme has one node.
 */
static double node_of(const probe *p, int c, int i, int *node) {
  const samples *s = &p->samples;
  *node = s->row ? s->row[i] : i;
  if (is_extreme(p)) return p->where[c].known && p->where[c].node == *node;
  if (s->weight) return s->weight[i];
  return p->def->take == TAKE_MEAN && !probe_is_local(p->def) ? 1.0 / s->n : 1;
}

/* How the column goes with the vector at one of the nodes: a length along it. */
static void direction_of(const probes *all, const probe *p, const probe_moment *now, int c,
                         int node, double direction[3]) {
  int component = p->def->component;
  int axis = component ? component - COMPONENT_VECTOR : c;
  const double *x = vector_at(all, p, now, node);
  double length = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
  for (int k = 0; k < 3; k++)
    if (component == COMPONENT_MAGNITUDE)
      direction[k] = length > 0 ? x[k] / length : 0;
    else
      direction[k] = k == axis;
}

static void weigh_nodes(const probes *all, const probe *p, const probe_moment *now, int c,
                        double *goal) {
  const int(*dof)[3] = corot_model_dof(all->model);
  for (int i = 0; i < p->samples.n; i++) {
    int node;
    double direction[3], weight = node_of(p, c, i, &node);
    if (weight == 0) continue;
    direction_of(all, p, now, c, node, direction);
    for (int k = 0; k < 3; k++)
      if (dof[node][k] >= 0) goal[dof[node][k]] += weight * direction[k];
  }
}

/* --- Fields of tets, by differences --- */

static int compare_ints(const void *a, const void *b) {
  int i = *(const int *)a, j = *(const int *)b;
  return (i > j) - (i < j);
}

/* The nodes of the tets that a column is of, ascending; room for all of them. */
static int list_nodes(const corot_mesh *mesh, const probe *p, int c, int *node) {
  int n = 0, count = 0, ntet = is_extreme(p) ? 1 : p->samples.n;
  for (int i = 0; i < ntet; i++) {
    int e = is_extreme(p) ? p->where[c].tet : p->samples.place[i].tet;
    for (int k = 0; k < 4; k++) node[n++] = mesh->tet[e][k];
    for (int k = 0; k < 6 && mesh->mid; k++) node[n++] = mesh->mid[e][k];
  }
  qsort(node, (size_t)n, sizeof *node, compare_ints);
  for (int i = 0; i < n; i++)
    if (i == 0 || node[i] != node[i - 1]) node[count++] = node[i];
  return count;
}

/* The column of a body that is a little off. Places have fields of their own. */
static corot_status value_at(probes *all, probe *p, const probe_moment *moved, int c,
                             double *value) {
  double its[6];
  if (!p->samples.place) COROT_TRY(probe_fields_find(&all->fields, moved));
  COROT_TRY(probe_value(p, &all->fields, moved, its));
  *value = its[c];
  return COROT_OK;
}

static corot_status differentiate(probes *all, probe *p, const probe_moment *now, int c, int n,
                                  const int *node, double *u, double *goal) {
  const corot_mesh *mesh = corot_model_mesh(all->model);
  const int(*dof)[3] = corot_model_dof(all->model);
  probe_moment moved = *now;
  moved.u = u;
  double edge = 0;
  for (int k = 0; k < 3; k++) edge = fmax(edge, fabs(mesh->x[node[1]][k] - mesh->x[node[0]][k]));
  for (int i = 0; i < 3 * n; i++) {
    int d = dof[node[i / 3]][i % 3];
    if (d < 0) continue;
    double at = u[d], h = STEP * edge, value[2] = {0}, to[2] = {at + h, at - h};
    for (int side = 0; side < 2; side++) {
      u[d] = to[side];
      COROT_TRY(value_at(all, p, &moved, c, &value[side]));
    }
    u[d] = at;
    goal[d] = (value[0] - value[1]) / (to[0] - to[1]);
  }
  /* fields and places as they were */
  return value_at(all, p, now, c, &(double){0});
}

static corot_status weigh_tets(probes *all, probe *p, const probe_moment *now, int c,
                               double *goal) {
  const corot_mesh *mesh = corot_model_mesh(all->model);
  size_t n = (size_t)corot_model_ndof(all->model);
  int *node = malloc(((size_t)p->samples.n + 1) * 10 * sizeof *node);
  double *u = malloc((n + 1) * sizeof *u);
  corot_status status = node && u ? COROT_OK : no_room();
  if (!status) {
    memcpy(u, now->u, n * sizeof *u);
    status = differentiate(all, p, now, c, list_nodes(mesh, p, c, node), node, u, goal);
  }
  free(node);
  free(u);
  return status;
}

/* --- Any column --- */

corot_status probes_goal(probes *all, const probe_moment *now, int i, double *goal, bool *known) {
  int k = 0;
  while (i >= all->probe[k].first + all->probe[k].n) k++;
  probe *p = &all->probe[k];
  int c = i - p->first;
  probe_carrier carrier = p->quantity->carrier;
  memset(goal, 0, (size_t)corot_model_ndof(all->model) * sizeof *goal);
  bool few = probe_is_local(p->def) || (is_extreme(p) && p->where[c].known);
  if (carrier == OF_NODES)
    weigh_nodes(all, p, now, c, goal);
  else if (carrier == OF_TETS && few)
    COROT_TRY(weigh_tets(all, p, now, c, goal));
  *known = carrier == OF_NODES || (carrier == OF_TETS && few);
  return COROT_OK;
}

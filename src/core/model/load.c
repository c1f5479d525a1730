/* Loads: constant forces and pressures that follow the surface, each with an amplitude in time. */
#include <stdlib.h>

#include "core/base/fault.h"
#include "definition.h"
#include "inputs.h"

static void add_force(const corot_model *m, double *force, int node, const double value[3],
                      double factor) {
  for (int c = 0; c < 3; c++)
    if (m->dof[node][c] >= 0) force[m->dof[node][c]] += factor * value[c];
}

/* The faces that load k acts on. */
static corot_status find_faces(const corot_model *m, const corot_load *from, int k,
                               const corot_group **group) {
  COROT_TRY(corot_definition_group(m->mesh, "load", k, from->group, group));
  if ((*group)->ntri) return COROT_OK;
  return corot_fail_at("load", k, "group",
                       "group '%s' has no faces for a %s to act on (%d nodes, %d tets)",
                       from->group, from->kind == COROT_PRESSURE ? "pressure" : "traction",
                       (*group)->nnode, (*group)->ntet);
}

/* Half the cross product of two tangents: the area, along the normal of the winding. */
static void area_vector(const double a[3], const double b[3], double area[3]) {
  area[0] = 0.5 * (a[1] * b[2] - a[2] * b[1]);
  area[1] = 0.5 * (a[2] * b[0] - a[0] * b[2]);
  area[2] = 0.5 * (a[0] * b[1] - a[1] * b[0]);
}

static const face_kind *faces_of(const corot_model *m) {
  return face_kind_of(solid_of(m)->elements.kind->order);
}

/* Tangents of a face at point q, along which the coordinates of corners 1 and 2 grow: of the rest
   mesh if u is NULL. */
static void tangents(const corot_model *m, const double (*u)[4], const int *n, int q, double a[3],
                     double b[3]) {
  const double(*x)[3] = (const double(*)[3])m->mesh->x;
  const face_kind *kind = faces_of(m);
  for (int c = 0; c < 3; c++) {
    a[c] = b[c] = 0;
    for (int i = 1; i < kind->nnode; i++) {
      double d = x[n[i]][c] - x[n[0]][c] + (u ? u[n[i]][c] - u[n[0]][c] : 0);
      a[c] += kind->slope[q][i - 1][0] * d;
      b[c] += kind->slope[q][i - 1][1] * d;
    }
  }
}

/* Their change with u. */
static void change_of_tangents(const corot_model *m, const double (*du)[4], const int *n, int q,
                               double da[3], double db[3]) {
  const face_kind *kind = faces_of(m);
  for (int c = 0; c < 3; c++) {
    da[c] = db[c] = 0;
    for (int i = 1; i < kind->nnode; i++) {
      double d = du[n[i]][c] - du[n[0]][c];
      da[c] += kind->slope[q][i - 1][0] * d;
      db[c] += kind->slope[q][i - 1][1] * d;
    }
  }
}

/* The nodes of triangles, those on their edges too; the caller frees. */
static corot_status list_faces(const corot_model *m, const corot_group *group,
                               int (**face)[FACE_NODES]) {
  if (m->mesh->mid)
    return corot_mesh_face_nodes(m->mesh, group->ntri, (const int(*)[3])group->tri, face);
  *face = calloc(group->ntri, sizeof **face);
  if (!*face) return corot_fail(COROT_ENOMEM, "no memory for %d faces", group->ntri);
  for (int k = 0; k < group->ntri; k++) memcpy((*face)[k], group->tri[k], sizeof group->tri[k]);
  return COROT_OK;
}

/* Of each face's traction its nodes' shares. */
static corot_status add_traction(const corot_model *m, const corot_load *from, int number,
                                 double (*f)[3]) {
  const corot_group *group;
  const face_kind *kind = faces_of(m);
  int(*face)[FACE_NODES];
  COROT_TRY(find_faces(m, from, number, &group));
  COROT_TRY(list_faces(m, group, &face));
  for (int k = 0; k < group->ntri; k++)
    for (int q = 0; q < kind->npoint; q++) {
      double a[3], b[3], area[3];
      tangents(m, NULL, face[k], q, a, b);
      area_vector(a, b, area);
      double size = sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
      for (int i = 0; i < kind->nnode; i++) {
        double part = size * kind->part[q] * kind->share[q][i] / kind->over;
        for (int c = 0; c < 3; c++) f[face[k][i]][c] += part * from->value[c];
      }
    }
  free(face);
  return COROT_OK;
}

static corot_status add_point_force(const corot_model *m, const corot_load *from, int number,
                                    double (*f)[3]) {
  const corot_group *group;
  COROT_TRY(corot_definition_nodes(m->mesh, "load", number, from->group, &group));
  for (int i = 0; i < group->nnode; i++)
    for (int c = 0; c < 3; c++) f[group->node[i]][c] += 1.0 / group->nnode * from->value[c];
  return COROT_OK;
}

/* Masses in the first column become weights. */
static void weigh(int nnode, const double gravity[3], double (*f)[3]) {
  for (int n = 0; n < nnode; n++) {
    double mass = f[n][0];
    for (int c = 0; c < 3; c++) f[n][c] = mass * gravity[c];
  }
}

/* What of f [nnode] falls on held components. */
static corot_status keep_held(const corot_model *m, const double (*f)[3], load *to) {
  int nnode = m->mesh->nnode, n = 0;
  for (int i = 0; i < 3 * nnode; i++) n += m->dof[i / 3][i % 3] < 0 && f[i / 3][i % 3] != 0;
  to->held = malloc((n + 1) * sizeof *to->held);
  if (!to->held) return corot_fail(COROT_ENOMEM, "no memory for the forces on %d supports", n);
  for (int i = 0; i < 3 * nnode; i++)
    if (m->dof[i / 3][i % 3] < 0 && f[i / 3][i % 3] != 0)
      to->held[to->nheld++] = (held_force){i / 3, i % 3, f[i / 3][i % 3]};
  return COROT_OK;
}

/* Gravity, a traction or a total force. */
static corot_status add_constant(const corot_model_def *def, const corot_model *m, int number,
                                 load *to) {
  const corot_load *from = &def->load[number];
  int nnode = m->mesh->nnode;
  double(*f)[3] = calloc(nnode, sizeof *f);
  if (!f) return corot_fail(COROT_ENOMEM, "no memory for the forces on %d nodes", nnode);
  corot_status status = COROT_OK;
  if (from->kind == COROT_TRACTION)
    status = add_traction(m, from, number, f);
  else if (from->kind == COROT_FORCE)
    status = add_point_force(m, from, number, f);
  else
    status = corot_mass_sum_rows(m, f);
  if (!status) status = corot_model_restrict(def, nnode, f);
  if (!status && from->kind == COROT_GRAVITY) weigh(nnode, from->value, f);
  for (int n = 0; !status && n < nnode; n++) add_force(m, to->force, n, f[n], 1);
  if (!status) status = keep_held(m, (const double(*)[3])f, to);
  free(f);
  return status;
}

static corot_status add_pressure(const corot_model *m, const corot_load *from, int number,
                                 load *to) {
  const corot_group *group;
  COROT_TRY(find_faces(m, from, number, &group));
  COROT_TRY(list_faces(m, group, &to->face));
  to->nface = group->ntri;
  to->pressure = from->value[0];
  return COROT_OK;
}

corot_status corot_load_check(const corot_model_def *def, int k) {
  const corot_load *from = &def->load[k];
  amplitude made;
  if ((unsigned)from->kind > COROT_PRESSURE)
    return corot_fail_at("load", k, "kind", "no kind of load has the number %d", (int)from->kind);
  for (int c = 0; c < 3; c++)
    if (!isfinite(from->value[c]))
      return corot_fail_at("load", k, "value", "component %d is not finite", c);
  COROT_TRY(corot_amplitude_create(&from->amplitude, "load", k, &made));
  corot_amplitude_clear(&made);
  return COROT_OK;
}

static corot_status create(const corot_model_def *def, const corot_model *m, int k, load *to) {
  const corot_load *from = &def->load[k];
  COROT_TRY(corot_amplitude_create(&from->amplitude, "load", k, &to->amplitude));
  if (from->kind == COROT_PRESSURE) return add_pressure(m, from, k, to);
  to->force = calloc(m->ndof, sizeof *to->force);
  if (!to->force) return corot_fail(COROT_ENOMEM, "no memory for load %d", k);
  return add_constant(def, m, k, to);
}

corot_status corot_loads_create(const corot_model_def *def, corot_model *m) {
  m->load = calloc(def->nload + 1, sizeof *m->load);
  if (!m->load) return corot_fail(COROT_ENOMEM, "no memory for %d loads", def->nload);
  m->nload = def->nload;
  for (int k = 0; k < def->nload; k++) COROT_TRY(create(def, m, k, &m->load[k]));
  return COROT_OK;
}

void corot_loads_destroy(corot_model *m) {
  for (int k = 0; k < m->nload; k++) {
    free(m->load[k].force);
    free(m->load[k].held);
    free(m->load[k].face);
    corot_amplitude_clear(&m->load[k].amplitude);
  }
  free(m->load);
}

static double factor_of(const corot_model *m, int k, const instant *now) {
  double factor =
      now->load_factor * corot_amplitude_at(&m->load[k].amplitude, now->side, now->load_t);
  return now->inputs ? factor * corot_inputs_load(now, k) : factor;
}

/* The area vector at a point of a face where u has taken it [m^2]. */
static void find_area(const corot_model *m, const double (*u)[4], const int *face, int q,
                      double area[3]) {
  double a[3], b[3];
  tangents(m, u, face, q, a, b);
  area_vector(a, b, area);
}

/* What of a pressure, times `factor`, falls on node i for an area at point q. */
static double pressure_share(const load *l, const face_kind *kind, int q, int i, double factor) {
  return -factor * l->pressure * kind->part[q] * kind->share[q][i] / kind->over;
}

void corot_loads_force(const corot_model *m, const instant *now, const double (*u)[4], double *f) {
  const face_kind *kind = faces_of(m);
  memset(f, 0, m->ndof * sizeof *f);
  for (int k = 0; k < m->nload; k++) {
    const load *l = &m->load[k];
    double factor = factor_of(m, k, now);
    if (factor == 0) continue;
    if (l->force)
      for (int i = 0; i < m->ndof; i++) f[i] += factor * l->force[i];
    for (int j = 0; j < l->nface; j++)
      for (int q = 0; q < kind->npoint; q++) {
        double area[3];
        find_area(m, u, l->face[j], q, area);
        for (int i = 0; i < kind->nnode; i++)
          add_force(m, f, l->face[j][i], area, pressure_share(l, kind, q, i, factor));
      }
  }
  corot_drags_apply(m, now, f);
  if (inputs_move(now)) corot_paths_drag(now, f);
  if (now->inputs) corot_inputs_add_force(m, now, f);
}

bool corot_loads_follow(const corot_model *m) {
  for (int k = 0; k < m->nload; k++)
    if (m->load[k].nface > 0) return true;
  return false;
}

static void add_to_node(double (*f)[3], int node, const double value[3], double factor) {
  for (int c = 0; c < 3; c++) f[node][c] += factor * value[c];
}

static void add_nodal_load(const corot_model *m, const load *l, double factor, const double (*u)[4],
                           double (*f)[3]) {
  const face_kind *kind = faces_of(m);
  for (int i = 0; l->force && i < 3 * m->mesh->nnode; i++)
    if (m->dof[i / 3][i % 3] >= 0) f[i / 3][i % 3] += factor * l->force[m->dof[i / 3][i % 3]];
  for (int i = 0; i < l->nheld; i++)
    f[l->held[i].node][l->held[i].component] += factor * l->held[i].force;
  for (int j = 0; j < l->nface; j++)
    for (int q = 0; q < kind->npoint; q++) {
      double area[3];
      find_area(m, u, l->face[j], q, area);
      for (int i = 0; i < kind->nnode; i++)
        add_to_node(f, l->face[j][i], area, pressure_share(l, kind, q, i, factor));
    }
}

void corot_loads_nodal(const corot_model *m, const instant *now, const double (*u)[4],
                       double (*f)[3]) {
  for (int k = 0; k < m->nload; k++) add_nodal_load(m, &m->load[k], factor_of(m, k, now), u, f);
  if (now->inputs) corot_inputs_add_nodal_force(m, now, f);
}

corot_status corot_load_force(const corot_model *m, double t, double factor,
                              const double (*displacement)[3], double (*f)[3]) {
  COROT_TRY(COROT_GIVEN_AS(m, "model"));
  COROT_TRY(COROT_GIVEN(displacement));
  COROT_TRY(COROT_GIVEN(f));
  int nnode = m->mesh->nnode;
  double(*u)[4] = calloc(nnode, sizeof *u);
  if (!u) return corot_fail(COROT_ENOMEM, "no memory for the displacement of %d nodes", nnode);
  for (int n = 0; n < nnode; n++) memcpy(u[n], displacement[n], 3 * sizeof **u);
  memset(f, 0, nnode * sizeof *f);
  const instant now = {.side = NAN, .load_t = t, .load_factor = factor}; /* as in statics */
  corot_loads_nodal(m, &now, (const double(*)[4])u, f);
  free(u);
  return COROT_OK;
}

void corot_loads_derivative(const corot_model *m, const instant *now, const double (*u)[4],
                            const double (*du)[4], double *f) {
  const face_kind *kind = faces_of(m);
  for (int k = 0; k < m->nload; k++) {
    const load *l = &m->load[k];
    double factor = factor_of(m, k, now);
    for (int at = 0; at < l->nface * kind->npoint; at++) { /* d(a x b) = da x b + a x db */
      const int *n = l->face[at / kind->npoint], q = at % kind->npoint;
      double a[3], b[3], da[3], db[3], first[3], second[3];
      tangents(m, u, n, q, a, b);
      change_of_tangents(m, du, n, q, da, db);
      area_vector(da, b, first);
      area_vector(a, db, second);
      for (int i = 0; i < kind->nnode; i++) {
        double part = pressure_share(l, kind, q, i, factor);
        add_force(m, f, n[i], first, part);
        add_force(m, f, n[i], second, part);
      }
    }
  }
}

/* K of one point of a face. Where u moves node j by e, the area a x b / 2 changes by e x w_j, and
   the force of node i by its share of that; the symmetric part between nodes i and j is e x z. */
static void add_turning(const corot_model *m, const load *l, const int *face, int q,
                        const double (*u)[4], double factor, double (*K)[9]) {
  const face_kind *kind = faces_of(m);
  double a[3], b[3], w[FACE_NODES][3], share[FACE_NODES];
  tangents(m, u, face, q, a, b);
  memset(w, 0, sizeof w);
  for (int i = 0; i < kind->nnode; i++) {
    share[i] = pressure_share(l, kind, q, i, factor);
    if (i == 0) continue;
    for (int c = 0; c < 3; c++) {
      w[i][c] = 0.5 * (kind->slope[q][i - 1][0] * b[c] - kind->slope[q][i - 1][1] * a[c]);
      w[0][c] -= w[i][c];
    }
  }
  for (int i = 0; i < kind->nnode; i++)
    for (int j = 0; j < kind->nnode; j++) {
      if (face[i] <= face[j]) continue; /* on the diagonal there is none */
      double z[3], *block = K[corot_pattern_find(&solid_of(m)->pattern, face[i], face[j])];
      for (int c = 0; c < 3; c++) z[c] = 0.5 * (share[i] * w[j][c] - share[j] * w[i][c]);
      block[1] -= z[2], block[2] += z[1], block[3] += z[2];
      block[5] -= z[0], block[6] -= z[1], block[7] += z[0];
    }
}

void corot_loads_stiffness(const corot_model *m, const instant *now, const double (*u)[4],
                           double (*K)[9]) {
  const face_kind *kind = faces_of(m);
  for (int k = 0; k < m->nload; k++) {
    const load *l = &m->load[k];
    double factor = factor_of(m, k, now);
    if (factor == 0) continue;
    for (int at = 0; at < l->nface * kind->npoint; at++)
      add_turning(m, l, l->face[at / kind->npoint], at % kind->npoint, u, factor, K);
  }
}

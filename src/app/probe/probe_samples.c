/* Where probes look: nodes, tets, faces, and the tets that meet at a point. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/element/element.h"
#include "core/mesh/mesh.h"
#include "probe_parts.h"

static corot_status no_room(void) { return corot_fail(COROT_ENOMEM, "the probes: out of memory"); }

void samples_clear(samples *s) {
  void *const all[] = {s->weight,    s->place,     s->side,         s->traction, s->at.frame,
                       s->at.strain, s->at.stress, s->at.principal, s->at.det,   s->at.von_mises};
  for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
  corot_points_destroy(s->points);
  *s = (samples){0};
}

/* --- Nodes --- */

static corot_status take_nodes(const corot_mesh *mesh, probe *p) {
  samples *s = &p->samples;
  const corot_group *group = p->def->group ? corot_mesh_find_group(mesh, p->def->group) : NULL;
  s->per = 1;
  s->stride = 3;
  s->n = group ? group->nnode : p->def->body ? mesh->nnode : p->at.nnode;
  s->row = group ? group->node : p->def->body ? NULL : p->at.node;
  if (p->def->group || p->def->body || s->n == 1) return COROT_OK;
  s->weight = malloc((size_t)s->n * sizeof *s->weight);
  if (!s->weight) return no_room();
  memcpy(s->weight, p->at.weight, (size_t)s->n * sizeof *s->weight);
  return COROT_OK;
}

/* --- Tets as a whole, or at their points of integration --- */

static corot_status take_tets(const corot_mesh *mesh, const corot_group *group, probe *p,
                              probe_fields *f) {
  samples *s = &p->samples;
  bool extreme = p->def->take == TAKE_MAX || p->def->take == TAKE_MIN;
  int ntet = group ? group->ntet : mesh->ntet;
  s->per = extreme && mesh->mid ? 4 : 1;
  s->n = s->per * ntet;
  s->row = group ? group->tet : NULL;
  s->by_volume = true;
  s->value = probe_fields_rows(f, p->def->of, s->per > 1, &s->stride);
  return s->value ? COROT_OK : no_room();
}

/* --- Places in tets --- */

/* Room for n places. */
static corot_status make_places(samples *s, int n) {
  s->per = 1;
  s->place = calloc((size_t)n + 1, sizeof *s->place);
  s->weight = calloc((size_t)n + 1, sizeof *s->weight);
  return s->place && s->weight ? COROT_OK : no_room();
}

/* The field that is asked for at the places. */
static bool make_field(samples *s, probe_of of) {
  size_t n = (size_t)s->n + 1;
  corot_point_fields *at = &s->at;
  s->stride = of == PROBE_FRAME_ANGLE ? 9 : probe_quantities[of].n;
  if (of == PROBE_TRACTION) {
    s->traction = calloc(n, sizeof *s->traction);
    at->stress = calloc(n, sizeof *at->stress);
    s->value = (const double *)s->traction;
    return s->traction && at->stress;
  }
  void *room = calloc(n * (size_t)s->stride, sizeof *s->value);
  if (of == PROBE_STRESS) at->stress = room;
  if (of == PROBE_STRAIN) at->strain = room;
  if (of == PROBE_PRINCIPAL) at->principal = room;
  if (of == PROBE_FRAME_ANGLE) at->frame = room;
  if (of == PROBE_VON_MISES) at->von_mises = room;
  if (of == PROBE_DET) at->det = room;
  s->value = room;
  return room != NULL;
}

static corot_status make_points(const corot_model *model, samples *s, probe_of of) {
  int *tet = malloc(((size_t)s->n + 1) * sizeof *tet);
  double(*at)[4] = malloc(((size_t)s->n + 1) * sizeof *at);
  corot_status status = COROT_OK;
  if (!tet || !at || !make_field(s, of)) status = no_room();
  for (int i = 0; status == COROT_OK && i < s->n; i++) {
    corot_location_weigh(corot_model_mesh(model), &s->place[i]);
    tet[i] = s->place[i].tet;
    memcpy(at[i], s->place[i].at, sizeof at[i]);
  }
  if (status == COROT_OK)
    status = corot_points_create(model, s->n, tet, (const double(*)[4])at, &s->points);
  free(tet);
  free(at);
  return status;
}

/* Where several tets meet, on a face, an edge or at a node, each has its own value. */
#define ON_FACE 1e-9

/* The volume coordinates in tet e of a place in another; whether it is in both. */
static bool carry_over(const corot_mesh *mesh, const corot_location *from, int e, double l[4]) {
  for (int a = 0; a < 4; a++) l[a] = 0;
  for (int k = 0; k < 4; k++) {
    bool has = false;
    for (int a = 0; a < 4; a++)
      if (mesh->tet[e][a] == mesh->tet[from->tet][k]) l[a] = from->at[k], has = true;
    if (!has && fabs(from->at[k]) > ON_FACE) return false;
  }
  return true;
}

static corot_status take_place(const corot_model *model, probe *p) {
  const corot_mesh *mesh = corot_model_mesh(model);
  samples *s = &p->samples;
  double l[4], sum = 0;
  int n = 0;
  for (int e = 0; e < mesh->ntet; e++) n += carry_over(mesh, &p->at, e, l);
  COROT_TRY(make_places(s, n));
  for (int e = 0; e < mesh->ntet; e++) {
    if (!carry_over(mesh, &p->at, e, l)) continue;
    s->weight[s->n] = corot_tet_volume((const double(*)[3])mesh->x, mesh->tet[e]);
    sum += s->weight[s->n];
    s->place[s->n].tet = e;
    memcpy(s->place[s->n++].at, l, sizeof l);
  }
  for (int i = 0; i < n; i++) s->weight[i] /= sum;
  return make_points(model, s, p->def->of);
}

/* --- Faces, from the tets at them --- */

static void sort_three(int v[3]) {
  for (int i = 0; i < 3; i++)
    for (int j = i + 1; j < 3; j++)
      if (v[j] < v[i]) {
        int other = v[i];
        v[i] = v[j], v[j] = other;
      }
}

static int compare_faces(const void *a, const void *b) { return corot_face_compare(a, b); }

/* Weight and volume coordinates of point q of a face: of linear tets its middle, of others three
   that integrate quadratic functions. */
static void put_on_face(const corot_mesh *mesh, int side, int q, corot_location *at,
                        double *weight) {
  const int *corner = corot_tet_face[side % 4];
  double normal[3];
  at->tet = side / 4;
  for (int k = 0; k < 3; k++) at->at[corner[k]] = !mesh->mid ? 1.0 / 3 : k == q ? 2.0 / 3 : 1.0 / 6;
  side_normal(mesh, NULL, side, at->at, normal);
  *weight = hypot(hypot(normal[0], normal[1]), normal[2]) / (mesh->mid ? 3 : 1);
}

static corot_status take_faces(const corot_model *model, const corot_group *group, probe *p) {
  const corot_mesh *mesh = corot_model_mesh(model);
  samples *s = &p->samples;
  corot_face *face;
  int per = mesh->mid ? 3 : 1;
  COROT_TRY(make_places(s, per * group->ntri));
  s->side = calloc((size_t)(per * group->ntri) + 1, sizeof *s->side);
  if (!s->side) return no_room();
  COROT_TRY(corot_faces_sort(mesh->nnode, mesh->ntet, (const int(*)[4])mesh->tet, &face));
  for (int k = 0; k < group->ntri; k++) {
    corot_face key = {.side = 0};
    memcpy(key.v, group->tri[k], sizeof key.v);
    sort_three(key.v);
    const corot_face *found =
        bsearch(&key, face, 4 * (size_t)mesh->ntet, sizeof *face, compare_faces);
    for (int q = 0; found && q < per; q++, s->n++) {
      s->side[s->n] = found->side;
      put_on_face(mesh, found->side, q, &s->place[s->n], &s->weight[s->n]);
    }
  }
  free(face);
  return make_points(model, s, p->def->of);
}

/* --- All of them --- */

corot_status samples_create(const corot_model *model, probe *p, probe_fields *f) {
  const corot_mesh *mesh = corot_model_mesh(model);
  const probe_def *def = p->def;
  const corot_group *group = def->group ? corot_mesh_find_group(mesh, def->group) : NULL;
  probe_carrier carrier = p->quantity->carrier;
  if (def->group && !group)
    return corot_fail(COROT_EINVAL, "probe %s: no group %s", def->name, def->group);
  if (carrier == OF_BODY || (def->body && def->of == PROBE_ELASTIC)) return COROT_OK;
  if (carrier == OF_NODES || carrier == SUM_OVER_NODES) return take_nodes(mesh, p);
  if (!def->group && !def->body) return take_place(model, p);
  if (carrier == OF_FACES || (carrier == OF_TETS && group && group->ntet == 0))
    return take_faces(model, group, p);
  return take_tets(mesh, group, p, f);
}

/* The place of point k of a tet, next to corner k; of several corners their middle. */
static void find_middle(const corot_mesh *mesh, int tet, int k, int per, double x[3]) {
  corot_location at = {.tet = tet};
  for (int a = 0; a < 4; a++) at.at[a] = per == 1 ? 0.25 : a == k ? TET10_A : TET10_B;
  corot_location_weigh(mesh, &at);
  memcpy(x, at.x, sizeof at.x);
}

probe_where samples_where(const probe *p, const corot_mesh *mesh, int i) {
  const samples *s = &p->samples;
  int row = s->row ? s->row[i / s->per] : i / s->per;
  probe_where where = {.known = true, .node = -1, .tet = -1};
  if (s->place) {
    where.tet = s->place[i].tet;
    memcpy(where.x, s->place[i].x, sizeof where.x);
  } else if (p->quantity->carrier == OF_NODES) {
    where.node = row;
    memcpy(where.x, mesh->x[row], sizeof where.x);
  } else {
    where.tet = row;
    find_middle(mesh, row, i % s->per, s->per, where.x);
  }
  return where;
}

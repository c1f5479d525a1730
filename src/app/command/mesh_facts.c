/* What `corot mesh info` finds in a mesh. */
#include "mesh_facts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/facts.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "core/mesh/mesh.h"

static corot_status count_corners(mesh_facts *f) {
  const corot_mesh *mesh = f->mesh;
  char *corner = calloc((size_t)mesh->nnode, 1);
  if (!corner) return no_memory();
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 4; k++) corner[mesh->tet[e][k]] = 1;
  for (int i = 0; i < mesh->nnode; i++) f->ncorner += corner[i];
  free(corner);
  return COROT_OK;
}

/* --- Parts --- */

static int root_of(int *up, int node) {
  while (up[node] != node) node = up[node] = up[up[node]];
  return node;
}

/* Each part's lowest node stands for all of its nodes. */
static void join_nodes(const corot_mesh *mesh, int *up) {
  for (int i = 0; i < mesh->nnode; i++) up[i] = i;
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < (mesh->mid ? 10 : 4); k++) {
      int a = root_of(up, mesh->tet[e][0]),
          b = root_of(up, k < 4 ? mesh->tet[e][k] : mesh->mid[e][k - 4]);
      up[a > b ? a : b] = a < b ? a : b;
    }
}

static int compare_part(const void *node, const void *part) {
  int a = *(const int *)node, b = ((const corot_part *)part)->first;
  return (a > b) - (a < b);
}

static corot_status measure_parts(mesh_facts *f) {
  COROT_TRY(corot_mesh_parts(f->mesh, &f->npart, &f->part));
  int *up = calloc((size_t)f->mesh->nnode, sizeof *up);
  f->size = calloc((size_t)f->npart, sizeof *f->size);
  if (!up || !f->size) {
    free(up);
    return no_memory();
  }
  join_nodes(f->mesh, up);
  for (int e = 0; e < f->mesh->ntet; e++) {
    int root = root_of(up, f->mesh->tet[e][0]);
    const corot_part *p = bsearch(&root, f->part, (size_t)f->npart, sizeof *f->part, compare_part);
    if (!p) continue;
    f->size[p - f->part].ntet++;
    f->size[p - f->part].volume += corot_mesh_volume_of(f->mesh, e);
  }
  free(up);
  return COROT_OK;
}

/* --- Areas --- */

void triangle_area(const corot_mesh *mesh, const int tri[3], const int *six, double vector[3],
                   double *area) {
  static const int plain[1][3] = {{0, 1, 2}},
                   halves[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  for (int i = 0; i < (six ? 4 : 1); i++) {
    const int *local = six ? halves[i] : plain[i], *node = six ? six : tri;
    const double *x = mesh->x[node[local[0]]], *y = mesh->x[node[local[1]]],
                 *z = mesh->x[node[local[2]]];
    double n[3];
    for (int k = 0; k < 3; k++) {
      int p = (k + 1) % 3, q = (k + 2) % 3;
      n[k] = ((y[p] - x[p]) * (z[q] - x[q]) - (y[q] - x[q]) * (z[p] - x[p])) / 2;
      vector[k] += n[k];
    }
    *area += sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  }
}

/* The nodes of triangles on ten-node tets; NULL on others. */
static corot_status six_nodes(const corot_mesh *mesh, int ntri, const int (*tri)[3],
                              int (**six)[6]) {
  *six = NULL;
  return mesh->mid ? corot_mesh_face_nodes(mesh, ntri, tri, six) : COROT_OK;
}

static corot_status measure_group(const corot_mesh *mesh, const corot_group *g, group_size *size) {
  const int(*tri)[3] = (const int(*)[3])g->tri;
  int(*six)[6];
  double sum[3] = {0};
  for (int i = 0; i < g->ntet; i++) size->volume += corot_mesh_volume_of(mesh, g->tet[i]);
  COROT_TRY(six_nodes(mesh, g->ntri, tri, &six));
  for (int i = 0; i < g->ntri; i++)
    triangle_area(mesh, tri[i], six ? six[i] : NULL, sum, &size->area);
  free(six);
  double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
  for (int k = 0; k < 3 && length > 1e-6 * size->area; k++) {
    size->normal[k] = sum[k] / length;
    if (fabs(size->normal[k]) < 1e-12) size->normal[k] = 0; /* rounding */
  }
  return COROT_OK;
}

static corot_status measure_groups(mesh_facts *f) {
  f->group = calloc((size_t)f->mesh->ngroup + 1, sizeof *f->group);
  if (!f->group) return no_memory();
  for (int i = 0; i < f->mesh->ngroup; i++)
    COROT_TRY(measure_group(f->mesh, &f->mesh->group[i], &f->group[i]));
  return COROT_OK;
}

/* --- Thickness --- */

typedef struct share {
  double ntet, area;
} share;

static int compare_shares(const void *a, const void *b) {
  double p = ((const share *)a)->ntet, q = ((const share *)b)->ntet;
  return (p > q) - (p < q);
}

/* Of n ways, by the areas that they begin at. */
static void sum_up(mesh_facts *f, int n, share *s) {
  double all = 0, thin = 0, below = 0;
  qsort(s, (size_t)n, sizeof *s, compare_shares);
  for (int i = 0; i < n; i++) {
    all += s[i].area;
    if (s[i].ntet < 2 - 1e-9) thin += s[i].area;
  }
  for (int i = 0; i < n && below < all / 2; i++) {
    below += s[i].area;
    f->through_median = s[i].ntet;
  }
  if (n > 0) f->through_min = s[0].ntet;
  if (all > 0) f->through_thin = thin / all;
}

static corot_status measure_thickness(mesh_facts *f) {
  const int(*tri)[3];
  int(*six)[6] = NULL, n = 0;
  corot_crossing *crossing = NULL;
  share *s = NULL;
  COROT_TRY(corot_mesh_boundary(f->mesh, &f->ntri, &f->tri));
  tri = (const int(*)[3])f->tri;
  corot_status status = corot_mesh_cross(f->mesh, &crossing);
  if (status == COROT_OK) status = six_nodes(f->mesh, f->ntri, tri, &six);
  if (status == COROT_OK) {
    s = calloc((size_t)f->ntri, sizeof *s);
    f->at_tet = calloc((size_t)f->ntri, sizeof *f->at_tet);
    if (!s || !f->at_tet) status = no_memory();
  }
  for (int i = 0; i < f->ntri && status == COROT_OK; i++) {
    double ignored[3] = {0}, area = 0;
    triangle_area(f->mesh, tri[i], six ? six[i] : NULL, ignored, &area);
    f->area += area;
    f->at_tet[i] = crossing[i].tet;
    if (crossing[i].length > 0) s[n++] = (share){crossing[i].ntet, area};
  }
  if (status == COROT_OK) sum_up(f, n, s);
  free(s);
  free(six);
  free(crossing);
  return status;
}

/* --- All of it --- */

corot_status mesh_facts_find(const char *path, const corot_mesh *mesh, mesh_facts *f) {
  f->path = path;
  f->mesh = mesh;
  f->quality = corot_mesh_measure(mesh);
  for (int e = 0; e < mesh->ntet; e++) {
    double shape = SHAPE_BINS * corot_mesh_shape(mesh, e); /* no number if edges are of 1e-99 m */
    f->shapes[shape > 1 ? (shape < SHAPE_BINS ? (int)ceil(shape) : SHAPE_BINS) - 1 : 0]++;
  }
  COROT_TRY(count_corners(f));
  COROT_TRY(measure_parts(f));
  COROT_TRY(measure_groups(f));
  COROT_TRY(measure_thickness(f));
  return warnings_of_mesh(mesh, &f->warnings);
}

void mesh_facts_free(mesh_facts *f) {
  warnings_free(&f->warnings);
  free(f->part);
  free(f->size);
  free(f->group);
  free(f->tri);
  free(f->at_tet);
}

/* --- Text --- */

static void print_size(const mesh_facts *f, FILE *out) {
  const corot_mesh_quality *q = &f->quality;
  fprintf(out, "file      %s\n", f->path);
  fprintf(out, "nodes     %d", f->mesh->nnode);
  if (f->mesh->mid)
    fprintf(out, ": %d corners and %d on edges", f->ncorner, f->mesh->nnode - f->ncorner);
  fprintf(out, "\ntets      %d\n", f->mesh->ntet);
  fprintf(out, "order     %d\n", corot_mesh_order(f->mesh));
  fprintf(out, "parts     %d\n", f->npart);
  for (int i = 0; i < f->npart && f->npart > 1; i++)
    fprintf(out, "part      of node %d: %d nodes, %d tets, %.6g m^3\n", f->part[i].first,
            f->part[i].nnode, f->size[i].ntet, f->size[i].volume);
  fprintf(out, "box       [%g, %g] x [%g, %g] x [%g, %g] m\n", q->min[0], q->max[0], q->min[1],
          q->max[1], q->min[2], q->max[2]);
  fprintf(out, "volume    %.6g m^3; of a tet %.3g to %.3g\n", q->volume, q->volume_min,
          q->volume_max);
  fprintf(out, "surface   %.6g m^2 in %d triangles\n", f->area, f->ntri);
}

static void print_quality(const mesh_facts *f, FILE *out) {
  const corot_mesh_quality *q = &f->quality;
  fprintf(out, "edges     %.4g to %.4g m\n", q->edge_min, q->edge_max);
  fprintf(out, "dihedral  %.1f to %.1f degrees\n", q->dihedral_min, q->dihedral_max);
  fprintf(out,
          "shape     mean %.3f, worst %.3f (tet %d); 3 inradius / circumradius, 1 is regular\n",
          q->shape_mean, q->shape_min, q->shape_worst);
  fprintf(out, "shapes   ");
  for (int i = 0; i < SHAPE_BINS; i++) fprintf(out, " %d", f->shapes[i]);
  fprintf(out, ": how many tets have a shape up to 0.1, 0.2, ... 1\n");
  fprintf(out,
          "through   at least %.2g tets, half of the surface has %.2g or more, %.3g %% of it fewer "
          "than 2; on straight ways inward\n",
          f->through_min, f->through_median, 100 * f->through_thin);
}

static void print_group(const corot_group *g, const group_size *size, FILE *out) {
  fprintf(out, "group     %s: %d nodes, %d triangles, %d tets", g->name, g->nnode, g->ntri,
          g->ntet);
  const double *n = size->normal;
  if (g->ntri > 0) fprintf(out, "; area %.6g m^2", size->area);
  if (n[0] != 0 || n[1] != 0 || n[2] != 0)
    fprintf(out, ", mean normal (%.3g, %.3g, %.3g)", n[0], n[1], n[2]);
  if (g->ntet > 0) fprintf(out, "; volume %.6g m^3", size->volume);
  fputc('\n', out);
}

corot_status mesh_facts_print(const void *what, FILE *out) {
  const mesh_facts *f = what;
  print_size(f, out);
  print_quality(f, out);
  for (int i = 0; i < f->mesh->ngroup; i++) print_group(&f->mesh->group[i], &f->group[i], out);
  warnings_print(&f->warnings, 0, "warning   ", out);
  return COROT_OK;
}

/* --- JSON --- */

static json_t *parts_json(const mesh_facts *f) {
  json_t *list = json_array();
  for (int k = 0; k < f->npart; k++)
    list = json_text_push(
        list, json_pack("{s:i, s:i, s:i, s:f}", "first", f->part[k].first, "nodes",
                        f->part[k].nnode, "tets", f->size[k].ntet, "volume", f->size[k].volume));
  return list;
}

static json_t *groups_json(const mesh_facts *f) {
  json_t *list = facts_groups(f->mesh);
  for (int i = 0; list && i < f->mesh->ngroup; i++) {
    const group_size *size = &f->group[i];
    const double *n = size->normal;
    bool faces = n[0] != 0 || n[1] != 0 || n[2] != 0;
    json_t *g = json_incref(json_array_get(list, (size_t)i));
    g = json_text_with(g, "area", json_text_real(size->area));
    g = json_text_with(g, "normal", faces ? json_pack("[f, f, f]", n[0], n[1], n[2]) : json_null());
    g = json_text_with(g, "volume", json_real(size->volume));
    if (!g) {
      json_decref(list);
      return NULL;
    }
    json_decref(g);
  }
  return list;
}

static json_t *shapes_json(const mesh_facts *f) {
  json_t *list = json_array();
  for (int i = 0; i < SHAPE_BINS; i++) list = json_text_push(list, json_integer(f->shapes[i]));
  return list;
}

json_t *mesh_facts_json(const mesh_facts *f) {
  const corot_mesh_quality *q = &f->quality;
  json_t *j = json_object();
  j = json_text_with(j, "file", json_text_string(f->path));
  j = json_text_with(j, "nodes", json_integer(f->mesh->nnode));
  j = json_text_with(j, "corners", json_integer(f->ncorner));
  j = json_text_with(j, "tets", json_integer(f->mesh->ntet));
  j = json_text_with(j, "order", json_integer(corot_mesh_order(f->mesh)));
  j = json_text_with(j, "parts", parts_json(f));
  j = json_text_with(j, "min", json_pack("[f, f, f]", q->min[0], q->min[1], q->min[2]));
  j = json_text_with(j, "max", json_pack("[f, f, f]", q->max[0], q->max[1], q->max[2]));
  j = json_text_with(j, "volume", json_real(q->volume));
  j = json_text_with(
      j, "surface", json_pack("{s:o, s:i}", "area", json_text_real(f->area), "triangles", f->ntri));
  j = json_text_with(j, "tet_volume", json_pack("[f, f]", q->volume_min, q->volume_max));
  j = json_text_with(j, "edge", json_pack("[f, f]", q->edge_min, q->edge_max));
  j = json_text_with(j, "dihedral_degrees", json_pack("[f, f]", q->dihedral_min, q->dihedral_max));
  j = json_text_with(j, "shape",
                     json_pack("{s:o, s:o, s:i, s:o}", "mean", json_text_real(q->shape_mean), "min",
                               json_text_real(q->shape_min), "worst", q->shape_worst, "histogram",
                               shapes_json(f)));
  j = json_text_with(
      j, "through",
      json_pack("{s:o, s:o, s:o}", "min", json_text_real(f->through_min), "median",
                json_text_real(f->through_median), "below_2", json_text_real(f->through_thin)));
  j = json_text_with(j, "groups", groups_json(f));
  return json_text_with(j, "warnings", warnings_json(&f->warnings));
}

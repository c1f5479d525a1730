/* The surface of a mesh, seen along parallel rays: triangles that face away are left out, the
   others drawn from the farthest to the nearest, so that what is behind is hidden. Of groups a
   triangle is in it has the colour of the smallest; groups that have nodes alone are dots. */
#include "mesh_picture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/escape.h"
#include "app/text/no_memory.h"
#include "app/text/text_stream.h"

enum {
  VIEW = 460,        /* width and height of a view */
  MARGIN = 30,       /* around the body in it */
  ROW = 22,          /* of the legend */
  EDGES_MAX = 60000, /* triangles, of which edges are drawn */
  DOTS_MAX = 2000    /* nodes of a group that are drawn */
};

/* Colours that stay apart for colour-blind readers (Okabe and Ito 2008); the body has the last. */
static const unsigned char palette[][3] = {
    {230, 159, 0}, {86, 180, 233},  {0, 158, 115},  {240, 228, 66},  {0, 114, 178},
    {213, 94, 0},  {204, 121, 167}, {148, 103, 61}, {127, 201, 127}, {120, 94, 240}};
static const unsigned char grey[3] = {205, 205, 205};
enum { NCOLOUR = sizeof palette / sizeof *palette };

static const unsigned char *colour(int group) {
  return group < 0 ? grey : palette[group % NCOLOUR];
}

typedef struct view {
  double toward[3], right[3], up[3]; /* the eye, of length 1, and the axes of the picture */
  double scale, middle[2];           /* picture = scale (p - middle) */
  double left;                       /* of the view in the picture */
} view;

/* What is drawn: a triangle of the surface, or the node of a group. */
typedef struct item {
  double depth;
  int tri;         /* -1: it is a node */
  int node, group; /* -1: in no group */
} item;

typedef struct picture {
  const mesh_facts *f;
  int *group;    /* [ntri] -1: none */
  int (*six)[6]; /* [ntri] all nodes of triangles on ten-node tets; NULL: of others */
  char *front;   /* [nnode] whether it is at a triangle that faces the eye */
  item *item;
  int nitem;
} picture;

/* --- Groups --- */

static int compare_ints(const void *a, const void *b) {
  int p = *(const int *)a, q = *(const int *)b;
  return (p > q) - (p < q);
}

static void sorted(const int tri[3], int key[3]) {
  memcpy(key, tri, 3 * sizeof *key);
  qsort(key, 3, sizeof *key, compare_ints);
}

/* The surface is in ascending order of its triangles' ascending nodes. */
static int compare_triangles(const void *a, const void *b) {
  int p[3], q[3];
  sorted(a, p);
  sorted(b, q);
  for (int k = 0; k < 3; k++)
    if (p[k] != q[k]) return p[k] < q[k] ? -1 : 1;
  return 0;
}

/* Groups of triangles, or of tets, in the order in which they are given to what they have. */
typedef struct ranked {
  int group, n;
} ranked;

static int compare_ranks(const void *a, const void *b) {
  const ranked *p = a, *q = b;
  if (p->n != q->n) return p->n > q->n ? -1 : 1;
  return (p->group > q->group) - (p->group < q->group);
}

static void paint_triangles(picture *p, int g) {
  const corot_group *group = &p->f->mesh->group[g];
  for (int i = 0; i < group->ntri; i++) {
    const int(*t)[3] =
        bsearch(group->tri[i], p->f->tri, (size_t)p->f->ntri, sizeof *p->f->tri, compare_triangles);
    if (t) p->group[t - (const int(*)[3])p->f->tri] = g;
  }
}

static void paint_tets(picture *p, int g) {
  const corot_group *group = &p->f->mesh->group[g];
  for (int i = 0; i < p->f->ntri; i++)
    if (bsearch(&p->f->at_tet[i], group->tet, (size_t)group->ntet, sizeof *group->tet,
                compare_ints))
      p->group[i] = g;
}

/* The largest first, so that the smallest stays; tets before triangles. A group of all tets is the
   body. */
static corot_status paint(picture *p) {
  const corot_mesh *mesh = p->f->mesh;
  ranked *rank = calloc((size_t)mesh->ngroup + 1, sizeof *rank);
  if (!rank) return no_memory();
  for (int i = 0; i < p->f->ntri; i++) p->group[i] = -1;
  for (int tets = 1; tets >= 0; tets--) {
    for (int g = 0; g < mesh->ngroup; g++)
      rank[g] = (ranked){g, tets ? mesh->group[g].ntet : mesh->group[g].ntri};
    qsort(rank, (size_t)mesh->ngroup, sizeof *rank, compare_ranks);
    for (int i = 0; i < mesh->ngroup && rank[i].n > 0; i++) {
      if (!tets) paint_triangles(p, rank[i].group);
      if (tets && rank[i].n < mesh->ntet) paint_tets(p, rank[i].group);
    }
  }
  free(rank);
  return COROT_OK;
}

/* --- Views --- */

static double dot(const double a[3], const double b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3]) {
  for (int k = 0; k < 3; k++) {
    int p = (k + 1) % 3, q = (k + 2) % 3;
    c[k] = a[p] * b[q] - a[q] * b[p];
  }
}

static void unit(double a[3]) {
  double length = sqrt(dot(a, a));
  for (int k = 0; k < 3; k++) a[k] /= length;
}

/* From an eye far away in the direction `toward`, z being upright. */
static view look(const mesh_facts *f, const double toward[3], double left) {
  static const double z[3] = {0, 0, 1};
  view v = {.left = left};
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  memcpy(v.toward, toward, sizeof v.toward);
  unit(v.toward);
  cross(z, v.toward, v.right);
  unit(v.right);
  cross(v.toward, v.right, v.up);
  for (int i = 0; i < f->mesh->nnode; i++) {
    const double at[2] = {dot(f->mesh->x[i], v.right), dot(f->mesh->x[i], v.up)};
    for (int k = 0; k < 2; k++) low[k] = fmin(low[k], at[k]), high[k] = fmax(high[k], at[k]);
  }
  for (int k = 0; k < 2; k++) v.middle[k] = (low[k] + high[k]) / 2;
  v.scale = (VIEW - 2 * MARGIN) / fmax(high[0] - low[0], high[1] - low[1]);
  return v;
}

static void project(const view *v, const double x[3], double at[2]) {
  at[0] = v->left + VIEW / 2. + v->scale * (dot(x, v->right) - v->middle[0]);
  at[1] = VIEW / 2. - v->scale * (dot(x, v->up) - v->middle[1]);
}

static int compare_items(const void *a, const void *b) {
  const item *p = a, *q = b;
  if (p->depth != q->depth) return p->depth < q->depth ? -1 : 1;
  if (p->tri != q->tri) return p->tri < q->tri ? -1 : 1;
  return (p->group > q->group) - (p->group < q->group);
}

static void unit_normal(const mesh_facts *f, int t, double n[3]) {
  double area = 0;
  n[0] = n[1] = n[2] = 0;
  triangle_area(f->mesh, f->tri[t], NULL, n, &area);
  bool known = area > 0 && area < INFINITY; /* squares of very small or large numbers may not be */
  for (int k = 0; k < 3; k++) n[k] = known ? n[k] / area : 0;
}

/* Curved triangles that face away as a whole may face the eye in part. */
static void list_triangles(picture *p, const view *v) {
  const mesh_facts *f = p->f;
  double least = p->six ? -0.4 : 0;
  memset(p->front, 0, (size_t)f->mesh->nnode);
  for (int t = 0; t < f->ntri; t++) {
    double n[3], depth = 0;
    unit_normal(f, t, n);
    double facing = dot(n, v->toward);
    if (facing <= least) continue;
    for (int k = 0; k < 3; k++) {
      depth += dot(f->mesh->x[f->tri[t][k]], v->toward) / 3;
      if (facing > 0) p->front[f->tri[t][k]] = 1;
      if (facing > 0 && p->six) p->front[p->six[t][3 + k]] = 1;
    }
    p->item[p->nitem++] = (item){.depth = depth, .tri = t, .group = p->group[t]};
  }
}

static bool is_dotted(const corot_mesh *mesh, const corot_group *g) {
  return g->ntri == 0 && g->ntet == 0 && g->nnode <= DOTS_MAX && g->nnode < mesh->nnode;
}

/* Whether it has no triangles and all that the mesh has. */
static bool is_body(const corot_mesh *mesh, const corot_group *g) {
  return g->ntri == 0 && (g->ntet == mesh->ntet || g->nnode == mesh->nnode);
}

/* A little nearer than the triangles that they are corners of. */
static void list_dots(picture *p, const view *v) {
  const corot_mesh *mesh = p->f->mesh;
  double nearer = p->f->quality.edge_max;
  for (int g = 0; g < mesh->ngroup; g++)
    for (int i = 0; i < mesh->group[g].nnode && is_dotted(mesh, &mesh->group[g]); i++) {
      int node = mesh->group[g].node[i];
      if (p->front[node])
        p->item[p->nitem++] = (item){
            .depth = dot(mesh->x[node], v->toward) + nearer, .tri = -1, .node = node, .group = g};
    }
}

/* --- SVG --- */

static void put_colour(const unsigned char c[3], double shade, FILE *out) {
  fprintf(out, "#%02x%02x%02x", (unsigned)(shade * c[0]), (unsigned)(shade * c[1]),
          (unsigned)(shade * c[2]));
}

static void put_item(const picture *p, const view *v, const item *i, FILE *out) {
  double at[2], n[3];
  if (i->tri < 0) {
    project(v, p->f->mesh->x[i->node], at);
    fprintf(out, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"", at[0], at[1]);
    put_colour(colour(i->group), 1, out);
    fputs("\"/>\n", out);
    return;
  }
  fputs("<path d=\"", out);
  for (int k = 0; k < (p->six ? 6 : 3); k++) {
    int node = p->six ? p->six[i->tri][k / 2 + 3 * (k % 2)] : p->f->tri[i->tri][k];
    project(v, p->f->mesh->x[node], at);
    fprintf(out, "%c%.1f,%.1f", k ? 'L' : 'M', at[0], at[1]);
  }
  unit_normal(p->f, i->tri, n);
  double above = (v->toward[2] > 0 ? 1 : -1) * n[2]; /* so that faces of a box differ */
  fputs("Z\" fill=\"", out);
  put_colour(colour(i->group), 0.66 + 0.26 * fmax(dot(n, v->toward), 0) + 0.08 * fmax(above, 0),
             out);
  fputs("\"/>\n", out);
}

/* The directions of x, y and z, at the lower left. */
static void put_axes(const view *v, FILE *out) {
  for (int k = 0; k < 3; k++) {
    double x = v->left + 30, y = VIEW - 30, a = x + 24 * v->right[k], b = y - 24 * v->up[k];
    fprintf(out,
            "<path d=\"M%.1f,%.1fL%.1f,%.1f\" stroke=\"#444\"/><text x=\"%.1f\" y=\"%.1f\" "
            "text-anchor=\"middle\" font-size=\"11\">%c</text>\n",
            x, y, a, b, x + 33 * v->right[k], y - 33 * v->up[k] + 4, "xyz"[k]);
  }
}

static void put_view(picture *p, const view *v, FILE *out) {
  p->nitem = 0;
  list_triangles(p, v);
  list_dots(p, v);
  qsort(p->item, (size_t)p->nitem, sizeof *p->item, compare_items);
  bool edges = p->nitem <= EDGES_MAX;
  fprintf(out, "<g stroke=\"#222\" stroke-width=\"%s\" stroke-linejoin=\"round\">\n",
          edges ? "0.4" : "0");
  for (int i = 0; i < p->nitem; i++) put_item(p, v, &p->item[i], out);
  fputs("</g>\n", out);
  put_axes(v, out);
}

static void put_legend(const mesh_facts *f, FILE *out) {
  for (int g = -1; g < f->mesh->ngroup; g++) {
    int y = VIEW + 20 + ROW * (g + 1);
    const corot_group *group = g < 0 ? NULL : &f->mesh->group[g];
    bool dots = group && is_dotted(f->mesh, group);
    fprintf(out, "<rect x=\"%d\" y=\"%d\" width=\"14\" height=\"14\" rx=\"%d\" fill=\"", MARGIN,
            y - 11, dots ? 7 : 0);
    put_colour(colour(group && is_body(f->mesh, group) ? -1 : g), 1, out);
    fprintf(out, "\" stroke=\"#222\" stroke-width=\"0.4\"/><text x=\"%d\" y=\"%d\">", MARGIN + 22,
            y + 1);
    if (group) {
      escape_markup(group->name, out);
      fprintf(out, ": %d nodes, %d triangles, %d tets", group->nnode, group->ntri, group->ntet);
      if (group->ntri > 0) fprintf(out, ", %.4g m&#178;", f->group[g].area);
    } else {
      fprintf(out, "the body: %d nodes, %d tets, %.4g m&#179;; %g x %g x %g m", f->mesh->nnode,
              f->mesh->ntet, f->quality.volume, f->quality.max[0] - f->quality.min[0],
              f->quality.max[1] - f->quality.min[1], f->quality.max[2] - f->quality.min[2]);
    }
    fputs("</text>\n", out);
  }
}

static void put_svg(picture *p, FILE *out) {
  static const double eyes[2][3] = {{1, -1.7, 0.9}, {-1, 1.7, -0.9}};
  int width = 2 * VIEW, height = VIEW + 30 + ROW * (p->f->mesh->ngroup + 1);
  fprintf(out,
          "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
          "viewBox=\"0 0 %d %d\" font-family=\"sans-serif\" font-size=\"13\">\n<title>",
          width, height, width, height);
  escape_markup(p->f->path, out);
  fprintf(out, "</title>\n<rect width=\"%d\" height=\"%d\" fill=\"#fff\"/>\n", width, height);
  for (int i = 0; i < 2; i++) {
    view v = look(p->f, eyes[i], i * VIEW);
    put_view(p, &v, out);
    fprintf(out, "<text x=\"%d\" y=\"18\" fill=\"#555\">%s</text>\n", i * VIEW + MARGIN,
            i ? "from behind and below" : "from the front and above");
  }
  put_legend(p->f, out);
  fputs("</svg>\n", out);
}

corot_status mesh_picture_svg(const void *what, FILE *out) {
  picture p = {.f = what};
  const corot_mesh *mesh = p.f->mesh;
  size_t n = (size_t)p.f->ntri;
  for (int g = 0; g < mesh->ngroup; g++)
    if (is_dotted(mesh, &mesh->group[g])) n += (size_t)mesh->group[g].nnode;
  p.group = calloc((size_t)p.f->ntri, sizeof *p.group);
  p.front = calloc((size_t)mesh->nnode, 1);
  p.item = calloc(n, sizeof *p.item);
  corot_status status = p.group && p.front && p.item ? paint(&p) : no_memory();
  if (status == COROT_OK && mesh->mid)
    status = corot_mesh_face_nodes(mesh, p.f->ntri, (const int(*)[3])p.f->tri, &p.six);
  if (status == COROT_OK) put_svg(&p, out);
  free(p.group);
  free(p.six);
  free(p.front);
  free(p.item);
  return status;
}

corot_status mesh_picture_html(const void *what, FILE *out) {
  const mesh_facts *f = what;
  char *text = NULL;
  size_t size = 0;
  fputs("<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>", out);
  escape_markup(f->path, out);
  fputs(
      "</title><style>body{font-family:sans-serif;margin:1.5em}svg{max-width:100%;height:auto}"
      "pre{white-space:pre-wrap}</style></head>\n<body><h1>",
      out);
  escape_markup(f->path, out);
  fputs("</h1>\n", out);
  COROT_TRY(mesh_picture_svg(what, out));
  FILE *facts = text_open(&text, &size);
  if (facts) mesh_facts_print(f, facts);
  if (text_close(facts)) {
    free(text);
    return no_memory();
  }
  fputs("<pre>", out);
  escape_markup(text, out);
  fputs("</pre></body></html>\n", out);
  free(text);
  return COROT_OK;
}

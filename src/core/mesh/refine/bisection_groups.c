/* Who inherits a group when tets are cut in halves: <corot/mesh.h> states the rule. */
#include <string.h>

#include "bisection.h"

/* What is known of a node or an edge, whether it is cut or not. */
enum {
  MEMBER = 1, /* a node of the group */
  FILLED = 2, /* of one of the group's triangles or tets */
  SKIN = 4    /* on the boundary of the mesh */
};

/* The work on one group after the other. */
typedef struct heirs {
  const bisection *b;
  const corot_edges *edges; /* of the mesh */
  const int *parent;        /* [fine->ntet] */
  char *node;               /* [b->nnode] what is known of it */
  char *edge;               /* [b->nedge] */
  char *tet;                /* [mesh->ntet] whether it is in the group */
  int *edge_of;             /* [b->nnode - mesh->nnode] on which a new node is */
} heirs;

typedef struct triangle {
  int v[3];
  int edge[3]; /* from each corner to the next */
} triangle;

static void mark_edge(heirs *h, int e, char what) {
  const cut_edge *edge = &h->b->edge[e];
  h->edge[e] |= what;
  for (int i = 0; i < 2; i++) h->node[edge->end[i]] |= what;
}

/* --- Triangles --- */

static corot_status put_triangle(const triangle *t, int_list *fine) {
  for (int k = 0; k < 3; k++) COROT_TRY(corot_int_list_push(fine, t->v[k]));
  return COROT_OK;
}

static int longest(const bisection *b, const triangle *t) {
  int k = 0;
  for (int i = 1; i < 3; i++)
    if (corot_bisection_longer(b, t->edge[i], t->edge[k])) k = i;
  return k;
}

/* Marks the edges of a triangle and of all its parts, and appends the uncut parts. */
static corot_status cut_triangle(heirs *h, triangle t, char what, int_list *fine) {
  for (int k = 0; k < 3; k++) mark_edge(h, t.edge[k], what);
  int k = longest(h->b, &t), e = t.edge[k], i = (k + 1) % 3, corner = t.v[(k + 2) % 3];
  if (h->b->edge[e].half < 0) return put_triangle(&t, fine);
  /* from corner k to the next, i, with the middle m, and the third corner opposite */
  int m = h->b->edge[e].middle, median = corot_bisection_median(h->b, e, corner);
  triangle part[2] = {t, t};
  part[0].v[i] = m;
  part[0].edge[k] = corot_bisection_half(h->b, e, t.v[k]);
  part[0].edge[i] = median;
  part[1].v[k] = m;
  part[1].edge[k] = corot_bisection_half(h->b, e, t.v[i]);
  part[1].edge[(k + 2) % 3] = median;
  COROT_TRY(cut_triangle(h, part[0], what, fine));
  return cut_triangle(h, part[1], what, fine);
}

static corot_status cut_triangles(heirs *h, int ntri, const int (*tri)[3], char what,
                                  int_list *fine) {
  for (int i = 0; i < ntri; i++) {
    triangle t;
    memcpy(t.v, tri[i], sizeof t.v);
    for (int k = 0; k < 3; k++)
      t.edge[k] = corot_edges_find(h->edges, tri[i][k], tri[i][(k + 1) % 3]);
    COROT_TRY(cut_triangle(h, t, what, fine));
  }
  return COROT_OK;
}

/* --- Groups --- */

/* The boundary, once for all groups. */
static corot_status mark_skin(heirs *h) {
  int ntri, (*tri)[3] = NULL;
  int_list unused = {0};
  COROT_TRY(corot_mesh_boundary(h->b->mesh, &ntri, &tri));
  corot_status status = cut_triangles(h, ntri, (const int(*)[3])tri, SKIN, &unused);
  free(tri);
  free(unused.at);
  for (int e = 0; e < h->b->nedge; e++)
    if (h->b->edge[e].middle >= 0) h->node[h->b->edge[e].middle] |= h->edge[e] & SKIN;
  return status;
}

/* Forgets the last group and marks the nodes of this one; the value is whether all lie on the
   boundary. */
static bool mark_nodes(heirs *h, const corot_group *g) {
  bool on_skin = true;
  for (int i = 0; i < h->b->nnode; i++) h->node[i] &= SKIN;
  for (int e = 0; e < h->b->nedge; e++) h->edge[e] &= SKIN;
  for (int i = 0; i < g->nnode; i++) {
    on_skin = on_skin && h->node[g->node[i]] & SKIN;
    h->node[g->node[i]] |= MEMBER;
  }
  return on_skin;
}

static void mark_tets(heirs *h, const corot_group *g) {
  memset(h->tet, 0, (size_t)h->b->mesh->ntet);
  for (int i = 0; i < g->ntet; i++) h->tet[g->tet[i]] = 1;
  for (int t = 0; g->ntet > 0 && t < h->b->ntet; t++)
    for (int k = 0; h->tet[h->b->tet[t].root] && k < 6; k++)
      mark_edge(h, h->b->tet[t].edge[k], FILLED);
}

/* Whether the node on edge e is in the group, given what any edge between loose nodes needs. */
static bool inherits(const heirs *h, int loose, int e) {
  const int *end = h->b->edge[e].end;
  int both = h->node[end[0]] & h->node[end[1]], need = both & FILLED ? FILLED : loose;
  return both & MEMBER && (h->edge[e] & need) == need;
}

/* The ends of the edge of a new node have lower numbers, so that they are known before it. */
static corot_status inherit_nodes(heirs *h, const corot_group *from, int loose, corot_group *to) {
  int first = h->b->mesh->nnode, n = from->nnode;
  for (int i = first; i < h->b->nnode; i++)
    if (inherits(h, loose, h->edge_of[i - first])) {
      h->node[i] |= MEMBER;
      n++;
    }
  COROT_TRY(COROT_ALLOC(to->node, n));
  for (int i = 0; i < from->nnode; i++) to->node[to->nnode++] = from->node[i];
  for (int i = first; i < h->b->nnode; i++)
    if (h->node[i] & MEMBER) to->node[to->nnode++] = i;
  return COROT_OK;
}

static corot_status inherit_tets(const heirs *h, const corot_mesh *fine, corot_group *to) {
  int n = 0;
  for (int e = 0; e < fine->ntet; e++) n += h->tet[h->parent[e]];
  COROT_TRY(COROT_ALLOC(to->tet, n));
  for (int e = 0; e < fine->ntet; e++)
    if (h->tet[h->parent[e]]) to->tet[to->ntet++] = e;
  return COROT_OK;
}

static corot_status inherit_group(heirs *h, const corot_group *from, const corot_mesh *fine,
                                  corot_group *to) {
  int_list tri = {0};
  int loose = mark_nodes(h, from) ? SKIN : 0;
  COROT_TRY(COROT_ALLOC(to->name, strlen(from->name) + 1));
  strcpy(to->name, from->name);
  corot_status status = cut_triangles(h, from->ntri, (const int(*)[3])from->tri, FILLED, &tri);
  to->tri = (int(*)[3])tri.at;
  COROT_TRY(status);
  to->ntri = tri.n / 3;
  mark_tets(h, from);
  COROT_TRY(inherit_nodes(h, from, loose, to));
  return inherit_tets(h, fine, to);
}

static corot_status begin(const bisection *b, heirs *h) {
  int first = b->mesh->nnode;
  COROT_TRY(COROT_ALLOC(h->node, b->nnode));
  COROT_TRY(COROT_ALLOC(h->edge, b->nedge));
  COROT_TRY(COROT_ALLOC(h->tet, b->mesh->ntet));
  COROT_TRY(COROT_ALLOC(h->edge_of, b->nnode - first));
  for (int e = 0; e < b->nedge; e++)
    if (b->edge[e].middle >= first) h->edge_of[b->edge[e].middle - first] = e;
  return mark_skin(h);
}

corot_status corot_bisection_groups(const bisection *b, const corot_edges *edges, const int *parent,
                                    corot_mesh *fine) {
  const corot_mesh *mesh = b->mesh;
  heirs h = {.b = b, .edges = edges, .parent = parent};
  corot_status status = COROT_ALLOC(fine->group, mesh->ngroup);
  if (!status) status = begin(b, &h);
  while (!status && fine->ngroup < mesh->ngroup) {
    const corot_group *from = &mesh->group[fine->ngroup];
    status = inherit_group(&h, from, fine, &fine->group[fine->ngroup++]);
  }
  free(h.node);
  free(h.edge);
  free(h.tet);
  free(h.edge_of);
  return status;
}

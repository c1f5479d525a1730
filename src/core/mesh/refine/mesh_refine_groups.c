/* Who inherits a group: <corot/mesh.h> states the rule. */
#include <string.h>

#include "mesh_refine.h"

/* What is known of a node or an edge. */
enum {
  MEMBER = 1, /* a node of the group */
  FILLED = 2, /* of one of the group's triangles or tets */
  SKIN = 4
}; /* on the boundary of the mesh */

typedef struct marks {
  char *node; /* [nnode] */
  char *edge; /* [nedge] */
} marks;

static void mark_triangles(int ntri, const int (*tri)[3], const corot_edges *edges, char what,
                           marks *m) {
  for (int t = 0; t < ntri; t++)
    for (int k = 0; k < 3; k++) {
      m->node[tri[t][k]] |= what;
      m->edge[corot_edges_find(edges, tri[t][k], tri[t][(k + 1) % 3])] |= what;
    }
}

/* The value is whether all nodes of the group lie on the boundary. */
static bool mark_group(const corot_mesh *mesh, const corot_group *g, const corot_edges *edges,
                       marks *m) {
  bool on_skin = true;
  for (int i = 0; i < mesh->nnode; i++) m->node[i] &= SKIN;
  for (int i = 0; i < edges->n; i++) m->edge[i] &= SKIN;
  for (int i = 0; i < g->nnode; i++) {
    on_skin = on_skin && m->node[g->node[i]] & SKIN;
    m->node[g->node[i]] |= MEMBER;
  }
  mark_triangles(g->ntri, (const int(*)[3])g->tri, edges, FILLED, m);
  for (int i = 0; i < g->ntet; i++) {
    for (int k = 0; k < 4; k++) m->node[mesh->tet[g->tet[i]][k]] |= FILLED;
    for (int k = 0; k < 6; k++) m->edge[edges->tet[g->tet[i]][k]] |= FILLED;
  }
  return on_skin;
}

/* Whether the middle of edge i is in the group, given what any edge between loose nodes needs. */
static bool inherits(const marks *m, const corot_edges *edges, int loose, int i) {
  int both = m->node[edges->end[i][0]] & m->node[edges->end[i][1]];
  int need = both & FILLED ? FILLED : loose;
  return both & MEMBER && (m->edge[i] & need) == need;
}

/* The middles have higher numbers than the ends, so the nodes ascend. Those of a mesh of order 2
   are there already. */
static corot_status refine_nodes(const corot_mesh *mesh, const corot_group *from,
                                 const corot_edges *edges, marks *m, corot_group *to) {
  int n = from->nnode, loose = mark_group(mesh, from, edges, m) ? SKIN : 0;
  int nedge = mesh->mid ? 0 : edges->n;
  for (int i = 0; i < nedge; i++) n += inherits(m, edges, loose, i);
  COROT_TRY(COROT_ALLOC(to->node, n));
  for (int i = 0; i < from->nnode; i++) to->node[to->nnode++] = from->node[i];
  for (int i = 0; i < nedge; i++)
    if (inherits(m, edges, loose, i)) to->node[to->nnode++] = mesh->nnode + i;
  return COROT_OK;
}

corot_status corot_refine_triangles(const corot_edges *edges, int ntri, const int (*tri)[3],
                                    int (**fine)[3]) {
  int(*f)[3];
  COROT_TRY(COROT_ALLOC(f, 4 * (size_t)ntri));
  *fine = f;
  for (int t = 0; t < ntri; t++, f += 4) {
    int middle[3]; /* of the edge from corner k to the next */
    for (int k = 0; k < 3; k++)
      middle[k] = corot_edge_middle(edges, corot_edges_find(edges, tri[t][k], tri[t][(k + 1) % 3]));
    for (int k = 0; k < 3; k++) {
      f[k][0] = tri[t][k];
      f[k][1] = middle[k];
      f[k][2] = middle[(k + 2) % 3];
      f[3][k] = middle[k];
    }
  }
  return COROT_OK;
}

/* Triangles and tets of a group of the refined mesh. */
static corot_status refine_parts(const corot_group *from, const corot_edges *edges,
                                 corot_group *to) {
  COROT_TRY(corot_refine_triangles(edges, from->ntri, (const int(*)[3])from->tri, &to->tri));
  to->ntri = 4 * from->ntri;
  COROT_TRY(COROT_ALLOC(to->tet, 8 * (size_t)from->ntet));
  to->ntet = 8 * from->ntet;
  for (int i = 0; i < to->ntet; i++) to->tet[i] = 8 * from->tet[i / 8] + i % 8;
  return COROT_OK;
}

/* The same of a mesh with the same tets. */
static corot_status copy_parts(const corot_group *from, const corot_edges *edges, corot_group *to) {
  (void)edges;
  COROT_TRY(COROT_ALLOC(to->tri, from->ntri));
  COROT_TRY(COROT_ALLOC(to->tet, from->ntet));
  to->ntri = from->ntri;
  to->ntet = from->ntet;
  for (int i = 0; i < to->ntri; i++) memcpy(to->tri[i], from->tri[i], sizeof *to->tri);
  for (int i = 0; i < to->ntet; i++) to->tet[i] = from->tet[i];
  return COROT_OK;
}

/* Who fills in the triangles and tets. */
typedef corot_status make_parts(const corot_group *from, const corot_edges *edges, corot_group *to);

static corot_status inherit_group(const corot_mesh *mesh, const corot_group *from,
                                  const corot_edges *edges, make_parts *parts, marks *m,
                                  corot_group *to) {
  COROT_TRY(COROT_ALLOC(to->name, strlen(from->name) + 1));
  strcpy(to->name, from->name);
  COROT_TRY(refine_nodes(mesh, from, edges, m, to));
  return parts(from, edges, to);
}

static corot_status inherit(const corot_mesh *mesh, const corot_edges *edges, int nskin,
                            const int (*skin)[3], make_parts *parts, corot_mesh *fine) {
  marks m = {0};
  corot_status status = COROT_ALLOC(m.node, mesh->nnode);
  if (!status) status = COROT_ALLOC(m.edge, edges->n);
  if (!status) status = COROT_ALLOC(fine->group, mesh->ngroup);
  if (!status) mark_triangles(nskin, skin, edges, SKIN, &m);
  while (!status && fine->ngroup < mesh->ngroup) {
    const corot_group *from = &mesh->group[fine->ngroup];
    status = inherit_group(mesh, from, edges, parts, &m, &fine->group[fine->ngroup++]);
  }
  free(m.node);
  free(m.edge);
  return status;
}

corot_status corot_refine_groups(const corot_mesh *mesh, const corot_edges *edges, int nskin,
                                 const int (*skin)[3], corot_mesh *fine) {
  return inherit(mesh, edges, nskin, skin, refine_parts, fine);
}

corot_status corot_raise_groups(const corot_mesh *mesh, const corot_edges *edges, int nskin,
                                const int (*skin)[3], corot_mesh *fine) {
  return inherit(mesh, edges, nskin, skin, copy_parts, fine);
}

static int compare_nodes(const void *a, const void *b) {
  int p = *(const int *)a, q = *(const int *)b;
  return (p > q) - (p < q);
}

/* Whether the group inherits the node on edge i and does not have it. */
static bool lacks(const marks *m, const corot_edges *edges, int loose, int i) {
  return inherits(m, edges, loose, i) && !(m->node[edges->middle[i]] & MEMBER);
}

static corot_status add_inherited(const corot_mesh *mesh, const corot_edges *edges, marks *m,
                                  corot_group *group) {
  int n = group->nnode, loose = mark_group(mesh, group, edges, m) ? SKIN : 0;
  for (int i = 0; i < edges->n; i++) n += lacks(m, edges, loose, i);
  int *more = realloc(group->node, (size_t)n * sizeof *more);
  if (!more) return corot_fail(COROT_ENOMEM, "out of memory: group '%s'", group->name);
  group->node = more;
  for (int i = 0; i < edges->n; i++)
    if (lacks(m, edges, loose, i)) group->node[group->nnode++] = edges->middle[i];
  qsort(group->node, (size_t)group->nnode, sizeof *group->node, compare_nodes);
  return COROT_OK;
}

corot_status corot_group_add_middles(const corot_mesh *mesh, int nskin, const int (*skin)[3],
                                     corot_group *group) {
  corot_edges edges = {0};
  marks m = {0};
  corot_status status = corot_edges_list(mesh, &edges);
  if (!status) status = COROT_ALLOC(m.node, mesh->nnode);
  if (!status) status = COROT_ALLOC(m.edge, edges.n);
  if (!status) {
    mark_triangles(nskin, skin, &edges, SKIN, &m);
    for (int i = 0; i < edges.n; i++) m.node[edges.middle[i]] |= m.edge[i] & SKIN;
    status = add_inherited(mesh, &edges, &m, group);
  }
  free(m.node);
  free(m.edge);
  corot_edges_clear(&edges);
  return status;
}

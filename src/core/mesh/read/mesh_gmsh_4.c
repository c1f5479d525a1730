/* gmsh formats 4.1, and 4.0 in ASCII. */
#include "mesh_gmsh.h"

#define ENTITY_GROUPS_MAX 256 /* so that a hostile file cannot multiply elements by groups */

static corot_status read_physical(corot_gmsh *g, corot_gmsh_entity *e) {
  size_t at = g->r.at;
  COROT_TRY(corot_reader_count(&g->r, "an entity's number of physical groups", 1, &e->count));
  if (e->count > ENTITY_GROUPS_MAX)
    return corot_reader_fail(&g->r, at, "entity %d is in %d physical groups, more than %d", e->tag,
                             e->count, ENTITY_GROUPS_MAX);
  e->first = (int)g->nphysical;
  for (int i = 0; i < e->count; i++) {
    void *items = g->physical;
    COROT_TRY(corot_make_room(&items, g->nphysical, &g->physical_room, sizeof *g->physical));
    g->physical = items;
    COROT_TRY(corot_reader_int(&g->r, "a physical group", &g->physical[g->nphysical]));
    g->nphysical++;
  }
  return COROT_OK;
}

/* The dimension and number of the entity that a partitioned one is part of, and its partitions. */
static corot_status read_parent(corot_gmsh *g, int *dim) {
  int tag, n, partition;
  COROT_TRY(corot_reader_int(&g->r, "the dimension of an entity", dim));
  COROT_TRY(corot_reader_int(&g->r, "an entity", &tag));
  COROT_TRY(corot_reader_count(&g->r, "an entity's number of partitions", 1, &n));
  for (int i = 0; i < n; i++) COROT_TRY(corot_reader_int(&g->r, "a partition", &partition));
  return COROT_OK;
}

/* TAG, if it is partitioned its parent, a point or box, its physical groups, and unless it is a
   point the entities around it. What separates partitions has the groups of what it separates in
   the file, but is in none. */
static corot_status read_entity(corot_gmsh *g, int dim, bool partitioned) {
  corot_gmsh_entity e = {.dim = dim};
  void *items = g->entity;
  int nbound = 0, bound, parent_dim = dim;
  double ignored;
  COROT_TRY(corot_reader_int(&g->r, "an entity", &e.tag));
  if (partitioned) COROT_TRY(read_parent(g, &parent_dim));
  for (int i = 0; i < (dim == 0 && !g->is_4_0 ? 3 : 6); i++)
    COROT_TRY(corot_reader_real(&g->r, "an entity's place", &ignored));
  COROT_TRY(read_physical(g, &e));
  if (parent_dim != dim) e.count = 0;
  if (dim > 0)
    COROT_TRY(corot_reader_count(&g->r, "the number of entities around an entity", 1, &nbound));
  for (int i = 0; i < nbound; i++)
    COROT_TRY(corot_reader_int(&g->r, "an entity around an entity", &bound));
  COROT_TRY(corot_make_room(&items, g->nentity, &g->entity_room, sizeof e));
  g->entity = items;
  g->entity[g->nentity++] = e;
  return corot_reader_end_line(&g->r);
}

static int compare_entities(const void *a, const void *b) {
  const corot_gmsh_entity *p = a, *q = b;
  if (p->dim != q->dim) return p->dim < q->dim ? -1 : 1;
  return (p->tag > q->tag) - (p->tag < q->tag);
}

/* How many points, curves, surfaces and volumes, then these. */
static corot_status read_entities(corot_gmsh *g, bool partitioned) {
  size_t at = g->r.at;
  int n[4];
  for (int dim = 0; dim < 4; dim++)
    COROT_TRY(corot_reader_count(&g->r, "a number of entities", 2, &n[dim]));
  COROT_TRY(corot_reader_end_line(&g->r));
  for (int dim = 0; dim < 4; dim++)
    for (int i = 0; i < n[dim]; i++) COROT_TRY(read_entity(g, dim, partitioned));
  if (g->nentity == 0) return COROT_OK;
  qsort(g->entity, g->nentity, sizeof *g->entity, compare_entities);
  for (size_t i = 1; i < g->nentity; i++)
    if (compare_entities(&g->entity[i - 1], &g->entity[i]) == 0)
      return corot_reader_fail(&g->r, at, "entity %d of dimension %d is listed twice",
                               g->entity[i].tag, g->entity[i].dim);
  return COROT_OK;
}

corot_status corot_gmsh_entities_4(corot_gmsh *g) {
  size_t at = g->r.at;
  if (g->has_entities) return corot_reader_fail(&g->r, at, "entities are listed twice");
  if (g->has_elements) return corot_reader_fail(&g->r, at, "elements are listed before entities");
  g->has_entities = true;
  return read_entities(g, false);
}

/* NPARTITION, NGHOST, then NGHOST times ENTITY PARTITION, then the entities that the elements are
   of; their numbers continue those of the entities that they are parts of. */
corot_status corot_gmsh_partitioned_entities_4(corot_gmsh *g) {
  corot_reader *r = &g->r;
  size_t at = r->at;
  int npartition, nghost, ignored;
  if (g->is_4_0)
    return corot_reader_fail(r, at,
                             "partitioned meshes of format 4.0 are not supported: save it as 4.1 "
                             "(gmsh FILE -save -format msh41)");
  if (g->has_partitions) return corot_reader_fail(r, at, "partitioned entities are listed twice");
  if (g->has_elements) return corot_reader_fail(r, at, "elements are listed before entities");
  g->has_entities = g->has_partitions = true;
  COROT_TRY(corot_reader_count(r, "the number of partitions", 1, &npartition));
  COROT_TRY(corot_reader_end_line(r));
  COROT_TRY(corot_reader_count(r, "the number of ghost entities", 4, &nghost));
  COROT_TRY(corot_reader_end_line(r));
  for (int i = 0; i < nghost; i++) {
    COROT_TRY(corot_reader_int(r, "a ghost entity", &ignored));
    COROT_TRY(corot_reader_int(r, "a partition", &ignored));
    COROT_TRY(corot_reader_end_line(r));
  }
  return read_entities(g, true);
}

/* NBLOCK, N, and in format 4.1 the smallest and largest tag. */
static corot_status start_list(corot_gmsh *g, const char *what, size_t text_bytes,
                               size_t binary_bytes, int *nblock, int *n) {
  int64_t ignored;
  COROT_TRY(corot_reader_count(&g->r, "the number of blocks", 4, nblock));
  COROT_TRY(corot_reader_count(&g->r, what, g->binary ? binary_bytes : text_bytes, n));
  if (g->is_4_0) return corot_reader_end_line(&g->r);
  COROT_TRY(corot_reader_long(&g->r, "the smallest tag", &ignored));
  COROT_TRY(corot_reader_long(&g->r, "the largest tag", &ignored));
  return corot_reader_end_line(&g->r);
}

/* The length of a block, of which `left` are still to come in all blocks. */
static corot_status read_length(corot_gmsh *g, const char *what, int left, int *n) {
  size_t at = g->r.at;
  COROT_TRY(corot_reader_count(&g->r, "the length of a block", 1, n));
  if (*n > left)
    return corot_reader_fail(&g->r, at, "a block of %d %s where %d are left", *n, what, left);
  return corot_reader_end_line(&g->r);
}

/* DIM ENTITY; format 4.0 has them the other way round. */
static corot_status read_place(corot_gmsh *g, int *dim, int *entity) {
  size_t at = g->r.at;
  if (g->is_4_0) COROT_TRY(corot_reader_int(&g->r, "an entity", entity));
  COROT_TRY(corot_reader_int(&g->r, "the dimension of an entity", dim));
  if (!g->is_4_0) COROT_TRY(corot_reader_int(&g->r, "an entity", entity));
  if (*dim < 0 || *dim > 3) return corot_reader_fail(&g->r, at, "an entity of dimension %d", *dim);
  return COROT_OK;
}

/* x y z, and if parametric `dim` more. */
static corot_status read_point(corot_gmsh *g, int i, int dim, int parametric) {
  double ignored;
  COROT_TRY(corot_reader_point(&g->r, g->d.x[i]));
  for (int k = 0; parametric && k < dim; k++)
    COROT_TRY(corot_reader_real(&g->r, "a parameter", &ignored));
  return corot_reader_end_line(&g->r);
}

/* DIM, ENTITY, PARAMETRIC, N, then N tags, then N points; in format 4.0 N times a tag and a point.
 */
static corot_status read_node_block(corot_gmsh *g, int *done) {
  corot_reader *r = &g->r;
  int dim, entity, parametric, n;
  COROT_TRY(read_place(g, &dim, &entity));
  COROT_TRY(corot_reader_int(r, "0 or 1 (parametric)", &parametric));
  COROT_TRY(read_length(g, "nodes", g->d.nnode - *done, &n));
  for (int i = *done; i < *done + n; i++) {
    g->d.node[i].at = r->at;
    COROT_TRY(corot_gmsh_tag(g, "a node", &g->d.node[i].tag));
    COROT_TRY(g->is_4_0 ? read_point(g, i, dim, parametric) : corot_reader_end_line(r));
  }
  for (int i = *done; i < *done + n && !g->is_4_0; i++) {
    g->d.node[i].at = r->at;
    COROT_TRY(read_point(g, i, dim, parametric));
  }
  *done += n;
  return COROT_OK;
}

corot_status corot_gmsh_nodes_4(corot_gmsh *g) {
  int nblock, n, done = 0;
  if (g->has_nodes) return corot_reader_fail(&g->r, g->r.at, "nodes are listed twice");
  COROT_TRY(start_list(g, "the number of nodes", 8, 32, &nblock, &n));
  COROT_TRY(corot_draft_alloc_nodes(&g->d, n));
  for (int i = 0; i < nblock; i++) COROT_TRY(read_node_block(g, &done));
  if (done != n)
    return corot_reader_fail(&g->r, g->r.at, "the blocks have %d nodes, not %d", done, n);
  g->has_nodes = true;
  return corot_draft_index_nodes(&g->d);
}

/* The physical groups of an entity: none where the file lists no entities at all. */
static corot_status find_physical(const corot_gmsh *g, size_t at, int dim, int tag, int *n,
                                  const int **physical) {
  const corot_gmsh_entity key = {.dim = dim, .tag = tag}, *e = NULL;
  if (g->nentity > 0) e = bsearch(&key, g->entity, g->nentity, sizeof key, compare_entities);
  if (!e && g->has_entities)
    return corot_reader_fail(&g->r, at, "entity %d of dimension %d is not in $Entities", tag, dim);
  *n = e ? e->count : 0;
  *physical = *n > 0 ? g->physical + e->first : NULL;
  return COROT_OK;
}

/* DIM, ENTITY, TYPE, N, then N times: ELEMENT, NODE... */
static corot_status read_element_block(corot_gmsh *g, int *left) {
  corot_reader *r = &g->r;
  size_t at = r->at;
  const corot_gmsh_type *type;
  const int *physical = NULL;
  int dim, entity, number, n, nphysical = 0;
  COROT_TRY(read_place(g, &dim, &entity));
  COROT_TRY(corot_reader_int(r, "the elements' type", &number));
  COROT_TRY(read_length(g, "elements", *left, &n));
  COROT_TRY(find_physical(g, at, dim, entity, &nphysical, &physical));
  *left -= n;
  for (int i = 0; i < n; i++) {
    corot_draft_element element = {.at = r->at};
    COROT_TRY(corot_gmsh_tag(g, "an element", &element.tag));
    COROT_TRY(corot_gmsh_find_type(g, &element, number, &type));
    if (type->dim != dim)
      return corot_reader_fail(r, element.at, "element %lld is a %s in an entity of dimension %d",
                               (long long)element.tag, type->name, dim);
    COROT_TRY(corot_gmsh_add_element(g, &element, type, nphysical, physical));
  }
  return COROT_OK;
}

corot_status corot_gmsh_elements_4(corot_gmsh *g) {
  corot_reader *r = &g->r;
  int nblock, n;
  if (!g->has_nodes) return corot_reader_fail(r, r->at, "elements are listed before nodes");
  if (g->has_elements) return corot_reader_fail(r, r->at, "elements are listed twice");
  g->has_elements = true;
  COROT_TRY(start_list(g, "the number of elements", 3, 16, &nblock, &n));
  int left = n;
  for (int i = 0; i < nblock; i++) COROT_TRY(read_element_block(g, &left));
  if (left > 0) return corot_reader_fail(r, r->at, "%d of %d elements are missing", left, n);
  return COROT_OK;
}

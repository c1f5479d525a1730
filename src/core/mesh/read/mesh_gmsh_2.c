/* gmsh formats 1 and 2.2. */
#include "mesh_gmsh.h"

/* The number of nodes or elements, and the beginning of their list. */
static corot_status start_list(corot_gmsh *g, const char *what, size_t text_bytes,
                               size_t binary_bytes, int *n) {
  COROT_TRY(corot_reader_count(&g->r, what, g->binary ? binary_bytes : text_bytes, n));
  return corot_gmsh_start_data(g);
}

/* The entity a node lies on, and its coordinates there: as many as a curve or surface has. */
static corot_status skip_parameters(corot_gmsh *g) {
  int dim, tag;
  double ignored;
  COROT_TRY(corot_reader_int(&g->r, "the dimension of an entity", &dim));
  COROT_TRY(corot_reader_int(&g->r, "the number of an entity", &tag));
  int n = dim == 1 ? 1 : dim == 2 ? 2 : 0;
  for (int i = 0; i < n; i++) COROT_TRY(corot_reader_real(&g->r, "a parameter", &ignored));
  return COROT_OK;
}

static corot_status read_nodes(corot_gmsh *g, bool parametric) {
  corot_reader *r = &g->r;
  int n;
  if (g->has_nodes) return corot_reader_fail(r, r->at, "nodes are listed twice");
  COROT_TRY(start_list(g, "the number of nodes", 7, 28, &n));
  COROT_TRY(corot_draft_alloc_nodes(&g->d, n));
  for (int i = 0; i < n; i++) {
    g->d.node[i].at = r->at;
    COROT_TRY(corot_gmsh_tag(g, "a node", &g->d.node[i].tag));
    COROT_TRY(corot_reader_point(r, g->d.x[i]));
    if (parametric) COROT_TRY(skip_parameters(g));
    COROT_TRY(corot_reader_end_line(r));
  }
  g->has_nodes = true;
  if (g->version == 0) g->version = 1;
  return corot_draft_index_nodes(&g->d);
}

corot_status corot_gmsh_nodes_2(corot_gmsh *g) { return read_nodes(g, false); }

corot_status corot_gmsh_parametric_nodes_2(corot_gmsh *g) { return read_nodes(g, true); }

static corot_status start_elements(corot_gmsh *g, int *n) {
  if (!g->has_nodes) return corot_reader_fail(&g->r, g->r.at, "elements are listed before nodes");
  if (g->has_elements) return corot_reader_fail(&g->r, g->r.at, "elements are listed twice");
  g->has_elements = true;
  g->d.repeats = true;
  return start_list(g, "the number of elements", 8, 8, n);
}

static corot_status read_element_tag(corot_gmsh *g, corot_draft_element *element) {
  *element = (corot_draft_element){.at = g->r.at};
  return corot_gmsh_tag(g, "an element", &element->tag);
}

/* "ELEMENT TYPE PHYSICAL ENTITY NNODE NODE..." */
static corot_status read_element_1(corot_gmsh *g) {
  corot_draft_element element;
  const corot_gmsh_type *type;
  int number, physical, entity, nnode;
  COROT_TRY(read_element_tag(g, &element));
  COROT_TRY(corot_reader_int(&g->r, "the element's type", &number));
  COROT_TRY(corot_reader_int(&g->r, "the element's physical group", &physical));
  COROT_TRY(corot_reader_int(&g->r, "the element's entity", &entity));
  COROT_TRY(corot_reader_int(&g->r, "the element's number of nodes", &nnode));
  COROT_TRY(corot_gmsh_find_type(g, &element, number, &type));
  if (nnode != type->nnode)
    return corot_reader_fail(&g->r, element.at, "element %lld has %d nodes, but is a %s",
                             (long long)element.tag, nnode, type->name);
  return corot_gmsh_add_element(g, &element, type, 1, &physical);
}

corot_status corot_gmsh_elements_1(corot_gmsh *g) {
  int n;
  COROT_TRY(start_elements(g, &n));
  for (int i = 0; i < n; i++) COROT_TRY(read_element_1(g));
  return COROT_OK;
}

/* The first of an element's tags is its physical group; no tags: it has none. */
static corot_status read_tags(corot_gmsh *g, const corot_draft_element *element, int ntag,
                              int *physical) {
  if (ntag < 0)
    return corot_reader_fail(&g->r, element->at, "element %lld has %d tags",
                             (long long)element->tag, ntag);
  *physical = 0;
  for (int i = 0; i < ntag; i++) {
    int tag;
    COROT_TRY(corot_reader_int(&g->r, "a tag", &tag));
    if (i == 0) *physical = tag;
  }
  return COROT_OK;
}

/* "ELEMENT TYPE NTAG TAG... NODE..." */
static corot_status read_element_2(corot_gmsh *g) {
  corot_draft_element element;
  const corot_gmsh_type *type;
  int number, ntag, physical;
  COROT_TRY(read_element_tag(g, &element));
  COROT_TRY(corot_reader_int(&g->r, "the element's type", &number));
  COROT_TRY(corot_reader_int(&g->r, "the element's number of tags", &ntag));
  COROT_TRY(corot_gmsh_find_type(g, &element, number, &type));
  COROT_TRY(read_tags(g, &element, ntag, &physical));
  return corot_gmsh_add_element(g, &element, type, 1, &physical);
}

/* TYPE, N, NTAG, then N times: ELEMENT, TAG..., NODE...; `left` elements are still to come. */
static corot_status read_block_2(corot_gmsh *g, int *left) {
  corot_draft_element element = {.at = g->r.at};
  const corot_gmsh_type *type;
  int number, n, ntag, physical;
  COROT_TRY(corot_reader_int(&g->r, "the elements' type", &number));
  COROT_TRY(corot_reader_int(&g->r, "a number of elements", &n));
  COROT_TRY(corot_reader_int(&g->r, "the elements' number of tags", &ntag));
  if (n <= 0 || n > *left)
    return corot_reader_fail(&g->r, element.at, "a block of %d elements where %d are left", n,
                             *left);
  *left -= n;
  for (int i = 0; i < n; i++) {
    COROT_TRY(read_element_tag(g, &element));
    COROT_TRY(corot_gmsh_find_type(g, &element, number, &type));
    COROT_TRY(read_tags(g, &element, ntag, &physical));
    COROT_TRY(corot_gmsh_add_element(g, &element, type, 1, &physical));
  }
  return COROT_OK;
}

corot_status corot_gmsh_elements_2(corot_gmsh *g) {
  int n;
  COROT_TRY(start_elements(g, &n));
  if (g->binary)
    while (n > 0) COROT_TRY(read_block_2(g, &n));
  else
    for (int i = 0; i < n; i++) COROT_TRY(read_element_2(g));
  return COROT_OK;
}

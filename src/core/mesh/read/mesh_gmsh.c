/* gmsh files: their sections, whatever the version. */
#include "mesh_gmsh.h"

#include <string.h>

#include "mesh_read.h"

static const corot_gmsh_type types[] = {
    {1, 1, 2, "2-node line"},
    {2, 2, 3, "3-node triangle"},
    {3, 2, 4, "4-node quadrangle"},
    {4, 3, 4, "4-node tet"},
    {5, 3, 8, "8-node hexahedron"},
    {6, 3, 6, "6-node prism"},
    {7, 3, 5, "5-node pyramid"},
    {8, 1, 3, "3-node line"},
    {9, 2, 6, "6-node triangle"},
    {10, 2, 9, "9-node quadrangle"},
    {11, 3, 10, "10-node tet"},
    {12, 3, 27, "27-node hexahedron"},
    {13, 3, 18, "18-node prism"},
    {14, 3, 14, "14-node pyramid"},
    {15, 0, 1, "point"},
    {16, 2, 8, "8-node quadrangle"},
    {17, 3, 20, "20-node hexahedron"},
    {18, 3, 15, "15-node prism"},
    {19, 3, 13, "13-node pyramid"},
    {20, 2, 9, "9-node triangle"},
    {21, 2, 10, "10-node triangle"},
    {22, 2, 12, "12-node triangle"},
    {23, 2, 15, "15-node triangle"},
    {24, 2, 15, "15-node triangle"},
    {25, 2, 21, "21-node triangle"},
    {26, 1, 4, "4-node line"},
    {27, 1, 5, "5-node line"},
    {28, 1, 6, "6-node line"},
    {29, 3, 20, "20-node tet"},
    {30, 3, 35, "35-node tet"},
    {31, 3, 56, "56-node tet"},
    {92, 3, 64, "64-node hexahedron"},
    {93, 3, 125, "125-node hexahedron"},
};

/* Before the name: "an 8-node hexahedron", "an 18-node prism". */
static const char *article(const corot_gmsh_type *t) {
  return t->name[0] == '8' || strncmp(t->name, "18", 2) == 0 ? "an" : "a";
}

/* Whether points, lines, triangles and tets have their corners only, or a node on each edge, too;
   0: neither. */
static int order_of(const corot_gmsh_type *t) {
  if (t->nnode == t->dim + 1) return 1;
  return t->nnode == t->dim + 1 + corot_draft_nedge(t->dim) ? 2 : 0;
}

/* What is cut into tets or triangles; DRAFT_SIMPLEX: nothing that is. */
static corot_draft_kind kind_of(const corot_gmsh_type *t) {
  switch (t->number) {
    case 3:
      return DRAFT_QUAD;
    case 5:
      return DRAFT_HEX;
    case 6:
      return DRAFT_PRISM;
    case 7:
      return DRAFT_PYRAMID;
    default:
      return DRAFT_SIMPLEX;
  }
}

corot_status corot_gmsh_find_type(const corot_gmsh *g, const corot_draft_element *element,
                                  int number, const corot_gmsh_type **type) {
  const corot_gmsh_type *t = NULL;
  for (size_t i = 0; i < sizeof types / sizeof *types; i++)
    if (types[i].number == number) t = &types[i];
  if (!t)
    return corot_reader_fail(&g->r, element->at, "element %lld is of type %d, which is unknown",
                             (long long)element->tag, number);
  if (t->dim == 3 && order_of(t) == 0 && !kind_of(t))
    return corot_reader_fail(&g->r, element->at,
                             "element %lld is %s %s: only tets of 4 or 10 nodes are supported, and "
                             "other solids of first order, to be cut into tets",
                             (long long)element->tag, article(t), t->name);
  *type = t;
  return COROT_OK;
}

corot_status corot_gmsh_tag(corot_gmsh *g, const char *what, int64_t *tag) {
  int v;
  if (!g->r.binary || g->version == 4) return corot_reader_long(&g->r, what, tag);
  COROT_TRY(corot_reader_int(&g->r, what, &v));
  *tag = v;
  return COROT_OK;
}

/* gmsh has the nodes of a tet on the edges 01 12 02 03 23 13. */
static void swap_last_two(int middle[6]) {
  int swap = middle[4];
  middle[4] = middle[5];
  middle[5] = swap;
}

corot_status corot_gmsh_add_element(corot_gmsh *g, corot_draft_element *element,
                                    const corot_gmsh_type *type, int n, const int *physical) {
  bool in_group = false;
  corot_draft_kind kind = kind_of(type);
  int order = kind ? 1 : order_of(type), middle[NMIDDLE_MAX];
  element->dim = type->dim;
  element->kind = kind;
  for (int i = 0; i < n; i++) in_group = in_group || physical[i] != 0;
  if (in_group && order == 0)
    return corot_reader_fail(
        &g->r, element->at,
        "element %lld of a physical group is %s %s: only points, lines of 2 or 3 nodes, "
        "triangles of 3 or 6 and tets of 4 or 10 are supported",
        (long long)element->tag, article(type), type->name);
  for (int i = 0; i < type->nnode; i++) {
    int64_t tag;
    int ignored;
    COROT_TRY(corot_gmsh_tag(g, "a node", &tag));
    corot_draft_find_node(&g->d, element, tag,
                          order ? corot_draft_slot(element, middle, i) : &ignored);
  }
  COROT_TRY(corot_reader_end_line(&g->r));
  if (order == 0 || ((order == 2 || kind) && type->dim < 3 && !in_group)) return COROT_OK;
  if (type->dim == 3 && order == 2) swap_last_two(middle);
  COROT_TRY(
      corot_draft_add_element(&g->d, element, order == 2 || kind > DRAFT_QUAD ? middle : NULL));
  for (int i = 0; i < n; i++)
    COROT_TRY(corot_draft_add_member(&g->d, (int)g->d.nelement - 1, physical[i]));
  return COROT_OK;
}

corot_status corot_gmsh_start_data(corot_gmsh *g) {
  if (!g->binary) return corot_reader_end_line(&g->r);
  corot_reader_skip_line(&g->r);
  g->r.binary = true;
  return COROT_OK;
}

/* "VERSION 0|1 8", and in a binary file the int 1, which shows its byte order. */
static corot_status read_format(corot_gmsh *g) {
  corot_reader *r = &g->r;
  size_t at = r->at;
  double version;
  int binary, size, one;
  if (g->version != 0) return corot_reader_fail(r, at, "a second file begins here");
  COROT_TRY(corot_reader_real(r, "the version of the format", &version));
  if (version >= 2 && version < 3)
    g->version = 2;
  else if (version == 4.1 || version == 4)
    g->version = 4;
  else
    return corot_reader_fail(r, at,
                             "gmsh format %g is not supported: save it as 4.1 or 2.2 (gmsh FILE "
                             "-save -format msh41)",
                             version);
  g->is_4_0 = version == 4;
  COROT_TRY(corot_reader_int(r, "0 (ASCII) or 1 (binary)", &binary));
  COROT_TRY(corot_reader_int(r, "the size of a number", &size));
  if (binary != 0 && binary != 1)
    return corot_reader_fail(r, at, "the file type is %d, not 0 (ASCII) or 1 (binary)", binary);
  if (size != 8) return corot_reader_fail(r, at, "the size of a number is %d, not 8 bytes", size);
  if (g->is_4_0 && binary)
    return corot_reader_fail(r, at,
                             "format 4.0 is supported in ASCII only: save it as 4.1 (gmsh FILE "
                             "-save -format msh41)");
  g->binary = r->bytes = binary;
  COROT_TRY(corot_gmsh_start_data(g));
  if (!binary) return COROT_OK;
  COROT_TRY(corot_reader_int(r, "the number 1", &one));
  if (one != 1 && one != 1 << 24)
    return corot_reader_fail(r, r->at - 4, "expected the number 1 in either byte order");
  r->swap = one != 1;
  return COROT_OK;
}

static corot_status read_name(corot_gmsh *g) {
  corot_reader *r = &g->r;
  size_t at = r->at;
  int dim, physical;
  char name[COROT_GROUP_NAME_MAX + 1];
  COROT_TRY(corot_reader_int(r, "the dimension of a physical group", &dim));
  COROT_TRY(corot_reader_int(r, "the number of a physical group", &physical));
  if (dim < 0 || dim > 3 || physical <= 0)
    return corot_reader_fail(r, at, "there is no physical group %d of dimension %d", physical, dim);
  if (!corot_reader_more(r) || r->data[r->at] != '"')
    return corot_reader_fail(r, r->at, "expected a name in double quotes");
  const char *start = r->data + r->at + 1, *end = start;
  while (*end && *end != '"' && *end != '\n') end++;
  if (*end != '"') return corot_reader_fail(r, r->at, "the name has no closing quote");
  size_t n = (size_t)(end - start);
  if (n > COROT_GROUP_NAME_MAX)
    return corot_reader_fail(r, r->at, "the name has %zu bytes, at most %d are allowed", n,
                             COROT_GROUP_NAME_MAX);
  memcpy(name, start, n);
  name[n] = 0;
  corot_status status = corot_draft_add_name(&g->d, dim, physical, name);
  if (status == COROT_EINVAL) return corot_reader_fail(r, r->at, "%s", corot_error());
  COROT_TRY(status);
  r->at += n + 2;
  return corot_reader_end_line(r);
}

static corot_status read_names(corot_gmsh *g) {
  int n;
  COROT_TRY(corot_reader_count(&g->r, "the number of names", 6, &n));
  COROT_TRY(corot_reader_end_line(&g->r));
  for (int i = 0; i < n; i++) COROT_TRY(read_name(g));
  return COROT_OK;
}

/* A section of the formats first to last. */
typedef struct section {
  const char *name, *end;
  int first, last;
  corot_status (*read)(corot_gmsh *g);
} section;

static const section sections[] = {
    {"$MeshFormat", "$EndMeshFormat", 0, 4, read_format},
    {"$NOD", "$ENDNOD", 0, 1, corot_gmsh_nodes_2},
    {"$ELM", "$ENDELM", 0, 1, corot_gmsh_elements_1},
    {"$PhysicalNames", "$EndPhysicalNames", 2, 4, read_names},
    {"$Nodes", "$EndNodes", 2, 2, corot_gmsh_nodes_2},
    {"$ParametricNodes", "$EndParametricNodes", 2, 2, corot_gmsh_parametric_nodes_2},
    {"$Elements", "$EndElements", 2, 2, corot_gmsh_elements_2},
    {"$Entities", "$EndEntities", 4, 4, corot_gmsh_entities_4},
    {"$PartitionedEntities", "$EndPartitionedEntities", 4, 4, corot_gmsh_partitioned_entities_4},
    {"$Nodes", "$EndNodes", 4, 4, corot_gmsh_nodes_4},
    {"$Elements", "$EndElements", 4, 4, corot_gmsh_elements_4},
};

/* Goes past a section that is of no use here: to the line "$EndNAME" or "$ENDNAME". */
static corot_status skip_section(corot_reader *r) {
  const char *name = r->data + r->at + 1, *p = name;
  size_t start = r->at, n = strcspn(name, " \t\r\n");
  const char *end = r->data + r->size;
  while ((p = memchr(p, '$', (size_t)(end - p)))) {
    p++;
    if (strncmp(p, "End", 3) != 0 && strncmp(p, "END", 3) != 0) continue;
    if (strncmp(p + 3, name, n) != 0 || !strchr(" \t\r\n", p[3 + n])) continue;
    r->at = (size_t)(p - r->data) + 3 + n;
    return corot_reader_end_line(r);
  }
  return corot_reader_fail(r, start, "the section %.*s has no end", (int)(n < 40 ? n + 1 : 40),
                           name - 1);
}

static corot_status read_section(corot_gmsh *g) {
  corot_reader *r = &g->r;
  const section *s = NULL;
  size_t at = r->at;
  if (r->data[at] != '$') return corot_reader_fail(r, at, "expected a section that begins with $");
  for (size_t i = 0; i < sizeof sections / sizeof *sections && !s; i++)
    if (g->version >= sections[i].first && g->version <= sections[i].last &&
        corot_reader_word(r, sections[i].name))
      s = &sections[i];
  if (!s) return skip_section(r);
  bool starts_binary = g->version == 4 && s->read != read_names;
  COROT_TRY(starts_binary ? corot_gmsh_start_data(g) : corot_reader_end_line(r));
  COROT_TRY(s->read(g));

  r->binary = false;
  corot_reader_skip_lines(r);
  COROT_TRY(corot_reader_expect(r, s->end));
  return corot_reader_end_line(r);
}

static corot_status parse(corot_gmsh *g, corot_mesh **mesh) {
  corot_reader_skip_lines(&g->r);
  while (g->r.at < g->r.size) COROT_TRY(read_section(g));
  if (g->version == 0)
    return corot_fail(COROT_EFORMAT, "%s: neither $MeshFormat nor $NOD is in the file", g->r.path);
  if (!g->has_nodes) return corot_fail(COROT_EFORMAT, "%s: the file has no nodes", g->r.path);
  if (!g->has_elements) return corot_fail(COROT_EFORMAT, "%s: the file has no elements", g->r.path);
  return corot_draft_finish(&g->d, mesh);
}

corot_status corot_gmsh_parse(const char *path, const char *data, size_t size,
                              const corot_reading *how, corot_mesh **mesh) {
  corot_gmsh g = {.r = {.path = path, .data = data, .size = size}};
  g.d.how = how;
  g.d.node_file = g.d.element_file = &g.r;
  g.d.unused_hint = "with a physical group for the volume, gmsh writes no others (centres of arcs)";
  corot_status status = corot_draft_end(&g.d, parse(&g, mesh));
  corot_draft_clear(&g.d);
  free(g.entity);
  free(g.physical);
  return status;
}

/* VTK's legacy files of unstructured grids, ASCII and binary, versions 1 to 5. */
#include <stdio.h>
#include <string.h>

#include "mesh_read.h"

/* A type of numbers, and its bytes in a binary file. */
typedef struct number_type {
  const char *name;
  size_t bytes;
  bool real;
} number_type;

static const number_type types[] = {
    {"double", 8, true},         {"float", 4, true},         {"int", 4, false},
    {"unsigned_int", 4, false},  {"long", 8, false},         {"unsigned_long", 8, false},
    {"vtktypeint64", 8, false},  {"vtktypeint32", 4, false}, {"vtkIdType", 4, false},
    {"vtkidtype", 4, false},     {"short", 2, false},        {"unsigned_short", 2, false},
    {"vtktypeuint64", 8, false}, {"char", 1, false},         {"unsigned_char", 1, false},
    {"vtktypeuint8", 1, false},  {"vtktypeint8", 1, false},
};

typedef struct vtk {
  corot_reader r;
  corot_draft d;
  bool binary, has_points;
  int ncell, nlist;
  size_t cells_at;
  int64_t *first; /* [ncell + 1] where the nodes of a cell begin in `list` */
  int64_t *list;  /* [nlist] */
  int *type;      /* [ncell] */
  int *value;     /* [ncell] of the array that becomes groups; NULL: there is none */
} vtk;

static corot_status read_type(vtk *v, const number_type **type) {
  corot_reader *r = &v->r;
  *type = &types[0];
  if (corot_reader_more(r))
    for (size_t i = 0; i < sizeof types / sizeof *types; i++)
      if (corot_reader_word(r, types[i].name)) {
        *type = &types[i];
        return COROT_OK;
      }
  return corot_reader_fail(r, r->at, "expected a type of numbers, as double or int");
}

static corot_status start_data(vtk *v) {
  if (!v->binary) return COROT_OK;
  corot_reader_skip_line(&v->r);
  v->r.binary = true;
  return COROT_OK;
}

static void end_data(vtk *v) {
  v->r.binary = false;
  corot_reader_skip_lines(&v->r);
}

static corot_status read_whole(vtk *v, const number_type *type, const char *what, int64_t *value) {
  int small;
  if (!v->binary || type->bytes == 8) return corot_reader_long(&v->r, what, value);
  COROT_TRY(corot_reader_int(&v->r, what, &small));
  *value = small;
  return COROT_OK;
}

static corot_status read_real(vtk *v, const number_type *type, const char *what, double *value) {
  int bits;
  float narrow;
  if (!v->binary || type->bytes == 8) return corot_reader_real(&v->r, what, value);
  COROT_TRY(corot_reader_int(&v->r, what, &bits));
  memcpy(&narrow, &bits, sizeof narrow);
  *value = narrow;
  return COROT_OK;
}

/* "POINTS N TYPE", then N times X Y Z. */
static corot_status read_points(vtk *v) {
  static const char *const name[3] = {"x", "y", "z"};
  const number_type *type;
  int n;
  if (v->has_points) return corot_reader_fail(&v->r, v->r.at, "POINTS are listed twice");
  v->has_points = true;
  COROT_TRY(corot_reader_count(&v->r, "the number of points", 6, &n));
  size_t at = v->r.at;
  COROT_TRY(read_type(v, &type));
  if (!type->real) return corot_reader_fail(&v->r, at, "points of type %s", type->name);
  COROT_TRY(corot_draft_alloc_nodes(&v->d, n));
  COROT_TRY(start_data(v));
  for (int i = 0; i < n; i++) {
    if (!v->binary) corot_reader_skip_lines(&v->r);
    v->d.node[i] = (corot_draft_node){i, v->r.at};
    for (int k = 0; k < 3; k++) COROT_TRY(read_real(v, type, name[k], &v->d.x[i][k]));
  }
  end_data(v);
  return corot_draft_index_nodes(&v->d);
}

/* N times "COUNT NODE...": `nlist` numbers in all, the counts among them. */
static corot_status read_counted_cells(vtk *v) {
  static const number_type type = {"int", 4, false};
  int left = v->nlist, n = 0;
  COROT_TRY(start_data(v));
  for (int i = 0; i < v->ncell; i++) {
    size_t at = v->r.at;
    int64_t count;
    COROT_TRY(read_whole(v, &type, "a number of nodes", &count));
    if (count < 0 || count > left - 1)
      return corot_reader_fail(&v->r, at, "cell %d has %lld nodes where %d numbers are left", i,
                               (long long)count, left);
    for (int64_t k = 0; k < count; k++) COROT_TRY(read_whole(v, &type, "a node", &v->list[n++]));
    left -= (int)count + 1;
    v->first[i + 1] = n;
  }
  end_data(v);
  return COROT_OK;
}

/* "OFFSETS TYPE", `ncell` + 1 numbers, "CONNECTIVITY TYPE", `nlist` numbers. */
static corot_status read_offset_cells(vtk *v) {
  const number_type *type;
  size_t at = v->r.at;
  COROT_TRY(read_type(v, &type));
  COROT_TRY(start_data(v));
  for (int i = 0; i <= v->ncell; i++) COROT_TRY(read_whole(v, type, "an offset", &v->first[i]));
  end_data(v);
  for (int i = 0; i <= v->ncell; i++)
    if (v->first[i] < (i ? v->first[i - 1] : 0) || v->first[i] > v->nlist)
      return corot_reader_fail(&v->r, at, "offset %d is %lld", i, (long long)v->first[i]);
  COROT_TRY(corot_reader_expect(&v->r, "CONNECTIVITY"));
  COROT_TRY(read_type(v, &type));
  COROT_TRY(start_data(v));
  for (int i = 0; i < v->nlist; i++) COROT_TRY(read_whole(v, type, "a node", &v->list[i]));
  end_data(v);
  return COROT_OK;
}

static corot_status read_cells(vtk *v) {
  corot_reader *r = &v->r;
  v->cells_at = r->at;
  if (v->first) return corot_reader_fail(r, r->at, "CELLS are listed twice");
  COROT_TRY(corot_reader_count(r, "the number of cells", 1, &v->ncell));
  COROT_TRY(corot_reader_count(r, "the number of nodes of cells", 1, &v->nlist));
  COROT_TRY(COROT_ALLOC(v->first, (size_t)v->ncell + 1));
  COROT_TRY(COROT_ALLOC(v->list, v->nlist));
  size_t at = r->at;
  corot_reader_skip_lines(r);
  if (!corot_reader_word(r, "OFFSETS")) {
    r->at = at;
    return read_counted_cells(v);
  }
  if (v->ncell == 0) return corot_reader_fail(r, at, "the file has no cells");
  v->ncell--; /* what is counted are the offsets */
  return read_offset_cells(v);
}

static corot_status read_cell_types(vtk *v) {
  static const number_type type = {"int", 4, false};
  int n;
  int64_t value;
  size_t at = v->r.at;
  COROT_TRY(corot_reader_count(&v->r, "the number of cells", 1, &n));
  if (!v->first || n != v->ncell || v->type)
    return corot_reader_fail(&v->r, at, "%d types of %d cells", n, v->ncell);
  COROT_TRY(COROT_ALLOC(v->type, n));
  COROT_TRY(start_data(v));
  for (int i = 0; i < n; i++) {
    COROT_TRY(read_whole(v, &type, "the type of a cell", &value));
    v->type[i] = value > 0 && value < 1000 ? (int)value : 0;
  }
  end_data(v);
  return COROT_OK;
}

/* --- groups --- */

/* The names of arrays that gmsh and meshio give the numbers of groups. */
static bool is_group_array(const char *name) {
  return strcmp(name, "CellEntityIds") == 0 || strcmp(name, "gmsh:physical") == 0 ||
         strcmp(name, "medit:ref") == 0;
}

/* A word of the line; cut if it is long. */
static void read_word(corot_reader *r, char word[32]) {
  size_t n = 0;
  corot_reader_more(r);
  for (; !strchr(" \t\r\n", r->data[r->at]); r->at++)
    if (n < 31) word[n++] = r->data[r->at];
  word[n] = 0;
}

/* Numbers of cells, or of anything else to go past. */
static corot_status read_array(vtk *v, const char *name, const number_type *type, int64_t n) {
  corot_reader *r = &v->r;
  bool keep = !v->value && n == v->ncell && is_group_array(name) && !type->real && type->bytes >= 4;
  int64_t whole;
  double ignored;
  COROT_TRY(start_data(v));
  if (v->binary && !keep) {
    if ((uint64_t)n > (r->size - r->at) / type->bytes)
      return corot_reader_fail(r, r->at, "the array %s is longer than the file", name);
    r->at += (size_t)n * type->bytes;
  } else if (keep) {
    COROT_TRY(COROT_ALLOC(v->value, n));
    for (int64_t i = 0; i < n; i++) {
      COROT_TRY(read_whole(v, type, "a number of a group", &whole));
      v->value[i] = whole > 0 && whole <= 1000000000 ? (int)whole : 0;
    }
  } else {
    for (int64_t i = 0; i < n; i++) COROT_TRY(corot_reader_real(r, "a number", &ignored));
  }
  end_data(v);
  return COROT_OK;
}

/* Behind an array, up to a line that is blank. */
static bool skip_metadata(corot_reader *r) {
  if (!corot_reader_word(r, "METADATA")) return false;
  do corot_reader_skip_line(r);
  while (corot_reader_more(r));
  corot_reader_skip_lines(r);
  return true;
}

/* "FIELD NAME N", then N times "NAME NCOMPONENT NTUPLE TYPE" and the numbers. */
static corot_status read_field(vtk *v) {
  corot_reader *r = &v->r;
  const number_type *type;
  char name[32];
  int n, ncomponent, ntuple;
  read_word(r, name);
  COROT_TRY(corot_reader_count(r, "the number of arrays", 6, &n));
  for (int i = 0; i < n; i++) {
    corot_reader_skip_lines(r);
    skip_metadata(r);
    read_word(r, name);
    COROT_TRY(corot_reader_count(r, "the number of components", 1, &ncomponent));
    COROT_TRY(corot_reader_count(r, "the number of tuples", 1, &ntuple));
    COROT_TRY(read_type(v, &type));
    COROT_TRY(read_array(v, name, type, (int64_t)ncomponent * ntuple));
  }
  return COROT_OK;
}

/* "SCALARS NAME TYPE [1]", "LOOKUP_TABLE NAME", and the numbers. */
static corot_status read_scalars(vtk *v) {
  corot_reader *r = &v->r;
  const number_type *type;
  char name[32], ignored[32];
  int ncomponent = 1;
  read_word(r, name);
  COROT_TRY(read_type(v, &type));
  if (corot_reader_more(r)) COROT_TRY(corot_reader_int(r, "the number of components", &ncomponent));
  corot_reader_skip_lines(r);
  COROT_TRY(corot_reader_expect(r, "LOOKUP_TABLE"));
  read_word(r, ignored);
  if (ncomponent < 1 || ncomponent > 4)
    return corot_reader_fail(r, r->at, "an array of %d components", ncomponent);
  return read_array(v, name, type, (int64_t)ncomponent * v->ncell);
}

/* Data of cells, as far as it is scalars and fields; what is behind it is not looked at. */
static corot_status read_cell_data(vtk *v) {
  corot_reader *r = &v->r;
  int n;
  COROT_TRY(corot_reader_count(r, "the number of cells", 1, &n));
  for (;;) {
    corot_reader_skip_lines(r);
    if (skip_metadata(r)) continue;
    if (corot_reader_word(r, "FIELD"))
      COROT_TRY(read_field(v));
    else if (corot_reader_word(r, "SCALARS"))
      COROT_TRY(read_scalars(v));
    else
      break;
  }
  r->at = r->size;
  return COROT_OK;
}

/* --- the mesh --- */

/* What a type of cell is here: its dimension and nodes; 0: it is left out, -1: a solid. */
static int kind_of(int type, int *nnode) {
  *nnode = type == 5 ? 3 : type == 22 ? 6 : type == 10 ? 4 : type == 24 ? 10 : 0;
  if (*nnode) return type == 5 || type == 22 ? 2 : 3;
  bool solid = (type >= 11 && type <= 16) || (type >= 25 && type <= 27) || type == 29 ||
               (type >= 31 && type <= 33) || type == 37 || type == 42 || (type >= 71 && type <= 74);
  return solid ? -1 : 0;
}

static corot_status add_cell(vtk *v, int i) {
  corot_draft_element e = {.tag = i, .at = v->cells_at};
  int middle[NMIDDLE_MAX], nnode, group = v->value ? v->value[i] : 0, has;
  int dim = kind_of(v->type[i], &nnode);
  has = (int)(v->first[i + 1] - v->first[i]);
  if (dim < 0)
    return corot_reader_fail(&v->r, v->cells_at,
                             "cell %d is a solid of type %d: only tets of 4 or 10 nodes (types 10 "
                             "and 24) are supported",
                             i, v->type[i]);
  if (dim == 0 || (dim == 2 && group == 0)) return COROT_OK;
  if (has != nnode)
    return corot_reader_fail(&v->r, v->cells_at, "cell %d has %d nodes, but is of type %d", i, has,
                             v->type[i]);
  e.dim = dim;
  for (int k = 0; k < nnode; k++)
    COROT_TRY(corot_draft_find_node(&v->d, &e, v->list[v->first[i] + k],
                                    k <= dim ? &e.node[k] : &middle[k - dim - 1]));
  COROT_TRY(corot_draft_add_element(&v->d, &e, nnode > dim + 1 ? middle : NULL));
  return corot_draft_add_member(&v->d, (int)v->d.nelement - 1, group);
}

/* The first lines: the version, a title, the kind of numbers, the kind of data. */
static corot_status read_header(vtk *v) {
  corot_reader *r = &v->r;
  const uint16_t one = 1;
  corot_reader_skip_lines(r);
  corot_reader_skip_line(r);
  corot_reader_skip_line(r);
  corot_reader_skip_lines(r);
  v->binary = corot_reader_word(r, "BINARY");
  if (!v->binary) COROT_TRY(corot_reader_expect(r, "ASCII"));
  r->bytes = v->binary;
  r->swap = *(const char *)&one == 1; /* binary numbers have their highest byte first */
  corot_reader_skip_lines(r);
  COROT_TRY(corot_reader_expect(r, "DATASET"));
  corot_reader_more(r);
  if (!corot_reader_word(r, "UNSTRUCTURED_GRID"))
    return corot_reader_fail(r, r->at, "only a DATASET UNSTRUCTURED_GRID has tets");
  return COROT_OK;
}

static corot_status read_section(vtk *v) {
  corot_reader *r = &v->r;
  if (corot_reader_word(r, "POINTS")) return read_points(v);
  if (corot_reader_word(r, "CELLS")) return read_cells(v);
  if (corot_reader_word(r, "CELL_TYPES")) return read_cell_types(v);
  if (corot_reader_word(r, "CELL_DATA")) return read_cell_data(v);
  if (corot_reader_word(r, "FIELD")) return read_field(v);
  if (skip_metadata(r)) return COROT_OK;
  if (corot_reader_word(r, "POINT_DATA")) {
    r->at = r->size; /* data of cells stands before */
    return COROT_OK;
  }
  return corot_reader_fail(r, r->at, "expected POINTS, CELLS, CELL_TYPES or data");
}

static corot_status parse(vtk *v, corot_mesh **mesh) {
  corot_reader *r = &v->r;
  COROT_TRY(read_header(v));
  for (corot_reader_skip_lines(r); r->at < r->size; corot_reader_skip_lines(r))
    COROT_TRY(read_section(v));
  if (!v->has_points || !v->first || !v->type)
    return corot_fail(COROT_EFORMAT, "%s: the file lacks %s", r->path,
                      !v->has_points ? "POINTS"
                      : !v->first    ? "CELLS"
                                     : "CELL_TYPES");
  for (int i = 0; i < v->ncell; i++) COROT_TRY(add_cell(v, i));
  return corot_draft_finish(&v->d, mesh);
}

corot_status corot_vtk_parse(const char *path, const char *data, size_t size, corot_mesh **mesh) {
  vtk v = {.r = {.path = path, .data = data, .size = size, .flows = true}};
  v.d.node_file = v.d.element_file = &v.r;
  v.d.raises = v.d.repeats = true; /* meshio repeats what gmsh 2.2 repeats for each group */
  corot_status status = parse(&v, mesh);
  corot_draft_clear(&v.d);
  free(v.first);
  free(v.list);
  free(v.type);
  free(v.value);
  return status;
}

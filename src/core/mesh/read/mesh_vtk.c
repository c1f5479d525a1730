/* VTK's legacy files of unstructured grids, ASCII and binary, versions 1 to 5. */
#include <stdio.h>
#include <string.h>

#include "mesh_read.h"
#include "mesh_vtk.h"

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
  int nitem;      /* of the data that are read: of cells, or points */
  bool of_points;
  corot_vtk_groups groups;
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

/* A word of the line; cut if it is long. */
static void read_word(corot_reader *r, char word[VTK_NAME_MAX + 1]) {
  size_t n = 0;
  corot_reader_more(r);
  for (; !strchr(" \t\r\n", r->data[r->at]); r->at++)
    if (n < VTK_NAME_MAX) word[n++] = r->data[r->at];
  word[n] = 0;
}

/* A whole number of any size, in binary one of 1, 4 or 8 bytes. */
static corot_status read_member(vtk *v, const number_type *type, int64_t *value) {
  corot_reader *r = &v->r;
  if (!v->binary || type->bytes != 1) return read_whole(v, type, "a number of a group", value);
  if (r->at == r->size)
    return corot_reader_fail(r, r->at, "expected a number of a group, found the end of the file");
  *value = r->data[r->at++];
  return COROT_OK;
}

static corot_status skip_numbers(vtk *v, const char *name, const number_type *type, int64_t n) {
  corot_reader *r = &v->r;
  double ignored;
  if (v->binary) {
    if ((uint64_t)n > (r->size - r->at) / type->bytes)
      return corot_reader_fail(r, r->at, "the array %s is longer than the file", name);
    r->at += (size_t)n * type->bytes;
    return COROT_OK;
  }
  for (int64_t i = 0; i < n; i++) COROT_TRY(corot_reader_real(r, "a number", &ignored));
  return COROT_OK;
}

/* Numbers of cells or points, or of anything else to go past. */
static corot_status read_array(vtk *v, const char *name, const number_type *type, int64_t n) {
  corot_reader *r = &v->r;
  char group[COROT_GROUP_NAME_MAX + 1];
  bool whole = !type->real && type->bytes != 2, fits = n == v->nitem && n > 0;
  bool numbers = whole && fits && !v->of_points && !v->groups.number && type->bytes >= 4 &&
                 corot_vtk_has_numbers(name);
  bool members = whole && fits && corot_vtk_is_group(name, group);
  int64_t value;
  COROT_TRY(start_data(v));
  if (!numbers && !members) {
    COROT_TRY(skip_numbers(v, name, type, n));
    end_data(v);
    return COROT_OK;
  }
  if ((uint64_t)n > r->size - r->at)
    return corot_reader_fail(r, r->at, "the array %s is longer than the file", name);
  if (numbers)
    COROT_TRY(COROT_ALLOC(v->groups.number, n));
  else
    COROT_TRY(corot_vtk_add_group(&v->groups, group, v->of_points, (int)n));
  for (int64_t i = 0; i < n; i++) {
    COROT_TRY(read_member(v, type, &value));
    if (numbers)
      v->groups.number[i] = value > 0 && value <= 1000000000 ? (int)value : 0;
    else
      v->groups.group[v->groups.n - 1].member[i] = value != 0;
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
  char name[VTK_NAME_MAX + 1];
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
  char name[VTK_NAME_MAX + 1], ignored[VTK_NAME_MAX + 1];
  int ncomponent = 1;
  read_word(r, name);
  COROT_TRY(read_type(v, &type));
  if (corot_reader_more(r)) COROT_TRY(corot_reader_int(r, "the number of components", &ncomponent));
  corot_reader_skip_lines(r);
  COROT_TRY(corot_reader_expect(r, "LOOKUP_TABLE"));
  read_word(r, ignored);
  if (ncomponent < 1 || ncomponent > 4)
    return corot_reader_fail(r, r->at, "an array of %d components", ncomponent);
  return read_array(v, name, type, (int64_t)ncomponent * v->nitem);
}

/* Data of cells or points, as far as it is scalars and fields; what is behind other data is not
   looked at. */
static corot_status read_data(vtk *v, bool of_points) {
  corot_reader *r = &v->r;
  int n;
  COROT_TRY(
      corot_reader_count(r, of_points ? "the number of points" : "the number of cells", 1, &n));
  v->of_points = of_points;
  v->nitem = of_points ? v->d.nnode : v->ncell;
  for (;;) {
    size_t at;
    corot_reader_skip_lines(r);
    at = r->at;
    if (skip_metadata(r)) continue;
    if (corot_reader_word(r, "FIELD")) {
      COROT_TRY(read_field(v));
    } else if (corot_reader_word(r, "SCALARS")) {
      COROT_TRY(read_scalars(v));
    } else {
      if (!corot_reader_word(r, "CELL_DATA") && !corot_reader_word(r, "POINT_DATA")) at = r->size;
      r->at = at;
      return COROT_OK;
    }
  }
}

/* --- the mesh --- */

static corot_status add_cell(vtk *v, int i) {
  return corot_vtk_add_cell(&v->d, i, v->cells_at, v->type[i], v->first[i + 1] - v->first[i],
                            v->list + v->first[i], &v->groups);
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
  if (corot_reader_word(r, "CELL_DATA")) return read_data(v, false);
  if (corot_reader_word(r, "POINT_DATA")) return read_data(v, true);
  if (corot_reader_word(r, "FIELD")) return read_field(v);
  if (skip_metadata(r)) return COROT_OK;
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
  COROT_TRY(corot_vtk_begin_groups(&v->groups, &v->d));
  for (int i = 0; i < v->ncell; i++) COROT_TRY(add_cell(v, i));
  return corot_draft_finish(&v->d, mesh);
}

corot_status corot_vtk_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh) {
  vtk v = {.r = {.path = path, .data = data, .size = size, .flows = true}};
  v.d.how = how;
  v.d.node_file = v.d.element_file = &v.r;
  v.d.raises = v.d.repeats = true; /* meshio repeats what gmsh 2.2 repeats for each group */
  corot_status status = corot_draft_end(&v.d, parse(&v, mesh));
  corot_draft_clear(&v.d);
  free(v.first);
  free(v.list);
  free(v.type);
  corot_vtk_groups_clear(&v.groups);
  return status;
}

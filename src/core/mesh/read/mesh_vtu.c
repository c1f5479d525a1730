/* VTK's XML files of unstructured grids (.vtu). */
#include "mesh_vtu.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>

#include "mesh_read.h"

enum { ARRAYS_MAX = 10000 };

/* --- Tags --- */

static corot_status read_file_tag(corot_vtu *v, const corot_xml_tag *tag) {
  char text[40];
  const uint16_t one = 1;
  bool little = *(const char *)&one == 1;
  if (!corot_xml_attribute(&v->r, tag, "type", sizeof text, text) ||
      strcmp(text, "UnstructuredGrid") != 0)
    return corot_reader_fail(&v->r, tag->at,
                             "the file is of type '%s': only an UnstructuredGrid has tets", text);
  corot_xml_attribute(&v->r, tag, "byte_order", sizeof text, text);
  v->swap = little ? strcmp(text, "BigEndian") == 0 : strcmp(text, "LittleEndian") == 0;
  corot_xml_attribute(&v->r, tag, "header_type", sizeof text, text);
  v->wide = strcmp(text, "UInt64") == 0;
  v->compressed = corot_xml_attribute(&v->r, tag, "compressor", sizeof text, text) && *text;
  if (v->compressed && strcmp(text, "vtkZLibDataCompressor") != 0)
    return corot_reader_fail(
        &v->r, tag->at, "the data are compressed by %s: only vtkZLibDataCompressor is supported",
        text);
  return COROT_OK;
}

static corot_status read_piece_tag(corot_vtu *v, const corot_xml_tag *tag) {
  if (v->npoint >= 0)
    return corot_reader_fail(
        &v->r, tag->at,
        "the file has several pieces: merge them into one before (in ParaView: "
        "Merge Blocks)");
  COROT_TRY(corot_xml_number(&v->r, tag, "NumberOfPoints", 0, &v->npoint));
  COROT_TRY(corot_xml_number(&v->r, tag, "NumberOfCells", 0, &v->ncell));
  if (v->npoint > INT_MAX || v->ncell > INT_MAX)
    return corot_reader_fail(&v->r, tag->at, "%lld points and %lld cells are too many",
                             (long long)v->npoint, (long long)v->ncell);
  return COROT_OK;
}

static corot_status add_array(corot_vtu *v, const corot_xml_tag *tag, corot_vtu_section section) {
  void *items = v->array;
  if (v->narray >= ARRAYS_MAX)
    return corot_reader_fail(&v->r, tag->at, "there are more than %d arrays", ARRAYS_MAX);
  COROT_TRY(corot_make_room(&items, v->narray, &v->array_room, sizeof *v->array));
  v->array = items;
  corot_vtu_array *a = &v->array[v->narray++];
  a->section = section;
  a->tag = *tag;
  corot_xml_attribute(&v->r, tag, "Name", sizeof a->name, a->name);
  return COROT_OK;
}

/* Data begin behind the first '_'. */
static corot_status begin_appended(corot_vtu *v, const corot_xml_tag *tag) {
  char text[16];
  const char *p = memchr(v->r.data + tag->end, '_', v->r.size - tag->end);
  if (!p) return corot_reader_fail(&v->r, tag->at, "AppendedData have no beginning, '_'");
  corot_xml_attribute(&v->r, tag, "encoding", sizeof text, text);
  v->appended_base64 = strcmp(text, "base64") == 0;
  if (!v->appended_base64 && strcmp(text, "raw") != 0)
    return corot_reader_fail(&v->r, tag->at,
                             "AppendedData: the encoding is '%s', not base64 or raw", text);
  v->appended = (size_t)(p - v->r.data) + 1;
  v->r.at = v->r.size; /* what follows is no XML */
  return COROT_OK;
}

static const struct {
  const char *name;
  corot_vtu_section section;
} sections[] = {{"Points", VTU_POINTS},
                {"Cells", VTU_CELLS},
                {"PointData", VTU_POINT_DATA},
                {"CellData", VTU_CELL_DATA}};

static corot_status read_tags(corot_vtu *v) {
  corot_xml_tag tag;
  bool found = true, is_vtk = false;
  int section = -1;
  for (;;) {
    COROT_TRY(corot_xml_next(&v->r, &tag, &found));
    if (!found) break;
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++)
      if (strcmp(tag.name, sections[i].name) == 0)
        section = tag.closes ? -1 : (int)sections[i].section;
    if (!tag.opens) continue;
    if (strcmp(tag.name, "VTKFile") == 0) {
      is_vtk = true;
      COROT_TRY(read_file_tag(v, &tag));
    } else if (strcmp(tag.name, "Piece") == 0) {
      COROT_TRY(read_piece_tag(v, &tag));
    } else if (strcmp(tag.name, "DataArray") == 0 && section >= 0) {
      COROT_TRY(add_array(v, &tag, (corot_vtu_section)section));
    } else if (strcmp(tag.name, "AppendedData") == 0) {
      COROT_TRY(begin_appended(v, &tag));
    }
  }
  if (!is_vtk) return corot_fail(COROT_EFORMAT, "%s: there is no VTKFile in it", v->r.path);
  if (v->npoint < 0) return corot_fail(COROT_EFORMAT, "%s: the file has no Piece", v->r.path);
  return COROT_OK;
}

/* --- Mesh --- */

/* Of a section, the array of that name; NULL: the first. */
static corot_status find_array(const corot_vtu *v, corot_vtu_section section, const char *name,
                               const corot_vtu_array **a) {
  for (size_t i = 0; i < v->narray; i++)
    if (v->array[i].section == section && (!name || strcmp(v->array[i].name, name) == 0)) {
      *a = &v->array[i];
      return COROT_OK;
    }
  return corot_fail(COROT_EFORMAT, "%s: the file lacks %s", v->r.path, name ? name : "Points");
}

static corot_status check_length(const corot_vtu *v, const corot_vtu_array *a, size_t n,
                                 size_t wanted) {
  if (n == wanted) return COROT_OK;
  return corot_reader_fail(&v->r, a->tag.at, "array %.60s has %zu numbers, not %zu", a->name, n,
                           wanted);
}

static corot_status read_points(corot_vtu *v) {
  const corot_vtu_array *a = NULL;
  double *x = NULL;
  size_t n = 0;
  COROT_TRY(find_array(v, VTU_POINTS, NULL, &a));
  COROT_TRY(corot_vtu_reals(v, a, &x, &n));
  corot_status status = check_length(v, a, n, 3 * (size_t)v->npoint);
  if (!status) status = corot_draft_alloc_nodes(&v->d, (int)v->npoint);
  for (int i = 0; i < v->npoint && !status; i++) {
    v->d.node[i] = (corot_draft_node){i, a->tag.at};
    memcpy(v->d.x[i], x + 3 * (size_t)i, sizeof *v->d.x);
  }
  free(x);
  return status ? status : corot_draft_index_nodes(&v->d);
}

static corot_status read_wholes(const corot_vtu *v, const char *name, int64_t **value, size_t *n) {
  const corot_vtu_array *a = NULL;
  COROT_TRY(find_array(v, VTU_CELLS, name, &a));
  COROT_TRY(corot_vtu_wholes(v, a, value, n));
  return strcmp(name, "connectivity") == 0 ? COROT_OK : check_length(v, a, *n, (size_t)v->ncell);
}

/* One of the arrays that have groups. */
static corot_status read_group(corot_vtu *v, const corot_vtu_array *a) {
  bool of_points = a->section == VTU_POINT_DATA;
  char name[COROT_GROUP_NAME_MAX + 1];
  bool numbers = !of_points && !v->groups.number && corot_vtk_has_numbers(a->name);
  int64_t *value = NULL;
  size_t n = 0;
  if (a->section == VTU_POINTS || a->section == VTU_CELLS) return COROT_OK;
  if (!numbers && !corot_vtk_is_group(a->name, name)) return COROT_OK;
  COROT_TRY(corot_vtu_wholes(v, a, &value, &n));
  corot_status status = check_length(v, a, n, (size_t)(of_points ? v->npoint : v->ncell));
  if (!status && numbers) status = COROT_ALLOC(v->groups.number, n);
  if (!status && !numbers) status = corot_vtk_add_group(&v->groups, name, of_points, (int)n);
  for (size_t i = 0; i < n && !status; i++) {
    if (numbers)
      v->groups.number[i] = value[i] > 0 && value[i] <= 1000000000 ? (int)value[i] : 0;
    else
      v->groups.group[v->groups.n - 1].member[i] = value[i] != 0;
  }
  free(value);
  return status;
}

typedef struct cells {
  int64_t *node, *end, *type;
  size_t nnode;
} cells;

static corot_status add_cells(corot_vtu *v, const cells *c) {
  const corot_vtu_array *a = NULL;
  COROT_TRY(find_array(v, VTU_CELLS, "offsets", &a));
  for (int i = 0; i < v->ncell; i++) {
    int64_t begin = i ? c->end[i - 1] : 0;
    if (c->end[i] < begin || (uint64_t)c->end[i] > c->nnode)
      return corot_reader_fail(&v->r, a->tag.at, "cell %d: its offset is %lld", i,
                               (long long)c->end[i]);
    int type = c->type[i] > 0 && c->type[i] < 1000 ? (int)c->type[i] : 0;
    COROT_TRY(corot_vtk_add_cell(&v->d, i, a->tag.at, type, c->end[i] - begin, c->node + begin,
                                 &v->groups));
  }
  return COROT_OK;
}

static corot_status read_cells(corot_vtu *v) {
  cells c = {0};
  size_t n;
  corot_status status = read_wholes(v, "connectivity", &c.node, &c.nnode);
  if (!status) status = read_wholes(v, "offsets", &c.end, &n);
  if (!status) status = read_wholes(v, "types", &c.type, &n);
  if (!status) status = add_cells(v, &c);
  free(c.node);
  free(c.end);
  free(c.type);
  return status;
}

static corot_status parse(corot_vtu *v, corot_mesh **mesh) {
  COROT_TRY(read_tags(v));
  COROT_TRY(read_points(v));
  for (size_t i = 0; i < v->narray; i++) COROT_TRY(read_group(v, &v->array[i]));
  COROT_TRY(corot_vtk_begin_groups(&v->groups, &v->d));
  COROT_TRY(read_cells(v));
  return corot_draft_finish(&v->d, mesh);
}

corot_status corot_vtu_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh) {
  corot_vtu v = {.r = {.path = path, .data = data, .size = size}, .npoint = -1};
  v.d.how = how;
  v.d.node_file = v.d.element_file = &v.r;
  v.d.raises = v.d.repeats = true; /* meshio repeats what gmsh 2.2 repeats for each group */
  corot_status status = corot_draft_end(&v.d, parse(&v, mesh));
  corot_draft_clear(&v.d);
  corot_vtk_groups_clear(&v.groups);
  free(v.array);
  return status;
}

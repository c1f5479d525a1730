/* Netgen's .vol: sections of a word, a count, and a line each; elements stand before the points, so
   they are read when these are known. */
#include <stdio.h>
#include <string.h>

#include "mesh_read.h"

typedef struct vol {
  corot_reader r;
  corot_draft d;
  size_t surfaces, volumes; /* where the sections begin, behind their word; 0: there is none */
  bool has_points;
} vol;

static bool begins_number(char c) {
  return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.';
}

/* To the next line that begins with a word. */
static void skip_section(corot_reader *r) {
  corot_reader_skip_lines(r);
  while (r->at < r->size && begins_number(r->data[r->at])) {
    corot_reader_skip_line(r);
    corot_reader_skip_lines(r);
  }
}

static corot_status read_points(vol *v) {
  corot_reader *r = &v->r;
  int n;
  if (v->has_points) return corot_reader_fail(r, r->at, "points are listed twice");
  v->has_points = true;
  COROT_TRY(corot_reader_count_line(r, "the number of points", 6, &n));
  COROT_TRY(corot_draft_alloc_nodes(&v->d, n));
  for (int i = 0; i < n; i++) {
    v->d.node[i] = (corot_draft_node){i + 1, r->at};
    COROT_TRY(corot_reader_point(r, v->d.x[i]));
    COROT_TRY(corot_reader_end_line(r));
  }
  return corot_draft_index_nodes(&v->d);
}

/* The rest of the line without blanks around it; "" if it is too long for a name. */
static void read_name(corot_reader *r, char name[COROT_GROUP_NAME_MAX + 1]) {
  while (r->data[r->at] == ' ' || r->data[r->at] == '\t') r->at++;
  size_t n = strcspn(r->data + r->at, "\r\n");
  while (n > 0 && (r->data[r->at + n - 1] == ' ' || r->data[r->at + n - 1] == '\t')) n--;
  name[0] = 0;
  if (n <= COROT_GROUP_NAME_MAX) {
    memcpy(name, r->data + r->at, n);
    name[n] = 0;
  }
  corot_reader_skip_line(r);
}

/* N, then N times NUMBER NAME: of the groups of that dimension. What is no name is passed over. */
static corot_status read_names(vol *v, int dim) {
  corot_reader *r = &v->r;
  int n;
  COROT_TRY(corot_reader_count_line(r, "the number of names", 3, &n));
  for (int i = 0; i < n; i++) {
    char name[COROT_GROUP_NAME_MAX + 1];
    int number;
    corot_reader_skip_lines(r);
    COROT_TRY(corot_reader_int(r, "the number of a name", &number));
    read_name(r, name);
    if (number <= 0 || corot_group_name_check(name) != COROT_OK) continue;
    COROT_TRY(corot_draft_add_name(&v->d, dim, number, name));
  }
  return COROT_OK;
}

/* Netgen's tets are left-handed: corners 1 and 2 change places here, and the nodes on edges, which
   it has on 01 02 03 12 13 23, of triangles on 12 02 01. Other solids are cut whatever their hand.
 */
static int place_of(int dim, int nnode, int k) {
  static const int tet[10] = {0, 2, 1, 3, 6, 4, 7, 5, 9, 8}, triangle[6] = {0, 1, 2, 4, 5, 3};
  if (dim == 3 && (nnode == 4 || nnode == 10)) return tet[k];
  return dim == 2 && nnode == 6 ? triangle[k] : k;
}

/* What has so many nodes; DRAFT_KINDS: nothing that is read. */
static corot_draft_kind kind_of(int dim, int nnode) {
  if (dim == 2)
    return nnode == 3 || nnode == 6 ? DRAFT_SIMPLEX : nnode == 4 ? DRAFT_QUAD : DRAFT_KINDS;
  switch (nnode) {
    case 4:
    case 10:
      return DRAFT_SIMPLEX;
    case 5:
      return DRAFT_PYRAMID;
    case 6:
      return DRAFT_PRISM;
    case 8:
      return DRAFT_HEX;
    default:
      return DRAFT_KINDS;
  }
}

/* NNODE NODE..., of group `number`. */
static corot_status read_element(vol *v, corot_draft_element *e, int number) {
  corot_reader *r = &v->r;
  int nnode, middle[NMIDDLE_MAX];
  COROT_TRY(corot_reader_int(r, "an element's number of nodes", &nnode));
  e->kind = kind_of(e->dim, nnode);
  if (e->kind == DRAFT_KINDS && e->dim == 3)
    return corot_reader_fail(r, e->at,
                             "element %lld is a solid of %d nodes: only tets of 4 or 10 nodes are "
                             "supported, and other solids of first order, to be cut into tets",
                             (long long)e->tag, nnode);
  if (e->kind == DRAFT_KINDS || (e->dim == 2 && number <= 0)) return COROT_OK;
  for (int k = 0; k < nnode; k++) {
    int64_t tag;
    COROT_TRY(corot_reader_long(r, "a node", &tag));
    corot_draft_find_node(&v->d, e, tag, corot_draft_slot(e, middle, place_of(e->dim, nnode, k)));
  }
  bool more = e->kind ? nnode > 4 : nnode > e->dim + 1;
  COROT_TRY(corot_draft_add_element(&v->d, e, more ? middle : NULL));
  return corot_draft_add_member(&v->d, (int)v->d.nelement - 1, number > 0 ? number : 0);
}

/* N, then N times SURFACE GROUP DOMAIN DOMAIN and an element; what is behind it is of the geometry.
 */
static corot_status read_surfaces(vol *v) {
  corot_reader *r = &v->r;
  int n, number, ignored;
  COROT_TRY(corot_reader_count_line(r, "the number of surface elements", 11, &n));
  for (int i = 0; i < n; i++) {
    corot_draft_element e = {.tag = i + 1, .at = r->at, .dim = 2};
    COROT_TRY(corot_reader_int(r, "the number of a surface", &ignored));
    COROT_TRY(corot_reader_int(r, "the number of a boundary condition", &number));
    COROT_TRY(corot_reader_int(r, "a domain", &ignored));
    COROT_TRY(corot_reader_int(r, "a domain", &ignored));
    COROT_TRY(read_element(v, &e, number));
    corot_reader_skip_line(r);
    corot_reader_skip_lines(r);
  }
  return COROT_OK;
}

/* N, then N times MATERIAL and an element. */
static corot_status read_volumes(vol *v) {
  corot_reader *r = &v->r;
  int n, number;
  COROT_TRY(corot_reader_count_line(r, "the number of volume elements", 11, &n));
  for (int i = 0; i < n; i++) {
    corot_draft_element e = {.tag = i + 1, .at = r->at, .dim = 3};
    COROT_TRY(corot_reader_int(r, "the number of a material", &number));
    COROT_TRY(read_element(v, &e, number));
    corot_reader_skip_line(r);
    corot_reader_skip_lines(r);
  }
  return COROT_OK;
}

/* Past the word at the beginning of a line. */
static bool take_word(corot_reader *r, const char *word) {
  size_t n = strlen(word);
  if (strncmp(r->data + r->at, word, n) != 0) return false;
  while (r->at < r->size && !strchr(" \t\r\n", r->data[r->at])) r->at++;
  return true;
}

static corot_status read_section(vol *v) {
  corot_reader *r = &v->r;
  size_t *begin = NULL;
  if (corot_reader_word(r, "points")) return read_points(v);
  if (corot_reader_word(r, "materials")) return read_names(v, 3);
  if (corot_reader_word(r, "bcnames")) return read_names(v, 2);
  if (corot_reader_word(r, "endmesh")) {
    r->at = r->size;
    return COROT_OK;
  }
  if (take_word(r, "surfaceelements")) begin = &v->surfaces; /* -gi and -uv, too */
  if (!begin && take_word(r, "volumeelements")) begin = &v->volumes;
  if (begin && *begin) return corot_reader_fail(r, r->at, "elements are listed twice");
  if (begin) *begin = r->at;
  if (!begin) corot_reader_skip_line(r);
  skip_section(r);
  return COROT_OK;
}

static corot_status parse(vol *v, corot_mesh **mesh) {
  corot_reader *r = &v->r;
  for (corot_reader_skip_lines(r); r->at < r->size; corot_reader_skip_lines(r))
    COROT_TRY(read_section(v));
  if (!v->has_points) return corot_fail(COROT_EFORMAT, "%s: the file has no points", r->path);
  if (!v->volumes) return corot_fail(COROT_EFORMAT, "%s: the file has no volumeelements", r->path);
  r->at = v->volumes;
  COROT_TRY(read_volumes(v));
  if (v->surfaces) {
    r->at = v->surfaces;
    COROT_TRY(read_surfaces(v));
  }
  corot_draft_turn_all(&v->d);
  return corot_draft_finish(&v->d, mesh);
}

corot_status corot_vol_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh) {
  vol v = {.r = {.path = path, .data = data, .size = size, .comment = '#'}};
  v.d.how = how;
  v.d.node_file = v.d.element_file = v.d.face_file = &v.r;
  v.d.raises = true;
  corot_status status = corot_draft_end(&v.d, parse(&v, mesh));
  corot_draft_clear(&v.d);
  return status;
}

/* VegaFEM's .veg: *VERTICES, *ELEMENTS and *SET, which becomes a group. */
#include <string.h>

#include "mesh_read.h"

typedef struct veg {
  corot_reader r;
  corot_draft d;
  bool has_nodes, has_elements;
  int64_t first; /* number of the first element */
  int nset;
} veg;

static corot_status begin_list(corot_reader *r, const char *what, size_t bytes, int *n) {
  corot_reader_skip_lines(r);
  return corot_reader_count(r, what, bytes, n);
}

/* N 3 0 0, then N times NUMBER X Y Z. */
static corot_status read_nodes(veg *v) {
  corot_reader *r = &v->r;
  int n, dim;
  if (v->has_nodes) return corot_reader_fail(r, r->at, "*VERTICES are listed twice");
  v->has_nodes = true;
  COROT_TRY(begin_list(r, "the number of vertices", 8, &n));
  size_t at = r->at;
  COROT_TRY(corot_reader_int(r, "the dimension", &dim));
  if (dim != 3) return corot_reader_fail(r, at, "the dimension is %d, not 3", dim);
  corot_reader_skip_line(r);
  COROT_TRY(corot_draft_alloc_nodes(&v->d, n));
  for (int i = 0; i < n; i++) {
    corot_reader_skip_lines(r);
    v->d.node[i].at = r->at;
    COROT_TRY(corot_reader_long(r, "a vertex", &v->d.node[i].tag));
    COROT_TRY(corot_reader_point(r, v->d.x[i]));
    corot_reader_skip_line(r); /* TetGen's markers may follow */
  }
  return corot_draft_index_nodes(&v->d);
}

/* NUMBER VERTEX... */
static corot_status read_element(veg *v, int nnode, int i) {
  corot_reader *r = &v->r;
  int middle[NMIDDLE_MAX];
  corot_reader_skip_lines(r);
  corot_draft_element e = {.at = r->at, .dim = 3, .kind = nnode == 8 ? DRAFT_HEX : DRAFT_SIMPLEX};
  COROT_TRY(corot_reader_long(r, "an element", &e.tag));
  if (i == 0) v->first = e.tag;
  if (v->first < 0 || v->first > 1 || e.tag != v->first + i)
    return corot_reader_fail(r, e.at, "element %lld stands where %lld should", (long long)e.tag,
                             (long long)(v->first == 0 ? i : i + 1));
  for (int k = 0; k < nnode; k++) {
    int64_t tag;
    COROT_TRY(corot_reader_long(r, "a vertex", &tag));
    corot_draft_find_node(&v->d, &e, tag, corot_draft_slot(&e, middle, k));
  }
  corot_reader_skip_line(r);
  return corot_draft_add_element(&v->d, &e, nnode == 8 ? middle : NULL);
}

/* TET or CUBIC, N NNODE 0, then the elements. */
static corot_status read_elements(veg *v) {
  corot_reader *r = &v->r;
  int n, nnode;
  if (v->has_elements) return corot_reader_fail(r, r->at, "*ELEMENTS are listed twice");
  if (!v->has_nodes) return corot_reader_fail(r, r->at, "*ELEMENTS are listed before *VERTICES");
  v->has_elements = true;
  corot_reader_skip_lines(r);
  corot_reader_skip_line(r);
  COROT_TRY(begin_list(r, "the number of elements", 10, &n));
  size_t at = r->at;
  COROT_TRY(corot_reader_int(r, "an element's number of vertices", &nnode));
  if (nnode != 4 && nnode != 8)
    return corot_reader_fail(
        r, at,
        "elements of %d vertices: only tets of 4 are supported, and cubes of 8, "
        "to be cut into tets",
        nnode);
  corot_reader_skip_line(r);
  for (int i = 0; i < n; i++) COROT_TRY(read_element(v, nnode, i));
  return COROT_OK;
}

static corot_status read_set_name(veg *v) {
  corot_reader *r = &v->r;
  char name[COROT_GROUP_NAME_MAX + 1];
  corot_reader_more(r);
  size_t n = strcspn(r->data + r->at, " \t\r\n");
  if (n > COROT_GROUP_NAME_MAX)
    return corot_reader_fail(r, r->at, "the name has %zu bytes, at most %d are allowed", n,
                             COROT_GROUP_NAME_MAX);
  memcpy(name, r->data + r->at, n);
  name[n] = 0;
  corot_status status = corot_draft_add_name(&v->d, 3, ++v->nset, name);
  if (status == COROT_EINVAL) return corot_reader_fail(r, r->at, "%s", corot_error());
  corot_reader_skip_line(r);
  return status;
}

/* NAME, then numbers of elements, commas between them, on any lines. */
static corot_status read_set(veg *v) {
  corot_reader *r = &v->r;
  if (!v->has_elements) return corot_reader_fail(r, r->at, "a *SET stands before *ELEMENTS");
  COROT_TRY(read_set_name(v));
  for (corot_reader_skip_lines(r); r->at < r->size && r->data[r->at] != '*';
       corot_reader_skip_lines(r)) {
    int64_t tag;
    size_t at = r->at;
    COROT_TRY(corot_reader_long(r, "an element", &tag));
    if (tag < v->first || tag - v->first >= (int64_t)v->d.nelement)
      return corot_reader_fail(r, at, "element %lld does not exist", (long long)tag);
    COROT_TRY(corot_draft_add_member(&v->d, (int)(tag - v->first), v->nset));
    corot_reader_separator(r);
  }
  return COROT_OK;
}

static corot_status read_block(veg *v) {
  corot_reader *r = &v->r;
  size_t at = r->at;
  if (r->data[at] != '*') return corot_reader_fail(r, at, "expected a keyword, as *VERTICES");
  if (corot_reader_word(r, "*VERTICES")) return read_nodes(v);
  if (corot_reader_word(r, "*ELEMENTS")) return read_elements(v);
  if (corot_reader_word(r, "*SET")) return read_set(v);
  if (corot_reader_word(r, "*INCLUDE"))
    return corot_reader_fail(r, at, "*INCLUDE is not supported: put the text of that file here");
  do {
    corot_reader_skip_line(r);
    corot_reader_skip_lines(r);
  } while (r->at < r->size && r->data[r->at] != '*');
  return COROT_OK;
}

static corot_status parse(veg *v, corot_mesh **mesh) {
  corot_reader *r = &v->r;
  for (corot_reader_skip_lines(r); r->at < r->size; corot_reader_skip_lines(r))
    COROT_TRY(read_block(v));
  if (!v->has_nodes) return corot_fail(COROT_EFORMAT, "%s: the file has no *VERTICES", r->path);
  if (!v->has_elements) return corot_fail(COROT_EFORMAT, "%s: the file has no *ELEMENTS", r->path);
  return corot_draft_finish(&v->d, mesh);
}

corot_status corot_veg_parse(const char *path, const char *data, size_t size,
                             const corot_reading *how, corot_mesh **mesh) {
  veg v = {.r = {.path = path, .data = data, .size = size, .comment = '#', .separator = ','}};
  v.d.how = how;
  v.d.node_file = v.d.element_file = &v.r;
  corot_status status = corot_draft_end(&v.d, parse(&v, mesh));
  corot_draft_clear(&v.d);
  return status;
}

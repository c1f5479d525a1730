/* MEDIT's .meshb, of libMeshb's versions 1 to 4: a 1 that shows the byte order, the version, then
   sections. Each has the code of its keyword, the place of the next one, and, where it is a list,
   a count. Version 1 has reals of 4 bytes, version 3 and 4 places of 8, version 4 whole numbers of
   8 bytes. */
#include <string.h>

#include "mesh_medit.h"

enum {
  DIMENSION = 3,
  VERTICES = 4,
  END = 54,
  BEZIER_BASIS = 125,
  TRIANGLES_ORDERING = 129,
  TETRAHEDRA_ORDERING = 133,
  PRECISION = 155
};

/* The place of the next section, 0 if there is none. */
static corot_status read_next(corot_medit *m, int version, int64_t *next) {
  corot_reader *r = &m->r;
  size_t at = r->at;
  int place = 0;
  if (version < 3) {
    COROT_TRY(corot_reader_int(r, "the place of the next section", &place));
    *next = place;
  } else {
    bool narrow = r->narrow;
    r->narrow = false;
    corot_status status = corot_reader_long(r, "the place of the next section", next);
    r->narrow = narrow;
    COROT_TRY(status);
  }
  if (*next == 0 || (*next >= (int64_t)r->at && (uint64_t)*next <= r->size)) return COROT_OK;
  return corot_reader_fail(r, at,
                           "the next section is at byte %lld, of %zu: the file has been cut short, "
                           "or is damaged",
                           (long long)*next, r->size);
}

/* Bits of a real: 32 or 64. */
static corot_status read_precision(corot_medit *m) {
  int64_t bits;
  size_t at = m->r.at;
  COROT_TRY(corot_reader_long(&m->r, "the precision", &bits));
  if (bits != 32 && bits != 64)
    return corot_reader_fail(&m->r, at, "reals of %lld bits are not known", (long long)bits);
  m->r.single = bits == 32;
  return COROT_OK;
}

static corot_status read_section(corot_medit *m, int code) {
  const corot_medit_list *l = corot_medit_list_of(code);
  if (l) return corot_medit_elements(m, l);
  switch (code) {
    case DIMENSION:
      return corot_medit_dimension(m);
    case VERTICES:
      return corot_medit_nodes(m);
    case TRIANGLES_ORDERING:
      return corot_medit_ordering(m, 2);
    case TETRAHEDRA_ORDERING:
      return corot_medit_ordering(m, 3);
    case BEZIER_BASIS:
      return corot_medit_basis(m);
    case PRECISION:
      return read_precision(m);
    default:
      return COROT_OK;
  }
}

static corot_status read_version(corot_medit *m, int *version) {
  corot_reader *r = &m->r;
  int one = 0;
  COROT_TRY(corot_reader_int(r, "the byte order", &one));
  r->swap = one != 1;
  COROT_TRY(corot_reader_int(r, "the version", version));
  if (*version < 1 || *version > 4)
    return corot_reader_fail(r, 4, "version %d: only 1 to 4 are known", *version);
  r->single = *version == 1;
  r->narrow = *version < 4;
  return COROT_OK;
}

static corot_status parse(corot_medit *m, corot_mesh **mesh) {
  corot_reader *r = &m->r;
  int version = 0, code = 0;
  int64_t next = 0;
  COROT_TRY(read_version(m, &version));
  while (r->at < r->size) {
    COROT_TRY(corot_reader_int(r, "the code of a section", &code));
    if (code == END) break;
    COROT_TRY(read_next(m, version, &next));
    COROT_TRY(read_section(m, code));
    if (next == 0) break;
    r->at = (size_t)next;
  }
  return corot_medit_finish(m, mesh);
}

corot_status corot_medit_binary_parse(const char *path, const char *data, size_t size,
                                      const corot_reading *how, corot_mesh **mesh) {
  corot_medit m = {.r = {.path = path, .data = data, .size = size, .binary = true, .bytes = true}};
  corot_medit_begin(&m, how);
  corot_status status = corot_draft_end(&m.d, parse(&m, mesh));
  corot_draft_clear(&m.d);
  return status;
}

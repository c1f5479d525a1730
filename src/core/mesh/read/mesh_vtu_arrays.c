/* Arrays of VTK's XML files: in ASCII; as base64 in the tag or in what is appended; appended as
   they are; each of these as it is or in blocks that zlib has compressed. */
#include <limits.h>
#include <string.h>

#include "inflate.h"
#include "mesh_vtu.h"

/* A type of numbers. */
typedef struct type {
  const char *name;
  size_t bytes;
  bool real, is_signed;
} type;

static const type types[] = {
    {"Int8", 1, false, true},    {"UInt8", 1, false, false}, {"Int16", 2, false, true},
    {"UInt16", 2, false, false}, {"Int32", 4, false, true},  {"UInt32", 4, false, false},
    {"Int64", 8, false, true},   {"UInt64", 8, false, true}, {"Float32", 4, true, true},
    {"Float64", 8, true, true},
};

static corot_status fail(const corot_vtu *v, const corot_vtu_array *a, const char *what) {
  return corot_reader_fail(&v->r, a->tag.at, "array %.60s: %s", a->name, what);
}

static corot_status find_type(const corot_vtu *v, const corot_vtu_array *a, const type **t) {
  char name[24];
  corot_xml_attribute(&v->r, &a->tag, "type", sizeof name, name);
  for (size_t i = 0; i < sizeof types / sizeof *types; i++)
    if (strcmp(types[i].name, name) == 0) {
      *t = &types[i];
      return COROT_OK;
    }
  return corot_reader_fail(&v->r, a->tag.at, "array %.60s: the type '%s' is not known", a->name,
                           name);
}

/* --- Bytes --- */

/* Where the bytes of an array stand, as they are or as base64, of which groups of four characters
   may be padded anywhere: a header may be encoded for itself. */
typedef struct source {
  const char *at, *end;
  bool base64;
  unsigned char left[3]; /* of the last group, what nobody has taken yet */
  int nleft;
} source;

static int sextet(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/* The next four characters; false: there are none, or others than base64 has. */
static bool read_group(source *s) {
  int value[4] = {0}, n = 0, padded = 0;
  for (; n < 4 && s->at < s->end; s->at++) {
    if (strchr(" \t\r\n", *s->at) && *s->at) continue;
    if (*s->at == '=' && n >= 2)
      padded++;
    else if (padded || (value[n] = sextet(*s->at)) < 0)
      return false;
    n++;
  }
  if (n < 4) return false;
  unsigned bits = (unsigned)value[0] << 18 | (unsigned)value[1] << 12 | (unsigned)value[2] << 6 |
                  (unsigned)value[3];
  s->nleft = 3 - padded;
  for (int i = 0; i < s->nleft; i++)
    s->left[s->nleft - 1 - i] = (unsigned char)(bits >> (16 - 8 * i)); /* taken from the end */
  return true;
}

static bool take(source *s, size_t n, unsigned char *to) {
  if (!s->base64) {
    if ((size_t)(s->end - s->at) < n) return false;
    memcpy(to, s->at, n);
    s->at += n;
    return true;
  }
  for (size_t i = 0; i < n; i++) {
    if (s->nleft == 0 && !read_group(s)) return false;
    to[i] = s->left[--s->nleft];
  }
  return true;
}

/* How many bytes there can be at most. */
static uint64_t room_of(const source *s) { return (uint64_t)(s->end - s->at) + 3; }

/* Puts `n` bytes into the order of this machine. */
static uint64_t whole_of(const unsigned char *p, size_t n, bool swap) {
  unsigned char ordered[8] = {0};
  const uint16_t one = 1;
  bool little = *(const unsigned char *)&one == 1;
  uint64_t value = 0;
  for (size_t i = 0; i < n; i++) ordered[i] = p[little != swap ? n - 1 - i : i]; /* highest first */
  for (size_t i = 0; i < n; i++) value = value << 8 | ordered[i];
  return value;
}

static bool take_length(const corot_vtu *v, source *s, uint64_t *length) {
  unsigned char p[8];
  size_t n = v->wide ? 8 : 4;
  if (!take(s, n, p)) return false;
  *length = whole_of(p, n, v->swap);
  return true;
}

/* Blocks of `whole` bytes, the last of `last` unless that is 0, from compressed ones. */
static corot_status inflate_blocks(const corot_vtu *v, const corot_vtu_array *a, source *s,
                                   uint64_t nblock, uint64_t whole, const uint64_t *packed,
                                   uint64_t last, unsigned char *to) {
  for (uint64_t i = 0; i < nblock; i++) {
    unsigned char *block;
    size_t n = (size_t)(i + 1 == nblock && last ? last : whole);
    if (packed[i] > room_of(s)) return fail(v, a, "a block is longer than the file");
    COROT_TRY(COROT_ALLOC(block, packed[i]));
    bool ok = take(s, (size_t)packed[i], block) && corot_inflate(block, (size_t)packed[i], to, n);
    free(block);
    if (!ok) return fail(v, a, "a compressed block is damaged");
    to += n;
  }
  return COROT_OK;
}

/* NBLOCK, WHOLE, LAST, then the compressed length of each block, then the blocks. */
static corot_status read_compressed(const corot_vtu *v, const corot_vtu_array *a, source *s,
                                    unsigned char **bytes, size_t *n) {
  uint64_t nblock, whole, last, *packed, most = 1100 * room_of(s); /* zlib makes 1032 of one */
  if (!take_length(v, s, &nblock) || nblock > room_of(s))
    return fail(v, a, "the header is cut off");
  if (nblock == 0) {
    *n = 0;
    return COROT_ALLOC(*bytes, 1);
  }
  if (!take_length(v, s, &whole) || !take_length(v, s, &last) || whole > most || last > whole ||
      nblock > most / (whole ? whole : 1))
    return fail(v, a, "the lengths of its blocks make no sense");
  COROT_TRY(COROT_ALLOC(packed, nblock));
  bool ok = true;
  for (uint64_t i = 0; i < nblock && ok; i++) ok = take_length(v, s, &packed[i]);
  s->nleft = 0; /* the blocks are encoded for themselves */
  *n = (size_t)(whole * (nblock - 1) + (last ? last : whole));
  corot_status status = ok ? COROT_ALLOC(*bytes, *n) : fail(v, a, "the header is cut off");
  if (!status) status = inflate_blocks(v, a, s, nblock, whole, packed, last, *bytes);
  free(packed);
  return status;
}

static corot_status read_plain(const corot_vtu *v, const corot_vtu_array *a, source *s,
                               unsigned char **bytes, size_t *n) {
  uint64_t length;
  if (!take_length(v, s, &length)) return fail(v, a, "the data are cut off");
  if (length > room_of(s)) return fail(v, a, "the data are longer than the file");
  COROT_TRY(COROT_ALLOC(*bytes, length));
  *n = (size_t)length;
  return take(s, *n, *bytes) ? COROT_OK : fail(v, a, "the data are cut off, or no base64");
}

/* Where the array's data are. */
static corot_status find_source(const corot_vtu *v, const corot_vtu_array *a, source *s) {
  char format[16];
  int64_t offset;
  corot_xml_attribute(&v->r, &a->tag, "format", sizeof format, format);
  *s = (source){.at = v->r.data + a->tag.end, .end = v->r.data + v->r.size, .base64 = true};
  if (strcmp(format, "binary") == 0) {
    const char *end = memchr(s->at, '<', (size_t)(s->end - s->at));
    if (end) s->end = end;
    return COROT_OK;
  }
  if (strcmp(format, "appended") != 0)
    return corot_reader_fail(&v->r, a->tag.at,
                             "array %.60s: the format is '%s', not ascii, binary or "
                             "appended",
                             a->name, format);
  COROT_TRY(corot_xml_number(&v->r, &a->tag, "offset", 0, &offset));
  if (v->appended == 0) return fail(v, a, "there are no appended data");
  if ((uint64_t)offset > v->r.size - v->appended)
    return fail(v, a, "its offset is beyond the file");
  s->at = v->r.data + v->appended + offset;
  s->base64 = v->appended_base64;
  return COROT_OK;
}

static corot_status read_bytes(const corot_vtu *v, const corot_vtu_array *a, unsigned char **bytes,
                               size_t *n) {
  source s;
  COROT_TRY(find_source(v, a, &s));
  corot_status status =
      v->compressed ? read_compressed(v, a, &s, bytes, n) : read_plain(v, a, &s, bytes, n);
  if (status) {
    free(*bytes);
    *bytes = NULL;
  }
  return status;
}

/* --- Numbers --- */

static double real_of(const unsigned char *p, const type *t, bool swap) {
  uint64_t bits = whole_of(p, t->bytes, swap);
  if (t->bytes == 8) {
    double wide;
    memcpy(&wide, &bits, sizeof wide);
    return wide;
  }
  uint32_t narrow_bits = (uint32_t)bits;
  float narrow;
  memcpy(&narrow, &narrow_bits, sizeof narrow);
  return narrow;
}

static int64_t signed_of(const unsigned char *p, const type *t, bool swap) {
  uint64_t bits = whole_of(p, t->bytes, swap);
  if (t->bytes == 8)
    return bits > INT64_MAX && strcmp(t->name, "UInt64") == 0 ? INT64_MAX : (int64_t)bits;
  uint64_t sign = (uint64_t)1 << (8 * t->bytes - 1);
  return t->is_signed && bits & sign ? (int64_t)bits - 2 * (int64_t)sign : (int64_t)bits;
}

/* Text from the tag to the next: a number each into real or whole, of which one is given; `room`.
 */
static corot_status read_text(const corot_vtu *v, const corot_vtu_array *a, double **real,
                              int64_t **whole, size_t *n) {
  const char *begin = v->r.data + a->tag.end, *end = v->r.data + v->r.size,
             *stop = memchr(begin, '<', (size_t)(end - begin));
  size_t room = 0;
  corot_reader r = v->r;
  r.at = a->tag.end;
  r.flows = true;
  r.separator = '<';
  if (!stop) return fail(v, a, "it has no end");
  *n = 0;
  for (;;) {
    void *items = real ? (void *)*real : (void *)*whole;
    corot_reader_skip_lines(&r);
    if (r.data + r.at >= stop) return COROT_OK;
    COROT_TRY(corot_make_room(&items, *n, &room, 8));
    if (real) {
      *real = items;
      COROT_TRY(corot_reader_real(&r, "a number", &(*real)[*n]));
    } else {
      *whole = items;
      COROT_TRY(corot_reader_long(&r, "a whole number", &(*whole)[*n]));
    }
    ++*n;
  }
}

static bool is_text(const corot_vtu *v, const corot_vtu_array *a) {
  char format[16];
  return !corot_xml_attribute(&v->r, &a->tag, "format", sizeof format, format) ||
         strcmp(format, "ascii") == 0;
}

corot_status corot_vtu_reals(const corot_vtu *v, const corot_vtu_array *a, double **value,
                             size_t *n) {
  const type *t = &types[0];
  unsigned char *bytes = NULL;
  double *x = NULL;
  corot_status status = find_type(v, a, &t);
  if (!status && !t->real) status = fail(v, a, "it is of whole numbers");
  if (!status && is_text(v, a)) {
    status = read_text(v, a, &x, NULL, n);
  } else if (!status) {
    status = read_bytes(v, a, &bytes, n);
    if (!status) status = COROT_ALLOC(x, *n / t->bytes);
    if (!status) *n /= t->bytes;
    for (size_t i = 0; i < *n && !status; i++) x[i] = real_of(bytes + i * t->bytes, t, v->swap);
  }
  free(bytes);
  if (status)
    free(x);
  else
    *value = x;
  return status;
}

corot_status corot_vtu_wholes(const corot_vtu *v, const corot_vtu_array *a, int64_t **value,
                              size_t *n) {
  const type *t = &types[0];
  unsigned char *bytes = NULL;
  int64_t *x = NULL;
  corot_status status = find_type(v, a, &t);
  if (!status && t->real) status = fail(v, a, "it is of reals, not of whole numbers");
  if (!status && is_text(v, a)) {
    status = read_text(v, a, NULL, &x, n);
  } else if (!status) {
    status = read_bytes(v, a, &bytes, n);
    if (!status) status = COROT_ALLOC(x, *n / t->bytes);
    if (!status) *n /= t->bytes;
    for (size_t i = 0; i < *n && !status; i++) x[i] = signed_of(bytes + i * t->bytes, t, v->swap);
  }
  free(bytes);
  if (status)
    free(x);
  else
    *value = x;
  return status;
}

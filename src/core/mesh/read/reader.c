/* The cursor over a file in memory. */
#include "reader.h"

#include <errno.h>
#include <limits.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Makes room for at least one more byte besides the 0. */
static corot_status grow(char **data, size_t *capacity) {
  size_t more = *capacity ? 2 * *capacity : 65536;
  char *p = more > *capacity ? realloc(*data, more) : NULL;
  if (!p) return corot_fail(COROT_ENOMEM, "out of memory: %zu bytes for a file", more);
  *data = p;
  *capacity = more;
  return COROT_OK;
}

corot_status corot_file_load(const char *path, char **data, size_t *size) {
  char *d = NULL;
  size_t n = 0, capacity = 0;
  corot_status status = COROT_OK;
  FILE *file = fopen(path, "rb");
  if (!file) return corot_fail(COROT_EIO, "%s: %s", path, strerror(errno));
  do {
    if (n + 1 >= capacity) status = grow(&d, &capacity);
    if (!status) n += fread(d + n, 1, capacity - n - 1, file);
    if (!status && ferror(file)) status = corot_fail(COROT_EIO, "%s: %s", path, strerror(errno));
  } while (!status && !feof(file));
  fclose(file);
  if (status) {
    free(d);
    return status;
  }
  d[n] = 0;
  *data = d;
  *size = n;
  return COROT_OK;
}

/* Files of old Macintosh programs end their lines with CR alone. Binary files have 0 bytes. */
static void end_lines(char *data, size_t size) {
  if (memchr(data, '\n', size) || memchr(data, 0, size)) return;
  for (size_t i = 0; i < size; i++)
    if (data[i] == '\r') data[i] = '\n';
}

corot_status corot_reader_load(const char *path, char **data, size_t *size) {
  COROT_TRY(corot_file_load(path, data, size));
  char *d = *data;
  if (*size >= 2 && (memcmp(d, "\xff\xfe", 2) == 0 || memcmp(d, "\xfe\xff", 2) == 0)) {
    free(d);
    return corot_fail(COROT_EFORMAT, "%s: the text is UTF-16: save it as UTF-8 or ASCII", path);
  }
  if (*size >= 3 && memcmp(d, "\xef\xbb\xbf", 3) == 0) {
    *size -= 3;
    memmove(d, d + 3, *size + 1);
  }
  end_lines(d, *size);
  return COROT_OK;
}

/* The file and line of a place, counted from where the piece begins in which it is. */
static corot_reader_piece place_of(const corot_reader *r, size_t at) {
  corot_reader_piece p = {0, r->path, 1};
  for (size_t i = 0; i < r->npiece && r->piece[i].start <= at; i++) p = r->piece[i];
  for (size_t i = p.start; i < at; i++) p.line += r->data[i] == '\n';
  return p;
}

corot_status corot_reader_fail(const corot_reader *r, size_t at, const char *format, ...) {
  char text[800];
  va_list args;
  va_start(args, format);
  vsnprintf(text, sizeof text, format, args);
  va_end(args);
  if (r->bytes) return corot_fail(COROT_EFORMAT, "%s: byte %zu: %s", r->path, at, text);
  corot_reader_piece place = place_of(r, at);
  return corot_fail(COROT_EFORMAT, "%s:%ld: %s", place.path, place.line, text);
}

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/* Whether a value ends before c. */
static bool is_end(const corot_reader *r, char c) {
  return is_blank(c) || c == '\n' || c == 0 || c == r->separator ||
         (r->stops && strchr(r->stops, c));
}

bool corot_reader_more(corot_reader *r) {
  while (is_blank(r->data[r->at])) r->at++;
  if (r->comment && r->data[r->at] == r->comment)
    while (r->at < r->size && r->data[r->at] != '\n') r->at++;
  return r->at < r->size && r->data[r->at] != '\n';
}

void corot_reader_skip_lines(corot_reader *r) {
  while (!corot_reader_more(r) && r->at < r->size) r->at++;
}

void corot_reader_skip_line(corot_reader *r) {
  const char *end = memchr(r->data + r->at, '\n', r->size - r->at);
  r->at = end ? (size_t)(end - r->data) + 1 : r->size;
}

/* What stands here, for messages: quoted, and cut if long. */
typedef struct excerpt {
  char text[32];
} excerpt;

static excerpt found(corot_reader *r) {
  excerpt e;
  if (!corot_reader_more(r)) {
    snprintf(e.text, sizeof e.text, "%s",
             r->at < r->size ? "the end of the line" : "the end of the file");
    return e;
  }
  int n = 0;
  const char *p = r->data + r->at;
  while (n < 24 && !is_end(r, p[n])) n++;
  snprintf(e.text, sizeof e.text, "'%.*s%s'", n, p, is_end(r, p[n]) ? "" : "...");
  for (char *c = e.text; *c; c++)
    if ((unsigned char)*c < 0x20 || (unsigned char)*c >= 0x7f) *c = '?';
  return e;
}

corot_status corot_reader_end_line(corot_reader *r) {
  if (r->binary) return COROT_OK;
  if (corot_reader_more(r) && !r->flows)
    return corot_reader_fail(r, r->at, "%s is too much on this line", found(r).text);
  corot_reader_skip_lines(r);
  return COROT_OK;
}

bool corot_reader_word(corot_reader *r, const char *word) {
  size_t n = strlen(word);
  if (strncmp(r->data + r->at, word, n) != 0 || !is_end(r, r->data[r->at + n])) return false;
  r->at += n;
  return true;
}

bool corot_reader_separator(corot_reader *r) {
  if (!corot_reader_more(r) || r->data[r->at] != r->separator) return false;
  r->at++;
  return true;
}

/* Goes to the next value; false if there is none where it may stand. */
static bool next_value(corot_reader *r) {
  if (r->flows) corot_reader_skip_lines(r);
  return corot_reader_more(r);
}

static corot_status expected(corot_reader *r, const char *what) {
  excerpt e = found(r);
  return corot_reader_fail(r, r->at, "expected %s, found %s", what, e.text);
}

corot_status corot_reader_expect(corot_reader *r, const char *word) {
  return corot_reader_word(r, word) ? COROT_OK : expected(r, word);
}

static corot_status text_long(corot_reader *r, const char *what, int64_t *value) {
  if (!next_value(r)) return expected(r, what);
  const char *start = r->data + r->at, *p = start + (*start == '-' || *start == '+');
  int64_t v = 0;
  if (is_end(r, *p)) return expected(r, what);
  for (; !is_end(r, *p); p++) {
    if (*p < '0' || *p > '9') return expected(r, what);
    int digit = *p - '0';
    if (v < (INT64_MIN + digit) / 10)
      return corot_reader_fail(r, r->at, "%s is too large: %s", what, found(r).text);
    v = 10 * v - digit; /* negative, where the range is larger */
  }
  if (*start != '-' && v == INT64_MIN)
    return corot_reader_fail(r, r->at, "%s is too large: %s", what, found(r).text);
  *value = *start == '-' ? v : -v;
  r->at = (size_t)(p - r->data);
  return COROT_OK;
}

static corot_status text_int(corot_reader *r, const char *what, int *value) {
  next_value(r);
  size_t at = r->at;
  int64_t v = 0;
  COROT_TRY(text_long(r, what, &v));
  if (v < INT_MIN || v > INT_MAX)
    return corot_reader_fail(r, at, "%s is too large: %lld", what, (long long)v);
  *value = (int)v;
  return COROT_OK;
}

/* Fortran's 1.5D-3; NaN if it is no number. `end` is where it ends. */
static double fortran_real(const corot_reader *r, const char *start, const char **end) {
  char text[64], *stop;
  size_t n = 0;
  for (; n + 1 < sizeof text && !is_end(r, start[n]); n++)
    text[n] = start[n] == 'D' || start[n] == 'd' ? 'e' : start[n];
  text[n] = 0;
  double v = strtod(text, &stop);
  *end = start + (*stop ? 0 : n);
  return v;
}

static corot_status text_real(corot_reader *r, const char *what, double *value) {
  if (!next_value(r)) return expected(r, what);
  const char *start = r->data + r->at, *end;
  char *stop;
  double v = strtod(start, &stop);
  end = stop;
  if (end != start && (*end == 'D' || *end == 'd')) v = fortran_real(r, start, &end);
  if (end == start || !is_end(r, *end)) return expected(r, what);
  *value = v;
  r->at = (size_t)(end - r->data);
  return COROT_OK;
}

/* n bytes in the order of this machine. */
static corot_status take(corot_reader *r, const char *what, size_t n, void *value) {
  const char *from = r->data + r->at;
  if (r->size - r->at < n)
    return corot_reader_fail(r, r->at, "expected %s, found the end of the file", what);
  r->at += n;
  for (size_t i = 0; i < n; i++) ((char *)value)[i] = from[r->swap ? n - 1 - i : i];
  return COROT_OK;
}

corot_status corot_reader_int(corot_reader *r, const char *what, int *value) {
  int32_t v = 0;
  if (!r->binary) return text_int(r, what, value);
  COROT_TRY(take(r, what, sizeof v, &v));
  *value = v;
  return COROT_OK;
}

corot_status corot_reader_long(corot_reader *r, const char *what, int64_t *value) {
  int v = 0;
  if (!r->binary) return text_long(r, what, value);
  if (!r->narrow) return take(r, what, sizeof *value, value);
  COROT_TRY(corot_reader_int(r, what, &v));
  *value = v;
  return COROT_OK;
}

corot_status corot_reader_real(corot_reader *r, const char *what, double *value) {
  float v = 0;
  if (!r->binary) return text_real(r, what, value);
  if (!r->single) return take(r, what, sizeof *value, value);
  COROT_TRY(take(r, what, sizeof v, &v));
  *value = (double)v;
  return COROT_OK;
}

corot_status corot_reader_point(corot_reader *r, double x[3]) {
  COROT_TRY(corot_reader_real(r, "x", &x[0]));
  COROT_TRY(corot_reader_real(r, "y", &x[1]));
  return corot_reader_real(r, "z", &x[2]);
}

corot_status corot_reader_count(corot_reader *r, const char *what, size_t bytes, int *value) {
  if (!r->binary) next_value(r);
  size_t at = r->at;
  int64_t v = 0;
  COROT_TRY(corot_reader_long(r, what, &v));
  if (v < 0) return corot_reader_fail(r, at, "%s is %lld", what, (long long)v);
  if ((uint64_t)v > (r->size - r->at) / bytes || v > INT_MAX)
    return corot_reader_fail(r, at, "%s is %lld, more than the rest of the file can hold", what,
                             (long long)v);
  *value = (int)v;
  return COROT_OK;
}

corot_status corot_reader_count_line(corot_reader *r, const char *what, size_t bytes, int *value) {
  corot_reader_skip_lines(r);
  COROT_TRY(corot_reader_count(r, what, bytes, value));
  return corot_reader_end_line(r);
}

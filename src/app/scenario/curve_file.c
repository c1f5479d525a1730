/* Reads the table line by line; what is wrong is told with the line. */
#include "curve_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/text/no_memory.h"
#include "core/mesh/read/reader.h"

enum { MOST_BYTES = 256 << 20 };

/* A table on its way in. */
typedef struct reading {
  config *tree;
  config_source source;
  size_t at; /* in the source's text */
  bool jumps;
  int n, room;
  double *time, *value; /* [room] */
} reading;

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

static void skip_blanks(reading *r) {
  const char *text = r->source.text;
  while (is_blank(text[r->at])) r->at++;
  if (text[r->at] == '#') r->at += strcspn(text + r->at, "\n");
}

static bool line_ends(const reading *r) {
  return r->at >= r->source.size || r->source.text[r->at] == '\n';
}

/* The word here, up to what separates cells; its length in characters. */
static size_t word_length(const reading *r) {
  return strcspn(r->source.text + r->at, " \t\r\n,;#");
}

/* The number here, without going past it. */
static bool number_here(const reading *r, double *x) {
  char word[64];
  size_t length = word_length(r);
  if (length == 0 || length >= sizeof word) return false;
  memcpy(word, r->source.text + r->at, length);
  word[length] = '\0';
  return config_parse_number(&(config_node){.kind = CONFIG_SCALAR, .text = word}, x);
}

static corot_status take_number(reading *r, const char *what, double *x) {
  if (line_ends(r))
    return config_fail_at(&r->source, r->at, "expected %s, found the end of the line", what);
  int length = (int)word_length(r);
  if (!number_here(r, x))
    return config_fail_at(&r->source, r->at, "expected %s, a finite number in decimal, found %.*s",
                          what, length > 0 && length < 40 ? length : 1, r->source.text + r->at);
  r->at += (size_t)length;
  skip_blanks(r);
  return COROT_OK;
}

static corot_status make_room(reading *r) {
  if (r->n < r->room) return COROT_OK;
  int room = r->room ? 2 * r->room : 256;
  double *time = config_alloc(r->tree, 2 * (size_t)room, sizeof *time), *value = time + room;
  if (!time) return no_memory();
  if (r->n) {
    memcpy(time, r->time, (size_t)r->n * sizeof *time);
    memcpy(value, r->value, (size_t)r->n * sizeof *value);
  }
  r->time = time, r->value = value, r->room = room;
  return COROT_OK;
}

/* The times in order, at `at` that of the point to come. */
static corot_status check_time(const reading *r, size_t at, double t) {
  int n = r->n;
  if (n == 0 || t > r->time[n - 1]) return COROT_OK;
  if (t < r->time[n - 1])
    return config_fail_at(&r->source, at, "times must increase, but %g follows %g", t,
                          r->time[n - 1]);
  if (!r->jumps)
    return config_fail_at(&r->source, at, "the second point at %g: there are no jumps here", t);
  if (n > 1 && t == r->time[n - 2])
    return config_fail_at(
        &r->source, at, "the third point at %g: a jump has a value before it and one after it", t);
  return COROT_OK;
}

static corot_status take_point(reading *r) {
  double t, value;
  size_t at = r->at;
  COROT_TRY(take_number(r, "a time", &t));
  char separator = r->source.text[r->at];
  if (separator == ',' || separator == ';') {
    r->at++;
    skip_blanks(r);
  }
  COROT_TRY(take_number(r, "a value", &value));
  if (!line_ends(r))
    return config_fail_at(&r->source, r->at, "expected two columns, time and value; here is more");
  COROT_TRY(check_time(r, at, t));
  COROT_TRY(make_room(r));
  r->time[r->n] = t;
  r->value[r->n++] = value;
  return COROT_OK;
}

static corot_status take_points(reading *r) {
  const char *text = r->source.text;
  bool first = true;
  if (r->source.size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0) r->at = 3;
  while (r->at < r->source.size) {
    double ignored;
    skip_blanks(r);
    if (!line_ends(r)) {
      if (first && !number_here(r, &ignored))
        r->at += strcspn(text + r->at, "\n"); /* a header */
      else
        COROT_TRY(take_point(r));
      first = false;
    }
    if (r->at < r->source.size) r->at++;
  }
  if (r->n == 0) return config_fail_at(&r->source, 0, "no points of time and value");
  return COROT_OK;
}

/* Only what is a file, and not a large one: a device may have no end. */
static corot_status load(const config_node *node, const char *path, char **text, size_t *size) {
  struct stat about;
  if (stat(path, &about) == 0 && !S_ISREG(about.st_mode))
    return config_fail(node, "%s: not a file", path);
  if (stat(path, &about) == 0 && about.st_size > MOST_BYTES)
    return config_fail(node, "%s: larger than %d MiB, the limit of a table", path,
                       MOST_BYTES >> 20);
  corot_status status = corot_file_load(path, text, size);
  return status == COROT_EIO ? config_fail(node, "%s", corot_error()) : status;
}

corot_status curve_file_read(config *tree, const config_node *node, const char *path, bool jumps,
                             curve *out) {
  char *text = NULL;
  size_t size = 0;
  COROT_TRY(load(node, path, &text, &size));
  reading r = {.tree = tree,
               .source = {.name = path, .text = text, .size = size, .lines = true},
               .jumps = jumps};
  corot_status status = take_points(&r);
  if (status == COROT_OK) {
    *out = (curve){.n = r.n, .time = r.time, .value = r.value};
    hash_bytes(text, size, out->digest);
  }
  free(text);
  return status;
}

/* Reads the table line by line; what is wrong is told with the line. */
#include "curve_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "plain_file.h"

/* A table on its way in. */
typedef struct reading {
  config *tree;
  config_source source;
  size_t at;    /* in the source's text */
  int wanted;   /* a point, or -1, and */
  size_t place; /* where it stands */
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

static corot_status take_point(reading *r) {
  double t, value;
  if (r->n == r->wanted) r->place = r->at;
  COROT_TRY(take_number(r, "a time", &t));
  char separator = r->source.text[r->at];
  if (separator == ',' || separator == ';') {
    r->at++;
    skip_blanks(r);
  }
  COROT_TRY(take_number(r, "a value", &value));
  if (!line_ends(r))
    return config_fail_at(&r->source, r->at, "expected two columns, time and value; here is more");
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

static corot_status load(const config_node *node, const char *path, char **text, size_t *size) {
  corot_status status = plain_file_load(path, text, size);
  return status == COROT_EIO ? config_fail(node, "%s", corot_error()) : status;
}

/* Takes all points of a file, and notes where the wanted one stands. The text is the caller's to
   free, on failure as well. */
static corot_status take_file(config *tree, const config_node *node, const char *path, int wanted,
                              reading *r, char **text) {
  size_t size = 0;
  COROT_TRY(load(node, path, text, &size));
  *r = (reading){.tree = tree,
                 .source = {.name = path, .text = *text, .size = size, .lines = true},
                 .wanted = wanted};
  return take_points(r);
}

corot_status curve_file_read(config *tree, const config_node *node, const char *path, curve *out) {
  reading r;
  char *text = NULL;
  corot_status status = take_file(tree, node, path, -1, &r, &text);
  if (status == COROT_OK) {
    *out = (curve){.n = r.n, .time = r.time, .value = r.value};
    hash_bytes(text, r.source.size, out->digest);
  }
  free(text);
  return status;
}

corot_status curve_file_fail(config *tree, const config_node *node, const char *scenario_path,
                             int point, const char *reason) {
  const char *path = config_beside(tree, scenario_path, node->text);
  if (!path) return no_memory();
  reading r;
  char *text = NULL;
  corot_status status = take_file(tree, node, path, point, &r, &text);
  if (status == COROT_OK) status = config_fail_at(&r.source, r.place, "%s", reason);
  free(text);
  return status;
}

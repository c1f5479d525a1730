/* Reads the file line by line and refines after each: only then is the next line's range known. */
#include "marks_file.h"

#include <stdlib.h>
#include <string.h>

#include "app/config/config.h"
#include "app/text/no_memory.h"
#include "plain_file.h"

/* A file on its way in. */
typedef struct reading {
  config_source source;
  size_t at;   /* in the source's text */
  size_t line; /* where this one begins */
  int n, room;
  int *mark; /* [n] of this line */
} reading;

/* Goes past blanks and a comment; the value is whether a word follows on this line. */
static bool more_on_line(reading *r) {
  const char *text = r->source.text;
  r->at += strspn(text + r->at, " \t\r");
  if (text[r->at] == '#') r->at += strcspn(text + r->at, "\n");
  return r->at < r->source.size && text[r->at] != '\n';
}

static corot_status make_room(reading *r) {
  if (r->n < r->room) return COROT_OK;
  int room = r->room ? 2 * r->room : 256;
  int *mark = realloc(r->mark, (size_t)room * sizeof *mark);
  if (!mark) return no_memory();
  r->mark = mark;
  r->room = room;
  return COROT_OK;
}

/* A number of more digits than any tet has is larger than theirs. */
static corot_status take_mark(reading *r, int ntet) {
  const char *word = r->source.text + r->at;
  size_t length = strcspn(word, " \t\r\n#"), digits = strspn(word, "0123456789");
  int shown = length > 0 && length < 40 ? (int)length : digits == length ? 40 : 1;
  if (digits != length || digits == 0)
    return config_fail_at(&r->source, r->at, "expected the number of a tet, found %.*s", shown,
                          word);
  size_t zeros = strspn(word, "0");
  long mark = digits - (zeros < digits ? zeros : digits) > 10 ? ntet : strtol(word, NULL, 10);
  if (mark >= ntet)
    return config_fail_at(&r->source, r->at,
                          "tet %.*s does not exist: the mesh has %d here, and the last is %d",
                          shown, word, ntet, ntet - 1);
  COROT_TRY(make_room(r));
  r->mark[r->n++] = (int)mark;
  r->at += length;
  return COROT_OK;
}

/* Carries out one pass. */
static corot_status refine(reading *r, corot_mesh **mesh) {
  corot_mesh *fine;
  if (r->n == 0) return COROT_OK;
  corot_status status = corot_mesh_refine_marked(*mesh, r->n, r->mark, &fine, NULL);
  if (status == COROT_EINVAL) return config_fail_at(&r->source, r->line, "%s", corot_error());
  COROT_TRY(status);
  corot_mesh_destroy(*mesh);
  *mesh = fine;
  return COROT_OK;
}

static corot_status take_passes(reading *r, corot_mesh **mesh) {
  if (r->source.size >= 3 && memcmp(r->source.text, "\xEF\xBB\xBF", 3) == 0) r->at = 3;
  while (r->at < r->source.size) {
    r->n = 0;
    r->at += strspn(r->source.text + r->at, " \t\r");
    r->line = r->at;
    while (more_on_line(r)) COROT_TRY(take_mark(r, (*mesh)->ntet));
    COROT_TRY(refine(r, mesh));
    if (r->at < r->source.size) r->at++;
  }
  return COROT_OK;
}

corot_status marks_file_apply(const char *path, corot_mesh **mesh) {
  char *text = NULL;
  size_t size = 0;
  corot_status status = plain_file_load(path, &text, &size);
  reading r = {.source = {.name = path, .text = text, .size = size, .lines = true}};
  if (status == COROT_OK) status = take_passes(&r, mesh);
  free(r.mark);
  free(text);
  return status;
}

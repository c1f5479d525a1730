/* Gathers the builds from the results, and the sentence about them. */
#include "builds.h"

#include <stdlib.h>
#include <string.h>

#include "app/folder/provenance.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "app/text/say.h"
#include "app/text/text_stream.h"

/* --- The list --- */

static const json_t *provenance_at(const json_t *list, size_t i) {
  return json_object_get(json_array_get(list, i), "provenance");
}

static json_t *runs_at(const json_t *list, size_t i) {
  return json_object_get(json_array_get(list, i), "runs");
}

builds builds_begin(void) { return (builds){json_array(), json_object()}; }

void builds_free(builds *b) {
  json_decref(b->list);
  json_decref(b->entered);
  *b = (builds){NULL, NULL};
}

/* What the runs of one build share: not how many threads its BLAS had, which each run's result
   says. */
static json_t *shared_part(const json_t *provenance) {
  if (!provenance) return json_null();
  json_t *copy = json_deep_copy(provenance);
  json_t *blas = json_object_get(copy, "blas");
  if (json_object_get(blas, "threads")) json_object_del(blas, "threads");
  return copy;
}

/* Where the entry of a build is, made if there is none. NULL: no memory. */
static json_t *find_entry(json_t *list, const json_t *provenance) {
  size_t i = 0, n = json_array_size(list);
  while (i < n && !provenance_equal(provenance_at(list, i), provenance)) i++;
  if (i < n) return json_array_get(list, i);
  json_t *entry =
      json_pack("{s:o, s:[], s:i}", "provenance", shared_part(provenance), "runs", "references", 0);
  return json_array_append_new(list, entry) ? NULL : entry;
}

static bool enter(builds *b, const char *id, const json_t *provenance, bool reference) {
  json_t *entry = find_entry(b->list, provenance);
  if (!entry) return false;
  json_int_t count = json_integer_value(json_object_get(entry, "references")) + reference;
  return json_array_append_new(json_object_get(entry, "runs"), json_string(id)) == 0 &&
         json_object_set_new(entry, "references", json_integer(count)) == 0 &&
         json_object_set_new(b->entered, id, json_true()) == 0;
}

void builds_add(builds *b, const study_run *run, const json_t *result, bool reference) {
  if (!b->list || json_object_get(b->entered, run->id)) return;
  if (!enter(b, run->id, json_object_get(result, "provenance"), reference)) builds_free(b);
}

void builds_add_timed(builds *b, const study_run *run, const json_t *result,
                      const json_t *provenance) {
  char id[64];
  snprintf(id, sizeof id, "%s, timed", run->id);
  if (!b->list || json_object_get(b->entered, id)) return;
  if (provenance_equal(provenance, json_object_get(result, "provenance"))) return;
  if (!enter(b, id, provenance, false)) builds_free(b);
}

void builds_sort(builds *b) {
  size_t first = 0;
  for (size_t i = 1; i < json_array_size(b->list); i++)
    if (json_array_size(runs_at(b->list, i)) > json_array_size(runs_at(b->list, first))) first = i;
  if (first == 0) return;
  json_t *entry = json_incref(json_array_get(b->list, first));
  bool moved = json_array_remove(b->list, first) == 0 && json_array_insert(b->list, 0, entry) == 0;
  json_decref(entry);
  if (!moved) builds_free(b);
}

/* --- In words --- */

/* What a build has that not all of the list have, nor `own` (or NULL). */
static void describe(const json_t *list, const json_t *own, const json_t *build, FILE *out) {
  const char *separator = "";
  char text[160];
  if (!json_is_string(json_object_get(build, "corot"))) {
    fputs("a build that is not recorded", out);
    return;
  }
  for (int field = 0; field < PROVENANCE_FIELDS; field++) {
    bool same = !own || provenance_same(own, build, field);
    for (size_t i = 0; same && i < json_array_size(list); i++)
      same = provenance_same(provenance_at(list, i), build, field);
    if (same) continue;
    provenance_words(build, field, sizeof text, text);
    fprintf(out, "%s%s", separator, text);
    separator = ", ";
  }
}

static void list_runs(const json_t *runs, FILE *out) {
  enum { MOST = 8 };
  size_t n = json_array_size(runs);
  for (size_t i = 0; i < n && i < MOST; i++)
    fprintf(out, "%s%s", i ? ", " : " (", json_string_value(json_array_get(runs, i)));
  fputs(n > MOST ? ", ...)" : ")", out);
}

static void write_sentence(const json_t *list, FILE *out) {
  size_t n = json_array_size(list);
  fprintf(out, "The runs are of %zu different builds of corot: ", n);
  for (size_t i = 0; i < n; i++) {
    const json_t *runs = runs_at(list, i);
    json_int_t nreference =
        json_integer_value(json_object_get(json_array_get(list, i), "references"));
    fprintf(out, "%s%zu", i ? "; " : "", json_array_size(runs));
    if (nreference > 0)
      fprintf(out, ", %" JSON_INTEGER_FORMAT " of %s references,", nreference,
              json_array_size(runs) > 1 ? "them" : "which");
    fputs(" of ", out);
    describe(list, NULL, provenance_at(list, i), out);
    if (i > 0) list_runs(runs, out);
  }
  fputs(". What they differ by may be the builds' difference.", out);
}

/* Text that is written to a stream; NULL: no memory. */
typedef struct told {
  char *text;
  size_t size;
  FILE *out;
} told;

static FILE *told_begin(told *t) {
  *t = (told){NULL, 0, NULL};
  return t->out = text_open(&t->text, &t->size);
}

static const char *told_end(told *t) {
  if (!t->out || text_close(t->out) == 0) return t->text;
  free(t->text);
  return t->text = NULL;
}

json_t *builds_sentence(const json_t *list) {
  if (!list) return NULL;
  if (json_array_size(list) < 2) return json_null();
  told t;
  if (told_begin(&t)) write_sentence(list, t.out);
  const char *text = told_end(&t);
  json_t *sentence = text ? json_text_string(text) : NULL;
  free(t.text);
  return sentence;
}

/* The runs that are not of the build `own`. */
static size_t count_others(const json_t *list, const json_t *own) {
  size_t count = 0;
  for (size_t i = 0; i < json_array_size(list); i++)
    if (!provenance_equal(provenance_at(list, i), own)) count += json_array_size(runs_at(list, i));
  return count;
}

static void write_others(const json_t *list, const json_t *own, FILE *out) {
  const char *separator = "";
  for (size_t i = 0; i < json_array_size(list); i++) {
    if (provenance_equal(provenance_at(list, i), own)) continue;
    fputs(separator, out);
    describe(list, own, provenance_at(list, i), out);
    separator = "; ";
  }
  fputs("; this is ", out);
  describe(list, NULL, own, out);
}

corot_status builds_tell(const char *dir, const json_t *list) {
  json_t *own;
  if (!list) return no_memory();
  COROT_TRY(provenance_make(&own));
  size_t count = count_others(list, own);
  const char *text = "";
  told t = {0};
  if (count > 0) {
    if (told_begin(&t)) write_others(list, own, t.out);
    text = told_end(&t);
  }
  if (count > 0 && text)
    say("%s: %zu of the runs that are done are of another build (%s); they are kept; "
        "another folder has all of them made anew\n",
        dir, count, text);
  free(t.text);
  json_decref(own);
  return text ? COROT_OK : no_memory();
}

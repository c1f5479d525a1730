/* What a study's runs have in common with the references that they are held against, and what their
   errors therefore say nothing of. */
#include "collect_shared.h"

#include <stdio.h>
#include <string.h>

#include "app/text/json_text.h"
#include "report/read/lookup.h"

enum { FRAMES, MESH, STRAIN, HIERARCHY, MASS, DILATATION, NKIND, TEXT = 128 };

static const char *const kind_words[NKIND] = {"frames",    "mesh", "strain measure",
                                              "hierarchy", "mass", "dilatation"};

/* --- Of one run --- */

static bool has_frames(const json_t *said) {
  const char *strain = lookup_text(said, "strain");
  const corot_strain_kind *kind = corot_strain_find(strain);
  return !kind || kind->frames || json_is_object(lookup(said, "hierarchy"));
}

/* Frames that are renewed after every step are as old in a reference as its own steps are long:
   their error counts as that of time. */
static void name_frames(const json_t *result, char text[TEXT]) {
  const json_t *frames = lookup(result, "frames");
  const char *policy = lookup_text(frames, "policy");
  if (!*policy || strcmp(policy, "exact") == 0 || strcmp(policy, "step") == 0 ||
      !has_frames(lookup(result, "scenario")))
    return;
  double interval = lookup_number(frames, "interval"), angle = lookup_number(frames, "max_angle");
  int n = snprintf(text, TEXT, "frames %s", policy);
  if (interval > 0) n += snprintf(text + n, (size_t)(TEXT - n), " %g s", interval);
  if (angle > 0) snprintf(text + n, (size_t)(TEXT - n), " %g rad", angle);
}

/* A choice by its word, unless it is the one that approximates nothing. */
static void name_choice(const json_t *said, const char *key, const char *none, char text[TEXT]) {
  const char *word = lookup_text(said, key);
  if (*word && strcmp(word, none) != 0)
    snprintf(text, TEXT, "%.*s %.60s", (int)strcspn(key, "."), key, word);
}

/* Automatic, the mass of four-node tets is lumped. */
static void name_mass(const json_t *said, bool quadratic, char text[TEXT]) {
  bool automatic = strcmp(lookup_text(said, "mass"), "auto") == 0;
  if (!automatic)
    name_choice(said, "mass", "consistent", text);
  else if (!quadratic)
    snprintf(text, TEXT, "mass lumped");
}

json_t *approximations_of(const json_t *result) {
  const json_t *said = lookup(result, "scenario");
  char text[NKIND][TEXT] = {""};
  name_frames(result, text[FRAMES]);
  double tets = lookup_number(result, "mesh.tets");
  bool quadratic = lookup_number(result, "mesh.order") == 2;
  if (tets > 0)
    snprintf(text[MESH], TEXT, "mesh of %.0f %stets", tets, quadratic ? "ten-node " : "");
  name_choice(said, "strain", "green", text[STRAIN]);
  if (json_is_object(lookup(said, "hierarchy")))
    snprintf(text[HIERARCHY], TEXT, "hierarchy over %.60s",
             lookup_text(said, "hierarchy.coarse_strain"));
  name_mass(said, quadratic, text[MASS]);
  name_choice(said, "dilatation.name", "local", text[DILATATION]);
  json_t *list = json_array();
  for (int k = 0; k < NKIND; k++) json_array_append_new(list, json_text_string(text[k]));
  return list;
}

/* --- Of all cells --- */

static const char *word_at(const json_t *list, int kind) {
  const char *text = json_string_value(json_array_get(list, (size_t)kind));
  return text ? text : "";
}

static const json_t *reference_of(const table_rows *t, const table_row *r) {
  return r->measured ? t->reference[r->cell->reference].approximations : NULL;
}

static bool is_shared(const table_rows *t, const table_row *r, int kind) {
  return strcmp(word_at(r->approximations, kind), word_at(reference_of(t, r), kind)) == 0;
}

bool cell_shares_mesh(const table_rows *t, const table_row *r) { return is_shared(t, r, MESH); }

bool table_is_total(const table_rows *t) {
  bool total = false;
  for (int i = 0; i < t->n && !total; i++)
    total = t->row[i].measured && !cell_shares_mesh(t, &t->row[i]);
  return total;
}

/* Adds to a list in words. */
static void append(char *text, size_t size, const char *item) {
  size_t used = strlen(text);
  if (used < size) snprintf(text + used, size - used, "%s%s", used ? ", " : "", item);
}

json_t *cell_shared(const table_rows *t, const table_row *r) {
  char text[NKIND * TEXT] = "";
  if (!r->measured) return json_null();
  for (int k = 0; k < NKIND; k++)
    if (is_shared(t, r, k) && *word_at(r->approximations, k))
      append(text, sizeof text, word_at(r->approximations, k));
  return json_string(text);
}

/* How the cells stand to their references in one kind of approximation. */
typedef struct kind_summary {
  bool differs;     /* some cell from its reference: its errors are of that, too */
  bool varies;      /* from cell to cell */
  bool any;         /* cell makes it */
  const char *word; /* of the first */
} kind_summary;

static kind_summary summarize(const table_rows *t, int kind) {
  kind_summary s = {0};
  for (int i = 0; i < t->n; i++) {
    const table_row *r = &t->row[i];
    if (!r->measured) continue;
    const char *word = word_at(r->approximations, kind);
    if (!s.word) s.word = word;
    s.varies |= strcmp(word, s.word) != 0;
    s.differs |= !is_shared(t, r, kind);
    s.any |= *word != '\0';
  }
  return s;
}

/* Where errors are those of the mesh, too: at which nodes, and in which cells they are not. */
static void tell_of_meshes(const table_rows *t, size_t size, char *text) {
  int measured = 0, same = 0, n = 0;
  if (!t->total) return;
  for (int i = 0; i < t->n; i++) {
    measured += t->row[i].measured;
    same += t->row[i].measured && cell_shares_mesh(t, &t->row[i]);
  }
  n = snprintf(text, size,
               " They are total errors, the mesh's included, at the nodes of each cell's mesh.");
  if (same > 0)
    snprintf(text + n, size - (size_t)n,
             " %d of %d cells have the reference's own mesh, whose error is not in theirs.", same,
             measured);
}

json_t *table_shared(const table_rows *t) {
  char of[NKIND * TEXT] = "", same[NKIND * TEXT] = "", own[NKIND * TEXT] = "";
  bool measured = false;
  for (int i = 0; i < t->n; i++) measured |= t->row[i].measured;
  if (!measured) return json_null();
  /* each kind of approximation: in the errors, shared by all, or shared by pairs */
  for (int k = 0; k < NKIND; k++) {
    kind_summary s = summarize(t, k);
    if (s.differs)
      append(of, sizeof of, kind_words[k]);
    else if (s.varies)
      append(own, sizeof own, kind_words[k]);
    else if (s.any)
      append(same, sizeof same, s.word);
  }
  /* the sentence */
  char text[4 * NKIND * TEXT];
  int n = snprintf(text, sizeof text,
                   *of ? "Errors are those of %s, %s" : "Errors are those of %s alone%s",
                   t->still ? "the iteration" : "time", of);
  if (*same)
    n += snprintf(text + n, sizeof text - (size_t)n, "; all runs and references share: %s", same);
  if (*own)
    n += snprintf(text + n, sizeof text - (size_t)n, "; each run shares with its reference: its %s",
                  own);
  n += snprintf(text + n, sizeof text - (size_t)n, "%s.",
                *same || *own ? ". How wrong these are, corot budget says" : "");
  tell_of_meshes(t, sizeof text - (size_t)n, text + n);
  return json_string(text);
}

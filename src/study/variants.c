#define _XOPEN_SOURCE 700 /* realpath */

#include "variants.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "plan.h"
#include "store.h"

static corot_status no_memory(void) { return corot_fail(COROT_ENOMEM, "out of memory"); }

/* --- As a study file --- */

static void write_quoted(const char *text, FILE *out) {
  json_t *string = json_string(text);
  json_dumpf(string, out, JSON_ENCODE_ANY);
  json_decref(string);
}

/* A map with a line for each key; the last of equal ones counts. */
static void write_settings(int indent, int nset, const char *const *set, FILE *out) {
  int written = 0;
  for (int i = 0; i < nset; i++) {
    size_t length = strcspn(set[i], "=");
    bool again = false;
    for (int k = i + 1; k < nset; k++) again |= strncmp(set[i], set[k], length + 1) == 0;
    if (again) continue;
    fprintf(out, "\n%*s%.*s: %s", indent, "", (int)length, set[i], set[i] + length + 1);
    written++;
  }
  fputs(written ? "\n" : " {}\n", out);
}

static void write_study(const variants *v, const char *base, FILE *out) {
  fputs("study: ", out);
  write_quoted(v->title, out);
  fputs("\nbase: ", out);
  write_quoted(base, out);
  fputs("\nset:", out);
  write_settings(2, v->nset, v->set, out);
  fputs("axes:\n  - name: run\n    variants:\n", out);
  for (int i = 0; i < v->nvariant; i++) {
    fputs("      - label: ", out);
    write_quoted(v->variant[i].label, out);
    fputs("\n        set:", out);
    write_settings(10, v->variant[i].nset, v->variant[i].set, out);
  }
  fputs("reference: none\n", out);
}

static corot_status study_text(const variants *v, char **text, size_t *size) {
  char *base = realpath(v->scenario, NULL);
  if (!base) return corot_fail(COROT_EIO, "%s: cannot be found", v->scenario);
  FILE *out = open_memstream(text, size);
  if (out) write_study(v, base, out);
  free(base);
  return out && fclose(out) == 0 ? COROT_OK : no_memory();
}

static corot_status plan(const variants *v, manifest **out) {
  char *text = NULL;
  size_t size = 0;
  study *s = NULL;
  corot_status status = study_text(v, &text, &size);
  if (status == COROT_OK) status = study_read_text("runs", text, size, &s);
  if (status == COROT_OK) status = plan_study(s, out);
  study_destroy(s);
  free(text);
  return status;
}

/* --- Carrying it out --- */

static void find_runs(const variants *v, const manifest *m, int *run) {
  for (int i = 0; i < m->ncell; i++) {
    const char *label = json_string_value(json_object_get(m->cell[i].settings, "run"));
    for (int k = 0; label && k < v->nvariant; k++)
      if (strcmp(label, v->variant[k].label) == 0) run[k] = m->cell[i].run;
  }
}

corot_status variants_execute(const variants *v, const execute_options *options, manifest **out,
                              int *run, int *signal_number) {
  manifest *m = NULL;
  COROT_TRY(plan(v, &m));
  store_lock lock;
  execute_totals totals;
  corot_status status = store_enter(options->dir, m, options->shard, options->nshard, &lock);
  if (status == COROT_OK) {
    status = execute_study(m, options, &totals, signal_number);
    store_leave(lock);
  }
  if (status == COROT_OK && totals.nlost > 0 && !*signal_number)
    status = corot_fail(COROT_EIO,
                        "%d runs stopped for reasons from outside; the same command "
                        "tries them again",
                        totals.nlost);
  if (status != COROT_OK) {
    manifest_destroy(m);
    return status;
  }
  find_runs(v, m, run);
  *out = m;
  return COROT_OK;
}

#include "budget.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <app/json_text.h>
#include <report/lookup.h>

#include "budget_plan.h"
#include "errors.h"
#include "json_file.h"
#include "store.h"
#include "variants.h"

/* Runs: as given; the chain, one more approximation gone in each; each gone alone; the check. */
enum {
  NCHAIN = BUDGET_KINDS,
  NRUN_MAX = 2 * BUDGET_KINDS + 2,
  NSET_MAX = (BUDGET_KINDS + 1) * BUDGET_SETTINGS,
  LABEL_SIZE = 64,
};

typedef struct budgeting {
  const scenario *scenario;
  budget_plan plan;
  int nrun;
  variant variant[NRUN_MAX];
  char label[NRUN_MAX][LABEL_SIZE];
  const char *chain_set[NSET_MAX], *alone_set[BUDGET_KINDS][BUDGET_SETTINGS];
  const char *check_set[NSET_MAX];
  int run[NRUN_MAX]; /* of the manifest */
  manifest *manifest;
  trajectory states[NRUN_MAX]; /* without records where the run failed */
  double cpu[NRUN_MAX];        /* [s]; NaN: failed */
  const char *status[NRUN_MAX];
  yardstick *yardstick;
} budgeting;

static int chain_run(int part) { return 1 + part; }
static int alone_run(const budgeting *b, int part) { return 1 + b->plan.npart + part; }
static int check_run(const budgeting *b) { return 1 + 2 * b->plan.npart; }

/* --- The runs --- */

static void name_run(budgeting *b, int run, const char *what, const char *how) {
  snprintf(b->label[run], LABEL_SIZE, "%s%s", what, how);
  b->variant[run].label = b->label[run];
}

/* The check differs from the chain up to the part of time in the method alone. */
static void plan_check(budgeting *b, int ntime) {
  int n = 0;
  for (; n < ntime; n++) b->check_set[n] = b->chain_set[n];
  for (int k = 0; k < b->plan.check.nset; k++) b->check_set[n++] = b->plan.check.set[k];
  b->variant[check_run(b)].nset = n;
  b->variant[check_run(b)].set = b->check_set;
  name_run(b, check_run(b), "time integration", ", by another method");
}

static void plan_runs(budgeting *b) {
  int n = 0, ntime = -1;

  name_run(b, 0, "as given", "");
  for (int i = 0; i < b->plan.npart; i++) {
    const budget_part *part = &b->plan.part[i];
    if (part->kind == BUDGET_TIME) ntime = n;
    for (int k = 0; k < part->nset; k++) b->chain_set[n++] = b->alone_set[i][k] = part->set[k];
    b->variant[chain_run(i)] = (variant){.nset = n, .set = b->chain_set};
    b->variant[alone_run(b, i)] = (variant){.nset = part->nset, .set = b->alone_set[i]};
    name_run(b, chain_run(i), "less ", budget_names[part->kind]);
    name_run(b, alone_run(b, i), budget_names[part->kind], ", alone");
  }
  b->nrun = check_run(b) + (ntime >= 0);
  if (ntime >= 0) plan_check(b, ntime);
}

static corot_status load_run(budgeting *b, const char *dir, int i) {
  const study_run *run = &b->manifest->run[b->run[i]];
  run_record record;
  COROT_TRY(store_look(dir, run, &record));
  b->status[i] = record.state == RUN_DONE ? "done" : "failed";
  b->cpu[i] = NAN;
  corot_status status = COROT_OK;
  if (record.state == RUN_DONE) {
    json_t *cpu = json_object_get(json_object_get(record.result, "timings"), "cpu");
    b->cpu[i] = json_number_value(cpu);
    char *folder = store_path(dir, run, "");
    status = folder ? states_read(folder, &b->states[i]) : COROT_ENOMEM;
    free(folder);
  }
  run_record_free(&record);
  return status;
}

static corot_status carry_out(budgeting *b, int nset, const char *const *set,
                              const execute_options *options, int *signal_number) {
  variants v = {.what = "Error budget",
                .scenario = b->scenario,
                .nset = nset,
                .set = set,
                .nvariant = b->nrun,
                .variant = b->variant};
  COROT_TRY(variants_execute(&v, options, &b->manifest, b->run, signal_number));
  for (int i = 0; i < b->nrun && !*signal_number; i++) COROT_TRY(load_run(b, options->dir, i));
  return COROT_OK;
}

/* --- Their distances --- */

/* Of two runs, the second taken as exact. Without an error of both, NaN and NULL. */
typedef struct distance {
  error_pair displacement;
  json_t *probes; /* the caller's to decref */
} distance;

static json_t *probe_distances(const budgeting *b, const errors *e) {
  json_t *all = json_object();
  for (int i = 0; i < b->scenario->nprobe; i++) {
    error_pair of = e->of[ERROR_PROBES + i];
    all = json_text_with(
        all, b->scenario->probe[i].name,
        json_pack("{s:o, s:o}", "max", json_text_real(of.max), "end", json_text_real(of.end)));
  }
  return all;
}

static corot_status measure(const budgeting *b, int run, int reference, distance *out) {
  *out = (distance){.displacement = {NAN, NAN}};
  if (b->states[run].count == 0 || b->states[reference].count == 0) return COROT_OK;
  errors e;
  COROT_TRY(errors_measure(b->yardstick, &b->states[run], &b->states[reference], &e));
  out->displacement = e.of[ERROR_DISPLACEMENT];
  out->probes = probe_distances(b, &e);
  errors_free(&e);
  return COROT_OK;
}

/* --- As JSON --- */

static json_t *settings_text(const budget_part *part) {
  char text[BUDGET_SETTINGS * BUDGET_SETTING_SIZE] = "";
  for (int k = 0; k < part->nset; k++) {
    if (k) strcat(text, ", ");
    strcat(text, part->set[k]);
  }
  return json_text_string(text);
}

static corot_status part_json(const budgeting *b, int i, json_t **out) {
  const budget_part *part = &b->plan.part[i];
  distance chain, alone;
  COROT_TRY(measure(b, i == 0 ? 0 : chain_run(i - 1), chain_run(i), &chain));
  corot_status status = measure(b, 0, alone_run(b, i), &alone);
  *out = json_pack(
      "{s:s, s:o, s:o, s:o, s:o, s:o, s:o?, s:o, s:s}", "part", budget_names[part->kind], "pair",
      settings_text(part), "error", json_text_real(chain.displacement.max), "end",
      json_text_real(chain.displacement.end), "alone", json_text_real(alone.displacement.max),
      "alone_end", json_text_real(alone.displacement.end), "probes", chain.probes, "cost",
      json_text_real(b->cpu[alone_run(b, i)] / b->cpu[0]), "advice", budget_remedies[part->kind]);
  json_decref(alone.probes);
  if (status != COROT_OK) {
    json_decref(*out);
    *out = NULL;
  }
  return status;
}

/* The largest part, and what to do about it. Parts of opposite directions may leave less than the
   largest of them: then to take away one alone can make things worse. */
static json_t *advice(const json_t *parts, double total) {
  const json_t *part, *largest = NULL;
  size_t i;
  json_array_foreach(parts, i, part) {
    double error = lookup_number(part, "error");
    if (isfinite(error) && (!largest || error > lookup_number(largest, "error"))) largest = part;
  }
  if (!largest) return json_null();
  char cancel[128] = "";
  if (total < 0.7 * lookup_number(largest, "error"))
    snprintf(cancel, sizeof cancel,
             " Parts cancel one another: together they are %.1e; look at each alone.", total);
  return json_sprintf(
      "The largest part is that of %s, %.1e of the displacement. Change first: %s.%s",
      json_string_value(json_object_get(largest, "part")), lookup_number(largest, "error"),
      json_string_value(json_object_get(largest, "advice")), cancel);
}

static json_t *runs_json(const budgeting *b) {
  json_t *list = json_array();
  for (int i = 0; i < b->nrun; i++)
    list = json_text_push(list, json_pack("{s:s, s:s, s:s, s:o}", "run", b->label[i], "id",
                                          b->manifest->run[b->run[i]].id, "status", b->status[i],
                                          "cpu", json_text_real(b->cpu[i])));
  return list;
}

static corot_status totals(const budgeting *b, json_t *parts, json_t **out) {
  distance total, check = {.displacement = {NAN, NAN}};
  int ntime = -1;
  double sum = 0;
  for (int i = 0; i < b->plan.npart; i++) {
    if (b->plan.part[i].kind == BUDGET_TIME) ntime = i;
    sum += lookup_number(json_array_get(parts, (size_t)i), "error");
  }
  COROT_TRY(measure(b, 0, chain_run(b->plan.npart - 1), &total));
  corot_status status = COROT_OK;
  if (ntime >= 0) status = measure(b, check_run(b), chain_run(ntime), &check);
  json_decref(check.probes);
  *out = json_pack("{s:o, s:s, s:s, s:O, s:o, s:o, s:o?, s:o, s:o, s:o, s:o, s:o}", "title",
                   json_text_string(b->scenario->title), "scenario", b->scenario->path, "measure",
                   "displacement in the mass norm, relative to its largest; largest over time",
                   "parts", parts, "total", json_text_real(total.displacement.max), "total_end",
                   json_text_real(total.displacement.end), "total_probes", total.probes, "sum",
                   json_text_real(sum), "interaction", json_text_real(total.displacement.max - sum),
                   "check", json_text_real(check.displacement.max), "first",
                   advice(parts, total.displacement.max), "runs", runs_json(b));
  if (status == COROT_OK && !*out) status = corot_fail(COROT_ENOMEM, "out of memory");
  return status;
}

static corot_status rate(budgeting *b, json_t **out) {
  COROT_TRY(yardstick_create(b->scenario, &b->yardstick));
  json_t *parts = json_array();
  corot_status status = COROT_OK;
  for (int i = 0; i < b->plan.npart && status == COROT_OK; i++) {
    json_t *part;
    status = part_json(b, i, &part);
    if (status == COROT_OK && json_array_append_new(parts, part))
      status = corot_fail(COROT_ENOMEM, "out of memory");
  }
  if (status == COROT_OK) status = totals(b, parts, out);
  json_decref(parts);
  return status;
}

static void release(budgeting *b) {
  for (int i = 0; i < b->nrun; i++) states_free(&b->states[i]);
  yardstick_destroy(b->yardstick);
  manifest_destroy(b->manifest);
  free(b);
}

corot_status budget_make(const scenario *s, int nset, const char *const *set, const bool *skip,
                         const execute_options *options, json_t **out, int *signal_number) {
  budgeting *b = calloc(1, sizeof *b);
  if (!b) return corot_fail(COROT_ENOMEM, "out of memory");
  b->scenario = s;
  budget_plan_make(s, &b->plan);
  for (int k = 0; k < BUDGET_KINDS; k++)
    if (skip[k]) budget_plan_skip(&b->plan, (budget_kind)k);
  if (b->plan.npart == 0) {
    free(b);
    return corot_fail(COROT_EINVAL, "nothing is left of the budget");
  }
  plan_runs(b);
  json_t *made = NULL;
  corot_status status = carry_out(b, nset, set, options, signal_number);
  if (status == COROT_OK && !*signal_number) status = rate(b, &made);
  if (status == COROT_OK && made) status = json_file_write(options->dir, "budget.json", made);
  release(b);
  if (status != COROT_OK) {
    json_decref(made);
    return status;
  }
  *out = made;
  return COROT_OK;
}

/* --- As text --- */

static void print_error(double error, FILE *out) {
  if (isfinite(error))
    fprintf(out, "  %9.2e", error);
  else
    fprintf(out, "  %9s", "?");
}

void budget_print(const json_t *budget, FILE *out) {
  const json_t *parts = json_object_get(budget, "parts"), *part;
  size_t i;
  fprintf(out, "%-18s  %9s  %9s  %9s  %5s  %s\n", "part", "largest", "at end", "alone", "cost",
          "taken away by");
  json_array_foreach(parts, i, part) {
    fprintf(out, "%-18s", json_string_value(json_object_get(part, "part")));
    print_error(lookup_number(part, "error"), out);
    print_error(lookup_number(part, "end"), out);
    print_error(lookup_number(part, "alone"), out);
    double cost = lookup_number(part, "cost");
    if (isfinite(cost))
      fprintf(out, "  %5.3g", cost);
    else
      fprintf(out, "  %5s", "?");
    fprintf(out, "  %s\n", json_string_value(json_object_get(part, "pair")));
  }
  fprintf(out, "%-18s", "total");
  print_error(lookup_number(budget, "total"), out);
  print_error(lookup_number(budget, "total_end"), out);
  fprintf(out, "\n%-18s", "sum of the parts");
  print_error(lookup_number(budget, "sum"), out);
  fprintf(out, "\n%-18s", "interaction");
  print_error(lookup_number(budget, "interaction"), out);
  fprintf(out, "\n%-18s", "check of time");
  print_error(lookup_number(budget, "check"), out);
  fputs("\n", out);
  const char *first = json_string_value(json_object_get(budget, "first"));
  if (first) fprintf(out, "%s\n", first);
}

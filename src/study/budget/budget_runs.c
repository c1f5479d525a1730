/* The runs of an error budget: planned, made, and read. */
#include "budget_runs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"
#include "study/execute/store.h"
#include "study/execute/variants.h"
#include "study/measure/collect_quantities.h"
#include "study/measure/states_sum.h"

int budget_chain_run(const budgeting *b, int part) {
  (void)b;
  return 1 + part;
}

int budget_before_run(const budgeting *b, int part) {
  return part == 0 ? 0 : budget_chain_run(b, part - 1);
}

int budget_alone_run(const budgeting *b, int part) { return 1 + b->plan.npart + part; }

const trajectory *budget_states(const budgeting *b, int run) {
  return run >= 0 && b->run[run].states.count > 0 ? &b->run[run].states : NULL;
}

/* --- Planning --- */

static int add_run(budgeting *b, const char *what, const char *how) {
  budget_run *run = &b->run[b->nrun];
  snprintf(run->label, LABEL_SIZE, "%s%s", what, how);
  run->status = "missing";
  return b->nrun++;
}

static void add_settings(budgeting *b, int run, const budget_part *part) {
  budget_run *r = &b->run[run];
  for (int k = 0; k < part->nset; k++) r->set[r->nset++] = part->set[k];
}

/* The settings of the chain before part `end`. */
static void add_chain(budgeting *b, int run, int end) {
  for (int i = 0; i < end; i++) add_settings(b, run, &b->plan.part[i]);
}

/* In the place of a part: the chain up to it with other settings. */
static int add_variant(budgeting *b, int place, const budget_part *part, const char *how) {
  int run = add_run(b, budget_names[part->kind], how);
  add_chain(b, run, place);
  add_settings(b, run, part);
  return run;
}

static void plan_runs(budgeting *b) {
  const budget_plan *plan = &b->plan;
  for (int k = 0; k < BUDGET_KINDS; k++) b->place[k] = -1;
  for (int i = 0; i < plan->npart; i++) b->place[plan->part[i].kind] = i;
  b->algebra_check = b->third_run = -1;
  int time = b->place[BUDGET_TIME], algebra = b->place[BUDGET_ALGEBRA];

  add_run(b, "as given", "");
  for (int i = 0; i < plan->npart; i++)
    add_chain(b, add_run(b, "less ", budget_names[plan->part[i].kind]), i + 1);
  for (int i = 0; i < plan->npart; i++)
    add_settings(b, add_run(b, budget_names[plan->part[i].kind], ", alone"), &plan->part[i]);

  if (time >= 0) {
    b->tight[0] = budget_chain_run(b, time);
    b->check[0] = add_variant(b, time, &plan->check, ", by another method");
    b->ntight = 1;
  }
  if (algebra >= 0)
    b->algebra_check = add_variant(b, algebra, &plan->algebra_check, ", ten times looser");
}

/* --- Making --- */

/* As four-node ones. */
static double tets_of(const json_t *result) {
  const json_t *mesh = json_object_get(result, "mesh");
  double tets = json_number_value(json_object_get(mesh, "tets"));
  return json_number_value(json_object_get(mesh, "order")) == 2 ? BUDGET_TETS_PER_TET10 * tets
                                                                : tets;
}

/* Iterations of an equilibrium, steps of a run. */
static double work_of(const json_t *result) {
  const json_t *statistics = json_object_get(result, "statistics");
  const json_t *steps = json_object_get(statistics, "nst");
  if (!json_is_number(steps)) steps = json_object_get(statistics, "nni");
  return json_number_value(steps) * tets_of(result);
}

/* value [nquantity] */
static corot_status read_quantities(const scenario *s, const json_t *result, double **value) {
  double *x = malloc(((size_t)s->nquantity + 1) * sizeof *x);
  if (!x) return corot_fail(COROT_ENOMEM, "out of memory");
  for (int i = 0; i < s->nquantity; i++) x[i] = quantity_found(result, s->quantity[i].name);
  *value = x;
  return COROT_OK;
}

static corot_status load_run(budgeting *b, const char *dir, budget_run *run) {
  const study_run *entry = &b->manifest->run[run->at];
  run_record record;
  COROT_TRY(store_look(dir, entry, &record));
  run->looked = true;
  run->status = record.state == RUN_DONE ? "done" : "failed";
  run->cpu = run->work = run->tets = NAN;
  corot_status status = COROT_OK;
  if (record.state == RUN_DONE) {
    builds_add(&b->builds, entry, record.result, false);
    const json_t *times = json_object_get(record.result, "timings");
    run->cpu = json_number_value(json_object_get(times, "cpu"));
    run->work = work_of(record.result);
    run->tets = tets_of(record.result);
    char *folder = store_path(dir, entry, "");
    status = folder ? states_read(folder, &run->states) : COROT_ENOMEM;
    if (status == COROT_OK) status = read_quantities(b->scenario, record.result, &run->quantity);
    free(folder);
    if (status == COROT_OK && b->options->still) states_keep_last(&run->states);
  }
  run_record_free(&record);
  return status;
}

/* Makes what is missing of all runs planned so far, and reads what is new. */
static corot_status carry_out(budgeting *b, int nset, const char *const *set,
                              const execute_options *options, int *signal_number) {
  variant list[NRUN_MAX];
  int at[NRUN_MAX];
  for (int i = 0; i < b->nrun; i++)
    list[i] = (variant){.label = b->run[i].label, .nset = b->run[i].nset, .set = b->run[i].set};
  variants v = {.what = b->options->still ? "Error budget of the equilibrium" : "Error budget",
                .scenario = b->scenario,
                .still = b->options->still,
                .nset = nset,
                .set = set,
                .nvariant = b->nrun,
                .variant = list};
  manifest *m = NULL;
  COROT_TRY(variants_execute(&v, options, &m, at, signal_number));
  manifest_destroy(b->manifest);
  b->manifest = m;
  for (int i = 0; i < b->nrun && !*signal_number; i++) {
    b->run[i].at = at[i];
    if (!b->run[i].looked) COROT_TRY(load_run(b, options->dir, &b->run[i]));
  }
  return COROT_OK;
}

corot_status budget_distance(const budgeting *b, const trajectory *run, const trajectory *reference,
                             errors *out) {
  return claim_distance(b->yardstick, run, reference, out);
}

/* The displacement's alone. */
static corot_status displacement_distance(const budgeting *b, int run, int reference,
                                          error_pair *out) {
  errors e;
  COROT_TRY(budget_distance(b, budget_states(b, run), budget_states(b, reference), &e));
  *out = e.n > 0 ? e.of[ERROR_DISPLACEMENT] : (error_pair){NAN, NAN};
  errors_free(&e);
  return COROT_OK;
}

/* --- A better reference of time, where the first one is no better than what it judges --- */

static corot_status judge_time(const budgeting *b, bool *enough) {
  int k = b->ntight - 1;
  error_pair error, check;
  COROT_TRY(
      displacement_distance(b, budget_before_run(b, b->place[BUDGET_TIME]), b->tight[k], &error));
  COROT_TRY(displacement_distance(b, b->check[k], b->tight[k], &check));
  /* what failed will not do better with smaller tolerances */
  *enough = isnan(error.max) || isnan(check.max) || is_rated(&error, &check, false);
  return COROT_OK;
}

static corot_status tighten_time(budgeting *b, int nset, const char *const *set,
                                 const execute_options *options, int *signal_number) {
  while (b->ntight > 0 && b->ntight <= BUDGET_TRIES && !*signal_number) {
    bool enough;
    COROT_TRY(judge_time(b, &enough));
    budget_part *finer = b->finer[b->ntight - 1];
    if (enough || !(budget_plan_tighten(b->scenario, b->ntight, &finer[0], &finer[1]) > 0)) break;
    char how[LABEL_SIZE / 2];
    snprintf(how, sizeof how, ", finer, %d", b->ntight);
    int reference = add_variant(b, b->place[BUDGET_TIME], &finer[0], how);
    snprintf(how, sizeof how, ", finer, %d, checked", b->ntight);
    int check = add_variant(b, b->place[BUDGET_TIME], &finer[1], how);
    b->run[reference].spare = b->run[check].spare = true;
    COROT_TRY(carry_out(b, nset, set, options, signal_number));
    if (!budget_states(b, reference) || !budget_states(b, check)) break;
    b->tight[b->ntight] = reference;
    b->check[b->ntight++] = check;
  }
  return COROT_OK;
}

/* --- The third level of the mesh --- */

/* Whether steps as they are given do for the third level: their error in time is small beside the
   difference of the first two levels. */
static corot_status may_be_loose(const budgeting *b, int space, bool *loose) {
  *loose = false;
  if (b->place[BUDGET_TIME] < 0) return COROT_OK;
  error_pair time, difference;
  COROT_TRY(displacement_distance(b, budget_before_run(b, b->place[BUDGET_TIME]),
                                  b->tight[b->ntight - 1], &time));
  COROT_TRY(displacement_distance(b, budget_before_run(b, space), budget_chain_run(b, space),
                                  &difference));
  *loose = 40 * time.max <= difference.max;
  return COROT_OK;
}

/* How much more than the run as given: from level to level it grows by equal factors. */
static void weigh_third(budgeting *b, int space, bool loose) {
  int one = loose ? budget_alone_run(b, space) : budget_chain_run(b, space);
  int zero = loose ? 0 : budget_before_run(b, space);
  double work = b->run[one].work * b->run[one].work / b->run[zero].work;
  double tets = (b->plan.by_order ? 8 * BUDGET_TETS_PER_TET10 : 64) * b->run[0].tets;
  if (b->options->levels == 3 || budget_plan_affords(b->options->still, work, tets)) return;
  if (isnan(work) || isnan(tets))
    snprintf(b->left_out, sizeof b->left_out, "its coarser levels failed");
  else
    snprintf(b->left_out, sizeof b->left_out,
             "%.3g tets, about %.2g times the work of the run as given; --levels 3 makes it", tets,
             work / b->run[0].work);
}

static corot_status refine_again(budgeting *b, int nset, const char *const *set,
                                 const execute_options *options, int *signal_number) {
  /* whether a third level is wanted, and can be paid for */
  int space = b->place[BUDGET_SPACE];
  if (space < 0 || !budget_states(b, budget_chain_run(b, space)) ||
      !budget_states(b, budget_before_run(b, space)))
    return COROT_OK;
  bool loose;
  COROT_TRY(may_be_loose(b, space, &loose));
  if (b->options->levels == 2)
    snprintf(b->left_out, sizeof b->left_out, "--levels 2 was asked for");
  else
    weigh_third(b, space, loose);
  if (*b->left_out) return COROT_OK;

  /* its run: without all that the second level is without */
  budget_plan_finer(&b->plan, b->scenario, 2, &b->third);
  b->third_is_loose = loose;
  b->third_run = add_run(b, "space, third level", "");
  for (int i = 0; i < space; i++)
    if (!loose || b->plan.part[i].kind != BUDGET_TIME)
      add_settings(b, b->third_run, &b->plan.part[i]);
  add_settings(b, b->third_run, &b->third);
  COROT_TRY(carry_out(b, nset, set, options, signal_number));
  if (!*signal_number && !budget_states(b, b->third_run))
    snprintf(b->left_out, sizeof b->left_out, "its run failed");
  return COROT_OK;
}

/* --- All of it --- */

corot_status budget_runs_make(budgeting *b, int nset, const char *const *set,
                              const execute_options *options, int *signal_number) {
  execute_options o = *options;
  plan_runs(b);
  COROT_TRY(carry_out(b, nset, set, &o, signal_number));
  if (*signal_number) return COROT_OK;
  o.tells_builds = false;
  o.expects_failures = true; /* told already, or looked at below */
  COROT_TRY(yardstick_create(b->scenario, &b->yardstick));
  COROT_TRY(tighten_time(b, nset, set, &o, signal_number));
  return *signal_number ? COROT_OK : refine_again(b, nset, set, &o, signal_number);
}

/* `corot find-limit`: options, then the bisection. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/command/cli.h"
#include "app/folder/folder.h"
#include "app/folder/read_csv.h"
#include "app/text/json_text.h"
#include "app/text/say.h"
#include "command_study.h"
#include "study/execute/builds.h"
#include "study/execute/store.h"
#include "study/execute/variants.h"
#include "study/measure/collect_quantities.h"
#include "study/measure/limit.h"
#include "study/plan/json_file.h"
#include "variants_command.h"

static const char help[] =
    "usage: corot find-limit MODEL.yaml --key KEY --from A --to B [-o DIR] [--set KEY=VALUE]... "
    "...\n"
    "\n"
    "Where does a scenario stop being stable as one of its numbers grows? Tries values of the key\n"
    "from A to B in equal ratios, then halves (in ratios) the step from the last stable to the\n"
    "first unstable one. A run is unstable if the integrator gives up, or if its kinetic and\n"
    "elastic energy ever exceed those of the run at A, at their largest, by the factor of "
    "--energy.\n"
    "With --quantity the question is where that number leaves its bound, in place of the energy's: "
    "a\n"
    "run is stable while it is below (or above) the bound.\n"
    "\n"
    "      --key KEY        the number that is varied, as frames.interval or integrator.step\n"
    "      --from A, --to B its range, 0 < A < B; the run at A must be stable\n"
    "      --scan N         values tried first, A and B included, 2 to 64; default 9\n"
    "      --precision P    the limit is known to this fraction; default 0.02\n"
    "      --energy F       how much more energy is too much, > 1; default 2\n"
    "      --quantity Q     a number of the run, such as max(corner.ux) or corner.ux@end; see\n"
    "                       corot schema quantities\n"
    "      --below X        stable while Q < X;\n"
    "      --above X        or while Q > X\n"
    "  -o, --output DIR     a folder for each run, and limit.json; default: out/MODEL-limit\n"
    "      --set KEY=VALUE  overrides a key of the scenario; any number of times\n"
    "  -j, --jobs N         so many runs at once; default: the number of processors\n"
    "      --timeout S      ends a run that takes longer than S seconds\n"
    "      --force          takes a folder that holds files of others by the names of corot's\n"
    "  -q, --quiet          nothing on stderr but errors\n"
    "      --json           limit.json on stdout in place of the table\n"
    "\n"
    "Exit code 1: the run at A is not stable, or all of them are.\n"
    "\n"
    "example: corot find-limit bar.yaml --set frames.policy=hold --key frames.interval \\\n"
    "           --from 0.01 --to 2\n";

static const struct option own[] = {
    {"key", required_argument, NULL, 'K'},       {"from", required_argument, NULL, 'A'},
    {"to", required_argument, NULL, 'B'},        {"scan", required_argument, NULL, 'N'},
    {"precision", required_argument, NULL, 'P'}, {"energy", required_argument, NULL, 'F'},
    {"quantity", required_argument, NULL, 'Q'},  {"below", required_argument, NULL, 'L'},
    {"above", required_argument, NULL, 'U'},     {0},
};

enum { SETTING_SIZE = 160 };

/* The number that is asked for in place of the energy. */
typedef struct bound {
  bool asked;
  quantity_option of;
  double below, above; /* NaN: not given */
} bound;

typedef struct search {
  const char *key;
  char first[SETTING_SIZE]; /* it, and the smallest value */
  limit_def def;
  double factor; /* of energy */
  bound bound;
  const scenario *scenario;
  const variants_arguments *arguments;
  double energy; /* at `from`, at its largest [J]; NaN: not yet known */
  int signal_number;
  bool looked; /* at what there was before */
  builds made_by;
} search;

/* --- Arguments --- */

static bool parse_number(const char *text, double *out) {
  char *end;
  *out = strtod(text, &end);
  return end > text && !*end && isfinite(*out);
}

static int take(void *context, int option, const char *value) {
  search *s = context;
  double number;
  if (option == 'K') {
    s->key = value;
    if (*value && strlen(value) < SETTING_SIZE / 2 && !strchr(value, '=')) return -1;
    return usage_error("corot find-limit", "--key %s: expected a key such as frames.interval",
                       value);
  }
  if (option == 'Q') {
    s->bound.asked = true;
    return variants_take_quantity("corot find-limit", value, &s->bound.of);
  }
  if (!parse_number(value, &number))
    return usage_error("corot find-limit", "%s: expected a number", value);
  switch (option) {
    case 'A':
      s->def.from = number;
      return -1;
    case 'B':
      s->def.to = number;
      return -1;
    case 'L':
      s->bound.below = number;
      return -1;
    case 'U':
      s->bound.above = number;
      return -1;
    case 'P':
      s->def.precision = number;
      return -1;
    case 'F':
      s->factor = number;
      if (number > 1) return -1;
      return usage_error("corot find-limit", "--energy %s: expected a number above 1", value);
    default:
      s->def.nscan = number == (int)number ? (int)number : 0;
      return -1;
  }
}

/* --- Trials --- */

/* The largest sum of kinetic and elastic energy, infinite if it ever is no number; NaN where the
   table is empty. */
static corot_status largest_energy(const char *dir, double *largest) {
  csv table;
  double *kinetic = NULL, *elastic = NULL;
  COROT_TRY(csv_read(dir, "energy.csv", &table));
  corot_status status = csv_column(&table, "kinetic", &kinetic);
  if (status == COROT_OK) status = csv_column(&table, "elastic", &elastic);
  *largest = NAN;
  for (int i = 0; status == COROT_OK && i < table.nrow; i++) {
    double energy = kinetic[i] + elastic[i];
    *largest = fmax(*largest, isnan(energy) ? INFINITY : energy);
  }
  free(kinetic);
  free(elastic);
  csv_free(&table);
  return status;
}

/* Unstable runs have a build, too. */
static corot_status enter_build(search *s, const study_run *run) {
  char *path = store_path(s->arguments->options.dir, run, "result.json");
  json_t *result = NULL;
  bool there = false;
  corot_status status = path ? folder_look(path, &there) : COROT_ENOMEM;
  if (status == COROT_OK && there) status = json_file_read(path, &result);
  free(path);
  if (status == COROT_OK && result) builds_add(&s->made_by, run, result, false);
  json_decref(result);
  return status;
}

/* Of a run that is done. */
static corot_status judge_quantity(const search *s, const study_run *run, limit_trial *trial) {
  const bound *b = &s->bound;
  run_record record;
  COROT_TRY(store_look(s->arguments->options.dir, run, &record));
  const json_t *all = json_object_get(record.result, "quantities");
  const char *why = json_string_value(json_object_get(json_object_get(all, b->of.name), "reason"));
  trial->quantity = quantity_found(record.result, b->of.name);
  trial->stable =
      !(trial->quantity >= b->below) && !(trial->quantity <= b->above) && !isnan(trial->quantity);
  if (isnan(trial->quantity))
    snprintf(trial->reason, sizeof trial->reason, "%.100s has no value: %.120s", b->of.text,
             why ? why : "");
  else if (!trial->stable)
    snprintf(trial->reason, sizeof trial->reason, "%.200s = %.6g", b->of.text, trial->quantity);
  run_record_free(&record);
  return COROT_OK;
}

static corot_status judge(search *s, const study_run *run, limit_trial *trial) {
  run_record record;
  COROT_TRY(store_look(s->arguments->options.dir, run, &record));
  trial->quantity = NAN;
  trial->stable = record.state == RUN_DONE;
  snprintf(trial->reason, sizeof trial->reason, "%s", record.reason ? record.reason : "");
  run_record_free(&record);
  COROT_TRY(enter_build(s, run));
  if (!trial->stable) return COROT_OK;
  if (s->bound.asked) return judge_quantity(s, run, trial);

  char *dir = store_path(s->arguments->options.dir, run, "");
  double energy;
  if (!dir) return COROT_ENOMEM;
  corot_status status = largest_energy(dir, &energy);
  free(dir);
  COROT_TRY(status);
  if (isnan(s->energy)) s->energy = energy;
  if (energy <= s->factor * s->energy) return COROT_OK;
  trial->stable = false;
  snprintf(trial->reason, sizeof trial->reason, "energy of %.3g J, where the stable run has %.3g",
           energy, s->energy);
  return COROT_OK;
}

static corot_status try_values(void *context, int n, limit_trial *trial) {
  search *s = context;
  char text[LIMIT_SCAN_MOST][SETTING_SIZE];
  const char *set[LIMIT_SCAN_MOST];
  variant v[LIMIT_SCAN_MOST];
  int run[LIMIT_SCAN_MOST];
  /* one variant for each value */
  for (int i = 0; i < n; i++) {
    snprintf(text[i], SETTING_SIZE, "%s=%.9g", s->key, trial[i].value);
    set[i] = text[i];
    v[i] = (variant){.label = strchr(text[i], '=') + 1, .nset = 1, .set = &set[i]};
  }
  /* all of them are one small study; runs that fail are what is looked for */
  char what[SETTING_SIZE];
  snprintf(what, sizeof what, "Limit of %s", s->key);
  variants all = {.what = what,
                  .scenario = s->scenario,
                  .nset = s->arguments->nset,
                  .set = s->arguments->set,
                  .nvariant = n,
                  .variant = v};
  manifest *m = NULL;
  execute_options options = s->arguments->options;
  options.expects_failures = true;
  options.tells_builds = !s->looked;
  s->looked = true;
  COROT_TRY(variants_execute(&all, &options, &m, run, &s->signal_number));
  /* which of them were stable */
  corot_status status = COROT_OK;
  if (s->signal_number) status = corot_fail(COROT_EINTEGRATE, "interrupted");
  for (int i = 0; i < n && status == COROT_OK; i++) status = judge(s, &m->run[run[i]], &trial[i]);
  manifest_destroy(m);
  return status;
}

/* --- What was found --- */

static json_t *bound_json(const bound *b) {
  if (!b->asked) return json_null();
  return json_pack("{s:s, s:o, s:o}", "of", b->of.text, "below", json_text_real(b->below), "above",
                   json_text_real(b->above));
}

static json_t *result_json(search *s, const limit_result *r) {
  json_t *trials = json_array();
  for (int i = 0; i < r->ntrial; i++) {
    const limit_trial *t = &r->trial[i];
    trials = json_text_push(
        trials, json_pack("{s:f, s:b, s:o, s:o}", "value", t->value, "stable", t->stable,
                          "quantity", json_text_real(t->quantity), "reason",
                          *t->reason ? json_text_string(t->reason) : json_null()));
  }
  builds_sort(&s->made_by);
  return json_pack("{s:o, s:s, s:s, s:o, s:o, s:o, s:i, s:f, s:o, s:o, s:o}", "title",
                   json_text_string(s->scenario->title), "scenario", s->scenario->path, "key",
                   s->key, "quantity", bound_json(&s->bound), "stable",
                   r->stable > 0 ? json_real(r->stable) : json_null(), "unstable",
                   json_text_real(r->unstable), "stable_again", r->nreturn, "energy_factor",
                   s->factor, "energy", json_text_real(s->energy), "mixed",
                   builds_sentence(s->made_by.list), "trials", trials);
}

static void print_result(const search *s, const limit_result *r, const char *mixed) {
  for (int i = 0; i < r->ntrial; i++)
    show("%12.6g  %s%s\n", r->trial[i].value,
         r->trial[i].stable ? "stable" : "unstable: ", r->trial[i].reason);
  if (r->stable == 0)
    show("%s: not even %g is stable\n", s->key, r->unstable);
  else if (isinf(r->unstable))
    show("%s: stable up to %g, the largest that was tried\n", s->key, r->stable);
  else
    show("%s: stable up to %.4g, unstable from %.4g on\n", s->key, r->stable, r->unstable);
  if (r->nreturn > 0)
    show("%d larger values are stable again: this limit is not the only one\n", r->nreturn);
  if (mixed) show("%s\n", mixed);
}

static int conclude(search *s, const limit_result *r) {
  json_t *found = result_json(s, r);
  corot_status status = found ? json_file_write(s->arguments->options.dir, "limit.json", found)
                              : corot_fail(COROT_ENOMEM, "out of memory");
  if (status == COROT_OK && s->arguments->json)
    status = json_text_show(found);
  else if (status == COROT_OK)
    print_result(s, r, json_string_value(json_object_get(found, "mixed")));
  json_decref(found);
  if (status != COROT_OK) return failure(status);
  return r->stable > 0 && isfinite(r->unstable) ? EXIT_OK : EXIT_CHECK;
}

/* The scenario need not have the key: it is read with the first value. */
static int ready(void *context, variants_arguments *a) {
  search *s = context;
  if (!s->key) return usage_error("corot find-limit", "--key is missing");
  if (isnan(s->def.from)) return usage_error("corot find-limit", "--from is missing");
  if (isnan(s->def.to)) return usage_error("corot find-limit", "--to is missing");
  bool bounded = !isnan(s->bound.below) || !isnan(s->bound.above);
  if (s->bound.asked && !bounded)
    return usage_error("corot find-limit", "--quantity wants --below or --above");
  if (bounded && !s->bound.asked)
    return usage_error("corot find-limit", "--below and --above are of a --quantity");
  snprintf(s->first, sizeof s->first, "%s=%.9g", s->key, s->def.from);
  a->set[a->nset++] = s->first;
  if (s->bound.asked) a->set[a->nset++] = s->bound.of.setting, a->nasked = 1;
  return -1;
}

static int find(void *context, const scenario *of, const variants_arguments *a) {
  search *s = context;
  s->scenario = of;
  s->arguments = a;
  s->made_by = builds_begin();
  limit_result *r = calloc(1, sizeof *r);
  if (!r) return failure(corot_fail(COROT_ENOMEM, "out of memory"));
  corot_status status = limit_find(&s->def, try_values, s, r);
  int code;
  if (s->signal_number)
    code = variants_interrupted(s->signal_number);
  else if (status == COROT_EINVAL)
    code = usage_error("corot find-limit", "%s", corot_error());
  else
    code = status == COROT_OK ? conclude(s, r) : failure(variants_retell(a, status));
  builds_free(&s->made_by);
  free(r);
  return code;
}

int command_find_limit(int argc, char **argv) {
  search s = {.def = {.from = NAN, .to = NAN, .nscan = 9, .precision = 0.02},
              .factor = 2,
              .bound = {.below = NAN, .above = NAN},
              .energy = NAN};
  const variants_command c = {.program = "corot find-limit",
                              .help = help,
                              .suffix = "-limit",
                              .more = own,
                              .take = take,
                              .ready = ready,
                              .go = find,
                              .context = &s};
  return variants_command_run(&c, argc, argv);
}

/* Puts the document together, part by part, and writes it as the last file of a run. */
#include "result.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "app/folder/folder.h"
#include "app/folder/provenance.h"
#include "app/scenario/field_frames.h"
#include "app/scenario/words.h"
#include "app/text/json_text.h"

/* Zero stands for what was not asked for. */
static json_t *positive(double x) { return x > 0 ? json_text_real(x) : json_null(); }

static json_t *integer(long i) { return json_integer(i); }

/* NULL gives null. */
static json_t *text(const char *s) { return s ? json_text_string(s) : json_null(); }

static json_t *vector(const double x[3]) {
  return json_pack("[o, o, o]", json_text_real(x[0]), json_text_real(x[1]), json_text_real(x[2]));
}

json_t *result_mesh(const scenario *s, const corot_model *model) {
  const corot_mesh *mesh = corot_model_mesh(model);
  return json_pack("{s:o, s:i, s:i, s:i, s:i}", "file", text(s->mesh_file), "order",
                   corot_mesh_order(mesh), "nodes", mesh->nnode, "tets", mesh->ntet, "dofs",
                   corot_model_ndof(model));
}

static json_t *frames_part(const scenario *s, const run_summary *run) {
  const corot_frame_policy *p = &s->frames;
  bool exact = p->frames == COROT_FRAMES_EXACT;
  json_t *by = json_object();
  for (int i = COROT_FRAMES_KEPT + 1; i < FRAME_REASONS; i++)
    by = json_text_with(by, frame_reason_words[i], integer(run->frames.by[i]));
  return json_pack(
      "{s:s, s:o, s:o, s:s?, s:o, s:o, s:o, s:o, s:o}", "policy", s->frame_policy, "interval",
      positive(p->interval), "max_angle", positive(p->max_angle), "history",
      exact ? NULL : words_frame_history[p->history], "updates", integer(run->frames.count),
      "updates_by", by, "angle_max", json_text_real(run->frames.angle_max), "angle_mean",
      json_text_real(run->frames.angle_mean), "energy", json_text_real(run->frames.energy));
}

static json_t *jacobian_part(const corot_integrator_choice *c) {
  if (corot_method_traits(c->method)->explicit_steps) return json_null();
  return json_pack("{s:s, s:o, s:o, s:o, s:o}", "tangent", words_tangent[c->tangent], "reassembly",
                   positive(c->reassembly), "refactorisation", positive(c->refactorisation),
                   "gamma_change", positive(c->gamma_change), "convergence",
                   positive(c->convergence));
}

static json_t *integrator_part(const scenario *s, const corot_integrator_choice *c) {
  const corot_integrator_def *d = &s->integrator;
  return json_pack("{s:s?, s:s?, s:o, s:o, s:o, s:i, s:s?, s:o, s:s?, s:o}", "method", c->method,
                   "linear_solver", c->linear_solver, "rtol", json_text_real(d->rtol),
                   "atol_displacement", json_text_real(c->atol_displacement), "atol_velocity",
                   json_text_real(c->atol_velocity), "max_order", c->max_order, "table",
                   c->table && *c->table ? c->table : NULL, "step", positive(d->step), "solution",
                   d->step > 0 ? words_solution[d->solution] : NULL, "jacobian", jacobian_part(c));
}

static json_t *statistics_part(const run_summary *run) {
  const corot_statistics *n = &run->statistics;
  json_t *part =
      json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:i}", "nst", integer(n->nst), "nfe",
                integer(n->nfe), "nsetups", integer(n->nsetups), "netf", integer(n->netf), "nni",
                integer(n->nni), "ncfn", integer(n->ncfn), "nje", integer(n->nje), "nli",
                integer(n->nli), "hlast", json_text_real(n->hlast), "qlast", n->qlast);
  json_t *more =
      json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "nfactor",
                integer(n->nfactor), "nsolve", integer(n->nsolve), "nlsfail", integer(n->nlsfail),
                "nfresh", integer(n->nfresh), "nindefinite", integer(n->nindefinite), "nclamped",
                integer(n->nclamped), "nfallback", integer(n->nfallback), "nfeQ", integer(n->nfeQ),
                "nrestart", integer(n->nrestart), "nframes", integer(run->frames.count));
  bool complete = part && more && json_object_update(part, more) == 0;
  json_decref(more);
  if (complete) return part;
  json_decref(part);
  return NULL;
}

/* Wall time by phase; `other` is what the phases leave of `wall`. */
static json_t *timings_part(const run_summary *run) {
  const corot_statistics *n = &run->statistics;
  double known = run->setup_s + n->force_s + n->assembly_s + n->combine_s + n->factor_s +
                 n->solve_s + n->work_s + n->integrator_s + run->frames_s + run->output_s +
                 run->seen->space.wall_s;
  return json_pack(
      "{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "setup",
      json_text_real(run->setup_s), "force", json_text_real(n->force_s), "assembly",
      json_text_real(n->assembly_s), "combine", json_text_real(n->combine_s), "factor",
      json_text_real(n->factor_s), "solve", json_text_real(n->solve_s), "work",
      json_text_real(n->work_s), "integrator", json_text_real(n->integrator_s), "frames",
      json_text_real(run->frames_s), "output", json_text_real(run->output_s), "space_error",
      json_text_real(run->seen->space.wall_s), "other", json_text_real(run->wall_s - known), "wall",
      json_text_real(run->wall_s), "cpu", json_text_real(run->cpu_s));
}

/* Bytes; `peak` is the largest resident set of the process so far. */
static json_t *memory_part(const run_summary *run) {
  struct rusage usage;
  double peak = getrusage(RUSAGE_SELF, &usage) == 0 ? 1024.0 * (double)usage.ru_maxrss : 0;
  return json_pack("{s:I, s:I, s:I}", "model", (json_int_t)corot_model_bytes(run->model), "state",
                   (json_int_t)run->state_bytes, "peak", (json_int_t)peak);
}

static json_t *energy_part(const outputs *o) {
  ledger e = outputs_ledger(o);
  return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "t", json_text_real(e.t),
                   "kinetic", json_text_real(e.kinetic), "elastic", json_text_real(e.elastic),
                   "dissipated", json_text_real(e.dissipated), "external_work",
                   json_text_real(e.external_work), "balance", json_text_real(e.balance),
                   "frame_energy", json_text_real(e.frame_energy), "momentum", vector(e.momentum),
                   "angular_momentum", vector(e.angular_momentum));
}

static json_t *extremes_part(const outputs *o) {
  return outputs_count(o) > 0 ? outputs_extremes(o) : json_object();
}

/* What the warnings were made from: parts of the energy, of the volume, of the stress. */
static json_t *observed_part(const run_summary *run) {
  const observed *o = run->seen;
  const history_facts *h = &o->history;
  double worst = fmax(h->balance_max.value, -h->balance_min.value);
  json_t *energy =
      run->statics || !(h->energy > 0) ? json_null() : json_text_real(worst / h->energy);
  return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o}", "displacement",
                   json_text_real(o->displacement), "period", positive(h->period), "energy_error",
                   energy, "strained", json_text_real(o->strained.strained), "turned",
                   json_text_real(o->turned.turned), "stress_jumps", json_text_real(o->jumps));
}

/* Who reads steps.csv must know whether each step is there. */
static json_t *steps_part(const outputs *o) {
  steps_count n = outputs_steps(o);
  return json_pack("{s:o, s:o, s:s}", "steps", integer(n.steps), "rows", integer(n.rows), "kept",
                   thin_rule(&n));
}

/* Who reads the fields, whether each output time is there; of a run with fields. */
static json_t *fields_part(const scenario *s, const run_summary *run) {
  if (!s->write_fields || run->statics) return json_null();
  field_frames f = field_frames_of(s, corot_model_mesh(run->model));
  return json_pack("{s:i, s:f, s:b}", "every", f.every, "bytes_per_frame", f.bytes, "thinned",
                   f.thinned);
}

json_t *result_versions(void) {
  return json_pack("{s:s, s:s, s:s}", "corot", corot_version(), "sundials",
                   corot_sundials_version(), "compiler", provenance_compiler);
}

/* In the order of the file. */
corot_status result_make(const scenario *s, const outputs *o, const run_summary *run,
                         json_t **out) {
  const hashes *h = &run->hashes;
  json_t *provenance;
  COROT_TRY(provenance_make(&provenance));
  json_t *result = json_pack(
      "{s:o, s:s, s:o, s:o, s:i, s:o, s:o, s:o, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:i, s:s, s:o, "
      "s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:{s:s, s:s, s:s}, s:O}",
      "title", text(s->title), "status", run->status, "reason", text(run->reason), "failure",
      run_failure_json(run->failure), "exit_code", run->exit_code, "t_reached",
      json_text_real(run->t_reached), "t_end", json_text_real(s->t_end), "warnings",
      warnings_json(run->warnings), "strain", corot_model_strain(run->model), "mesh",
      result_mesh(s, run->model), "frames", run->statics ? json_null() : frames_part(s, run),
      "integrator", run->statics ? json_null() : integrator_part(s, &run->chosen), "statics",
      run->statics ? result_statics(s, run->statics) : json_null(), "statistics",
      run->statics ? result_statics_counts(&run->statics->counts) : statistics_part(run), "timings",
      timings_part(run), "threads", run->threads, "solver_costs", s->tuned ? "measured" : "usual",
      "memory", memory_part(run), "probes", outputs_probes(o), "energy", energy_part(o),
      "quantities", outputs_quantities(o), "extremes", extremes_part(o), "observed",
      observed_part(run), "steps_csv", steps_part(o), "fields", fields_part(s, run), "space_error",
      space_json(outputs_recorded(o), &run->seen->space), "versions", result_versions(),
      "provenance", provenance, "hashes", "scenario", h->scenario, "mesh", h->mesh, "run", h->run,
      "scenario", s->resolved);
  if (!run->statics && run->nresume >= 0)
    result = json_text_with(result, "resumed", integer(run->nresume));
  if (!result) return corot_fail(COROT_ENOMEM, "result.json: out of memory");
  *out = result;
  return COROT_OK;
}

corot_status result_text(const json_t *result, char **text) {
  char *dump = json_text_dump(result, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
  char *whole = dump ? malloc(strlen(dump) + 2) : NULL;
  if (whole) {
    size_t length = strlen(dump);
    memcpy(whole, dump, length);
    memcpy(whole + length, "\n", 2);
  }
  free(dump);
  if (!whole) return corot_fail(COROT_ENOMEM, "result.json: out of memory");
  *text = whole;
  return COROT_OK;
}

corot_status result_write(const char *dir, const char *text) {
  char *path = folder_path(dir, "result.json");
  if (!path) return COROT_ENOMEM;
  corot_status status = file_replace_durably(path, text, strlen(text));
  free(path);
  return status;
}

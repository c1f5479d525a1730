/* What the modes are about, the modes, their files. */
#include "modal.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/folder/write_vtu.h"
#include "app/text/json_text.h"
#include "app/text/say.h"
#include "fields.h"
#include "modes_space.h"
#include "result_modes.h"
#include "run_clock.h"
#include "run_common.h"
#include "static.h"
#include "stop.h"

typedef struct modal_run {
  const scenario *scenario;
  const run_options *options;
  corot_mesh *mesh;
  corot_refinement *refinement; /* or NULL */
  corot_model *model;
  double *u; /* [n] what the modes are about: an equilibrium, */
  bool rest; /* or rest */
  double t;  /* of loads and supports [s] */
  corot_modes *modes;
  table *table;
  vtu *fields;
  folder_lock lock;
  warnings warnings;
  double wall_at_start, cpu_at_start, setup_s, equilibrium_s, output_s; /* [s] */
} modal_run;

static const char *about(const modal_run *r) { return r->rest ? "rest" : "equilibrium"; }

/* --- The modes --- */

static bool is_stopped(void *data) {
  (void)data;
  return stop_signal() != 0;
}

static corot_status find_equilibrium(modal_run *r) {
  const scenario *s = r->scenario;
  double start = wall_clock();
  corot_status status = static_find(s, r->refinement, r->model, r->t, r->u);
  r->equilibrium_s = wall_clock() - start;
  if (status == COROT_OK) return COROT_OK;
  return corot_fail(status, "%s: about equilibrium: %s", s->path, corot_error());
}

/* The scenario's solver, unless it is one that iterates. */
static corot_linear_def direct_solver(const corot_linear_def *linear) {
  corot_linear_def direct = *linear;
  if (strcmp(direct.solver, "pcg") == 0) direct = corot_linear_defaults();
  return direct;
}

/* What the model and the options do not allow is told before an equilibrium is looked for. */
static corot_status find_modes(modal_run *r) {
  const scenario *s = r->scenario;
  corot_modes_def def = corot_modes_defaults();
  def.count = r->options->nmode;
  def.linear = direct_solver(&s->statics.linear);
  def.stop = is_stopped;
  corot_status status = corot_modes_check(&def, r->model, r->t, r->rest);
  if (status == COROT_OK && !r->rest) COROT_TRY(find_equilibrium(r));
  if (status == COROT_OK)
    status = corot_modes_find(&def, r->model, r->t, r->rest ? NULL : r->u, &r->modes);
  if (status == COROT_OK) return COROT_OK;
  return corot_fail(status, "%s: %s", s->path, corot_error());
}

static corot_status prepare(modal_run *r) {
  const scenario *s = r->scenario;
  modes_about what = r->options->about;
  COROT_TRY(scenario_refuse_inputs(s, "corot modes"));
  COROT_TRY(scenario_build_warned(s, &r->mesh, &r->refinement, &r->model, &r->warnings));
  COROT_TRY(run_warn_before(s, r->model, true, r->options, &r->warnings));
  r->rest = what == MODES_ABOUT_REST || (what == MODES_ABOUT_START && !s->start_at_equilibrium);
  r->t = what == MODES_ABOUT_EQUILIBRIUM ? s->t_end : 0;
  r->u = calloc((size_t)corot_model_ndof(r->model), sizeof *r->u);
  if (!r->u) return corot_fail(COROT_ENOMEM, "%s: out of memory", s->path);
  r->setup_s = wall_clock() - r->wall_at_start;
  COROT_TRY(find_modes(r));
  int before = r->warnings.n;
  COROT_TRY(warnings_of_modes(s, r->modes, &r->warnings));
  if (r->rest && !r->options->lean)
    COROT_TRY(modes_space_warn(s, r->model, r->modes, &r->warnings));
  if (!r->options->quiet) warnings_print(&r->warnings, before, "warning: ", stderr);
  return COROT_OK;
}

/* --- The files --- */

static corot_status open_fields(modal_run *r) {
  int *material = calloc((size_t)r->mesh->ntet, sizeof *material);
  if (!material) return corot_fail(COROT_ENOMEM, "%s/fields: out of memory", r->options->dir);
  const corot_mesh *mesh = corot_model_mesh(r->model);
  fields_number_materials(&r->scenario->model, mesh, material);
  vtu_data data = r->scenario->compress_fields ? VTU_ZLIB : VTU_RAW;
  corot_status status = vtu_create_modes(r->options->dir, mesh, material, data, &r->fields);
  free(material);
  return status;
}

static corot_status open_outputs(modal_run *r) {
  const char *dir = r->options->dir;
  COROT_TRY(run_enter(r->scenario->path, r->options, &r->lock));
  COROT_TRY(folder_make(dir));
  COROT_TRY(folder_clean(dir));
  COROT_TRY(modes_open(dir, &r->table));
  return r->scenario->write_fields ? open_fields(r) : COROT_OK;
}

/* What the modes are about, moved on by the mode. */
static corot_status write_frame(modal_run *r, int number, const double *shape) {
  const int(*dof)[3] = corot_model_dof(r->model);
  int nnode = corot_model_mesh(r->model)->nnode;
  vtu_fields value = vtu_arrays(r->fields);
  double most = 0;
  corot_nodal(r->model, r->t, r->u, r->u, value.displacement, NULL);
  for (int n = 0; n < nnode; n++) {
    double *x = value.mode[n];
    for (int c = 0; c < 3; c++) x[c] = dof[n][c] >= 0 ? shape[dof[n][c]] : 0;
    most = fmax(most, hypot(hypot(x[0], x[1]), x[2]));
  }
  double scale = MODE_SHOWN * corot_model_length(r->model) / most;
  for (int n = 0; n < nnode; n++)
    for (int c = 0; c < 3; c++) value.displacement[n][c] += scale * value.mode[n][c];
  return vtu_write(r->fields, number);
}

static void tell_mode(const modal_run *r, int number, const corot_mode *m) {
  if (r->options->quiet) return;
  if (m->growth > 0)
    fprintf(stderr, "mode %d: unstable, grows as e^(%.6g t)\n", number, m->growth);
  else if (m->eigenvalue == 0)
    fprintf(stderr, "mode %d: 0 Hz, a rigid motion or a mechanism\n", number);
  else
    fprintf(stderr, "mode %d: %.6g Hz\n", number, m->frequency);
}

static corot_status write_modes(modal_run *r) {
  double started = wall_clock();
  corot_status status = COROT_OK;
  for (int k = 0; k < corot_modes_count(r->modes) && status == COROT_OK; k++) {
    corot_mode mode = corot_modes_at(r->modes, k);
    tell_mode(r, k + 1, &mode);
    status = modes_row(r->table, k + 1, &mode);
    if (status == COROT_OK && r->fields) status = write_frame(r, k + 1, mode.shape);
  }
  r->output_s = wall_clock() - started;
  return status;
}

static corot_status close_outputs(modal_run *r) {
  corot_status status = table_close(r->table);
  r->table = NULL;
  corot_status closed = r->fields ? vtu_finish(r->fields) : COROT_OK;
  return status == COROT_OK ? closed : status;
}

/* --- The end --- */

static corot_status write_result(const modal_run *r, const char *reason, int code,
                                 run_failure failure) {
  modes_summary summary = {
      .status = code == EXIT_OK ? "ok" : "failed",
      .reason = code == EXIT_OK ? NULL : reason,
      .exit_code = code,
      .failure = failure,
      .model = r->model,
      .modes = r->modes,
      .about = about(r),
      .t = r->t,
      .setup_s = r->setup_s,
      .equilibrium_s = r->equilibrium_s,
      .output_s = r->output_s,
      .wall_s = wall_clock() - r->wall_at_start,
      .cpu_s = cpu_clock() - r->cpu_at_start,
      .warnings = &r->warnings,
  };
  json_t *result = NULL;
  COROT_TRY(hashes_of(r->scenario->resolved, r->mesh, &summary.hashes));
  hashes_modes(&summary.hashes);
  COROT_TRY(result_modes_make(r->scenario, &summary, &result));
  return run_write_document(result, false, r->options);
}

static void tell(const modal_run *r, const char *reason) {
  const char *path = r->scenario->path;
  int count = corot_modes_count(r->modes);
  if (*reason) say("%s: %s\n", path, reason);
  if (r->options->quiet) return;
  say("%s: %d mode%s about %s, to %.6g Hz, %.3g s; %s\n", path, count, count == 1 ? "" : "s",
      about(r), corot_modes_at(r->modes, count - 1).frequency, wall_clock() - r->wall_at_start,
      r->options->dir);
}

/* Closes the books; returns the exit code. */
static int conclude(modal_run *r, corot_status status) {
  char reason[1024] = "";
  int code = run_exit_code(status);
  if (code != EXIT_OK) snprintf(reason, sizeof reason, "%s", corot_error());
  corot_status late = close_outputs(r);
  if (run_late_code(code, late) != code) {
    code = run_late_code(code, late);
    status = late;
    run_add_reason(sizeof reason, reason);
  }
  late = write_result(r, reason, code, run_failure_of(status, code));
  if (late != COROT_OK) say_error();
  stop_forget();
  stop_release();
  tell(r, reason);
  return run_late_code(code, late);
}

static void release(modal_run *r) {
  table_close(r->table);
  vtu_destroy(r->fields);
  corot_modes_destroy(r->modes);
  corot_model_destroy(r->model);
  corot_refinement_destroy(r->refinement);
  corot_mesh_destroy(r->mesh);
  warnings_free(&r->warnings);
  free(r->u);
}

static int search(const scenario *s, const run_options *options) {
  modal_run r = {.scenario = s, .options = options};
  r.wall_at_start = wall_clock();
  r.cpu_at_start = cpu_clock();

  run_without_checkpoints(s, options, "corot modes");
  corot_status status = run_begin(s, options);
  if (status == COROT_OK) status = run_preparing(prepare(&r));
  if (status == COROT_OK) status = open_outputs(&r);
  int code = status == COROT_OK ? conclude(&r, write_modes(&r))
                                : run_end_early(s, options, &r.lock, &r.warnings, status);
  folder_leave(&r.lock); /* its files are closed, even if a library crashes below */
  release(&r);
  return code;
}

int modal_scenario(const scenario *s, const run_options *options) {
  return run_in_c_locale(search, s, options);
}

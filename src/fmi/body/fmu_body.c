/* Reads and builds, and keeps what was set apart from what was read. */
#include "fmu_body.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "core/base/c_locale.h"
#include "core/model/amplitude.h"

const material_number body_material_numbers[BODY_MATERIAL] = {
    {"lambda", "Pa", "Lame's first constant"},
    {"mu", "Pa", "shear modulus"},
    {"density", "kg/m^3", "density"},
    {"damping.lambda", "Pa s", "damping of the change of volume"},
    {"damping.mu", "Pa s", "damping of shear"},
    {"damping.mass", "1/s", "damping by mass"},
};

double *body_material_at(corot_material *m, int k) {
  double *const number[BODY_MATERIAL] = {&m->lambda,         &m->mu,         &m->density,
                                         &m->damping_lambda, &m->damping_mu, &m->damping_mass};
  return number[k];
}

static const double t_start = 0;

double body_input_start(const body *b, int i) {
  const input_def *in = &b->scenario->input[i];
  const corot_amplitude *a = &in->values;
  amplitude made;
  double value = a->value[0];
  if (in->of == INPUT_MATERIAL) {
    for (int k = 0; k < a->n && a->time[k] <= t_start; k++) value = a->value[k];
  } else if (corot_amplitude_create(a, "input", i, &made) == COROT_OK) {
    value = corot_amplitude_at(&made, NAN, t_start);
    corot_amplitude_clear(&made);
  }
  return value;
}

void body_forget(body *b) {
  const corot_model_def *def = &b->scenario->model;
  for (int k = 0; k < def->nmaterial; k++)
    if (memcmp(&b->material[k], &def->material[k], sizeof *b->material) != 0) {
      b->material[k] = def->material[k];
      b->built = false;
    }
  for (int i = 0; i < b->used.ninput; i++) b->value[i] = body_input_start(b, i);
}

/* The scenario with room for what will be set. */
static corot_status use(body *b) {
  const scenario *s = b->scenario;
  b->used = *s;
  if (!s->threads) b->used.threads = 1; /* the processors are the importer's */
  b->material = calloc((size_t)s->model.nmaterial + 1, sizeof *b->material);
  b->input = calloc((size_t)s->ninput + 1, sizeof *b->input);
  b->value = calloc((size_t)s->ninput + 1, sizeof *b->value);
  if (!b->material || !b->input || !b->value) return no_memory();
  b->used.model.material = b->material;
  b->used.input = b->input;
  if (b->used.model.hierarchy) b->used.model.hierarchy = &b->used.hierarchy;
  for (int k = 0; k < s->model.nmaterial; k++) b->material[k] = s->model.material[k];
  for (int i = 0; i < s->ninput; i++) {
    b->input[i] = s->input[i];
    b->input[i].values =
        (corot_amplitude){.n = 1, .time = &t_start, .value = &b->value[i], .curve = 0};
    b->value[i] = body_input_start(b, i);
  }
  return COROT_OK;
}

/* What is in the program and not in an FMU. */
static corot_status check(const scenario *s) {
  const corot_linear_def *linear = &s->integrator.linear;
  const char *name = linear->solver ? linear->solver : "";
  const char *ordering = linear->ordering ? linear->ordering : "";
  if (strcmp(name, "cholmod") == 0)
    return corot_fail(
        COROT_EFORMAT,
        "%s: linear_solver: cholmod is not in an FMU, for its licence: say klu, pcg or "
        "auto",
        s->path);
  if (strcmp(ordering, "metis") == 0)
    return corot_fail(COROT_EFORMAT,
                      "%s: linear_solver.ordering: metis is not in an FMU: say amd or auto",
                      s->path);
  return COROT_OK;
}

static void drop_model(body *b) {
  probes_destroy(b->probes);
  corot_model_destroy(b->model);
  corot_refinement_destroy(b->refinement);
  corot_mesh_destroy(b->mesh);
  b->probes = NULL, b->model = NULL, b->refinement = NULL, b->mesh = NULL;
}

static corot_status build(body *b) {
  body made = {.used = b->used};
  COROT_TRY(scenario_build(&b->used, &made.mesh, &made.refinement, &made.model));
  corot_status status = probes_create(&b->used, made.model, &made.probes);
  if (status) {
    drop_model(&made);
    return status;
  }
  drop_model(b);
  b->mesh = made.mesh, b->refinement = made.refinement;
  b->model = made.model, b->probes = made.probes;
  b->built = true;
  return COROT_OK;
}

/* Files are read with a point for decimals, whatever the importer's locale. */
corot_status body_build(body *b) {
  if (b->built) return COROT_OK;
  corot_c_locale before = corot_c_locale_enter();
  corot_status status = build(b);
  corot_c_locale_leave(before);
  return status;
}

static corot_status open_in_c_locale(const char *path, body *b) {
  COROT_TRY(scenario_read(path, 0, NULL, &b->scenario));
  /* an FMU does the same wherever it goes: not what its user's machine has measured of solvers */
  b->scenario->integrator.linear.costs = b->scenario->statics.linear.costs = NULL;
  COROT_TRY(check(b->scenario));
  COROT_TRY(use(b));
  COROT_TRY(build(b));
  return hashes_of(b->scenario->resolved, b->mesh, &b->hashes);
}

corot_status body_open(const char *path, body *b) {
  *b = (body){0};
  corot_c_locale before = corot_c_locale_enter();
  corot_status status = open_in_c_locale(path, b);
  corot_c_locale_leave(before);
  if (status) body_close(b);
  return status;
}

void body_close(body *b) {
  drop_model(b);
  free(b->material);
  free(b->input);
  free(b->value);
  scenario_destroy(b->scenario);
  *b = (body){0};
}

/* --- What is possible --- */

static bool is_work(probe_of of) {
  return of == PROBE_DISSIPATED || of == PROBE_EXTERNAL_WORK || of == PROBE_BALANCE ||
         of == PROBE_FRAME_ENERGY;
}

bool body_wants_ledger(const body *b) {
  for (int i = 0; i < b->used.nprobe; i++)
    if (b->used.probe[i].body) return true;
  return false;
}

const char *body_no_exchange(const body *b) {
  if (b->used.frames.frames != COROT_FRAMES_EXACT)
    return "frames that are held or extrapolated are found anew at times of their own, which no "
           "integrator outside knows of";
  for (int i = 0; i < b->used.nprobe; i++)
    if (is_work(b->used.probe[i].of))
      return "a probe is of work done since the start, which corot's own integrators sum up";
  return NULL;
}

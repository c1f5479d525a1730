/* A state that is taken away: a run writes it to a file, another one, which could be another
   process, goes on from there, to the same bits; and a window of time is taken once more with
   another load. Needs corot::integrate. */
#include <corot/checkpoint.h>
#include <corot/inputs.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

/* A bar on a base, pulled sideways. */
static corot_model *create_bar(void) {
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 6}};
  const corot_material rubber = {.lambda = 1e5, .mu = 1e4, .density = 1000, .damping_mu = 20};
  const corot_fix base = {"zmin", {true, true, true}};
  const corot_load pull = {.kind = COROT_TRACTION, .group = "zmax", .value = {20, 0, 0}};
  corot_mesh *mesh;
  corot_model *model;
  check(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.nmaterial = 1, def.material = &rubber;
  def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = &pull;
  check(corot_model_create(&def, &model));
  corot_mesh_destroy(mesh);
  return model;
}

/* A run of that model: its state, what comes in, and who integrates. */
typedef struct run {
  corot_state *state;
  corot_inputs *inputs;
  corot_integrator *integrator;
  double t, *u; /* [n] */
} run;

static run begin(const corot_model *model) {
  run r = {.u = calloc(2 * (size_t)corot_model_ndof(model), sizeof *r.u)};
  if (!r.u) exit(1);
  check(corot_state_create(model, &r.state));
  check(corot_inputs_create(model, &r.inputs));
  check(corot_state_use_inputs(r.state, r.inputs));
  corot_integrator_def def = corot_integrator_defaults();
  def.method = "arkode"; /* of one step: nothing is lost by going back */
  def.rtol = 1e-6;
  double *v = r.u + corot_model_ndof(model);
  check(corot_integrator_create(&def, model, r.state, 0, r.u, v, &r.integrator));
  return r;
}

static void end(run *r) {
  corot_integrator_destroy(r->integrator);
  corot_state_destroy(r->state);
  corot_inputs_destroy(r->inputs);
  free(r->u);
}

/* On to t; returns where the last free node is in x [m]. */
static double advance(run *r, const corot_model *model, double t) {
  corot_step step = {0};
  while (step.t < t) check(corot_integrator_step(r->integrator, t, &step));
  check(corot_integrator_at(r->integrator, t, r->u, NULL));
  return r->u[corot_model_ndof(model) - 3];
}

int main(void) {
  corot_model *model = create_bar();
  run first = begin(model), second = begin(model);
  void *blob;
  size_t bytes;

  /* saved at 0.5 s, and gone on */
  advance(&first, model, 0.5);
  check(corot_integrator_save(first.integrator, &blob, &bytes));
  double x = advance(&first, model, 1);

  /* the same from the blob */
  check(corot_integrator_restore(second.integrator, blob, bytes));
  double same = advance(&second, model, 1);
  printf("at 1 s: %.6f m, and from the state of %zu bytes %.6f m: %s\n", x, bytes, same,
         x == same ? "the same bits" : "DIFFERENT");

  /* back to 0.5 s, and on with half the load */
  check(corot_integrator_restore(first.integrator, blob, bytes));
  check(corot_inputs_set_load(first.inputs, 0, 0.5));
  check(corot_integrator_changed(first.integrator, COROT_HISTORY_AUTO));
  printf("with half the load from 0.5 s on: %.6f m\n", advance(&first, model, 1));

  corot_blob_free(blob);
  end(&second);
  end(&first);
  corot_model_destroy(model);
  return x == same ? 0 : 1;
}

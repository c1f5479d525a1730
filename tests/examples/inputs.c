/* A partner code in a loop of windows: a jet of air that bends a bar, and gives way as the bar
   does. In each window of 0.01 s the partner knows the force at its beginning, guesses the one at
   its end from how fast the tip moves, and goes on from there. Near its tip the bar is held by a
   spring that the model knows nothing of. Needs corot::integrate. */
#include <corot/inputs.h>
#include <corot/integrate.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

static corot_model *create_bar(void) {
  const corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 6}};
  const corot_material rubber = {
      .lambda = 1e5, .mu = 1e4, .density = 1000, .damping_lambda = 10, .damping_mu = 1};
  const corot_fix base = {"zmin", {true, true, true}};
  corot_mesh *mesh;
  corot_model *model;
  check(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.nmaterial = 1, def.material = &rubber, def.nfix = 1, def.fix = &base;
  check(corot_model_create(&def, &model));
  corot_mesh_destroy(mesh);
  return model;
}

/* The spring, between a node and where it was at rest: its force, and its block of the matrix. */
typedef struct spring {
  int node;
  double k; /* [N/m] */
} spring;

static corot_status pull(void *data, double t, const double (*u)[3], const double (*v)[3],
                         double (*f)[3]) {
  const spring *s = data;
  (void)t, (void)v;
  for (int c = 0; c < 3; c++) f[s->node][c] -= s->k * u[s->node][c];
  return COROT_OK;
}

static corot_status stiffness(void *data, double t, const double (*u)[3], const double (*v)[3],
                              corot_blocks *blocks) {
  const spring *s = data;
  const double K[9] = {s->k, 0, 0, 0, s->k, 0, 0, 0, s->k};
  (void)t, (void)u, (void)v;
  return corot_blocks_add(blocks, s->node, s->node, K, NULL);
}

int main(void) {
  corot_model *model = create_bar();
  const corot_mesh *mesh = corot_model_mesh(model);
  const corot_group *tip = corot_mesh_find_group(mesh, "zmax");
  int n = corot_model_ndof(model), row = corot_model_dof(model)[tip->node[0]][0];
  double(*force)[3] = calloc(2 * (size_t)mesh->nnode, sizeof *force), (*next)[3];
  double *u = calloc(2 * (size_t)n, sizeof *u), *v = u + n;
  if (!force || !u) return 1;
  next = force + mesh->nnode;

  corot_state *state;
  corot_inputs *inputs;
  corot_integrator *integrator = NULL;
  spring held = {corot_mesh_nearest(mesh, (double[]){0.1, 0.1, 0.5}), 1e5};
  const corot_feedback feedback = {"spring", &held, pull, stiffness, NULL};
  check(corot_state_create(model, &state));
  check(corot_inputs_create(model, &inputs));
  check(corot_inputs_set_feedback(inputs, &feedback));
  check(corot_state_use_inputs(state, inputs));

  double window = 0.01, drag = 0.05; /* [s], [N s/m] on each node */
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-6;
  for (int k = 0; k < 50; k++) {
    /* the partner: the jet opens within 0.1 s, and blows the less the faster the tip gives way */
    double t = k * window, jet = t + window < 0.1 ? 0.5 * (t + window) : 0.05;
    for (int i = 0; i < tip->nnode; i++) next[tip->node[i]][0] = jet - drag * v[row];
    check(corot_inputs_ramp_force(inputs, mesh->nnode, t, (const double(*)[3])force, t + window,
                                  (const double(*)[3])next));
    for (int i = 0; i < tip->nnode; i++) force[tip->node[i]][0] = next[tip->node[i]][0];

    /* the solid, to the end of the window */
    if (!integrator)
      check(corot_integrator_create(&def, model, state, 0, u, v, &integrator));
    else
      check(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
    corot_step step = {.t = t};
    while (step.t < t + window) check(corot_integrator_step(integrator, t + window, &step));
    check(corot_integrator_at(integrator, step.t, u, v));
  }

  double dissipated, external;
  corot_energies e;
  corot_statistics s = corot_integrator_statistics(integrator);
  check(corot_integrator_energy(integrator, u, v, &e));
  check(corot_integrator_work(integrator, 0.5, &dissipated, &external));
  printf("tip %.4g m, beside %.4g m at the spring\n", u[row],
         u[corot_model_dof(model)[held.node][0]]);
  printf("restarts %ld, convergence failures %ld\n", s.nrestart, s.ncfn);
  printf("energy [J]: in the body %.6g + dissipated %.6g = external %.6g\n", e.kinetic + e.elastic,
         dissipated, external);

  free(u), free(force);
  corot_integrator_destroy(integrator);
  corot_inputs_destroy(inputs);
  corot_state_destroy(state);
  corot_model_destroy(model);
}

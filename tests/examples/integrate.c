/* Integration in time with error control: steps of the method's own choice, output at times of
   ours, a stop at the kink of a load, and the books of the energy. Needs corot::integrate. */
#include <corot/integrate.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

/* A bar on a base, pushed sideways by a traction that rises in half a second and rests then. */
static corot_model *create_bar(void) {
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 6}};
  const corot_material rubber = {.lambda = 1e5, .mu = 1e4, .density = 1000, .damping_mu = 20};
  const corot_fix base = {"zmin", {true, true, true}};
  const double time[] = {0, 0.5}, factor[] = {0, 1};
  const corot_load push = {.kind = COROT_TRACTION,
                           .group = "zmax",
                           .value = {20, 0, 0},
                           .amplitude = {.n = 2, .time = time, .value = factor}};
  corot_mesh *mesh;
  corot_model *model;
  check(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.nmaterial = 1, def.material = &rubber;
  def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = &push;
  check(corot_model_create(&def, &model));
  corot_mesh_destroy(mesh);
  return model;
}

/* Goes to t_end, which is a kink or the end, and prints where a corner is every quarter second. */
static void advance(corot_integrator *integrator, const corot_model *model, double t_begin,
                    double t_end, double *u) {
  const corot_mesh *mesh = corot_model_mesh(model);
  int corner = corot_model_dof(model)[corot_mesh_nearest(mesh, (double[]){0.1, 0.1, 0.6})][0];
  double output = t_begin + 0.25;
  for (corot_step step = {.t = t_begin}; step.t < t_end;) {
    check(corot_integrator_step(integrator, t_end, &step));
    for (; output <= step.t; output += 0.25) { /* within the step that has just been taken */
      check(corot_integrator_at(integrator, output, u, NULL));
      printf("t = %.2f s: x of the corner %.6f m\n", output, u[corner]);
    }
  }
}

int main(void) {
  corot_model *model = create_bar();
  corot_state *state;
  corot_integrator *integrator;
  check(corot_state_create(model, &state));
  int n = corot_model_ndof(model);
  double *u = calloc(2 * (size_t)n, sizeof *u), *v = u + n; /* from rest */
  if (!u) return 1;

  corot_integrator_def def = corot_integrator_defaults();
  def.method = "arkode";
  def.rtol = 1e-6;
  corot_state_enter(state, 0); /* the law of the time before the kink */
  check(corot_integrator_create(&def, model, state, 0, u, v, &integrator));
  double t = 0, t_end = 2, kink;
  while (corot_model_kinks(model, t, t_end, 1, &kink) > 0) {
    advance(integrator, model, t, kink, u);
    corot_state_enter(state, kink);
    check(corot_integrator_kink(integrator));
    t = kink;
  }
  advance(integrator, model, t, t_end, u);

  double dissipated, external;
  corot_energies energies;
  check(corot_integrator_work(integrator, t_end, &dissipated, &external));
  check(corot_integrator_at(integrator, t_end, u, v));
  check(corot_integrator_energy(integrator, u, v, &energies));
  printf("energy [J]: external work %.6e, stored %.6e, dissipated %.6e\n", external,
         energies.kinetic + energies.elastic, dissipated);

  free(u);
  corot_integrator_destroy(integrator);
  corot_state_destroy(state);
  corot_model_destroy(model);
}

/* The coupling of host_partner.c, iterated: in each window the bar moves through it under a guess
   of the force at its end, the wind says what that would be for the motion it saw, and the bar goes
   back to the start of the window and moves through it once more, until both agree. So a partner as
   heavy as the solid can be coupled, and windows may be longer. corot's own integrator takes its
   state away at the start of each window, and gets it back before each further pass.

   A method of one step loses nothing by that. CVODE and IDA would begin again at order 1 in each
   pass.
 */
#include <corot/checkpoint.h>
#include <corot/inputs.h>
#include <math.h>

#include "bar.h"

static const double WINDOW = 0.02, DRAG = 0.05; /* [s], [N s/m] on each node */
enum { MOST_PASSES = 20 };

/* The partner: a wind along x that rises to 0.2 m/s within half a second. */
static double wind_force(double t, double v) { return DRAG * (0.2 * fmin(t / 0.5, 1) - v); }

/* Through the window from t0 to t1, the state being that at t0. */
static void pass(corot_integrator *integrator, double t0, double t1) {
  for (corot_step step = {.t = t0}; step.t < t1;)
    check(corot_integrator_step(integrator, t1, &step));
}

int main(int argc, char **argv) {
  corot_model *model = bar_create();
  corot_state *state;
  corot_inputs *inputs;
  corot_integrator *integrator;
  int n = corot_model_ndof(model);
  const corot_mesh *mesh = corot_model_mesh(model);
  const corot_group *top = corot_mesh_find_group(mesh, "zmax");
  double *u = calloc(2 * (size_t)n, sizeof *u);
  double(*force)[3] = calloc(3 * (size_t)mesh->nnode, sizeof *force);
  if (!top || !u || !force) return 1;
  double(*next)[3] = force + mesh->nnode, (*v)[3] = next + mesh->nnode;
  check(corot_state_create(model, &state));
  check(corot_inputs_create(model, &inputs));
  check(corot_state_use_inputs(state, inputs));
  corot_integrator_def def = corot_integrator_defaults();
  def.method = argc > 1 ? argv[1] : "arkode";
  def.rtol = 1e-6;
  check(corot_integrator_create(&def, model, state, 0, u, u + n, &integrator));

  long passes = 0, windows = 0, steps = 0;
  for (; windows * WINDOW < T_END - 0.5 * WINDOW; windows++) {
    double t0 = windows * WINDOW, t1 = (windows + 1) * WINDOW, change = 1;
    void *start;
    size_t bytes;
    check(corot_integrator_save(integrator, &start, &bytes));
    for (int k = 0; change > 1e-10; k++, passes++) {
      /* back, but for the first pass; then the window with what is known of the force */
      if (k == MOST_PASSES) return fprintf(stderr, "the window from %g s does not settle\n", t0), 1;
      if (k > 0) check(corot_integrator_restore(integrator, start, bytes));
      check(corot_inputs_ramp_force(inputs, mesh->nnode, t0, (const double(*)[3])force, t1,
                                    (const double(*)[3])next));
      check(corot_integrator_changed(integrator, COROT_HISTORY_AUTO));
      long before = corot_integrator_statistics(integrator).nst;
      pass(integrator, t0, t1);
      steps += corot_integrator_statistics(integrator).nst - before;

      /* the partner: what the force at the end is for that motion */
      check(corot_integrator_at(integrator, t1, u, u + n));
      corot_nodal(model, t1, u, u + n, NULL, v);
      change = 0;
      for (int i = 0; i < top->nnode; i++) {
        int node = top->node[i];
        double f = wind_force(t1, v[node][0]);
        change = fmax(change, fabs(f - next[node][0]));
        next[node][0] = f;
      }
    }
    corot_blob_free(start);
    for (int i = 0; i < top->nnode; i++) force[top->node[i]][0] = next[top->node[i]][0];
  }
  bar_print(model, u);
  fprintf(stderr, "%s: %ld windows, %.1f passes a window, %.1f steps a pass\n", def.method, windows,
          (double)passes / (double)windows, (double)steps / (double)passes);

  free(u), free(force);
  corot_integrator_destroy(integrator);
  corot_state_destroy(state);
  corot_inputs_destroy(inputs);
  corot_model_destroy(model);
}

/* A host that couples the bar to a partner code, here a wind whose drag on the top depends on how
   the top moves. They go from window to window: the partner says what the force will be at the end
   of the next one, the bar moves through it by the host's CVODE, and the partner gets velocities
   back. Forces come in by corot/inputs.h; along a straight line through each window they do not
   jump, and no step begins anew. */
#include <corot/inputs.h>
#include <corot/sun_cvode.h>
#include <math.h>

#include "bar.h"
#include "sun.h"

static const double WINDOW = 0.01, DRAG = 0.05; /* [s], [N s/m] on each node */

/* The partner: a wind along x that rises to 0.2 m/s within half a second. */
static double wind_force(double t, double v) { return DRAG * (0.2 * fmin(t / 0.5, 1) - v); }

int main(void) {
  /* the solid, and what comes in */
  corot_model *model = bar_create();
  corot_state *state;
  corot_inputs *inputs;
  corot_pencil *pencil;
  check(corot_state_create(model, &state));
  check(corot_inputs_create(model, &inputs));
  check(corot_state_use_inputs(state, inputs));
  check(corot_pencil_create(model, state, NULL, &pencil));

  /* the surface they share: the nodes of a group, of which the partner knows where each is */
  const corot_mesh *mesh = corot_model_mesh(model);
  const corot_group *top = corot_mesh_find_group(mesh, "zmax");
  double(*force)[3] = calloc(4 * (size_t)mesh->nnode, sizeof *force);
  if (!top || !force) return 1;
  double(*next)[3] = force + mesh->nnode, (*v)[3] = next + mesh->nnode,
  (*before)[3] = v + mesh->nnode;

  /* the host's own objects, set up as corot's own integrator is */
  SUNContext ctx;
  SUN(SUNContext_Create(SUN_COMM_NULL, &ctx));
  int n = corot_model_ndof(model);
  N_Vector y = zeros(2 * n, ctx);
  void *cvode = CVodeCreate(CV_BDF, ctx);
  SUN(CVodeInit(cvode, corot_sun_rhs, 0, y));
  corot_sun_host host = {0};
  corot_sun_data data = {.model = model, .state = state, .rtol = 1e-6};
  check(corot_sun_cvode_open(&host, cvode, pencil, &data, y));

  for (int k = 0; k * WINDOW < T_END - 0.5 * WINDOW; k++) {
    /* the partner: what the force will be, by velocities carried on in a straight line */
    double t0 = k * WINDOW, t1 = (k + 1) * WINDOW;
    for (int i = 0; i < top->nnode; i++) {
      int node = top->node[i];
      next[node][0] = wind_force(t1, 2 * v[node][0] - before[node][0]);
      before[node][0] = v[node][0];
    }
    check(corot_inputs_ramp_force(inputs, mesh->nnode, t0, (const double(*)[3])force, t1,
                                  (const double(*)[3])next));
    for (int i = 0; i < top->nnode; i++) force[top->node[i]][0] = next[top->node[i]][0];

    /* the bar: the integrator is told, and moves through the window */
    check(corot_sun_host_loaded(&host, y));
    check(corot_sun_host_advance(&host, t1, y));
    corot_nodal(model, t1, N_VGetArrayPointer(y), N_VGetArrayPointer(y) + n, NULL, v);
  }
  bar_print(model, N_VGetArrayPointer(y));
  fprintf(stderr, "%ld steps, begun again %ld times\n", host.nst, host.nrestart);

  CVodeFree(&cvode);
  corot_sun_host_close(&host);
  N_VDestroy(y);
  SUNContext_Free(&ctx);
  free(force);
  corot_pencil_destroy(pencil);
  corot_state_destroy(state);
  corot_inputs_destroy(inputs);
  corot_model_destroy(model);
}

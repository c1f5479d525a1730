/* Integrators that a host owns, set up by corot/sun_cvode.h, sun_ida.h, sun_arkode.h: they take the
   steps of corot's own, to the same answer. */
#include <cvodes/cvodes.h> /* the program has CVODES and IDAS, by corot::integrate */
#include <idas/idas.h>

#include <corot/sun_arkode.h>
#include <corot/sun_cvode.h>
#include <corot/sun_ida.h>
#include <nvector/nvector_serial.h>

#include "bar.h"
#include "solve/sundials/sun_compat.h"

/* --- Hosts ----------------------------------------------------------------------------------- */

typedef struct machine {
  SUNContext ctx;
  N_Vector y, yp;
  corot_pencil *pencil;
  corot_mass_solver *mass;
  corot_sun_host host;
  void *memory;
} machine;

static corot_status open_cvode(machine *m, const corot_sun_data *data) {
  m->memory = CVodeCreate(CV_BDF, m->ctx);
  assert_int_equal(CVodeInit(m->memory, corot_sun_rhs, 0, m->y), 0);
  return corot_sun_cvode_open(&m->host, m->memory, m->pencil, data, m->y);
}

static corot_status open_ida(machine *m, const corot_sun_data *data) {
  m->memory = IDACreate(m->ctx);
  assert_int_equal(corot_sun_rhs(0, m->y, m->yp, (void *)data), 0);
  assert_int_equal(IDAInit(m->memory, corot_sun_residual, 0, m->y, m->yp), 0);
  return corot_sun_ida_open(&m->host, m->memory, m->pencil, data, m->y, m->yp);
}

static corot_status open_arkode(machine *m, const corot_sun_data *data) {
  m->memory = ARKStepCreate(NULL, corot_sun_rhs, 0, m->y, m->ctx);
  return corot_sun_arkode_open(&m->host, m->memory, m->pencil, data, m->y);
}

static const struct {
  const char *name;
  corot_status (*open)(machine *m, const corot_sun_data *data);
  void (*release)(void **memory);
  void (*close)(corot_sun_host *host);
} hosts[] = {
    {"cvode", open_cvode, CVodeFree, corot_sun_host_close},
    {"ida", open_ida, IDAFree, corot_sun_host_close},
    {"arkode", open_arkode, COROT_SUN_ARK_(Free), corot_sun_arkode_close},
};
enum { NHOST = sizeof hosts / sizeof *hosts };

/* Opens host k at rest. */
static void start_host(machine *m, int k, const bar *b, double rtol) {
  *m = (machine){0};
  assert_int_equal(sun_context_create(&m->ctx), 0);
  m->y = N_VNew_Serial(2 * b->n, m->ctx);
  m->yp = N_VClone(m->y);
  memcpy(N_VGetArrayPointer(m->y), b->u, 2 * b->n * sizeof *b->u);
  assert_ok(corot_mass_solver_create(b->model, &m->mass));
  assert_ok(corot_pencil_create(b->model, b->state, NULL, &m->pencil));
  corot_sun_data data = {.model = b->model, .state = b->state, .mass = m->mass, .rtol = rtol};
  assert_ok(hosts[k].open(m, &data));
}

static void end_host(machine *m, int k) {
  hosts[k].release(&m->memory);
  hosts[k].close(&m->host);
  corot_pencil_destroy(m->pencil);
  corot_mass_solver_destroy(m->mass);
  N_VDestroy(m->y), N_VDestroy(m->yp);
  SUNContext_Free(&m->ctx);
}

/* Example 2 as models/bar has it, but for the traction. */
static bar paper_bar(const double traction[3], const corot_amplitude *amplitude) {
  bar b;
  corot_mesh *mesh;
  assert_ok(corot_mesh_read(SOURCE_DIR "/models/bar/bar.msh", &mesh));
  assert_ok(corot_mesh_group_plane(mesh, "base", 2, 0, 0));
  assert_ok(corot_mesh_group_plane(mesh, "top", 2, 0.6, 0));
  const corot_material soft_bar = {
      .lambda = 1e5, .mu = 1e4, .density = 1000, .damping_lambda = 10, .damping_mu = 1};
  const corot_fix base = {"base", {true, true, true}};
  const corot_load load = {
      COROT_TRACTION, "top", {traction[0], traction[1], traction[2]}, *amplitude};
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.viscosity = COROT_COROTATED;
  def.nmaterial = 1, def.material = &soft_bar;
  def.nfix = 1, def.fix = &base;
  def.nload = 1, def.load = &load;
  assert_ok(corot_model_create(&def, &b.model));
  assert_ok(corot_state_create(b.model, &b.state));
  b.n = corot_model_ndof(b.model);
  b.tip = corot_model_dof(b.model)[corot_mesh_nearest(mesh, (double[]){0.1, 0.1, 0.6})][0];
  b.u = calloc(2 * b.n, sizeof *b.u);
  b.v = b.u + b.n;
  corot_mesh_destroy(mesh);
  return b;
}

/* What each of corot's own takes to t_end, stopping at kinks; tip [m] is where it ends. */
static corot_statistics run_ours(const char *method, bar *b, double rtol, double t_end,
                                 double *tip) {
  corot_integrator_def def = corot_integrator_defaults();
  def.method = method, def.rtol = rtol;
  corot_state_enter(b->state, 0);
  corot_integrator *integrator = start(b, &def);
  double kinks[16], *u = malloc(b->n * sizeof *u);
  int nkink = corot_model_kinks(b->model, 0, t_end, 16, kinks);
  for (int k = 0; k <= nkink; k++) {
    run_to(integrator, k < nkink ? kinks[k] : t_end);
    if (k == nkink) break;
    corot_state_enter(b->state, kinks[k]);
    assert_ok(corot_integrator_kink(integrator));
  }
  assert_ok(corot_integrator_at(integrator, t_end, u, NULL));
  *tip = u[b->tip];
  free(u);
  corot_statistics s = corot_integrator_statistics(integrator);
  corot_integrator_destroy(integrator);
  return s;
}

/* --- Tests ----------------------------------------------------------------------------------- */

static const double ramp_time[] = {0, 10}, ramp[] = {0, 1};
static const double gust_time[] = {0, 0.5, 0.5, 1.5, 2}, gust[] = {0, 0, 1, 1, 0.2};
static const double late_time[] = {0, 1, 1.9, 2, 2.1, 2.2}, late[] = {0, 0, 0, 0.3, 0.7, 1};
static const struct {
  const char *what;
  double traction[3];
  corot_amplitude amplitude;
  double t_end;
} cases[] = {
    {"Example 2", {200, 0, 0}, {.n = 2, .time = ramp_time, .value = ramp}, 40},
    {"jumps", {50, 20, 0}, {.n = 5, .time = gust_time, .value = gust}, 3},
    {"shaken", {50, 20, 0}, {.curve = COROT_CURVE_SINE, .frequency = 0.5}, 3},
    {"spline",
     {50, 0, 0},
     {.curve = COROT_CURVE_SMOOTH, .n = 6, .time = late_time, .value = late},
     3},
};
enum { NCASE = sizeof cases / sizeof *cases };

/* The steps and the assemblies of K and D of a host and of corot's own, of several runs. */
typedef struct counts {
  long steps, ours, assemblies, our_assemblies;
} counts;

/* One run of each. The answers are off from each other by what errors of 1e-4 a step make over many
   swings. */
static void run_both(int c, int k, double rtol, counts *sum) {
  bar b = paper_bar(cases[c].traction, &cases[c].amplitude);
  double tip;
  corot_statistics ours = run_ours(hosts[k].name, &b, rtol, cases[c].t_end, &tip);
  machine m;
  start_host(&m, k, &b, rtol);
  assert_ok(corot_sun_host_advance(&m.host, cases[c].t_end, m.y));
  assert_true(m.host.t == cases[c].t_end);
  assert_close(N_VGetArrayPointer(m.y)[b.tip], tip, 0.02, 0);
  sum->steps += m.host.nst, sum->ours += ours.nst;
  sum->assemblies += corot_pencil_statistics(m.pencil).nassembly;
  sum->our_assemblies += ours.nje;
  end_host(&m, k);
  bar_destroy(&b);
}

/* At most 1.2 times the steps, and 1.2 times the assemblies of K and D: the same rules, but for
   rounding in SUNDIALS' vector, whose norms sum in another order. Of several runs at tolerances
   that hardly differ, for over many swings rounding alone makes a third more steps of one, or less.
 */
static void a_host_takes_the_steps_of_our_own(void **state) {
  (void)state;
  enum { RUNS = 3 };
  for (int c = 0; c < NCASE; c++)
    for (int k = 0; k < NHOST; k++) {
      counts sum = {0};
      for (int run = 0; run < RUNS; run++) run_both(c, k, 1e-4 * (1 + 0.002 * run), &sum);
      if (sum.steps > 1.2 * sum.ours)
        fail_msg("%s, %s: %ld steps, ours %ld", cases[c].what, hosts[k].name, sum.steps, sum.ours);
      assert_true(sum.assemblies <= 1.2 * sum.our_assemblies + RUNS);
    }
}

/* Frames that are held, and found anew every tenth of a second: r jumps there, and the host says
   so. At most 1.2 times the steps of our own, to the same answer but for rounding, which may decide
   where a step ends. */
static void a_host_feels_changes_as_our_own(void **state) {
  (void)state;
  const double every = 0.1, t_end = 1;
  const corot_amplitude at_once = {.n = 0};
  for (int k = 0; k < NHOST; k++) {
    bar b = paper_bar((double[]){20, 10, 0}, &at_once);
    corot_integrator_def def = corot_integrator_defaults();
    corot_frame_policy policy = corot_frame_policy_defaults();
    def.method = hosts[k].name;
    policy.frames = COROT_FRAMES_HELD, policy.interval = every;
    corot_integrator *ours = start(&b, &def);
    corot_frame_clock *clock;
    corot_frame_event event;
    corot_state_enter(b.state, 0);
    assert_ok(corot_frame_clock_create(&policy, b.model, b.state, ours, 0, b.u, b.v, &clock));
    for (corot_step step = {0}; step.t < t_end;) {
      assert_ok(corot_integrator_step(ours, fmin(t_end, corot_frame_clock_stop(clock)), &step));
      assert_ok(corot_frame_clock_tick(clock, step.t, &event));
    }
    double *u = malloc(b.n * sizeof *u);
    assert_ok(corot_integrator_at(ours, t_end, u, NULL));
    long nst = corot_integrator_statistics(ours).nst;
    corot_frame_clock_destroy(clock);
    corot_integrator_destroy(ours);

    machine m;
    assert_ok(corot_frames_update(b.model, b.state, 0, b.u, NULL));
    start_host(&m, k, &b, 1e-4);
    for (int window = 1; window * every <= t_end * (1 + 1e-12); window++) {
      assert_ok(corot_sun_host_advance(&m.host, window * every, m.y));
      assert_ok(corot_frames_update(b.model, b.state, m.host.t, N_VGetArrayPointer(m.y), NULL));
      assert_ok(corot_sun_host_changed(&m.host, m.y));
    }
    if (m.host.nst > 1.2 * nst) fail_msg("%s: %ld steps, ours %ld", hosts[k].name, m.host.nst, nst);
    assert_close(N_VGetArrayPointer(m.y)[b.tip], u[b.tip], 1e-3, 0);
    free(u);
    end_host(&m, k);
    bar_destroy(&b);
  }
}

/* Where nothing has changed nothing is lost: a multistep method keeps its history, and K and D stay
   where only loads may have changed; else they are made anew at the next set-up. */
static void what_does_not_change_costs_nothing(void **state) {
  (void)state;
  bar b = bar_create(&example2);
  for (int k = 0; k < NHOST; k++)
    for (int matrices = 0; matrices < 2; matrices++) {
      long nassembly[2], nst[2];
      for (int told = 0; told < 2; told++) {
        machine m;
        start_host(&m, k, &b, 1e-4);
        assert_ok(corot_sun_host_advance(&m.host, 0.3, m.y));
        for (int window = 1; window <= 10; window++) {
          if (told)
            assert_ok(matrices ? corot_sun_host_changed(&m.host, m.y)
                               : corot_sun_host_loaded(&m.host, m.y));
          assert_ok(corot_sun_host_advance(&m.host, 0.3 + 0.01 * window, m.y));
        }
        assert_int_equal(m.host.nrestart, 0);
        nassembly[told] = corot_pencil_statistics(m.pencil).nassembly;
        nst[told] = m.host.nst;
        end_host(&m, k);
      }
      assert_true(nst[1] <= 1.2 * nst[0]);
      if (!matrices && k < 2) assert_int_equal(nassembly[1], nassembly[0]);
    }
  bar_destroy(&b);
}

/* A window that is gone through twice, as by a partner who iterates, comes out the same to the last
   bit: a restart forgets all that was. */
static void a_window_can_be_repeated(void **state) {
  (void)state;
  bar b = bar_create(&example2);
  for (int k = 0; k < NHOST; k++) {
    machine m;
    start_host(&m, k, &b, 1e-4);
    assert_ok(corot_sun_host_advance(&m.host, 0.2, m.y));
    N_Vector kept = N_VClone(m.y), once = N_VClone(m.y);
    N_VScale(1, m.y, kept);
    for (int pass = 0; pass < 2; pass++) {
      N_VScale(1, kept, m.y);
      corot_pencil_invalidate(m.pencil);
      assert_ok(corot_sun_host_restart(&m.host, 0.2, m.y, 1e-3));
      assert_ok(corot_sun_host_advance(&m.host, 0.3, m.y));
      if (pass == 0) N_VScale(1, m.y, once);
    }
    const double *first = N_VGetArrayPointer(once), *second = N_VGetArrayPointer(m.y);
    assert_memory_equal(first, second, 2 * b.n * sizeof *first);
    N_VDestroy(kept), N_VDestroy(once);
    end_host(&m, k);
  }
  bar_destroy(&b);
}

/* A cube under a weight that it cannot bear: elements turn inside out, beyond which there is no
   step. SUNDIALS would take ever shorter ones. */
static void a_host_gives_up_where_an_element_inverts(void **state) {
  (void)state;
  for (int k = 0; k < NHOST; k++) {
    bar_def def = example2;
    def.cells[2] = 1, def.ramp = 0, def.traction[0] = 0, def.traction[2] = -2e6;
    bar b = bar_create(&def);
    machine m;
    start_host(&m, k, &b, 1e-4);
    assert_fails(corot_sun_host_advance(&m.host, 10, m.y), COROT_EINTEGRATE, "is inverted");
    assert_below(m.host.t, 10);
    assert_below(m.host.nst, 20000);
    end_host(&m, k);
    bar_destroy(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_host_takes_the_steps_of_our_own),
      cmocka_unit_test(a_host_feels_changes_as_our_own),
      cmocka_unit_test(what_does_not_change_costs_nothing),
      cmocka_unit_test(a_window_can_be_repeated),
      cmocka_unit_test(a_host_gives_up_where_an_element_inverts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Evaluations that are shared out: whatever the model, the number of threads, or who runs the
   parts, all results are those of one thread, to the last bit. */
#include <pthread.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "alloc.h"
#include "core/lanes/widths.h"
#include "hierarchical.h"

/* --- All that a state can evaluate, one result after the other --- */

typedef struct results {
  size_t n;
  double *value;
} results;

static void keep(results *r, size_t n, const void *value) {
  r->value = realloc(r->value, (r->n + n) * sizeof *r->value);
  memcpy(r->value + r->n, value, n * sizeof *r->value);
  r->n += n;
}

typedef struct subject {
  const corot_model *model;
  corot_state *state;
  int n;
  double *u, *v, *du, *dv, *out; /* [n] */
  double (*K)[9], (*D)[9];
  double (*nodal)[3];
} subject;

static void keep_forces(const subject *s, double t, results *all) {
  assert_ok(corot_residual(s->model, s->state, t, s->u, s->v, s->out));
  keep(all, s->n, s->out);
  for (int k = COROT_TANGENT_HELD; k <= COROT_TANGENT_EXACT; k++) {
    assert_ok(corot_jvp(s->model, s->state, t, s->u, s->v, k, s->du, s->dv, s->out));
    keep(all, s->n, s->out);
  }
  assert_ok(corot_elastic_force(s->model, s->state, t, s->u, s->nodal));
  keep(all, 3 * corot_model_mesh(s->model)->nnode, s->nodal);
}

static void keep_matrices(const subject *s, double t, results *all) {
  size_t nblock = corot_model_nblock(s->model);
  for (int k = COROT_TANGENT_HELD; k <= COROT_TANGENT_CLAMPED; k++) {
    assert_ok(corot_jacobian(s->model, s->state, t, s->u, s->v, k, s->K, s->D));
    keep(all, 9 * nblock, s->K);
    keep(all, 9 * nblock, s->D);
  }
  assert_ok(corot_jacobian(s->model, s->state, t, s->u, s->v, COROT_TANGENT_EXACT, NULL, s->D));
  keep(all, 9 * nblock, s->D);
}

static void keep_energies(const subject *s, double t, results *all) {
  corot_energies e;
  assert_ok(corot_energy(s->model, s->state, t, s->u, s->v, &e));
  keep(all, 1, &e.elastic), keep(all, 1, &e.kinetic), keep(all, 1, &e.power_dissipated);
}

/* With exact frames, then with those that are held at u, then with those that turn on. */
static results evaluate(const subject *s) {
  results all = {0};
  for (int k = COROT_FRAMES_EXACT; k <= COROT_FRAMES_EXTRAPOLATED; k++) {
    corot_frames_change change = {0};
    double spin = 0;
    corot_state_use(s->state, k);
    if (k == COROT_FRAMES_HELD)
      assert_ok(corot_frames_update(s->model, s->state, 0, s->u, &change));
    if (k == COROT_FRAMES_EXTRAPOLATED)
      assert_ok(corot_frames_spin(s->model, s->state, 0, s->u, s->v, &spin));
    keep(&all, 1, &change.angle_max), keep(&all, 1, &change.angle_mean);
    keep(&all, 1, &change.energy), keep(&all, 1, &spin);
    double tet = change.angle_tet;
    keep(&all, 1, &tet);
    keep_forces(s, 0.01, &all);
    keep_matrices(s, 0.01, &all);
    keep_energies(s, 0.01, &all);
  }
  return all;
}

static subject subject_of(const corot_model *model) {
  subject s = {.model = model, .n = corot_model_ndof(model)};
  size_t nblock = corot_model_nblock(model);
  s.u = vectors(5, s.n), s.v = s.u + s.n, s.du = s.v + s.n, s.dv = s.du + s.n, s.out = s.dv + s.n;
  s.K = calloc(nblock, sizeof *s.K), s.D = calloc(nblock, sizeof *s.D);
  s.nodal = calloc(corot_model_mesh(model)->nnode, sizeof *s.nodal);
  fill_noise(s.n, 3, 2e-3, s.u), fill_noise(s.n, 4, 1, s.v);
  fill_noise(s.n, 5, 1, s.du), fill_noise(s.n, 6, 1, s.dv);
  return s;
}

static void drop_subject(subject *s) { free(s->u), free(s->K), free(s->D), free(s->nodal); }

/* --- Who runs the parts --- */

/* A host that has no threads: last part first. */
static void backwards(void *host, int nparts, void (*part)(void *work, int k), void *work) {
  (*(int *)host)++;
  for (int k = nparts - 1; k >= 0; k--) part(work, k);
}

static const int numbers[] = {2, 3, 8};
enum { NNUMBER = sizeof numbers / sizeof *numbers };

/* Evaluates with all numbers of threads, and with a host's, each time by a state of its own. */
static void assert_same_by_all(const corot_model *model, const char *what) {
  subject s = subject_of(model);
  results one = {0};
  for (int k = -1; k <= NNUMBER; k++) {
    int calls = 0;
    assert_ok(corot_state_create(model, &s.state));
    if (k >= 0 && k < NNUMBER) {
      assert_ok(corot_state_threads(s.state, numbers[k]));
      assert_int_equal(corot_state_thread_count(s.state), numbers[k]);
    }
    if (k == NNUMBER) assert_ok(corot_state_parallel(s.state, 5, backwards, &calls));
    results all = evaluate(&s);
    if (k < 0) {
      one = all;
    } else {
      assert_int_equal(all.n, one.n);
      for (size_t i = 0; i < all.n; i++)
        if (memcmp(&all.value[i], &one.value[i], sizeof *all.value))
          fail_msg("%s, run %d: result %zu of %zu is %.17g, of one thread %.17g", what, k, i, all.n,
                   all.value[i], one.value[i]);
      free(all.value);
    }
    if (k == NNUMBER) assert_true(calls > 0);
    corot_state_destroy(s.state);
  }
  free(one.value);
  drop_subject(&s);
}

/* --- Plain models --- */

/* The nodes numbered as if at random: then the elements of a node are all over the loop. */
static corot_mesh *renumber(corot_mesh *mesh) {
  const double low[3] = {-9, -9, -9}, high[3] = {9, 9, 0.12};
  int n = mesh->nnode, step = 7;
  while (n % step == 0) step += 2;
  double(*x)[3] = malloc(n * sizeof *x);
  corot_mesh *made;
  for (int i = 0; i < n; i++) memcpy(x[(long)i * step % n], mesh->x[i], sizeof *x);
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 4; k++) mesh->tet[e][k] = (int)((long)mesh->tet[e][k] * step % n);
  assert_ok(
      corot_mesh_create(n, (const double(*)[3])x, mesh->ntet, (const int(*)[4])mesh->tet, &made));
  assert_ok(corot_mesh_group_box(made, "zmin", low, high, 0));
  free(x);
  corot_mesh_destroy(mesh);
  return made;
}

typedef struct variant {
  const char *name;
  bool damped, shuffled, held;
  corot_dilatation dilatation;
} variant;

static const variant variants[] = {
    {"damped", true, false, false, COROT_DILATATION_LOCAL},
    {"undamped, shuffled", false, true, false, COROT_DILATATION_LOCAL},
    {"damped, held, shuffled", true, true, true, COROT_DILATATION_LOCAL},
    {"averaged at nodes", true, false, true, COROT_DILATATION_NODAL},
};
enum { NVARIANT = sizeof variants / sizeof *variants };

static corot_model *make_plain(const char *strain, const variant *of) {
  static const corot_fix fix = {"zmin", {true, true, true}};
  corot_material material = soft;
  corot_mesh *mesh = order_of_test() == 1 ? linear_box(4, 4, 10) : linear_box(3, 3, 8);
  corot_model_def def = corot_model_defaults();
  corot_model *model;
  if (!of->damped) material.damping_lambda = material.damping_mu = 0;
  if (of->shuffled) mesh = renumber(mesh);
  mesh = of_order(mesh);
  def.mesh = mesh, def.strain = strain, def.dilatation = of->dilatation;
  def.nmaterial = 1, def.material = &material;
  def.nfix = of->held, def.fix = &fix;
  assert_ok(corot_model_create(&def, &model));
  corot_mesh_destroy(mesh);
  return model;
}

/* What writes where does not depend on the measure: one will do where it takes long. */
#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
enum { SLOW = 1 };
#else
enum { SLOW = 0 };
#endif

/* Each measure by the widest build of the kernels, and all builds for one of them. */
static void any_number_of_threads_gives_the_same(void **state) {
  static const int widths[] = {8, 4, 2};
  (void)state;
  bool one = SLOW || order_of_test() == 2;
  for (int k = one ? NMEASURE - 2 : 0; k < (one ? NMEASURE - 1 : NMEASURE + 2); k++)
    for (int i = 0; i < NVARIANT; i++) {
      int measure = k < NMEASURE ? k : NMEASURE - 2;
      corot_lanes_limit(k < NMEASURE ? 0 : widths[k - NMEASURE + 1]);
      corot_model *model = make_plain(measures[measure], &variants[i]);
      char what[80];
      snprintf(what, sizeof what, "%s, %s, %d lanes", measures[measure], variants[i].name,
               corot_lanes_in_use());
      assert_same_by_all(model, what);
      corot_model_destroy(model);
    }
  corot_lanes_limit(0);
}

/* --- Hierarchies, whose tets may have one of a coarser level above them --- */

static void hierarchies_do_too(void **state) {
  static const choice choices[] = {{"green", "polar", 2, 0, true, false},
                                   {"green", "polar", 2, 1, true, false},
                                   {"polar", "polar", 2, 2, false, false},
                                   {"green", "cauchy", 2, 0, false, false},
                                   {"green", "polar", 1, 1, true, true}};
  corot_coupling coupling = coupling_of(state);
  if (order_of_test() == 2) skip(); /* these have orders of their own */
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) {
    corot_mesh *coarse = linear_box(2, 2, 2), *mesh;
    corot_refinement *refinement;
    corot_hierarchy_def hierarchy;
    corot_model *model;
    corot_model_def def = definition(&choices[k], coupling, &soft, true, &hierarchy);
    refine_to(&choices[k], coarse, &mesh, &refinement);
    def.mesh = mesh, hierarchy.refinement = refinement;
    assert_ok(corot_model_create(&def, &model));
    assert_same_by_all(model, choices[k].coarse);
    corot_model_destroy(model);
    corot_refinement_destroy(refinement);
    corot_mesh_destroy(mesh), corot_mesh_destroy(coarse);
  }
}

/* --- What fails --- */

/* The inverted tet that is named is the first one of the loop, as with one thread. */
static void the_same_tet_is_named(void **state) {
  (void)state;
  corot_model *model = make_plain("polar", &variants[1]);
  subject s = subject_of(model);
  int first = -1;
  for (int i = 0; i < s.n; i++) s.u[i] *= 100; /* many are */
  for (int k = -1; k < NNUMBER; k++) {
    assert_ok(corot_state_create(model, &s.state));
    if (k >= 0) assert_ok(corot_state_threads(s.state, numbers[k]));
    assert_fails(corot_residual(model, s.state, 0, s.u, s.v, s.out), COROT_RETRY, "is inverted");
    if (k < 0) first = corot_state_inverted(s.state);
    assert_int_equal(corot_state_inverted(s.state), first);
    corot_state_destroy(s.state);
  }
  for (int i = 0; i < s.n; i++) s.v[i] *= 1e308, s.u[i] *= 1e-3;
  corot_model_destroy(model);
  model = make_plain("polar", &variants[0]);
  assert_ok(corot_state_create(model, &s.state));
  assert_ok(corot_state_threads(s.state, 3));
  assert_fails(corot_residual(model, s.state, 0, s.u, s.v, s.out), COROT_RETRY,
               "the forces exceed double precision");
  corot_state_destroy(s.state);
  drop_subject(&s);
  corot_model_destroy(model);
}

static void numbers_make_sense(void **state) {
  (void)state;
  corot_model *model = make_plain("polar", &variants[0]);
  corot_state *s;
  int calls = 0;
  assert_ok(corot_state_create(model, &s));
  assert_int_equal(corot_state_thread_count(s), 1);
  assert_fails(corot_state_threads(NULL, 1), COROT_EINVAL, "'state' is NULL");
  assert_fails(corot_state_threads(s, -1), COROT_EINVAL, "threads: -1 is not from 0 to 256");
  assert_fails(corot_state_threads(s, 10000), COROT_EINVAL, "threads: 10000 is not from 0 to 256");
  assert_fails(corot_state_parallel(s, 0, backwards, &calls), COROT_EINVAL, "0 is not from 1");
  assert_fails(corot_state_parallel(s, 2, NULL, &calls), COROT_EINVAL, "'run' is NULL");
  assert_ok(corot_state_threads(s, 0)); /* a small body */
  assert_int_equal(corot_state_thread_count(s), 1);
  assert_true(corot_processors() >= 1);

  /* more ranges take more memory, which comes back */
  size_t alone = corot_state_bytes(s);
  assert_ok(corot_state_threads(s, 4));
  assert_true(corot_state_bytes(s) > alone);
  assert_ok(corot_state_threads(s, 1));
  assert_int_equal(corot_state_bytes(s), alone);
  corot_state_destroy(s);
  corot_model_destroy(model);
}

/* Where memory runs out, the state goes on as it was. */
static void failures_leave_the_state_as_it_was(void **state) {
  (void)state;
  corot_model *model = make_plain("polar", &variants[2]);
  subject s = subject_of(model);
  assert_ok(corot_state_create(model, &s.state));
  assert_ok(corot_state_threads(s.state, 2));
  results before = evaluate(&s);
  long count = 1, k = 0;
  for (corot_status status = COROT_ENOMEM; status; k++) {
    alloc_fail_at(k + 1);
    status = corot_state_threads(s.state, 3);
    count = alloc_count();
    alloc_fail_at(0);
    assert_int_equal(corot_state_thread_count(s.state), status ? 2 : 3);
    if (status) assert_int_equal(status, COROT_ENOMEM);
    corot_state_use(s.state, COROT_FRAMES_EXACT);
    assert_ok(corot_residual(model, s.state, 0.01, s.u, s.v, s.out));
    assert_memory_equal(s.out, before.value + 5, s.n * sizeof *s.out);
  }
  assert_true(k > 10 && count >= k - 1);
  free(before.value);
  corot_state_destroy(s.state);
  drop_subject(&s);
  corot_model_destroy(model);
}

/* --- Other threads and processes --- */

/* A copy of the process has none of the threads, and works on alone. */
static void a_copy_works_on_alone(void **state) {
  (void)state;
  corot_model *model = make_plain("hybrid", &variants[0]);
  subject s = subject_of(model);
  assert_ok(corot_state_create(model, &s.state));
  assert_ok(corot_state_threads(s.state, 3));
  assert_ok(corot_residual(model, s.state, 0, s.u, s.v, s.out));
  pid_t copy = fork();
  if (copy == 0) {
    double *again = malloc(s.n * sizeof *again);
    alarm(60); /* should it wait for threads that are not there */
    bool same = !corot_residual(model, s.state, 0, s.u, s.v, again) &&
                !memcmp(again, s.out, s.n * sizeof *again);
    corot_state_destroy(s.state);
    _exit(same ? 0 : 1);
  }
  int status;
  assert_true(copy > 0 && waitpid(copy, &status, 0) == copy);
  assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  corot_state_destroy(s.state);
  drop_subject(&s);
  corot_model_destroy(model);
}

typedef struct user {
  const corot_model *model;
  const double *expected;
  const subject *from;
  bool same;
  pthread_t thread;
} user;

static void *work_alone(void *of) {
  user *me = of;
  corot_state *state;
  double *out = malloc(me->from->n * sizeof *out);
  me->same = !corot_state_create(me->model, &state) && !corot_state_threads(state, 2);
  for (int k = 0; k < 50 && me->same; k++)
    me->same = !corot_residual(me->model, state, 0, me->from->u, me->from->v, out) &&
               !memcmp(out, me->expected, me->from->n * sizeof *out);
  corot_state_destroy(state);
  free(out);
  return NULL;
}

/* States of one model in several threads of a host, each with threads of its own. */
static void hosts_may_have_threads_too(void **state) {
  (void)state;
  corot_model *model = make_plain("polar", &variants[3]);
  subject s = subject_of(model);
  user users[3];
  assert_ok(corot_state_create(model, &s.state));
  assert_ok(corot_residual(model, s.state, 0, s.u, s.v, s.out));
  for (int k = 0; k < 3; k++) {
    users[k] = (user){.model = model, .expected = s.out, .from = &s};
    assert_int_equal(pthread_create(&users[k].thread, NULL, work_alone, &users[k]), 0);
  }
  for (int k = 0; k < 3; k++) {
    pthread_join(users[k].thread, NULL);
    assert_true(users[k].same);
  }
  corot_state_destroy(s.state);
  drop_subject(&s);
  corot_model_destroy(model);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(any_number_of_threads_gives_the_same),
      each_coupling_unit_test(hierarchies_do_too),
      cmocka_unit_test(the_same_tet_is_named),
      cmocka_unit_test(numbers_make_sense),
      cmocka_unit_test(failures_leave_the_state_as_it_was),
      cmocka_unit_test(a_copy_works_on_alone),
      cmocka_unit_test(hosts_may_have_threads_too),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

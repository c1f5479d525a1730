/* Definitions of another size than the library's, and what must be given and is not: each is
   refused with a message, and nothing is read or written beyond what the host has. */
#include <corot/integrate.h>
#include <corot/modes.h>
#include <corot/space.h>
#include <corot/statics.h>

#include "check.h"

enum { CANARY = 0x5a };

static const corot_material rubber = {.lambda = 1e5, .mu = 1e4, .density = 1000};
static const corot_fix base = {"zmin", {true, true, true}};

/* One of each that the makers need. */
typedef struct things {
  corot_mesh *mesh;
  corot_model *model;
  corot_state *state;
  double *u, *v;
} things;

static things make(void) {
  things s = {0};
  corot_model_def def = corot_model_defaults();
  assert_ok(corot_mesh_box(&(corot_box){.size = {1, 1, 1}, .cells = {1, 1, 2}}, &s.mesh));
  def.mesh = s.mesh, def.nmaterial = 1, def.material = &rubber, def.nfix = 1, def.fix = &base;
  assert_ok(corot_model_create(&def, &s.model));
  assert_ok(corot_state_create(s.model, &s.state));
  s.u = calloc(2 * corot_model_ndof(s.model), sizeof *s.u);
  s.v = s.u + corot_model_ndof(s.model);
  return s;
}

static void drop(things *s) {
  corot_state_destroy(s->state);
  corot_model_destroy(s->model);
  corot_mesh_destroy(s->mesh);
  free(s->u);
}

/* Makers, each of one kind of definition; a NULL definition is handed on. */
static corot_status make_model(const things *s, const void *given) {
  corot_model *model;
  corot_model_def def;
  if (given) memcpy(&def, given, sizeof def), def.mesh = s->mesh, def.nmaterial = 1;
  if (given) def.material = &rubber;
  corot_status status = corot_model_create(given ? &def : NULL, &model);
  if (!status) corot_model_destroy(model);
  return status;
}

static corot_status make_hierarchy(const things *s, const void *given) {
  corot_model *model;
  corot_model_def def = corot_model_defaults();
  def.mesh = s->mesh, def.nmaterial = 1, def.material = &rubber, def.hierarchy = given;
  corot_status status = corot_model_create(&def, &model);
  if (!status) corot_model_destroy(model);
  return status;
}

static corot_status make_pencil(const things *s, const void *def) {
  corot_pencil *pencil;
  corot_status status = corot_pencil_create(s->model, s->state, def, &pencil);
  if (!status) corot_pencil_destroy(pencil);
  return status;
}

static corot_status make_integrator(const things *s, const void *def) {
  corot_integrator *integrator;
  corot_status status =
      corot_integrator_create(def, s->model, s->state, 0, s->u, s->v, &integrator);
  if (!status) corot_integrator_destroy(integrator);
  return status;
}

static corot_status make_clock(const things *s, const void *policy) {
  corot_integrator *integrator;
  corot_frame_clock *clock;
  corot_integrator_def def = corot_integrator_defaults();
  assert_ok(corot_integrator_create(&def, s->model, s->state, 0, s->u, s->v, &integrator));
  corot_status status =
      corot_frame_clock_create(policy, s->model, s->state, integrator, 0, s->u, s->v, &clock);
  if (!status) corot_frame_clock_destroy(clock);
  corot_integrator_destroy(integrator);
  return status;
}

static corot_status make_statics(const things *s, const void *def) {
  corot_statics *statics;
  corot_status status = corot_statics_create(def, s->model, 0, NULL, &statics);
  if (!status) corot_statics_destroy(statics);
  return status;
}

static corot_status check_modes(const things *s, const void *def) {
  return corot_modes_check(def, s->model, 0, true);
}

#define FILL(noun, type)                             \
  static void fill_##noun(void *def, size_t bytes) { \
    corot_##noun##_set_defaults((type *)def, bytes); \
  }
FILL(model, corot_model_def)
FILL(hierarchy, corot_hierarchy_def)
FILL(linear, corot_linear_def)
FILL(integrator, corot_integrator_def)
FILL(frame_policy, corot_frame_policy)
FILL(statics, corot_statics_def)
FILL(modes, corot_modes_def)

/* Every definition: its size, who fills it, who takes it. */
static const struct {
  const char *type;
  size_t size;
  void (*fill)(void *def, size_t bytes);
  corot_status (*make)(const things *s, const void *def);
  bool optional; /* NULL stands for something */
} table[] = {
    {"corot_model_def", sizeof(corot_model_def), fill_model, make_model, false},
    {"corot_hierarchy_def", sizeof(corot_hierarchy_def), fill_hierarchy, make_hierarchy, true},
    {"corot_linear_def", sizeof(corot_linear_def), fill_linear, make_pencil, true},
    {"corot_integrator_def", sizeof(corot_integrator_def), fill_integrator, make_integrator, false},
    {"corot_frame_policy", sizeof(corot_frame_policy), fill_frame_policy, make_clock, false},
    {"corot_statics_def", sizeof(corot_statics_def), fill_statics, make_statics, false},
    {"corot_modes_def", sizeof(corot_modes_def), fill_modes, check_modes, false},
};
enum { NTYPE = sizeof table / sizeof *table };

/* A host of an older and of a newer version: only as many bytes as it has are written, and what it
   then hands over is refused by name. */
static void test_other_sizes_are_refused(void **unused) {
  (void)unused;
  things s = make();
  for (int i = 0; i < NTYPE; i++)
    for (int change = -8; change <= 8; change += 16) {
      size_t bytes = table[i].size + change;
      unsigned char room[1024];
      assert_true(bytes < sizeof room / 2);
      memset(room, CANARY, sizeof room);
      table[i].fill(room, bytes);
      for (size_t k = bytes; k < sizeof room; k++) assert_int_equal(room[k], CANARY);
      assert_int_equal(table[i].make(&s, room), COROT_EINVAL);
      assert_non_null(strstr(corot_error(), table[i].type));
      assert_non_null(strstr(corot_error(), "another version"));
    }
  drop(&s);
}

/* Of our size they are what the defaults are. */
static void test_own_size_is_taken(void **unused) {
  (void)unused;
  things s = make();
  for (int i = 0; i < NTYPE; i++) {
    unsigned char room[1024];
    table[i].fill(room, table[i].size);
    if (table[i].make == check_modes && !corot_modes_available()) continue;
    corot_status status = table[i].make(&s, room);
    if (table[i].make == make_hierarchy) { /* of which a refinement is still missing */
      assert_int_equal(status, COROT_EINVAL);
      assert_null(strstr(corot_error(), "version"));
    } else {
      assert_ok(status);
    }
  }
  drop(&s);
}

/* A size of 0 is that of a definition which was written down. */
static void test_written_definitions_are_taken(void **unused) {
  (void)unused;
  things s = make();
  corot_model *model;
  assert_ok(corot_model_create(
      &(corot_model_def){.mesh = s.mesh, .strain = "polar", .nmaterial = 1, .material = &rubber},
      &model));
  corot_model_destroy(model);
  assert_ok(make_clock(&s, &(corot_frame_policy){.frames = COROT_FRAMES_EXACT}));
  drop(&s);
}

static void test_null_definitions_are_refused(void **unused) {
  (void)unused;
  things s = make();
  for (int i = 0; i < NTYPE; i++) {
    if (table[i].optional) {
      assert_ok(table[i].make(&s, NULL));
      continue;
    }
    assert_int_equal(table[i].make(&s, NULL), COROT_EINVAL);
    assert_non_null(strstr(corot_error(), table[i].type));
  }
  drop(&s);
}

#define REFUSED(call, word)                       \
  do {                                            \
    assert_int_equal((call), COROT_EINVAL);       \
    assert_non_null(strstr(corot_error(), word)); \
  } while (0)

/* Whatever else must be there: the message names it. */
static void test_null_arguments_are_refused(void **unused) {
  (void)unused;
  things s = make();
  corot_model_def def = corot_model_defaults();
  corot_integrator_def run = corot_integrator_defaults();
  corot_statics_def rest = corot_statics_defaults();
  corot_state *state = NULL;
  corot_pencil *pencil = NULL;
  corot_mass_solver *mass = NULL;
  corot_integrator *integrator = NULL;
  corot_statics *statics = NULL;
  corot_csc *csc = NULL;
  corot_mesh *mesh = NULL;
  corot_space_estimate estimate;

  def.mesh = s.mesh, def.nmaterial = 1;
  corot_model *model = NULL;
  REFUSED(corot_model_create(&def, &model), "nmaterial = 1");
  def.material = &rubber;
  REFUSED(corot_model_create(&def, NULL), "'model'");
  def.nload = -1;
  REFUSED(corot_model_create(&def, &model), "nload = -1");

  REFUSED(corot_state_create(NULL, &state), "'model'");
  REFUSED(corot_pencil_create(s.model, NULL, NULL, &pencil), "'state'");
  REFUSED(corot_mass_solver_create(NULL, &mass), "'model'");
  REFUSED(corot_csc_create(NULL, COROT_LOWER, &csc), "NULL");
  REFUSED(corot_integrator_create(&run, s.model, NULL, 0, s.u, s.v, &integrator), "'state'");
  REFUSED(corot_integrator_create(&run, s.model, s.state, 0, NULL, s.v, &integrator), "'u'");
  REFUSED(corot_integrator_create(&run, s.model, s.state, 0, s.u, s.v, NULL), "'integrator'");
  REFUSED(corot_statics_create(&rest, NULL, 0, NULL, &statics), "'model'");
  REFUSED(corot_space_error(&def, s.model, NULL, NULL, NULL, &estimate), "'at'");
  REFUSED(corot_mesh_create(4, NULL, 1, (const int[][4]){{0, 1, 2, 3}}, &mesh), "'x'");
  REFUSED(corot_mesh_create(4, (const double(*)[3])s.mesh->x, 1, NULL, &mesh), "'tet'");
  REFUSED(corot_mesh_read(NULL, &mesh), "'path'");
  REFUSED(corot_mesh_write(s.mesh, NULL), "'path'");
  REFUSED(corot_mesh_box(NULL, &mesh), "'box'");
  assert_null(mesh);
  drop(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_other_sizes_are_refused),
      cmocka_unit_test(test_own_size_is_taken),
      cmocka_unit_test(test_written_definitions_are_taken),
      cmocka_unit_test(test_null_definitions_are_refused),
      cmocka_unit_test(test_null_arguments_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

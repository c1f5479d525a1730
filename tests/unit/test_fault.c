/* What a refused definition is told to be about: entry, index and field, beside the message. */
#include <corot/model.h>
#include <pthread.h>

#include "check.h"
#include "core/base/fault.h"
#include "core/model/definition.h"

static corot_material material[2];
static corot_motion motion[2];
static corot_load load[2];
static corot_fix fix;
static corot_hierarchy_def hierarchy;
static corot_model_def def;
static const double times[] = {0, 1, 1, 1}, values[] = {0, 1, 2, 3};

/* A definition that makes a model of the box below. */
static void good(void) {
  material[0] = material[1] = (corot_material){.lambda = 1, .mu = 1, .density = 1};
  motion[0] = motion[1] = (corot_motion){
      .kind = COROT_TRANSLATE, .group = "zmin", .velocity = {1, 0, 0}, .from = 0, .to = 1};
  load[0] = load[1] = (corot_load){.kind = COROT_TRACTION, .group = "zmax", .value = {1, 0, 0}};
  fix = (corot_fix){.group = "xmin", .component = {true, false, false}};
  hierarchy = corot_hierarchy_defaults();
  def = corot_model_defaults();
  def.nmaterial = 1, def.material = material;
  def.motion = motion, def.load = load, def.fix = &fix;
}

/* Each makes one thing wrong with it. */
static void no_mu(void) { material[0].mu = 0; }
static void no_number(void) { material[0].damping_mass = NAN; }
static void no_bulk(void) { material[0].lambda = -1; }
static void no_group(void) { def.nmaterial = 2; }
static void same_group(void) { def.nmaterial = 2, material[0].group = material[1].group = "all"; }
static void no_span(void) { def.nmotion = 1, motion[0].to = 0; }
static void no_axis(void) { def.nmotion = 1, motion[0].kind = COROT_ROTATE; }
static void overlap(void) { def.nmotion = 2, motion[1].from = 0.5, motion[1].to = 2; }
static void other_axis(void) {
  def.nmotion = 2, motion[1].kind = COROT_ROTATE, motion[1].axis[2] = 1;
}
static void jump(void) {
  def.nmotion = 1, motion[0].kind = COROT_MOVE,
  motion[0].amplitude = (corot_amplitude){3, times, values};
}
static void no_load(void) { def.nload = 2, load[1].kind = (corot_load_kind)9; }
static void no_value(void) { def.nload = 2, load[1].value[2] = INFINITY; }
static void third(void) { def.nload = 2, load[1].amplitude = (corot_amplitude){4, times, values}; }
static void no_frequency(void) {
  def.nload = 1, load[0].amplitude = (corot_amplitude){.curve = COROT_CURVE_SINE};
}
static void no_viscosity(void) { def.strain = "green", def.viscosity = COROT_OBJECTIVE; }
static void no_mass(void) { def.mass = (corot_mass)9; }
static void no_local(void) { def.dilatation = COROT_DILATATION_NODAL, def.dilatation_local = -1; }
static void no_level(void) { def.hierarchy = &hierarchy, hierarchy.frame_level = 3; }
static void no_coupling(void) {
  def.hierarchy = &hierarchy, hierarchy.coupling = (corot_coupling)9;
}
static void not_linear(void) { def.hierarchy = &hierarchy, def.strain = "green"; }

static void a_rule_names_entry_and_field(void **state) {
  (void)state;
  static const struct {
    void (*spoil)(void);
    corot_fault at;
  } wrong[] = {
      {no_mu, {"material", 0, "mu"}},
      {no_number, {"material", 0, "damping_mass"}},
      {no_bulk, {"material", 0, "lambda"}},
      {no_group, {"material", 1, "group", 0, "material", 0}},
      {same_group, {"material", 1, "group", 0, "material", 0}},
      {no_span, {"motion", 0, "to"}},
      {no_axis, {"motion", 0, "axis"}},
      {overlap, {"motion", 1, "", 0, "motion", 0}},
      {other_axis, {"motion", 1, "", 0, "motion", 0}},
      {jump, {"motion", 0, "amplitude.time", 2}},
      {no_load, {"load", 1, "kind"}},
      {no_value, {"load", 1, "value"}},
      {third, {"load", 1, "amplitude.time", 3}},
      {no_frequency, {"load", 0, "amplitude.frequency"}},
      {no_viscosity, {"model", 0, "viscosity"}},
      {no_mass, {"model", 0, "mass"}},
      {no_local, {"model", 0, "dilatation_local"}},
      {no_level, {"hierarchy", 0, "frame_level"}},
      {no_coupling, {"hierarchy", 0, "coupling"}},
      {not_linear, {"model", 0, "strain"}},
  };
  good();
  assert_ok(corot_definition_check(&def, 2));
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    const corot_fault *at = &wrong[k].at;
    good();
    wrong[k].spoil();
    assert_int_equal(corot_definition_check(&def, 2), COROT_EINVAL);
    corot_fault f = corot_fault_last();
    assert_string_equal(f.entry, at->entry);
    assert_string_equal(f.field, at->field);
    assert_int_equal(f.index, at->index);
    assert_int_equal(f.point, at->point);
    assert_string_equal(f.other ? f.other : "", at->other ? at->other : "");
    assert_int_equal(f.other_index, at->other_index);
    assert_true(f.length > 10 && f.reason >= corot_error());
    assert_non_null(strstr(corot_error(), f.reason));
  }
}

/* Each by its mesh: groups that are not there or hold nothing, and what is held or filled twice. */
static void strange_group(void) { def.nfix = 1, fix.group = "nowhere"; }
static void no_faces(void) { def.nload = 1, load[0].group = "node"; }
static void no_tets(void) { material[0].group = "zmin"; }
static void filled(void) {
  def.nmaterial = 2, material[0].group = "body", material[1].group = "same";
}
static void held(void) { def.nfix = def.nmotion = 1; }
static void held_by_motion(void) { def.nmotion = 2, motion[1].group = "xmin"; }
static void all_held(void) {
  def.nfix = 1, fix = (corot_fix){.group = "body", .component = {true, true, true}};
}

static void the_mesh_may_refuse_as_well(void **state) {
  (void)state;
  static const struct {
    void (*spoil)(void);
    const char *entry;
    int index;
    const char *field, *words;
  } wrong[] = {
      {strange_group, "fix", 0, "group", "fix 0: the mesh has no group 'nowhere'"},
      {no_faces, "load", 0, "group", "load 0: group 'node' has no faces for a traction"},
      {no_tets, "material", 0, "group", "material 0: group 'zmin' has no tets"},
      {filled, "material", 1, "group", "tet 0 belongs to materials 0 and 1 (material 0)"},
      {held, "motion", 0, "group",
       "motion 0: node 0 of group 'zmin' is already held in x: it is in 'xmin', too (fix 0)"},
      {held_by_motion, "motion", 1, "group",
       "group 'xmin' is already held in x: it is in 'zmin', too (motion 0)"},
      {all_held, "model", 0, "fix", "nothing can move"},
  };
  corot_box box = corot_box_defaults();
  corot_mesh *mesh;
  const double min[3] = {0, 0, 0}, max[3] = {1, 1, 1};
  int node = 7;
  for (int c = 0; c < 3; c++) box.size[c] = 1, box.cells[c] = 1;
  assert_ok(corot_mesh_box(&box, &mesh));
  assert_ok(corot_mesh_group_nodes(mesh, "node", 1, &node));
  assert_ok(corot_mesh_group_box(mesh, "body", min, max, 0));
  assert_ok(corot_mesh_group_box(mesh, "same", min, max, 0));
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    corot_model *model = NULL;
    good();
    wrong[k].spoil();
    def.mesh = mesh;
    assert_fails(corot_model_create(&def, &model), COROT_EINVAL, wrong[k].words);
    corot_fault f = corot_fault_last();
    assert_string_equal(f.entry, wrong[k].entry);
    assert_int_equal(f.index, wrong[k].index);
    assert_string_equal(f.field, wrong[k].field);
  }
  corot_mesh_destroy(mesh);
}

static void the_message_begins_with_the_entry(void **state) {
  (void)state;
  assert_int_equal(corot_fail_at("motion", 2, "from", "%d of %d", 3, 4), COROT_EINVAL);
  assert_string_equal(corot_error(), "motion 2: 3 of 4");
  assert_string_equal(corot_fault_last().reason, "3 of 4");
  corot_fail_at("model", 0, "mass", "heavy");
  assert_string_equal(corot_error(), "heavy");
  corot_fail_at("hierarchy", 0, "coupling", "loose");
  assert_string_equal(corot_error(), "hierarchy: loose");
  corot_fail_about(&(corot_fault){"load", 1, "group", .other = "fix", .other_index = 5}, "stuck");
  assert_string_equal(corot_error(), "load 1: stuck (fix 5)");
  assert_int_equal(corot_fault_last().length, 5);
}

/* What is longer than the message is cut, and the reason ends where the message does. */
static void a_long_reason_is_cut(void **state) {
  (void)state;
  char text[9000];
  memset(text, 'x', sizeof text - 1);
  text[sizeof text - 1] = 0;
  corot_fail_about(&(corot_fault){"load", 1, "group", .other = "fix"}, "%s", text);
  assert_int_equal(strlen(corot_error()), 4095);
  assert_int_equal(corot_fault_last().length, 4095 - strlen("load 1: "));
}

static void *fail_elsewhere(void *arg) {
  (void)arg;
  corot_fail_at("load", 0, "kind", "elsewhere");
  return NULL;
}

static void another_failure_takes_its_place(void **state) {
  (void)state;
  pthread_t thread;
  corot_fail_at("motion", 2, "from", "here");
  assert_int_equal(pthread_create(&thread, NULL, fail_elsewhere, NULL), 0);
  pthread_join(thread, NULL);
  assert_string_equal(corot_fault_last().entry, "motion");
  corot_fail(COROT_ENOMEM, "no memory");
  assert_null(corot_fault_last().entry);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_rule_names_entry_and_field),
      cmocka_unit_test(the_mesh_may_refuse_as_well),
      cmocka_unit_test(the_message_begins_with_the_entry),
      cmocka_unit_test(a_long_reason_is_cut),
      cmocka_unit_test(another_failure_takes_its_place),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

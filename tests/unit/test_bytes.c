/* The bytes that a model and a state say they hold are those that they allocated. */
#include "alloc.h"
#include "hierarchical.h"

/* The pool of tets, loads and supports of a definition, whatever takes memory of its own. */
typedef struct variant {
  const char *name, *strain;
  int nload, nmotion;
  corot_mass mass;
  corot_dilatation dilatation;
  double damping_mass;
} variant;

static const variant variants[] = {
    {"nothing else", "polar", 0, 0, COROT_MASS_LUMPED, COROT_DILATATION_LOCAL, 0},
    {"rest bases", "warp", 0, 0, COROT_MASS_LUMPED, COROT_DILATATION_LOCAL, 0},
    {"green", "green", 1, 0, COROT_MASS_LUMPED, COROT_DILATATION_LOCAL, 0},
    {"all loads", "polar", 4, 0, COROT_MASS_LUMPED, COROT_DILATATION_LOCAL, 0},
    {"a motion", "polar", 2, 1, COROT_MASS_LUMPED, COROT_DILATATION_LOCAL, 0},
    {"consistent mass", "polar", 1, 0, COROT_MASS_CONSISTENT, COROT_DILATATION_LOCAL, 0},
    {"damped mass", "polar", 1, 0, COROT_MASS_LUMPED, COROT_DILATATION_LOCAL, 3},
    {"both", "hybrid", 1, 0, COROT_MASS_CONSISTENT, COROT_DILATATION_LOCAL, 3},
    {"averages", "hybrid", 3, 1, COROT_MASS_LUMPED, COROT_DILATATION_NODAL, 0},
};

static corot_status create(const variant *v, const corot_mesh *mesh, corot_model **model) {
  static const double time[] = {0, 1, 3}, value[] = {0, 1, 0};
  corot_material material = {.lambda = 9e4, .mu = 1e4, .density = 1000, .damping_mu = 1};
  material.damping_mass = v->damping_mass;
  const corot_fix fix = {"zmin", {true, true, true}};
  const corot_load load[] = {{COROT_TRACTION, "xmax", {1, 0, 0}, {3, time, value}},
                             {COROT_GRAVITY, NULL, {0, 0, -1}, {0, NULL, NULL}},
                             {COROT_PRESSURE, "xmin", {5}, {3, time, value}},
                             {COROT_FORCE, "ymin", {0, 1, 0}, {0, NULL, NULL}}};
  const corot_motion motion = {
      .kind = COROT_ROTATE, .group = "zmax", .axis = {0, 0, 1}, .rate = 1, .to = 2};
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.strain = v->strain, def.nmaterial = 1, def.material = &material;
  def.nfix = 1, def.fix = &fix, def.nload = v->nload, def.load = load;
  def.nmotion = v->nmotion, def.motion = &motion;
  def.mass = v->mass, def.dilatation = v->dilatation;
  return corot_model_create(&def, model);
}

/* Lists of materials, loads, motions and kinks have room for one entry more, and that of the kinks
   for those that coincide, some ten at most here; these few bytes are not counted. Of a state each
   byte is, but where rows of nodes are rounded up to whole vectors: of a hierarchy, and of a mesh
   whose nodes are odd in number, as they are here in order 2. */
enum { SPARE = 640 };

static void assert_bytes(const char *what, size_t said, size_t slack) {
  size_t held = alloc_live_bytes();
  print_message("%s: %zu said, %zu held in %ld blocks\n", what, said, held, alloc_live());
  assert_true(said <= held && held <= said + slack);
}

static void a_model_and_its_state(void **state) {
  (void)state;
  corot_mesh *mesh = crooked_box(3, 3, 4);
  for (size_t k = 0; k < sizeof variants / sizeof *variants; k++) {
    corot_model *model;
    corot_state *s;
    alloc_fail_at(0);
    assert_ok(create(&variants[k], mesh, &model));
    assert_bytes(variants[k].name, corot_model_bytes(model), SPARE);
    alloc_fail_at(0);
    assert_ok(corot_state_create(model, &s));
    assert_bytes("its state", corot_state_bytes(s), mesh->nnode % 2 ? SPARE : 0);
    corot_state_destroy(s), corot_model_destroy(model);
  }
  corot_mesh_destroy(mesh);
}

/* A hierarchy has models of its own, two or three, and so has its state. */
static void a_hierarchy(void **state) {
  corot_coupling coupling = coupling_of(state);
  for (int k = 0; k < 6; k++) { /* the second level is an octasection, or that of order 2 */
    const choice c = {"green", "polar", 2 - k / 3, k % 3, true, .raised = k / 3};
    solid s = make_solid(&c, coupling, &soft, true);
    corot_hierarchy_def hierarchy;
    corot_model_def def = definition(&c, coupling, &soft, true, &hierarchy);
    corot_model *model;
    corot_state *own;
    def.mesh = s.mesh, hierarchy.refinement = s.refinement;
    alloc_fail_at(0);
    assert_ok(corot_model_create(&def, &model));
    assert_bytes("a hierarchy", corot_model_bytes(model), 4 * SPARE);
    alloc_fail_at(0);
    assert_ok(corot_state_create(model, &own));
    assert_bytes("its state", corot_state_bytes(own), SPARE);
    corot_state_destroy(own), corot_model_destroy(model), drop_solid(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_model_and_its_state),
                                     each_coupling_unit_test(a_hierarchy)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

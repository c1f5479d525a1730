/* A hierarchical model: its force against differences of the energy, the models to which it
   reduces, and what is refused. */
#include "alloc.h"
#include "hierarchical.h"

/* --- Force and energy ------------------------------------------------------------------------ */

/* |dE/du du + f du| / |f du| by central differences, along a random direction. */
static double gradient_error(const choice *c, corot_coupling coupling, corot_frames frames) {
  solid s = make_solid(c, coupling, &undamped, true);
  double *u = vectors(5, s.n), *zero = u + s.n, *du = zero + s.n, *r = du + s.n, *x = r + s.n;
  bend(&s, 0.6, 0.01, u);
  if (frames != COROT_FRAMES_EXACT) {
    bend(&s, 0.5, 0.005, x);
    corot_state_use(s.state, frames);
    assert_ok(corot_frames_update(s.model, s.state, 0, x, NULL));
  }
  fill_noise(s.n, 21, 1, du);
  assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
  double energy[2], h = 1e-5;
  for (int side = 0; side < 2; side++) {
    for (int i = 0; i < s.n; i++) x[i] = u[i] + (side ? h : -h) * du[i];
    energy[side] = elastic_energy(s.model, s.state, x, zero);
  }
  double expected = -inner(s.n, r, du), found = (energy[1] - energy[0]) / (2 * h);
  free(u);
  drop_solid(&s);
  return fabs(found - expected) / fabs(expected);
}

static void test_force_is_the_gradient_of_the_energy(void **state) {
  corot_coupling coupling = coupling_of(state);
  const choice choices[] = {
      {"green", "polar", 1, 0, true},
      {"green", "polar", 2, 0, true},
      {"green", "polar", 2, 1, true},
      {"green", "polar", 2, 2, true},
      {"polar", "polar", 2, 1, true},
      {"hybrid", "polar", 1, 0, true},
      {"green", "cauchy", 1, 0, true},
      {"cauchy", "polar", 1, 1, true},
      {"green", "polar", 0, 0, true, .raised = true},
      {"green", "polar", 0, 1, true, .raised = true},
      {"green", "polar", 1, 0, true, .raised = true},
      {"green", "polar", 1, 1, true, .raised = true},
      {"green", "polar", 1, 2, true, .raised = true},
      {"polar", "polar", 0, 0, true, .raised = true},
      {"hybrid", "polar", 0, 0, true, .raised = true},
      {"green", "cauchy", 0, 0, true, .raised = true},
  };
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++)
    assert_below(gradient_error(&choices[k], coupling, COROT_FRAMES_EXACT), 1e-6);
}

/* As in the paper: not a gradient, unless the frames are held. */
static void test_force_without_the_turning_of_frames(void **state) {
  corot_coupling coupling = coupling_of(state);
  for (int raised = 0; raised < 2; raised++) {
    int nlevel = raised ? 0 : 2;
    choice c = {"green", "polar", nlevel, 0, false, raised};
    choice warp = {"green", "warp", nlevel, 0, false, raised};
    assert_above(gradient_error(&c, coupling, COROT_FRAMES_EXACT), 1e-4);
    assert_below(gradient_error(&c, coupling, COROT_FRAMES_HELD), 1e-6);
    assert_below(gradient_error(&warp, coupling, COROT_FRAMES_HELD), 1e-6);
    c.conservative = true;
    assert_below(gradient_error(&c, coupling, COROT_FRAMES_HELD), 1e-6);
  }
}

/* Sum of the forces and of their moments about the origin, on the displaced body; relative. */
static void resultants(const solid *s, const double *u, const double *r, double *force,
                       double *moment) {
  double f[3] = {0}, m[3] = {0}, scale = 0;
  for (int n = 0; n < s->mesh->nnode; n++) {
    double x[3];
    const double *p = r + 3 * n;
    for (int c = 0; c < 3; c++) {
      x[c] = s->mesh->x[n][c] + u[3 * n + c];
      f[c] += p[c];
      scale += fabs(p[c]);
    }
    m[0] += x[1] * p[2] - x[2] * p[1];
    m[1] += x[2] * p[0] - x[0] * p[2];
    m[2] += x[0] * p[1] - x[1] * p[0];
  }
  *force = norm_max(3, f) / scale;
  *moment = norm_max(3, m) / scale;
}

static void test_forces_on_a_free_body_balance(void **state) {
  corot_coupling coupling = coupling_of(state);
  choice choices[] = {{"green", "polar", 2, 1, true},
                      {"green", "polar", 0, 0, true, .raised = true},
                      {"green", "polar", 1, 1, true, .raised = true},
                      {"green", "polar", 1, 0, true, .raised = true}};
  for (int k = 0; k < 8; k++) {
    choice c = choices[k / 2];
    c.conservative = k % 2 == 0;
    solid s = make_solid(&c, coupling, &undamped, false);
    double *u = vectors(3, s.n), *zero = u + s.n, *r = zero + s.n, force, moment;
    bend(&s, 0.6, 0.01, u);
    assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
    resultants(&s, u, r, &force, &moment);
    assert_below(force, 1e-13);
    if (c.conservative)
      assert_below(moment, 1e-13);
    else
      assert_above(moment, 1e-6);
    free(u);
    drop_solid(&s);
  }
}

static void test_a_turned_body_feels_turned_forces(void **state) {
  corot_coupling coupling = coupling_of(state);
  const choice choices[] = {{"green", "polar", 2, 0, true},
                            {"green", "warp", 1, 0, false},
                            {"hybrid", "polar", 2, 1, false},
                            {"green", "polar", 0, 0, true, .raised = true},
                            {"green", "warp", 0, 0, false, .raised = true},
                            {"green", "polar", 1, 1, true, .raised = true}};
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) {
    solid s = make_solid(&choices[k], coupling, &undamped, false);
    double *u = vectors(5, s.n), *zero = u + s.n, *r = zero + s.n, *Qu = r + s.n, *Qr = Qu + s.n;
    double axis[3] = {1, -2, 0.5}, Q[9];
    rotation(axis, 2.1, Q);

    turn(&s, Q, zero, Qu); /* rigidly */
    assert_ok(corot_residual(s.model, s.state, 0, Qu, zero, r));
    assert_below(norm_max(s.n, r), 1e-10); /* rounding of mu times an area, 1e4 m^2 Pa */
    assert_below(elastic_energy(s.model, s.state, Qu, zero), 1e-20);

    bend(&s, 0.6, 0.01, u);
    turn(&s, Q, u, Qu);
    assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
    assert_ok(corot_residual(s.model, s.state, 0, Qu, zero, Qr));
    double scale = norm_max(s.n, r);
    for (int n = 0; n < s.mesh->nnode; n++) {
      double expected[3];
      apply(Q, r + 3 * n, expected);
      for (int c = 0; c < 3; c++) assert_close(Qr[3 * n + c], expected[c], 0, 1e-12 * scale);
    }
    free(u);
    drop_solid(&s);
  }
}

/* --- What it reduces to ---------------------------------------------------------------------- */

static void test_no_level_is_the_plain_model(void **state) {
  corot_coupling coupling = coupling_of(state);
  choice c = {"green", "warp", 0, 0, true};
  solid s = make_solid(&c, coupling, &soft, true);
  body b = plain_body(&s, "green", &soft, true);
  double *u = vectors(4, s.n), *v = u + s.n, *r = v + s.n, *plain = r + s.n;
  bend(&s, 0.6, 0.01, u);
  fill_noise(s.n, 3, 1, v);
  assert_string_equal(corot_model_strain(s.model), "green");
  assert_ok(corot_residual(s.model, s.state, 0, u, v, r));
  assert_ok(corot_residual(b.model, b.state, 0, u, v, plain));
  assert_memory_equal(r, plain, s.n * sizeof *r);
  free(u);
  drop_body(&b);
  drop_solid(&s);
}

/* Where all differences vanish, the forces on level 0 and the energies are those of the coarse
   mesh: to the rounding of fine and linear terms that cancel. */
static void test_coarse_motion_feels_coarse_forces(void **state) {
  corot_coupling coupling = coupling_of(state);
  const choice choices[] = {{"green", "polar", 2, 0, true},
                            {"polar", "polar", 1, 1, true},
                            {"hybrid", "warp", 2, 0, false},
                            {"green", "cauchy", 1, 0, true},
                            {"green", "polar", 0, 0, true, .raised = true},
                            {"hybrid", "warp", 0, 0, false, .raised = true},
                            {"green", "polar", 1, 1, true, .raised = true},
                            {"green", "polar", 1, 0, true, .raised = true}};
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) {
    solid s = make_solid(&choices[k], coupling, &soft, false);
    solid zero_level =
        make_solid(&(choice){choices[k].coarse, "polar", 0, 0, true}, coupling, &soft, false);
    double *u = vectors(6, s.n), *v = u + s.n, *r = v + s.n;
    double *uc = r + s.n, *vc = uc + s.n, *rc = vc + s.n;
    bend(&zero_level, 0.6, 0.03, uc);
    fill_noise(zero_level.n, 3, 1, vc);
    memcpy(u, uc, zero_level.n * sizeof *u);
    memcpy(v, vc, zero_level.n * sizeof *v);
    corot_hierarchy_apply(s.refinement, (double(*)[3])u);
    corot_hierarchy_apply(s.refinement, (double(*)[3])v);

    corot_energies fine, coarse;
    assert_ok(corot_energy(s.model, s.state, 0, u, v, &fine));
    assert_ok(corot_energy(zero_level.model, zero_level.state, 0, uc, vc, &coarse));
    assert_close(fine.elastic, coarse.elastic, 1e-12, 0);
    assert_close(fine.power_dissipated, coarse.power_dissipated, 1e-12, 0);

    assert_ok(corot_residual(s.model, s.state, 0, u, v, r));
    assert_ok(corot_residual(zero_level.model, zero_level.state, 0, uc, vc, rc));
    corot_hierarchy_apply_transposed(s.refinement, (double(*)[3])r);
    double scale = norm_max(zero_level.n, rc);
    for (int i = 0; i < zero_level.n; i++) assert_close(r[i], rc[i], 0, 1e-12 * scale);
    free(u);
    drop_solid(&zero_level);
    drop_solid(&s);
  }
}

static void assert_affine_motion_has_no_force_inside(const choice *c, corot_coupling coupling,
                                                     int least) {
  solid s = make_solid(c, coupling, &undamped, false);
  double *u = vectors(3, s.n), *zero = u + s.n, *r = zero + s.n, F[9];
  uint64_t seed = 9;
  random_gradient(&seed, 0.2, F);
  turn(&s, F, zero, u);
  assert_ok(corot_residual(s.model, s.state, 0, u, zero, r));
  int ntri, (*tri)[3], inside = 0;
  char *surface = calloc(s.mesh->nnode, 1);
  assert_ok(corot_mesh_boundary(s.mesh, &ntri, &tri));
  for (int k = 0; k < ntri; k++)
    for (int a = 0; a < 3; a++) surface[tri[k][a]] = 1;
  int(*mid)[6] = NULL;
  if (c->raised) assert_ok(corot_mesh_face_nodes(s.mesh, ntri, (const int(*)[3])tri, &mid));
  for (int k = 0; mid && k < ntri; k++)
    for (int a = 3; a < 6; a++) surface[mid[k][a]] = 1;
  double scale = norm_max(s.n, r);
  for (int n = 0; n < s.mesh->nnode; n++) {
    if (surface[n]) continue;
    inside++;
    assert_below(norm_max(3, r + 3 * n), 1e-12 * scale);
  }
  assert_true(inside > least);
  free(surface), free(tri), free(mid), free(u);
  drop_solid(&s);
}

/* One strain everywhere: no force on a node inside, coarse or fine. */
static void test_affine_motion_has_no_force_inside(void **state) {
  corot_coupling coupling = coupling_of(state);
  assert_affine_motion_has_no_force_inside(&(choice){"green", "polar", 2, 0, true}, coupling, 20);
  for (int nlevel = 0; nlevel < 2; nlevel++)
    assert_affine_motion_has_no_force_inside(
        &(choice){"green", "polar", nlevel, 0, true, .raised = true}, coupling, nlevel ? 20 : 2);
}

static void test_one_measure_in_its_own_frames_is_the_plain_model(void **state) {
  corot_coupling coupling = coupling_of(state);
  const choice choices[] = {{"cauchy", "cauchy", 1, 1, true},
                            {"polar", "polar", 1, 1, true},
                            {"cauchy", "cauchy", 0, 1, true, .raised = true},
                            {"polar", "polar", 0, 1, true, .raised = true},
                            {"polar", "polar", 1, 2, true, .raised = true}};
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) {
    solid s = make_solid(&choices[k], coupling, &soft, true);
    body b = plain_body(&s, choices[k].fine, &soft, true);
    double *u = vectors(4, s.n), *v = u + s.n, *r = v + s.n, *plain = r + s.n;
    bend(&s, 0.6, 0.01, u);
    fill_noise(s.n, 3, 1, v);
    assert_ok(corot_residual(s.model, s.state, 0, u, v, r));
    assert_ok(corot_residual(b.model, b.state, 0, u, v, plain));
    double scale = norm_max(s.n, plain);
    for (int i = 0; i < s.n; i++) assert_close(r[i], plain[i], 0, 1e-12 * scale);
    free(u);
    drop_body(&b);
    drop_solid(&s);
  }
}

/* --- Forces on supports, statics, inversion -------------------------------------------------- */

static void assert_force_on_all_nodes(const choice *c, corot_coupling coupling) {
  solid held = make_solid(c, coupling, &undamped, true),
        free_one = make_solid(c, coupling, &undamped, false);
  int n = free_one.n, nnode = held.mesh->nnode;
  double *u = vectors(4, n), *all = u + n, *zero = all + n, *r = zero + n;
  double(*f)[3] = calloc(nnode, sizeof *f);
  bend(&held, 0.6, 0.01, u);
  for (int k = 0; k < nnode; k++)
    for (int i = 0; i < 3; i++) {
      int d = corot_model_dof(held.model)[k][i];
      all[3 * k + i] = d >= 0 ? u[d] : 0;
    }
  assert_ok(corot_elastic_force(held.model, held.state, 0, u, f));
  assert_ok(corot_residual(free_one.model, free_one.state, 0, all, zero, r));
  for (int i = 0; i < n; i++) r[i] = -r[i];
  assert_near(n, f[0], r, 1e-13);
  free(f), free(u);
  drop_solid(&free_one);
  drop_solid(&held);
}

static void test_force_on_all_nodes(void **state) {
  corot_coupling coupling = coupling_of(state);
  assert_force_on_all_nodes(&(choice){"green", "polar", 2, 1, true}, coupling);
  assert_force_on_all_nodes(&(choice){"green", "polar", 1, 1, true, .raised = true}, coupling);
}

static void test_standing_still_has_no_viscous_force(void **state) {
  corot_coupling coupling = coupling_of(state);
  choice c = {"green", "polar", 1, 0, true};
  solid s = make_solid(&c, coupling, &soft, true);
  double *u = vectors(4, s.n), *v = u + s.n, *r = v + s.n, *still = r + s.n;
  bend(&s, 0.6, 0.01, u);
  assert_ok(corot_residual(s.model, s.state, 0, u, v, r));
  fill_noise(s.n, 3, 100, v);
  corot_state_stand_still(s.state, 0, 1);
  assert_ok(corot_residual(s.model, s.state, 0, u, v, still));
  assert_near(s.n, still, r, 1e-14);
  free(u);
  drop_solid(&s);
}

static bool has_node(const corot_mesh *mesh, int tet, int node) {
  bool found = false;
  for (int k = 0; k < 4; k++) found |= mesh->tet[tet][k] == node;
  for (int k = 0; mesh->mid && k < 6; k++) found |= mesh->mid[tet][k] == node;
  return found;
}

static void assert_inverted_tets_are_named(const choice *c, corot_coupling coupling) {
  solid s = make_solid(c, coupling, &soft, false);
  double *u = vectors(3, s.n), *zero = u + s.n, *r = zero + s.n;
  u[0] = u[1] = u[2] = 3; /* a corner of the body, and its tets, beyond the opposite one */
  corot_hierarchy_apply(s.refinement, (double(*)[3])u);
  assert_fails(corot_residual(s.model, s.state, 0, u, zero, r), COROT_RETRY, "of level 0");
  assert_int_equal(corot_state_inverted(s.state) % (s.mesh->ntet / s.coarse->ntet), 0);
  memset(u, 0, s.n * sizeof *u);
  int last = s.mesh->nnode - 1;
  u[3 * last] = 3;
  assert_fails(corot_residual(s.model, s.state, 0, u, zero, r), COROT_RETRY, "is inverted");
  assert_true(has_node(s.mesh, corot_state_inverted(s.state), last));
  free(u);
  drop_solid(&s);
}

static void test_inverted_tets_are_named(void **state) {
  corot_coupling coupling = coupling_of(state);
  assert_inverted_tets_are_named(&(choice){"green", "polar", 2, 0, true}, coupling);
  assert_inverted_tets_are_named(&(choice){"green", "polar", 0, 0, true, .raised = true}, coupling);
  assert_inverted_tets_are_named(&(choice){"green", "polar", 1, 0, true, .raised = true}, coupling);
}

/* --- Refusals -------------------------------------------------------------------------------- */

static void refuse(const choice *c, corot_coupling coupling, const corot_mesh *mesh,
                   const corot_refinement *refinement, const char *words) {
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(c, coupling, &soft, true, &hierarchy);
  corot_model *model;
  def.mesh = mesh, hierarchy.refinement = refinement;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, words);
}

static void test_refusals(void **state) {
  corot_coupling coupling = coupling_of(state);
  choice good = {"green", "polar", 1, 0, true}, bad = good;
  solid s = make_solid(&good, coupling, &soft, true);
  refuse(&good, coupling, s.mesh, NULL, "no refinement");
  refuse(&good, coupling, s.coarse, s.refinement, "the mesh has");
  bad.frame_level = 2;
  refuse(&bad, coupling, s.mesh, s.refinement, "frame level 2, where the levels are 0 to 1");
  refuse(&good, (corot_coupling)7, s.mesh, s.refinement, "no coupling has the number 7");
  bad = good, bad.coarse = "blue";
  refuse(&bad, coupling, s.mesh, s.refinement, "no strain measure 'blue'");
  bad = good, bad.fine = "hybrid";
  refuse(&bad, coupling, s.mesh, s.refinement, "strain hybrid is not linear");
  bad = good, bad.fine = "warp";
  refuse(&bad, coupling, s.mesh, s.refinement, "strain warp has no conservative force");
  bad.conservative = false, bad.frame_level = 1;
  refuse(&bad, coupling, s.mesh, s.refinement, "or frame level 0");

  int moved = s.mesh->nnode - 1;
  s.mesh->x[moved][1] += 1e-4;
  refuse(&good, coupling, s.mesh, s.refinement, "off the middle of its parents");
  drop_solid(&s);
}

static void test_materials_are_those_of_level_0(void **state) {
  corot_coupling coupling = coupling_of(state);
  choice c = {"green", "polar", 1, 0, true};
  solid s = make_solid(&c, coupling, &soft, true);
  corot_hierarchy_def hierarchy;
  corot_material two[2] = {soft, soft};
  corot_model_def def = definition(&c, coupling, two, true, &hierarchy);
  corot_model *model;
  def.mesh = s.mesh, hierarchy.refinement = s.refinement;
  def.nmaterial = 2, two[1].group = "corner";
  assert_ok(corot_mesh_group_nodes(s.mesh, "corner", 4, s.mesh->tet[9]));
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL,
               "tets 8 and 9 descend from tet 1 of level 0");
  def.viscosity = COROT_OBJECTIVE;
  def.nmaterial = 1;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "the viscous law");
  def.viscosity = COROT_COROTATED, def.dilatation = COROT_DILATATION_NODAL;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "averaged at nodes");
  drop_solid(&s);
}

static corot_status make_and_drop(void *context) {
  const corot_model_def *def = context;
  corot_model *model;
  corot_state *state = NULL;
  COROT_TRY(corot_model_create(def, &model));
  corot_status status = corot_state_create(model, &state);
  corot_state_destroy(state);
  corot_model_destroy(model);
  return status;
}

static void test_failed_allocations(void **state) {
  corot_coupling coupling = coupling_of(state);
  const choice choices[] = {{"green", "polar", 2, 1, true},
                            {"green", "polar", 1, 1, true, .raised = true},
                            {"green", "polar", 0, 1, true, .raised = true}};
  for (size_t k = 0; k < sizeof choices / sizeof *choices; k++) {
    solid s = make_solid(&choices[k], coupling, &soft, true);
    corot_hierarchy_def hierarchy;
    corot_model_def def = definition(&choices[k], coupling, &soft, true, &hierarchy);
    def.mesh = s.mesh, hierarchy.refinement = s.refinement;
    assert_true(assert_survives_failed_allocations(make_and_drop, &def) > 60);
    drop_solid(&s);
  }
}

/* The corners of one tet are moved so that it turns inside out, while each of its eight
   descendants, whose other nodes stay, keeps at least two fifths of its volume: the fields are
   those of sound tets, but there is no frame to hand down. */
static void test_fields_in_frames_of_an_inverted_tet_are_refused(void **state) {
  (void)state;
  static const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static const int tet[1][4] = {{0, 1, 2, 3}};
  static const double moved[4][3] = {
      {0.2, 0.6, -0.7}, {-0.1, -0.3, -0.4}, {-0.8, 0, -0.1}, {-0.8, 0.6, 0.4}};
  choice c = {"cauchy", "polar", 1, 0, true};
  corot_hierarchy_def hierarchy;
  corot_model_def def = definition(&c, COROT_COUPLING_NODES, &undamped, false, &hierarchy);
  solid s = {0};
  assert_ok(corot_mesh_create(4, x, 1, tet, &s.coarse));
  assert_ok(corot_mesh_refine(s.coarse, 1, COROT_DIAGONAL_CONSISTENT, &s.mesh, &s.refinement));
  def.mesh = s.mesh, hierarchy.refinement = s.refinement;
  assert_ok(corot_model_create(&def, &s.model));
  assert_ok(corot_state_create(s.model, &s.state));
  s.n = corot_model_ndof(s.model);

  double *u = vectors(1, s.n), det[8];
  corot_element_fields fields = {.det = det};
  assert_ok(corot_elements(s.model, s.state, 0, u, &fields));
  memcpy(u, moved, sizeof moved);
  assert_fails(corot_elements(s.model, s.state, 0, u, &fields), COROT_RETRY,
               "tet 0 of level 0 is inverted");
  assert_int_equal(corot_state_inverted(s.state), 0);
  for (int e = 0; e < 8; e++) assert_above(det[e], 0.3);
  free(u);
  drop_solid(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      coupled_unit_test(test_force_is_the_gradient_of_the_energy),
      coupled_unit_test(test_force_without_the_turning_of_frames),
      coupled_unit_test(test_forces_on_a_free_body_balance),
      each_coupling_unit_test(test_a_turned_body_feels_turned_forces),
      each_coupling_unit_test(test_no_level_is_the_plain_model),
      coupled_unit_test(test_coarse_motion_feels_coarse_forces),
      each_coupling_unit_test(test_affine_motion_has_no_force_inside),
      coupled_unit_test(test_one_measure_in_its_own_frames_is_the_plain_model),
      each_coupling_unit_test(test_force_on_all_nodes),
      each_coupling_unit_test(test_standing_still_has_no_viscous_force),
      each_coupling_unit_test(test_inverted_tets_are_named),
      cmocka_unit_test(test_fields_in_frames_of_an_inverted_tet_are_refused),
      each_coupling_unit_test(test_refusals),
      each_coupling_unit_test(test_materials_are_those_of_level_0),
      each_coupling_unit_test(test_failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

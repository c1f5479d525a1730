/* The model: refusal of definitions that make no sense, mass, loads, supports, memory. */
#include <float.h>
#include <stdio.h>

#include "alloc.h"
#include "solid.h"

/* A box of 1 x 0.5 x 2 m, cut into 2 x 1 x 4 cells, with some groups. */
static corot_mesh *bar(void) {
  corot_box box = {.size = {1, 0.5, 2}, .cells = {2, 1, 4}, .origin = {0, 0, 0}};
  double low[3] = {0, 0, 0}, half[3] = {1, 0.5, 1}, all[3] = {1, 0.5, 2};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  assert_ok(corot_mesh_group_box(mesh, "lower", low, half, 0));
  assert_ok(corot_mesh_group_box(mesh, "all", low, all, 0));
  assert_ok(corot_mesh_group_plane(mesh, "waist", 2, 1, 0));
  return mesh;
}

static const double volume = 1.0, area = 0.5; /* [m^3], [m^2] of a face across z */

static corot_model_def plain(const corot_mesh *mesh) {
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.nmaterial = 1, def.material = &soft;
  return def;
}

static corot_model *must_create(const corot_model_def *def) {
  corot_model *model;
  assert_ok(corot_model_create(def, &model));
  return model;
}

static void refuses(const corot_model_def *def, const char *words) {
  corot_model *model = (corot_model *)def; /* must stay as it is */
  assert_fails(corot_model_create(def, &model), COROT_EINVAL, words);
  assert_ptr_equal(model, def);
}

static void refuses_a_definition_without_sense(void **state) {
  (void)state;
  corot_mesh *mesh = bar();
  corot_model_def def = plain(NULL);
  refuses(&def, "no mesh");
  def = plain(mesh), def.strain = "gren";
  refuses(&def, "no strain measure 'gren': cauchy, warp, polar, hybrid or green");
  def = plain(mesh), def.strain = NULL;
  refuses(&def, "no strain measure");
  def = plain(mesh), def.viscosity = COROT_OBJECTIVE, def.strain = "green";
  refuses(&def, "the objective viscous law needs a polar frame, not strain green");
  def = plain(mesh), def.nmaterial = 0;
  refuses(&def, "tet 0 has no material");

  corot_fix fix = {"nowhere", {true, true, true}};
  def = plain(mesh), def.nfix = 1, def.fix = &fix;
  refuses(&def, "fix 0: the mesh has no group 'nowhere'");
  fix.group = NULL;
  refuses(&def, "fix 0: the mesh has no group ''");
  fix.group = "all";
  refuses(&def, "nothing can move");
  corot_mesh_destroy(mesh);
}

static void refuses_a_material_out_of_range(void **state) {
  (void)state;
  corot_mesh *mesh = bar();
  corot_material m = soft;
  corot_model_def def = plain(mesh);
  def.material = &m;
  const struct {
    double *value, bad;
    const char *words;
  } cases[] = {
      {&m.mu, 0, "material 0: mu = 0"},
      {&m.mu, -1, "material 0: mu = -1"},
      {&m.mu, NAN, "material 0: mu"},
      {&m.mu, INFINITY, "material 0: mu"},
      {&m.lambda, -2e4 / 3, "3 lambda + 2 mu"},
      {&m.lambda, NAN, "lambda"},
      {&m.lambda, INFINITY, "lambda"},
      {&m.density, 0, "density = 0"},
      {&m.density, -1000, "density = -1000"},
      {&m.density, NAN, "density"},
      {&m.density, INFINITY, "density"},
      {&m.damping_lambda, -1, "damping_lambda = -1"},
      {&m.damping_lambda, NAN, "damping_lambda"},
      {&m.damping_mu, -1e-9, "damping_mu = -1e-09"},
      {&m.damping_mu, INFINITY, "damping_mu"},
      {&m.damping_mass, -0.5, "damping_mass = -0.5"},
      {&m.damping_mass, NAN, "damping_mass"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    m = soft;
    *cases[k].value = cases[k].bad;
    refuses(&def, cases[k].words);
  }
  m = soft, m.lambda = -0.6e4; /* auxetic, but stable */
  corot_model_destroy(must_create(&def));
  corot_mesh_destroy(mesh);
}

static void every_tet_has_one_material(void **state) {
  (void)state;
  corot_mesh *mesh = bar();
  corot_material m[3] = {soft, soft, soft};
  corot_model_def def = plain(mesh);
  def.material = m;
  m[0].group = "lower";
  refuses(&def, "has no material"); /* the upper half */
  m[0].group = "nowhere";
  refuses(&def, "material 0: the mesh has no group 'nowhere'");
  m[0].group = "waist"; /* a plane of nodes */
  refuses(&def, "group 'waist' has no tets");
  def.nmaterial = 2;
  m[0].group = m[1].group = NULL;
  refuses(&def, "material 1: group is missing: one entry only may go without (material 0)");
  m[0].group = "lower", m[1].group = "all";
  refuses(&def, "belongs to materials 0 and 1");
  m[1].group = NULL; /* the rest */
  corot_model_destroy(must_create(&def));
  def.nmaterial = 3, m[2].group = "nowhere";
  refuses(&def, "'nowhere'");
  corot_mesh_destroy(mesh);
}

static void refuses_a_load_without_sense(void **state) {
  (void)state;
  corot_mesh *mesh = bar();
  double time[] = {0, 1, 0.5}, value[] = {0, 1, 2};
  corot_load load = {COROT_TRACTION, "zmax", {1, 0, 0}, {0, NULL, NULL}};
  corot_model_def def = plain(mesh);
  def.nload = 1, def.load = &load;
  load.group = "nowhere";
  refuses(&def, "load 0: the mesh has no group 'nowhere'");
  load.group = "waist"; /* inner nodes: no face of the boundary */
  refuses(&def, "load 0: group 'waist' has no faces for a traction to act on");
  load.group = "zmax", load.value[1] = NAN;
  refuses(&def, "load 0: component 1 is not finite");
  load.kind = COROT_GRAVITY, load.value[1] = INFINITY;
  refuses(&def, "load 0: component 1 is not finite");
  load.value[1] = 0, load.amplitude = (corot_amplitude){3, time, value};
  refuses(&def, "load 0: the amplitude's times do not increase at point 2");
  time[2] = NAN;
  refuses(&def, "load 0: point 2 of the amplitude is not finite");
  time[2] = 2, value[0] = INFINITY;
  refuses(&def, "load 0: point 0 of the amplitude is not finite");
  value[0] = 0;
  corot_model_destroy(must_create(&def));
  load.kind = (corot_load_kind)7;
  refuses(&def, "load 0: no kind of load has the number 7");
  corot_mesh_destroy(mesh);
}

/* The message of a failure names what is wrong in a definition that was right before: nothing of
   the definition is kept. */
static void the_definition_is_copied(void **state) {
  (void)state;
  corot_mesh *mesh = bar();
  char strain[] = "green", group[] = "zmin", loaded[] = "zmax";
  double time[] = {0, 1}, value[] = {1, 3};
  corot_material m = soft;
  corot_fix fix = {group, {true, true, true}};
  corot_load load = {COROT_TRACTION, loaded, {1, 2, 3}, {2, time, value}};
  corot_model_def def = plain(mesh);
  def.strain = strain, def.material = &m;
  def.nfix = 1, def.fix = &fix, def.nload = 1, def.load = &load;
  body b = make_body(mesh, def);
  double *u = calloc(3 * b.n, sizeof *u), *before = u + b.n, *after = before + b.n;
  assert_ok(corot_residual(b.model, b.state, 0.5, u, u, before));
  memset(strain, 'x', 5), memset(group, 'x', 4), memset(loaded, 'x', 4);
  m.mu = -1, time[1] = value[1] = 0, load.value[0] = 0, fix.component[0] = false;
  mesh->x[0][0] = 9;
  assert_ok(corot_residual(b.model, b.state, 0.5, u, u, after));
  assert_memory_equal(before, after, b.n * sizeof *before);
  assert_string_equal(corot_model_strain(b.model), "green");
  assert_true(corot_model_mesh(b.model)->x[0][0] == 0);
  free(u), drop_body(&b);
}

static void supports_take_their_components_away(void **state) {
  (void)state;
  corot_mesh *mesh = bar();
  corot_fix fix[] = {{"zmin", {true, true, true}}, {"xmin", {true, false, false}}};
  corot_model_def def = plain(mesh);
  def.nfix = 2, def.fix = fix;
  corot_model *model = must_create(&def);
  const int(*dof)[3] = corot_model_dof(model);
  int next = 0;
  for (int n = 0; n < mesh->nnode; n++)
    for (int c = 0; c < 3; c++) {
      bool held = mesh->x[n][2] == 0 || (mesh->x[n][0] == 0 && c == 0);
      assert_int_equal(dof[n][c], held ? -1 : next++);
    }
  assert_int_equal(corot_model_ndof(model), next);
  corot_model_destroy(model), corot_mesh_destroy(mesh);
}

/* Sums of a nodal force over the free body, by component. */
static void sum_of(const body *b, double t, double sum[3]) {
  int n = b->n;
  double *u = calloc(2 * n, sizeof *u), *r = u + n;
  assert_ok(corot_residual(b->model, b->state, t, u, u, r));
  sum[0] = sum[1] = sum[2] = 0;
  for (int i = 0; i < n; i++) sum[i % 3] += r[i]; /* free: three to a node */
  free(u);
}

static void the_mass_is_that_of_the_volume(void **state) {
  (void)state;
  corot_material m[2] = {soft, soft};
  m[0].group = "lower", m[1].density = 3000;
  corot_mesh *mesh = bar();
  corot_model_def def = plain(mesh);
  def.nmaterial = 2, def.material = m;
  corot_model *model = must_create(&def);
  const double *mass = corot_model_mass(model);
  const int(*dof)[3] = corot_model_dof(model);
  double total = 0, *lumped = calloc(mesh->nnode, sizeof *lumped);
  for (int e = 0; e < mesh->ntet; e++) { /* six equal tets to a cell of 1/8 m^3 */
    double z = 0, density;
    for (int a = 0; a < 4; a++) z += mesh->x[mesh->tet[e][a]][2] / 4;
    density = z < 1 ? 1000 : 3000;
    for (int a = 0; a < 4; a++) lumped[mesh->tet[e][a]] += density * 0.125 / 6 / 4;
  }
  for (int n = 0; n < mesh->nnode; n++) {
    for (int c = 0; c < 3; c++) assert_close(mass[dof[n][c]], lumped[n], 1e-14, 0);
    total += mass[dof[n][0]];
  }
  assert_close(total, (1000 + 3000) * volume / 2, 1e-14, 0);
  free(lumped), corot_model_destroy(model), corot_mesh_destroy(mesh);
}

static void loads_sum_to_their_totals(void **state) {
  (void)state;
  corot_load load[] = {{COROT_TRACTION, "zmax", {3, -2, 7}, {0, NULL, NULL}},
                       {COROT_GRAVITY, NULL, {0.5, 0, -9.81}, {0, NULL, NULL}},
                       {COROT_TRACTION, "zmin", {0, 1, 0}, {0, NULL, NULL}}};
  corot_mesh *mesh = bar();
  corot_model_def def = plain(mesh);
  def.nload = 3, def.load = load;
  body b = make_body(mesh, def);
  double sum[3], mass = soft.density * volume;
  sum_of(&b, 0, sum);
  assert_close(sum[0], 3 * area + 0.5 * mass, 1e-13, 0);
  assert_close(sum[1], -2 * area + area, 1e-13, 0);
  assert_close(sum[2], 7 * area - 9.81 * mass, 1e-13, 0);

  /* gravity alone accelerates everything alike: r = M g */
  def.nload = 1, def.load = &load[1];
  corot_model *model = must_create(&def);
  corot_state *s;
  assert_ok(corot_state_create(model, &s));
  double *y = calloc(4 * b.n, sizeof *y), *ydot = y + 2 * b.n;
  y[b.n] = 2;
  assert_ok(corot_rhs(model, s, 0, y, ydot));
  assert_true(ydot[0] == 2); /* du/dt = v */
  for (int i = 3; i < b.n; i++) assert_true(ydot[i] == 0);
  y[b.n] = 0;
  assert_ok(corot_rhs(model, s, 0, y, ydot));
  for (int i = 0; i < b.n; i++) assert_close(ydot[b.n + i], load[1].value[i % 3], 1e-14, 1e-14);
  free(y), corot_state_destroy(s), corot_model_destroy(model), drop_body(&b);
}

/* The load of a fixed configuration follows its amplitude: constant beyond the ends, linear
   between the points, and the loads add up. */
static void amplitudes_are_piecewise_linear(void **state) {
  (void)state;
  double time[] = {1, 2, 4}, value[] = {2, -1, 5}, once[] = {3}, factor[] = {0.5};
  corot_load load[] = {{COROT_TRACTION, "zmax", {1, 0, 0}, {3, time, value}},
                       {COROT_TRACTION, "zmax", {0, 1, 0}, {1, once, factor}},
                       {COROT_TRACTION, "zmax", {0, 0, 1}, {0, NULL, NULL}}};
  const struct {
    double t, amplitude;
  } at[] = {{-1e9, 2},  {0, 2}, {1, 2}, {1.25, 1.25}, {2, -1},
            {2.5, 0.5}, {3, 2}, {4, 5}, {4.001, 5},   {1e9, 5}};
  corot_mesh *mesh = bar();
  corot_model_def def = plain(mesh);
  def.nload = 3, def.load = load;
  body b = make_body(mesh, def);
  for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
    double sum[3];
    sum_of(&b, at[k].t, sum);
    assert_close(sum[0], at[k].amplitude * area, 1e-13, 0);
    assert_close(sum[1], 0.5 * area, 1e-13, 0);
    assert_close(sum[2], area, 1e-13, 0);
  }
  drop_body(&b);
}

static void kinks_are_the_points_of_all_amplitudes(void **state) {
  (void)state;
  double first[] = {0, 1, 4}, second[] = {-3, 1, 2.5}, value[] = {0, 1, 0}, kink[8];
  corot_load load[] = {{COROT_GRAVITY, NULL, {0, 0, 1}, {3, first, value}},
                       {COROT_GRAVITY, NULL, {0, 0, 1}, {0, NULL, NULL}},
                       {COROT_GRAVITY, NULL, {0, 0, 1}, {3, second, value}}};
  corot_mesh *mesh = bar();
  corot_model_def def = plain(mesh);
  def.nload = 3, def.load = load;
  corot_model *model = must_create(&def);
  static const double all[] = {-3, 0, 1, 2.5, 4};
  assert_int_equal(corot_model_kinks(model, -10, 10, 8, kink), 5);
  for (int k = 0; k < 5; k++) assert_true(kink[k] == all[k]);
  assert_int_equal(corot_model_kinks(model, 0, 4, 8, kink), 2); /* strictly between */
  assert_true(kink[0] == 1 && kink[1] == 2.5);
  assert_int_equal(corot_model_kinks(model, -10, 10, 0, NULL), 5);
  kink[1] = 77;
  assert_int_equal(corot_model_kinks(model, -10, 10, 1, kink), 5);
  assert_true(kink[0] == -3 && kink[1] == 77);
  assert_int_equal(corot_model_kinks(model, 4, 100, 8, kink), 0);
  assert_int_equal(corot_model_kinks(model, 3, 3, 8, kink), 0);
  corot_model_destroy(model), corot_mesh_destroy(mesh);
}

/* Two halves of unlike stiffness, stretched alike: each side's force on the waist is its own, and
   what is left over is their difference. */
static void each_tet_has_its_own_stiffness(void **state) {
  (void)state;
  corot_material m[2] = {soft, soft};
  m[0].group = "lower", m[1].mu *= 5, m[1].lambda *= 2;
  corot_mesh *mesh = bar();
  corot_model_def def = plain(mesh);
  def.nmaterial = 2, def.material = m;
  body b = make_body(mesh, def);
  double stretch = 1e-3, pull[3] = {0};
  double *u = calloc(2 * b.n, sizeof *u), *v = calloc(b.n, sizeof *v), *r = u + b.n;
  const int(*dof)[3] = corot_model_dof(b.model);
  for (int n = 0; n < mesh->nnode; n++) u[dof[n][2]] = stretch * mesh->x[n][2];
  assert_ok(corot_residual(b.model, b.state, 0, u, v, r));
  for (int n = 0; n < mesh->nnode; n++) {
    double z = mesh->x[n][2];
    if (z == 0 || z == 1 || z == 2)
      pull[(int)z] += r[dof[n][2]];
    else
      assert_close(r[dof[n][2]], 0, 0, 1e-9); /* [N] of some 100 */
  }
  double below = (m[0].lambda + 2 * m[0].mu) * stretch * area;
  double above = (m[1].lambda + 2 * m[1].mu) * stretch * area;
  assert_close(pull[0], below, 1e-11, 0);
  assert_close(pull[1], above - below, 1e-11, 0);
  assert_close(pull[2], -above, 1e-11, 0);
  free(u), free(v), drop_body(&b);
}

static void an_inverted_tet_is_named(void **state) {
  (void)state;
  corot_mesh *mesh = bar();
  body b = make_body(mesh, plain(mesh));
  double *u = calloc(3 * b.n, sizeof *u), *v = u + b.n, *r = v + b.n;
  int e = 29, n = mesh->tet[e][3];
  const int(*dof)[3] = corot_model_dof(b.model);
  char words[32];
  u[dof[n][0]] = u[dof[n][1]] = u[dof[n][2]] = 1e200; /* det F is not a number */
  assert_fails(corot_residual(b.model, b.state, 0, u, v, r), COROT_RETRY, "is inverted");
  int named = corot_state_inverted(b.state);
  assert_in_range(named, 0, mesh->ntet - 1);
  bool touches = false;
  for (int a = 0; a < 4; a++) touches |= mesh->tet[named][a] == n;
  assert_true(touches);
  snprintf(words, sizeof words, "tet %d is inverted", named);
  assert_string_equal(corot_error(), words);
  memset(u, 0, b.n * sizeof *u);
  assert_ok(corot_residual(b.model, b.state, 0, u, v, r));
  assert_int_equal(corot_state_inverted(b.state), -1);
  free(u), drop_body(&b);
}

/* The first one, whichever it is, in forces and in fields; and in fields the others still count. */
static void the_first_inverted_tet_is_named(void **state) {
  (void)state;
  const double x[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                          {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}};
  const int tet[2][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  for (int k = 0; k < 3; k++) { /* the first, the second, both */
    corot_mesh *mesh;
    assert_ok(corot_mesh_create(8, x, 2, tet, &mesh));
    body b = make_body(mesh, plain(mesh));
    double u[24] = {0}, v[24] = {0}, r[24], det[2] = {0};
    for (int e = 0; e < 2; e++)
      if (k == 2 || k == e) u[corot_model_dof(b.model)[4 * e + 3][2]] = -3;
    char words[64];
    snprintf(words, sizeof words, "tet %d is inverted", k == 1);
    assert_fails(corot_residual(b.model, b.state, 0, u, v, r), COROT_RETRY, words);
    assert_int_equal(corot_state_inverted(b.state), k == 1);
    corot_element_fields fields = {.det = det};
    assert_fails(corot_elements(b.model, b.state, 0, u, &fields), COROT_RETRY, words);
    assert_int_equal(corot_state_inverted(b.state), k == 1);
    for (int e = 0; e < 2; e++) assert_close(det[e], k == 2 || k == e ? -2 : 1, 1e-14, 0);
    drop_body(&b);
  }
}

/* It is the caller's mistake, not a step too long: in r where it plays a part, in ydot always. */
static void what_is_not_a_number_is_named(void **state) {
  (void)state;
  for (int damped = 0; damped < 2; damped++) {
    corot_mesh *mesh = bar();
    corot_model_def def = plain(mesh);
    corot_material m = soft;
    m.damping_lambda = m.damping_mass = 0, m.damping_mu = damped;
    def.material = &m;
    body b = make_body(mesh, def);
    double *y = calloc(4 * b.n, sizeof *y), *ydot = y + 2 * b.n;
    int n = mesh->tet[29][3], i = corot_model_dof(b.model)[n][1];
    char words[80];
    y[i] = NAN;
    snprintf(words, sizeof words, "u[%d], the y component at node %d, is not a number", i, n);
    assert_fails(corot_residual(b.model, b.state, 0, y, y + b.n, ydot), COROT_EINVAL, words);
    assert_fails(corot_rhs(b.model, b.state, 0, y, ydot), COROT_EINVAL, words);
    y[i] = 0, y[b.n + i] = NAN;
    words[0] = 'v';
    assert_fails(corot_rhs(b.model, b.state, 0, y, ydot), COROT_EINVAL, words);
    assert_int_equal(corot_residual(b.model, b.state, 0, y, y + b.n, ydot),
                     damped ? COROT_EINVAL : COROT_OK);
    y[b.n + i] = 0;
    assert_ok(corot_rhs(b.model, b.state, 0, y, ydot));
    free(y), drop_body(&b);
  }
}

static void scales_of_the_model(void **state) {
  (void)state;
  corot_material m[2] = {soft, soft};
  m[0].group = "lower", m[0].mu = 4e4, m[0].lambda = 1e4, m[0].damping_lambda = 0.1;
  corot_mesh *mesh = bar();
  corot_model_def def = plain(mesh);
  def.nmaterial = 2, def.material = m;
  corot_model *model = must_create(&def);
  double length = sqrt(1 + 0.25 + 4);
  assert_close(corot_model_length(model), length, 1e-14, 0); /* the centroid sums all tets */
  assert_close(corot_model_frequency(model), sqrt(1e4 / 1000) / length, 1e-14, 0);
  assert_close(corot_model_damping_time(model), 0.1 / 1e4, 1e-15, 0); /* of 1e-4, 2.5e-5, 1e-5 */
  corot_model_destroy(model), corot_mesh_destroy(mesh);
}

/* A thousand bytes a tet for model and state together. */
static void memory_is_bounded(void **state) {
  (void)state;
  corot_box box = {.size = {1, 1, 1}, .cells = {16, 16, 12}, .origin = {0, 0, 0}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  assert_int_equal(mesh->ntet, 18432);
  double gravity[] = {0, 0, -1};
  corot_load load = {COROT_GRAVITY, NULL, {gravity[0], gravity[1], gravity[2]}, {0, NULL, NULL}};
  for (int k = 0; k < NMEASURE; k++) {
    corot_model_def def = plain(mesh);
    def.mesh = mesh, def.strain = measures[k], def.nload = 1, def.load = &load;
    corot_model *model;
    corot_state *s;
    assert_ok(corot_model_create(&def, &model));
    assert_ok(corot_state_create(model, &s));
    double each = (double)(corot_model_bytes(model) + corot_state_bytes(s)) / mesh->ntet;
    assert_below(each, 1000);
    assert_above(each, 200); /* gradients, volume and two frames alone */
    corot_state_destroy(s), corot_model_destroy(model);
  }
  corot_mesh_destroy(mesh);
}

static corot_status make_all(void *context) {
  corot_mesh *mesh = context;
  double time[] = {0, 1}, value[] = {0, 1};
  corot_fix fix = {"zmin", {true, true, true}};
  corot_load load[] = {{COROT_TRACTION, "zmax", {1, 0, 0}, {2, time, value}},
                       {COROT_GRAVITY, NULL, {0, 0, -1}, {0, NULL, NULL}},
                       {COROT_PRESSURE, "xmin", {5}, {0, NULL, NULL}}};
  corot_motion motion = {COROT_ROTATE, "zmax", {0, 0, 1}, {0, 0, 0}, 1, {0, 0, 0}, 0, INFINITY};
  corot_model_def def = plain(mesh);
  def.strain = "warp", def.nfix = 1, def.fix = &fix, def.nload = 3, def.load = load;
  def.nmotion = 1, def.motion = &motion;
  def.dilatation = COROT_DILATATION_NODAL;
  corot_model *model = NULL;
  corot_state *s = NULL;
  corot_csc *full = NULL, *lower = NULL;
  corot_status status = corot_model_create(&def, &model);
  if (!status) status = corot_state_create(model, &s);
  if (!status) status = corot_csc_create(model, COROT_FULL, &full);
  if (!status) status = corot_csc_create(model, COROT_LOWER, &lower);
  corot_csc_destroy(lower);
  corot_csc_destroy(full);
  corot_state_destroy(s);
  corot_model_destroy(model);
  return status;
}

static void any_allocation_may_fail(void **state) {
  (void)state;
  corot_mesh *mesh = bar();
  assert_true(assert_survives_failed_allocations(make_all, mesh) > 40);
  corot_mesh_destroy(mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(refuses_a_definition_without_sense),
      cmocka_unit_test(refuses_a_material_out_of_range),
      cmocka_unit_test(every_tet_has_one_material),
      cmocka_unit_test(refuses_a_load_without_sense),
      cmocka_unit_test(the_definition_is_copied),
      cmocka_unit_test(supports_take_their_components_away),
      cmocka_unit_test(the_mass_is_that_of_the_volume),
      cmocka_unit_test(loads_sum_to_their_totals),
      cmocka_unit_test(amplitudes_are_piecewise_linear),
      cmocka_unit_test(kinks_are_the_points_of_all_amplitudes),
      cmocka_unit_test(each_tet_has_its_own_stiffness),
      cmocka_unit_test(an_inverted_tet_is_named),
      cmocka_unit_test(the_first_inverted_tet_is_named),
      cmocka_unit_test(what_is_not_a_number_is_named),
      cmocka_unit_test(scales_of_the_model),
      cmocka_unit_test(memory_is_bounded),
      cmocka_unit_test(any_allocation_may_fail),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

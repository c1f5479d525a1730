/* Where a mesh leaves out most: indicators of tets against exact solutions, what they may not see,
   and what a goal makes of them. */
#include <corot/space.h>
#include <corot/statics.h>

#include "alloc.h"
#include "core/mesh/mesh.h"
#include "order_2.h"
#include "solid.h"
#include "solver.h"

static const corot_material firm = {.lambda = 3.0e4, .mu = 2.0e4, .density = 1000};

static corot_mesh *box_of(double x, double y, double z, int nx, int ny, int nz, int order) {
  corot_box box = corot_box_defaults();
  box.size[0] = x, box.size[1] = y, box.size[2] = z;
  box.cells[0] = nx, box.cells[1] = ny, box.cells[2] = nz;
  corot_mesh *one, *mesh;
  assert_ok(corot_mesh_box(&box, &one));
  mesh = with_order(one, order);
  corot_mesh_destroy(one);
  return mesh;
}

static double *equilibrium_of(const body *b) {
  corot_statics_def def = corot_statics_defaults();
  corot_statics *s;
  double *u = malloc((size_t)b->n * sizeof *u);
  def.tolerance = 1e-12;
  assert_ok(corot_statics_create(&def, b->model, 0, NULL, &s));
  assert_ok(corot_statics_solve(s));
  corot_statics_at(s, u);
  corot_statics_destroy(s);
  return u;
}

static corot_space_moment still(const double *u) {
  return (corot_space_moment){.u = u, .still = true, .factor = 1};
}

/* The indicators of all tets; the caller's to free. */
static double *indicators_of(const body *b, const double *u, const double *goal,
                             corot_space_total *total) {
  double *indicator = malloc((size_t)b->mesh->ntet * sizeof *indicator), sum = 0;
  corot_space_moment at = still(u);
  assert_ok(corot_space_indicators(b->model, &at, goal, NULL, indicator, total));
  for (int e = 0; e < b->mesh->ntet; e++) {
    assert_true(indicator[e] >= 0);
    sum += indicator[e];
  }
  assert_close(sum, goal ? total->bound : total->energy, 1e-12, 0);
  assert_true(fabs(total->goal) <= total->bound * (1 + 1e-12));
  return indicator;
}

/* goal [n], the caller's to free: the displacement of a point in component c. */
static double *displacement_at(const body *b, const double point[3], int c) {
  double *goal = calloc((size_t)b->n, sizeof *goal);
  corot_location at;
  assert_ok(corot_mesh_locate(b->mesh, point, &at));
  for (int k = 0; k < at.nnode; k++) {
    int i = corot_model_dof(b->model)[at.node[k]][c];
    if (i >= 0) goal[i] += at.weight[k];
  }
  return goal;
}

/* --- A thick tube under pressure (Lame): a quarter, in plane strain --- */

static const double r_inner = 1, r_outer = 2, pressure = 0.01;

static body quarter_of_a_tube(const char *strain, int order, int cells) {
  static const corot_fix fix[] = {{"ymin", {false, true, false}},
                                  {"ymax", {true, false, false}},
                                  {"zmin", {false, false, true}},
                                  {"zmax", {false, false, true}}};
  static const corot_load push = {COROT_PRESSURE, "xmin", {pressure}, {0}};
  corot_mesh *mesh = box_of(r_outer - r_inner, 1, 0.5, cells, 2 * cells, (cells + 1) / 2, order);
  for (int n = 0; n < mesh->nnode; n++) {
    double r = r_inner + mesh->x[n][0], angle = 1.5707963267949 * mesh->x[n][1];
    mesh->x[n][0] = r * cos(angle), mesh->x[n][1] = r * sin(angle);
  }
  corot_model_def def = corot_model_defaults();
  def.strain = strain;
  def.nmaterial = 1, def.material = &firm;
  def.nfix = 4, def.fix = fix;
  def.nload = 1, def.load = &push;
  return make_body(mesh, def);
}

/* Strains xx yy zz xy yz xz of u_r = C r + D / r. */
static void lame_strain(const double x[3], double e[6]) {
  double part = pressure * r_inner * r_inner / (r_outer * r_outer - r_inner * r_inner);
  double C = part / (2 * (firm.lambda + firm.mu)), D = part * r_outer * r_outer / (2 * firm.mu);
  double square = x[0] * x[0] + x[1] * x[1], cc = x[0] * x[0] / square, ss = 1 - cc;
  double along = C - D / square, across = C + D / square;
  memset(e, 0, 6 * sizeof *e);
  e[0] = along * cc + across * ss;
  e[1] = along * ss + across * cc;
  e[3] = (along - across) * x[0] * x[1] / square;
}

/* The roots of the Legendre polynomial of degree 4 on [0, 1], and weights. */
enum { GAUSS = 4 };
static const double gauss_at[GAUSS] = {0.069431844202973712, 0.33000947820757187,
                                       0.66999052179242813, 0.93056815579702629};
static const double gauss_weight[GAUSS] = {0.17392742256872693, 0.32607257743127307,
                                           0.32607257743127307, 0.17392742256872693};

/* The energy of the true error, integrated over tets by products of Gauss's rule. Strains are those
   of cauchy, from which those of other measures differ by no more than their square. */
static double true_energy(const body *b, const double *u) {
  enum { EACH = GAUSS * GAUSS * GAUSS };
  size_t n = (size_t)b->mesh->ntet * EACH;
  int *tet = malloc(n * sizeof *tet);
  double(*at)[4] = malloc(n * sizeof *at), (*strain)[6] = malloc(n * sizeof *strain), sum = 0;
  double *weight = malloc(n * sizeof *weight);
  for (size_t i = 0; i < n; i++) {
    int x = i % GAUSS, y = i / GAUSS % GAUSS, z = i / GAUSS / GAUSS % GAUSS;
    double p = gauss_at[x], q = gauss_at[y] * (1 - p), r = gauss_at[z] * (1 - p - q);
    tet[i] = (int)(i / EACH);
    at[i][0] = 1 - p - q - r, at[i][1] = p, at[i][2] = q, at[i][3] = r;
    weight[i] = gauss_weight[x] * gauss_weight[y] * gauss_weight[z] * (1 - p) * (1 - p - q) * 6 *
                corot_mesh_volume_of(b->mesh, tet[i]);
  }
  corot_points *points;
  assert_ok(corot_points_create(b->model, (int)n, tet, (const double(*)[4])at, &points));
  corot_point_fields fields = {.strain = strain};
  assert_ok(corot_points_evaluate(points, b->state, 0, u, &fields));
  for (size_t i = 0; i < n; i++) {
    corot_location here = {.tet = tet[i]};
    double e[6], trace = 0, square = 0;
    memcpy(here.at, at[i], sizeof here.at);
    corot_location_weigh(b->mesh, &here);
    lame_strain(here.x, e);
    for (int k = 0; k < 6; k++) {
      e[k] -= strain[i][k];
      square += (k < 3 ? 1 : 2) * e[k] * e[k];
      if (k < 3) trace += e[k];
    }
    sum += weight[i] * (firm.mu * square + 0.5 * firm.lambda * trace * trace);
  }
  corot_points_destroy(points);
  free(tet), free(at), free(strain), free(weight);
  return sum;
}

/* The root of the energy falls by 2^order where tets are halved, as the true one does. Of four-node
   tets it is within a tenth of that; quadratic polynomials in patches as wide as the tube is thick
   are a little off themselves, and less so with every level. */
static void of_a_smooth_solution_it_is_the_error(void **state) {
  (void)state;
  static const double least = 0.9, most[2][2] = {{1.1, 1.1}, {1.8, 1.3}};
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++) {
      double energy[2];
      for (int k = 0; k < 2; k++) {
        body b = quarter_of_a_tube(measures[m], order, 3 << k);
        double *u = equilibrium_of(&b);
        corot_space_total total;
        double *indicator = indicators_of(&b, u, NULL, &total);
        double effectivity = sqrt(total.energy / true_energy(&b, u));
        energy[k] = total.energy;
        assert_above(effectivity, least);
        assert_below(effectivity, most[order - 1][k]);
        free(u), free(indicator);
        drop_body(&b);
      }
      assert_close(0.5 * log2(energy[0] / energy[1]), order, 0, 0.35);
    }
}

/* --- What the elements hold exactly --- */

/* A crooked box with nothing to hold it, displaced to x -> F x + part (x.x) w. */
static double *displaced(const body *b, const double F[9], double part) {
  static const double w[3] = {0.2, -0.5, 1};
  double *u = malloc((size_t)b->n * sizeof *u);
  for (int n = 0; n < b->mesh->nnode; n++) {
    const double *X = b->mesh->x[n];
    double x[3], square = X[0] * X[0] + X[1] * X[1] + X[2] * X[2];
    apply(F, X, x);
    for (int c = 0; c < 3; c++) u[3 * n + c] = x[c] - X[c] + part * square * w[c];
  }
  return u;
}

static body free_box(const char *strain, int order, const corot_material *of) {
  corot_mesh *one = linear_box(3, 2, 3);
  corot_model_def def = corot_model_defaults();
  def.strain = strain;
  def.nmaterial = 1, def.material = of;
  body b = make_body(with_order(one, order), def);
  corot_mesh_destroy(one);
  return b;
}

/* Strains are rounded to some 1e-16, and squared. */
static const double rounding = 1e-25;

static void what_tets_hold_exactly_is_no_error(void **state) {
  (void)state;
  uint64_t seed = 3;
  double F[9], Q[9], QF[9];
  random_gradient(&seed, 0.1, F);
  random_rotation(&seed, Q);
  multiply(Q, F, QF);
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++)
      for (int quadratic = 0; quadratic < 2; quadratic++) {
        body b = free_box(measures[m], order, &firm);
        double *u = displaced(&b, QF, 0.1 * quadratic);
        corot_space_total total;
        double *indicator = indicators_of(&b, u, NULL, &total);
        if (order == 2 || !quadratic)
          assert_below(total.energy, rounding * firm.mu);
        else
          assert_above(total.relative, 1e-3);
        free(u), free(indicator);
        drop_body(&b);
      }
}

static void a_body_at_rest_has_no_relative_error(void **state) {
  (void)state;
  body b = free_box("polar", 1, &firm);
  double *u = displaced(&b, identity, 0);
  corot_space_total total;
  for (int n = 0; n < b.n; n++) u[n] = 0.1; /* moved, which leaves rounding */
  free(indicators_of(&b, u, NULL, &total));
  assert_close(total.relative, 0, 0, 0);
  free(u);
  drop_body(&b);
}

/* Two materials one behind the other, pulled: strains jump from one to the other, and are those of
   either. A state that is not that has an error. */
static void a_jump_between_materials_is_no_error(void **state) {
  (void)state;
  const corot_material two[] = {{.group = "left", .lambda = 0, .mu = 1e4, .density = 1000},
                                {.group = "right", .lambda = 0, .mu = 4e4, .density = 1000}};
  for (int order = 1; order <= 2; order++)
    for (int off = 0; off < 2; off++) {
      corot_mesh *mesh = box_of(2, 1, 1, 4, 2, 2, order);
      assert_ok(corot_mesh_group_box(mesh, "left", (double[]){0, 0, 0}, (double[]){1, 1, 1}, 0));
      assert_ok(corot_mesh_group_box(mesh, "right", (double[]){1, 0, 0}, (double[]){2, 1, 1}, 0));
      corot_model_def def = corot_model_defaults();
      def.nmaterial = 2, def.material = two;
      body b = make_body(mesh, def);
      double *u = calloc((size_t)b.n, sizeof *u);
      for (int n = 0; n < mesh->nnode; n++) {
        double x = mesh->x[n][0];
        u[3 * n] = x < 1 ? 0.04 * x : 0.04 + 0.01 * (x - 1);
        if (off && x == 0.5) u[3 * n] += 0.01;
      }
      corot_space_total total;
      double *indicator = indicators_of(&b, u, NULL, &total);
      if (off)
        assert_above(total.energy, 1e-3);
      else
        assert_below(total.energy, rounding * two[1].mu);
      free(u), free(indicator);
      drop_body(&b);
    }
}

/* --- Turns --- */

/* Turned as a whole, with the goal, a deformed body has the same indicators. */
static void a_turn_of_the_body_changes_nothing(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2 && !corot_strain_find(measures[m])->linear; order++) {
      body b = free_box(measures[m], order, &firm);
      uint64_t seed = 11;
      double Q[9], *u = calloc((size_t)b.n, sizeof *u), *w = calloc((size_t)b.n, sizeof *w);
      double *goal = displacement_at(&b, b.mesh->x[5], 1), *turned = calloc((size_t)b.n, 8);
      random_rotation(&seed, Q);
      for (int n = 0; n < b.mesh->nnode; n++) {
        double x[3], *X = b.mesh->x[n];
        for (int c = 0; c < 3; c++)
          x[c] = X[c] + 0.01 * noise(&seed) + (c == 0 ? 0.03 * X[2] * X[2] : 0);
        for (int c = 0; c < 3; c++) u[3 * n + c] = x[c] - X[c];
        apply(Q, x, w + 3 * n);
        for (int c = 0; c < 3; c++) w[3 * n + c] += 0.5 - X[c];
        apply(Q, goal + 3 * n, turned + 3 * n);
      }
      for (int with = 0; with < 2; with++) {
        corot_space_total first, second;
        double *a = indicators_of(&b, u, with ? goal : NULL, &first);
        double *c = indicators_of(&b, w, with ? turned : NULL, &second);
        /* a hundred times the rounding of strains, over their size of 1e-2; the condition of K */
        double most = norm_max(b.mesh->ntet, a);
        for (int e = 0; e < b.mesh->ntet; e++) assert_close(c[e], a[e], 0, 1e-7 * most);
        assert_close(second.goal, first.goal, 0, 1e-7 * first.bound);
        assert_int_equal(first.indefinite, second.indefinite);
        free(a), free(c);
      }
      free(u), free(w), free(goal), free(turned);
      drop_body(&b);
    }
}

/* --- Numbers --- */

/* The same mesh with its nodes numbered from the last to the first, so that corners come last. */
static body backward(const body *b, const corot_model_def *def) {
  const corot_mesh *mesh = b->mesh;
  double(*x)[3] = malloc((size_t)mesh->nnode * sizeof *x);
  int(*tet)[10] = malloc((size_t)mesh->ntet * sizeof *tet);
  corot_mesh *turned;
  for (int n = 0; n < mesh->nnode; n++) memcpy(x[mesh->nnode - 1 - n], mesh->x[n], sizeof *x);
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 10; k++)
      tet[e][k] = mesh->nnode - 1 - (k < 4 ? mesh->tet[e][k] : mesh->mid[e][k - 4]);
  assert_ok(corot_mesh_create_order_2(mesh->nnode, (const double(*)[3])x, mesh->ntet,
                                      (const int(*)[10])tet, &turned));
  free(x), free(tet);
  return make_body(turned, *def);
}

static void numbers_of_nodes_do_not_matter(void **state) {
  (void)state;
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &firm;
  body b = free_box("polar", 2, &firm), c = backward(&b, &def);
  double *u = malloc((size_t)b.n * sizeof *u), *w = malloc((size_t)b.n * sizeof *w);
  uint64_t seed = 7;
  for (int n = 0; n < b.mesh->nnode; n++)
    for (int i = 0; i < 3; i++)
      u[3 * n + i] = w[3 * (b.mesh->nnode - 1 - n) + i] = 0.01 * noise(&seed);
  corot_space_total first, second;
  double *a = indicators_of(&b, u, NULL, &first), *d = indicators_of(&c, w, NULL, &second);
  for (int e = 0; e < b.mesh->ntet; e++) assert_close(d[e], a[e], 1e-9, 0);
  free(a), free(d), free(u), free(w);
  drop_body(&b), drop_body(&c);
}

/* --- Goals --- */

static const corot_fix wall = {"xmin", {true, true, true}};

/* A cantilever whose end sinks: nothing is singular, for a Poisson's ratio of zero. */
static body cantilever(const char *strain, int order, int cells, double force) {
  static const corot_material cork = {.lambda = 0, .mu = 2e4, .density = 1000};
  static corot_load push;
  push = (corot_load){COROT_TRACTION, "xmax", {0, 0, -force}, {0}};
  corot_model_def def = corot_model_defaults();
  def.strain = strain;
  def.nmaterial = 1, def.material = &cork;
  def.nfix = 1, def.fix = &wall;
  def.nload = 1, def.load = &push;
  return make_body(box_of(2, 0.5, 0.5, 4 * cells, cells, cells, order), def);
}

/* What is missing to the deflection is estimated with its sign, within a factor of two: the truth
   is that of ten-node tets which are half as large, or of the same size as the four-node ones. */
static void a_goal_is_told_what_it_misses(void **state) {
  (void)state;
  const double end[3] = {2, 0.25, 0.25};
  for (int m = 0; m < NMEASURE; m++) {
    double truth = 0;
    for (int k = 0; k < 3; k++) {
      int order = k == 0 ? 2 : k, cells = k == 2 ? 2 : 4;
      body b = cantilever(measures[m], order, cells, 2);
      double *u = equilibrium_of(&b), *goal = displacement_at(&b, end, 2);
      double value = inner(b.n, goal, u);
      corot_space_total total;
      free(indicators_of(&b, u, goal, &total));
      if (k == 0) truth = value;
      if (k > 0) {
        assert_above(total.goal / (truth - value), 0.4);
        assert_below(total.goal / (truth - value), 2.5);
      }
      free(u), free(goal);
      drop_body(&b);
    }
  }
}

/* Of two bodies that do not touch, a goal on one has nothing to do with the other, and as a part
   of one body has little to do with what is far away from it. */
static void what_a_goal_does_not_depend_on_has_no_part_in_it(void **state) {
  (void)state;
  corot_model_def def = corot_model_defaults();
  const corot_fix both[] = {wall, {"xmax", {true, true, true}}};
  const corot_load weight = {COROT_GRAVITY, "", {0, 0, -0.01}, {0}};
  def.nmaterial = 1, def.material = &firm;
  def.nfix = 2, def.fix = both;
  def.nload = 1, def.load = &weight;
  for (int order = 1; order <= 2; order++) {
    body b = make_body(box_of(6, 0.5, 0.5, 24, 2, 2, order), def);
    double *u = equilibrium_of(&b), *goal = displacement_at(&b, (double[]){0.5, 0.25, 0.25}, 2);
    corot_space_total total;
    for (int with = 0; with < 2; with++) {
      double far = 0, *indicator = indicators_of(&b, u, with ? goal : NULL, &total);
      for (int e = 0; e < b.mesh->ntet; e++)
        if (b.mesh->x[b.mesh->tet[e][0]][0] > 3) far += indicator[e];
      if (with)
        assert_below(far, 0.2 * total.bound);
      else
        assert_above(far, 0.4 * total.energy); /* the half beyond the middle */
      free(indicator);
    }
    free(u), free(goal);
    drop_body(&b);
  }
}

/* A body that flies, at some time of its motion: neither that nor its turn is an error. */
static void a_body_that_flies_has_a_dual_state(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (int order = 1; order <= 2; order++) {
      body b = free_box(measures[m], order, &firm);
      double *w = calloc((size_t)(2 * b.n), sizeof *w),
             *indicator = calloc((size_t)b.mesh->ntet, 8);
      double *goal = displacement_at(&b, b.mesh->x[0], 0);
      uint64_t seed = 5;
      for (int i = 0; i < b.n; i++) w[i] = 0.01 * noise(&seed), w[b.n + i] = noise(&seed);
      corot_space_moment at = {.t = 0.3, .u = w, .v = w + b.n};
      corot_space_total total;
      assert_ok(corot_space_indicators(b.model, &at, goal, NULL, indicator, &total));
      assert_above(total.bound, 0);
      free(w), free(goal), free(indicator);
      drop_body(&b);
    }
}

/* A strut that is pressed to beyond the load that buckles it. */
static void an_unstable_state_is_said_to_be_so(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    body b = cantilever(measures[m], 1, 2, 0);
    double *u = calloc((size_t)b.n, sizeof *u), *goal = displacement_at(&b, (double[]){2, 0, 0}, 2);
    for (int n = 0; n < b.mesh->nnode; n++) {
      int i = corot_model_dof(b.model)[n][0];
      if (i >= 0) u[i] = -0.3 * b.mesh->x[n][0];
    }
    corot_space_total total;
    free(indicators_of(&b, u, goal, &total));
    bool stable = corot_strain_find(measures[m])->linear || !strcmp(measures[m], "warp");
    assert_int_equal(total.indefinite, !stable);
    free(u), free(goal);
    drop_body(&b);
  }
}

/* --- Marking --- */

static void the_fewest_that_carry_a_fraction_are_marked(void **state) {
  (void)state;
  const double indicator[] = {1, 4, 0, 2, 2, 1, 0};
  const struct {
    double fraction;
    int n, mark[7];
  } row[] = {{0.1, 1, {1}},       {0.4, 1, {1}},          {0.41, 2, {1, 3}},      {0.6, 2, {1, 3}},
             {0.8, 3, {1, 3, 4}}, {0.9, 4, {0, 1, 3, 4}}, {1, 5, {0, 1, 3, 4, 5}}};
  for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
    int n = -1, mark[7];
    assert_ok(corot_space_mark(7, indicator, row[k].fraction, &n, mark));
    assert_int_equal(n, row[k].n);
    assert_memory_equal(mark, row[k].mark, (size_t)n * sizeof *mark);
  }
  int n = -1, mark[7];
  assert_ok(corot_space_mark(3, (double[]){0, 0, 0}, 0.5, &n, mark));
  assert_int_equal(n, 0);
  assert_fails(corot_space_mark(7, indicator, 0, &n, mark), COROT_EINVAL, "fraction of 0");
  assert_fails(corot_space_mark(7, indicator, NAN, &n, mark), COROT_EINVAL, "fraction of");
  assert_fails(corot_space_mark(7, indicator, 1.1, &n, mark), COROT_EINVAL, "fraction of 1.1");
  assert_fails(corot_space_mark(2, (double[]){1, NAN}, 0.5, &n, mark), COROT_EINVAL, "tet 1");
  assert_fails(corot_space_mark(2, (double[]){-1, 1}, 0.5, &n, mark), COROT_EINVAL, "tet 0");
}

/* --- What fails --- */

static void what_cannot_be_indicated_is_refused(void **state) {
  (void)state;
  body b = free_box("polar", 1, &firm);
  double *u = calloc((size_t)b.n, sizeof *u), *indicator = calloc((size_t)b.mesh->ntet, 8);
  corot_space_moment at = still(NULL);
  corot_space_total total = {.energy = -1};
  assert_fails(corot_space_indicators(b.model, &at, NULL, NULL, indicator, &total), COROT_EINVAL,
               "no u");
  at = still(u);
  assert_fails(corot_space_indicators(b.model, &at, u, SOLVER("abacus"), indicator, &total),
               COROT_EINVAL, "abacus");
  u[3] = NAN;
  assert_fails(corot_space_indicators(b.model, &at, NULL, NULL, indicator, &total), COROT_RETRY,
               "not finite");
  assert_close(total.energy, -1, 0, 0); /* outputs are set on success only */
  free(u), free(indicator);
  drop_body(&b);
}

typedef struct asked {
  const corot_model *model;
  corot_space_moment at;
  const double *goal;
  double *indicator;
  int *mark;
} asked;

static corot_status ask(void *context) {
  asked *a = context;
  int n;
  COROT_TRY(corot_space_indicators(a->model, &a->at, a->goal, NULL, a->indicator, NULL));
  return corot_space_mark(corot_model_mesh(a->model)->ntet, a->indicator, 0.5, &n, a->mark);
}

static void failed_allocations_leave_nothing(void **state) {
  (void)state;
  for (int held = 0; held < 2; held++)
    for (int order = 1; order <= 2; order++) {
      body b = held ? cantilever("polar", order, 1, 0) : free_box("polar", order, &firm);
      double *u = calloc((size_t)b.n, sizeof *u), *goal = calloc((size_t)b.n, sizeof *goal);
      u[3] = 0.01, goal[4] = 1;
      asked a = {b.model, still(u), goal, calloc((size_t)b.mesh->ntet, sizeof(double)),
                 calloc((size_t)b.mesh->ntet, sizeof(int))};
      assert_true(assert_survives_failed_allocations(ask, &a) > 15);
      a.goal = NULL;
      assert_true(assert_survives_failed_allocations(ask, &a) > 8);
      free(u), free(goal), free(a.indicator), free(a.mark);
      drop_body(&b);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(of_a_smooth_solution_it_is_the_error),
      cmocka_unit_test(what_tets_hold_exactly_is_no_error),
      cmocka_unit_test(a_body_at_rest_has_no_relative_error),
      cmocka_unit_test(a_jump_between_materials_is_no_error),
      cmocka_unit_test(a_turn_of_the_body_changes_nothing),
      cmocka_unit_test(numbers_of_nodes_do_not_matter),
      cmocka_unit_test(a_goal_is_told_what_it_misses),
      cmocka_unit_test(what_a_goal_does_not_depend_on_has_no_part_in_it),
      cmocka_unit_test(a_body_that_flies_has_a_dual_state),
      cmocka_unit_test(an_unstable_state_is_said_to_be_so),
      cmocka_unit_test(the_fewest_that_carry_a_fraction_are_marked),
      cmocka_unit_test(what_cannot_be_indicated_is_refused),
      cmocka_unit_test(failed_allocations_leave_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

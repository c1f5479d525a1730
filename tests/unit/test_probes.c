/* What probes say of a body in a given state, against sums made here; and what is refused of them.
 */
#define TEST_NAME "probes"
#include <corot/solve.h>

#include "alloc.h"
#include "app/probe/probe.h"
#include "scenario_text.h"
#include "solid.h"

/* A body, strained and moving, and the numbers of its probes. */
typedef struct scene {
  scenario *scenario;
  corot_mesh *mesh;
  corot_model *model;
  corot_state *state;
  int n;
  double *u, *v;            /* [n] */
  double (*x)[3], (*dx)[3]; /* [nnode] displacement, velocity */
  corot_energies energies;
  probes *probes;
  double *value; /* [ncolumn] */
} scene;

#define BAR                                                                                      \
  "mesh: {box: {size: [0.2, 0.1, 0.3], cells: [2, 1, 3]}, order: %d}\n"                          \
  "groups: {base: {plane: {axis: z, at: 0}}, top: {plane: {axis: z, at: 0.3}}, half: {box: "     \
  "{min: [0, 0, 0], max: [1, 1, 0.2]}}, all: {box: {min: [-1, -1, -1], max: [1, 1, 1]}}}\n"      \
  "material: {lambda: 1.0e5, mu: 1.0e4, density: 1000, damping: {lambda: 10, mu: 1, mass: 2}}\n" \
  "boundary: [{group: base, fix: [x, y, z]}, {group: top, fix: [y]}]\n"                          \
  "loads: [{group: top, traction: [200, 10, 0]}, {group: xmax, pressure: 50}]\n"                 \
  "time: {end: 1}\n"

static ledger ledger_of(const scene *s) {
  ledger row = {.kinetic = s->energies.kinetic, .elastic = s->energies.elastic, .balance = 7};
  memcpy(row.momentum, s->energies.momentum, sizeof row.momentum);
  memcpy(row.angular_momentum, s->energies.angular_momentum, sizeof row.angular_momentum);
  return row;
}

static void evaluate(scene *s) {
  const ledger row = ledger_of(s);
  const probe_moment now = {.state = s->state,
                            .u = s->u,
                            .v = s->v,
                            .displacement = (const double(*)[3])s->x,
                            .ledger = &row};
  assert_ok(probes_evaluate(s->probes, &now, s->value));
}

/* Nodes displaced by size times noise, on what is free. */
static scene open_scene(int order, const char *list, double size) {
  char text[4000];
  scene s = {0};
  uint64_t seed = 3;
  snprintf(text, sizeof text, BAR "probes:\n%s", order, list);
  s.scenario = accept(text);
  assert_ok(scenario_build(s.scenario, &s.mesh, NULL, &s.model));
  assert_ok(corot_state_create(s.model, &s.state));
  s.n = corot_model_ndof(s.model);
  s.u = calloc(2 * s.n, sizeof *s.u), s.v = s.u + s.n;
  s.x = calloc(2 * s.mesh->nnode, sizeof *s.x), s.dx = s.x + s.mesh->nnode;
  for (int i = 0; i < s.n; i++) s.u[i] = size * noise(&seed), s.v[i] = noise(&seed);
  corot_nodal(s.model, 0, s.u, s.v, s.x, s.dx);
  assert_ok(corot_energy(s.model, s.state, 0, s.u, s.v, &s.energies));
  assert_ok(probes_create(s.scenario, s.model, &s.probes));
  s.value = calloc(probes_ncolumn(s.probes) + 1, sizeof *s.value);
  evaluate(&s);
  return s;
}

static void close_scene(scene *s) {
  probes_destroy(s->probes);
  free(s->value), free(s->u), free(s->x);
  corot_state_destroy(s->state), corot_model_destroy(s->model), corot_mesh_destroy(s->mesh);
  scenario_destroy(s->scenario);
}

static int column_of(const scene *s, const char *name) {
  for (int i = 0; i < probes_ncolumn(s->probes); i++)
    if (strcmp(probes_columns(s->probes)[i], name) == 0) return i;
  fail_msg("no column %s", name);
  return -1;
}

static double value_of(const scene *s, const char *name) { return s->value[column_of(s, name)]; }

static void assert_unit(const scene *s, const char *name, const char *unit) {
  assert_string_equal(probes_unit(s->probes, column_of(s, name)), unit);
}

static probe_where where_of(const scene *s, const char *name) {
  int i = column_of(s, name), k = 0;
  while (probes_known(s->probes, k).first + probes_known(s->probes, k).ncolumn <= i) k++;
  return probes_where(s->probes, k, i - probes_known(s->probes, k).first);
}

static const corot_group *group_of(const scene *s, const char *name) {
  return corot_mesh_find_group(s->mesh, name);
}

/* --- Nodes --- */

static void nodes_are_summed(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    scene s = open_scene(order,
                         "  mean: {group: top, of: displacement, take: mean}\n"
                         "  sum: {group: top, take: sum}\n"
                         "  max: {group: top, of: velocity, take: max}\n"
                         "  far: {of: displacement, take: max, component: magnitude}\n"
                         "  low: {of: velocity, component: z, take: min}\n"
                         "  node: {node: 5}\n",
                         2e-3);
    const corot_group *top = group_of(&s, "top");
    double sum[3] = {0}, max = -INFINITY, far = 0, low = INFINITY;
    int at_max = -1, at_far = -1;
    for (int i = 0; i < top->nnode; i++) {
      for (int c = 0; c < 3; c++) sum[c] += s.x[top->node[i]][c];
      if (s.dx[top->node[i]][0] > max) max = s.dx[top->node[i]][0], at_max = top->node[i];
    }
    for (int n = 0; n < s.mesh->nnode; n++) {
      double length = sqrt(inner(3, s.x[n], s.x[n]));
      if (length > far) far = length, at_far = n;
      low = fmin(low, s.dx[n][2]);
    }
    assert_close(value_of(&s, "sum.ux"), sum[0], 1e-14, 0);
    assert_close(value_of(&s, "mean.uz"), sum[2] / top->nnode, 1e-14, 0);
    assert_close(value_of(&s, "max.vx"), max, 0, 0);
    assert_close(value_of(&s, "far.value"), far, 1e-15, 0);
    assert_close(value_of(&s, "low.value"), low, 0, 0);
    assert_close(value_of(&s, "node.uy"), s.x[5][1], 0, 0);
    assert_int_equal(where_of(&s, "max.vx").node, at_max);
    assert_int_equal(where_of(&s, "far.value").node, at_far);
    assert_close(where_of(&s, "max.vx").x[2], 0.3, 1e-15, 0);
    assert_false(where_of(&s, "mean.ux").known);
    assert_unit(&s, "max.vx", "m/s"), assert_unit(&s, "far.value", "m");
    close_scene(&s);
  }
}

/* What is linear (of order 2 quadratic) in the nodes' places is that at a point. */
static void points_are_not_moved_to_nodes(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    scene s = open_scene(order,
                         "  in: {point: [0.03, 0.041, 0.123]}\n"
                         "  near: {point: [0.03, 0.041, 0.123], nearest: true}\n"
                         "  corner: {point: [0.2, 0.1, 0.3]}\n"
                         "  out: {point: [0.2, 0.05, 0.35]}\n",
                         0);
    const double p[3] = {0.03, 0.041, 0.123};
    double c = order == 2 ? 3 : 0;
    for (int n = 0; n < s.mesh->nnode; n++) {
      const double *X = s.mesh->x[n];
      s.x[n][0] = X[0] - 2 * X[2] + c * X[1] * X[2], s.x[n][1] = X[1], s.x[n][2] = X[2];
    }
    evaluate(&s);
    assert_close(value_of(&s, "in.ux"), p[0] - 2 * p[2] + c * p[1] * p[2], 1e-13, 0);
    assert_close(value_of(&s, "in.uy"), p[1], 1e-13, 0);
    int near = corot_mesh_nearest(s.mesh, p),
        corner = corot_mesh_nearest(s.mesh, (double[]){1, 1, 1});
    assert_close(value_of(&s, "near.ux"), s.x[near][0], 0, 0);
    assert_close(value_of(&s, "corner.ux"), s.x[corner][0], 0, 0);
    assert_close(value_of(&s, "out.uy"), 0.05, 1e-7, 0); /* the nearest of the edge */
    assert_close(value_of(&s, "out.uz"), 0.3, 1e-13, 0);
    close_scene(&s);
  }
}

/* --- Forces --- */

static void forces_are_summed(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    scene s = open_scene(order,
                         "  wall: {group: base, of: reaction, about: [1, 2, 3]}\n"
                         "  all: {of: reaction}\n"
                         "  internal: {of: reaction, part: internal}\n"
                         "  viscous: {of: reaction, part: viscous}\n"
                         "  load: {of: reaction, part: load}\n"
                         "  inertial: {of: reaction, part: inertial}\n"
                         "  out: {of: force}\n"
                         "  a: {of: acceleration, take: sum}\n",
                         2e-3);
    int nnode = s.mesh->nnode;
    const int(*dof)[3] = corot_model_dof(s.model);
    double *a = calloc(s.n, sizeof *a), wall[6] = {0}, all[3] = {0}, load[3] = {0}, sum = 0;
    double(*room)[3] = calloc(4 * nnode, sizeof *room);
    corot_nodal_forces f = {room, room + nnode, room + 2 * nnode, room + 3 * nnode};
    corot_mass_solver *solver;
    assert_ok(corot_residual(s.model, s.state, 0, s.u, s.v, a));
    assert_ok(corot_mass_solver_create(s.model, &solver));
    assert_ok(corot_mass_solve(solver, a, a));
    assert_ok(corot_forces(s.model, s.state, 0, s.u, s.v, a, &f));
    for (int n = 0; n < nnode; n++) {
      double r[3], arm[3];
      const double about[3] = {1, 2, 3};
      for (int c = 0; c < 3; c++) {
        bool held = dof[n][c] < 0;
        r[c] = held ? f.internal[n][c] + f.viscous[n][c] + f.inertial[n][c] - f.load[n][c] : 0;
        all[c] += r[c], load[c] += f.load[n][c];
        arm[c] = s.mesh->x[n][c] + s.x[n][c] - about[c];
        if (!held && c == 0) sum += a[dof[n][c]];
      }
      if (s.mesh->x[n][2] > 1e-9) continue;
      for (int c = 0; c < 3; c++) {
        int i = (c + 1) % 3, j = (c + 2) % 3;
        wall[c] += r[c], wall[3 + c] += arm[i] * r[j] - arm[j] * r[i];
      }
    }
    for (int c = 0; c < 6; c++) {
      char name[16];
      snprintf(name, sizeof name, "wall.%c%c", c < 3 ? 'f' : 'm', "xyz"[c % 3]);
      assert_close(value_of(&s, name), wall[c], 1e-11, 1e-11);
    }
    assert_close(value_of(&s, "all.fy"), all[1], 1e-11, 0);
    assert_true(fabs(all[1] - wall[1]) > 1e-3 * fabs(all[1])); /* the top is held in y */
    assert_close(value_of(&s, "internal.fx") + value_of(&s, "viscous.fx") +
                     value_of(&s, "inertial.fx") - value_of(&s, "load.fx"),
                 value_of(&s, "all.fx"), 1e-11, 1e-11);
    assert_close(value_of(&s, "out.fx"), load[0], 1e-13, 0);
    assert_close(value_of(&s, "a.ax"), sum, 1e-11, 0);
    assert_unit(&s, "wall.fx", "N"), assert_unit(&s, "wall.mz", "N m");
    free(a), free(room), corot_mass_solver_destroy(solver), close_scene(&s);
  }
}

/* --- Tets --- */

static void tets_are_summed(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    scene s = open_scene(order,
                         "  hot: {of: von_mises, take: max}\n"
                         "  mean: {group: half, of: stress}\n"
                         "  whole: {of: stress, take: sum, component: zx}\n"
                         "  det: {of: det}\n"
                         "  volume: {of: volume}\n"
                         "  part: {group: half, of: volume}\n"
                         "  p: {of: principal, component: 3, take: min}\n"
                         "  energy: {group: all, of: elastic}\n"
                         "  E: {of: elastic}\n",
                         2e-3);
    int ntet = s.mesh->ntet;
    const corot_group *half = group_of(&s, "half");
    corot_element_fields e = {.von_mises_at = calloc(ntet, sizeof *e.von_mises_at),
                              .det_at = calloc(ntet, sizeof *e.det_at),
                              .principal_at = calloc(ntet, sizeof *e.principal_at),
                              .stress = calloc(ntet, sizeof *e.stress),
                              .det = calloc(ntet, sizeof *e.det),
                              .volume = calloc(ntet, sizeof *e.volume)};
    assert_ok(corot_elements(s.model, s.state, 0, s.u, &e));
    double hot = 0, det = INFINITY, volume = 0, part = 0, mean = 0, rest = 0, whole = 0, p = 0;
    int at = -1;
    for (int t = 0; t < ntet; t++) {
      for (int k = 0; k < 4; k++) {
        if (e.von_mises_at[t][k] > hot) hot = e.von_mises_at[t][k], at = t;
        det = fmin(det, e.det_at[t][k]), p = fmin(p, e.principal_at[t][k][2]);
      }
      volume += e.det[t] * e.volume[t], whole += e.volume[t] * e.stress[t][5];
    }
    for (int i = 0; i < half->ntet; i++) {
      int t = half->tet[i];
      part += e.det[t] * e.volume[t], rest += e.volume[t], mean += e.volume[t] * e.stress[t][3];
    }
    assert_close(value_of(&s, "hot.value"), hot, 0, 0);
    assert_int_equal(where_of(&s, "hot.value").tet, at);
    assert_close(value_of(&s, "mean.xy"), mean / rest, 1e-12, 1e-10);
    assert_close(value_of(&s, "whole.value"), whole, 1e-12, 1e-12);
    assert_close(value_of(&s, "det.value"), det, 0, 0);
    assert_close(value_of(&s, "volume.value"), volume, 1e-13, 0);
    assert_close(value_of(&s, "part.value"), part, 1e-13, 0);
    assert_close(value_of(&s, "p.value"), p, 0, 0);
    assert_close(value_of(&s, "E.value"), s.energies.elastic, 0, 0);
    assert_close(value_of(&s, "energy.value"), s.energies.elastic, 1e-12, 0);
    assert_unit(&s, "whole.value", "Pa m^3"), assert_unit(&s, "det.value", "");
    free(e.von_mises_at), free(e.det_at), free(e.principal_at), free(e.stress), free(e.det);
    free(e.volume), close_scene(&s);
  }
}

/* Of linear tets at a node: the mean of those that meet there, and on a face that of its two. At
   the faces of a group: of the tets behind them, by area. */
static void places_between_tets_have_means(void **state) {
  (void)state;
  scene s = open_scene(1,
                       "  node: {node: 4, of: stress}\n"
                       "  face: {group: base, of: stress}\n"
                       "  sum: {group: base, of: stress, take: sum}\n",
                       2e-3);
  int ntet = s.mesh->ntet;
  corot_element_fields e = {.stress = calloc(ntet, sizeof *e.stress),
                            .volume = calloc(ntet, sizeof *e.volume)};
  assert_ok(corot_elements(s.model, s.state, 0, s.u, &e));
  double node = 0, volume = 0, face = 0, area = 0;
  const corot_group *base = group_of(&s, "base");
  for (int t = 0; t < ntet; t++) {
    const int *v = s.mesh->tet[t];
    if (v[0] == 4 || v[1] == 4 || v[2] == 4 || v[3] == 4)
      node += e.volume[t] * e.stress[t][2], volume += e.volume[t];
    for (int i = 0; i < base->ntri; i++) {
      int n = 0;
      for (int k = 0; k < 4; k++)
        for (int j = 0; j < 3; j++) n += v[k] == base->tri[i][j];
      const double *a = s.mesh->x[base->tri[i][0]], *b = s.mesh->x[base->tri[i][1]],
                   *c = s.mesh->x[base->tri[i][2]];
      double size = 0.5 * fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
      if (n == 3) face += size * e.stress[t][2], area += size;
    }
  }
  assert_close(area, 0.02, 1e-13, 0);
  assert_close(value_of(&s, "node.zz"), node / volume, 1e-12, 0);
  assert_close(value_of(&s, "face.zz"), face / area, 1e-12, 0);
  assert_close(value_of(&s, "sum.zz"), face, 1e-12, 0);
  assert_unit(&s, "sum.zz", "Pa m^2");
  free(e.stress), free(e.volume), close_scene(&s);
}

/* --- The body --- */

static void momenta_and_energies_are_those_of_the_ledger(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    scene s = open_scene(order,
                         "  p: {of: momentum}\n  pg: {group: all, of: momentum}\n"
                         "  l: {of: angular_momentum, about: [1, 2, 3]}\n"
                         "  lg: {group: all, of: angular_momentum, about: [1, 2, 3]}\n"
                         "  k: {of: kinetic}\n  kg: {group: all, of: kinetic}\n"
                         "  b: {of: balance}\n",
                         2e-3);
    const double *p = s.energies.momentum, *l = s.energies.angular_momentum;
    double lx = l[0] - (2 * p[2] - 3 * p[1]);
    assert_close(value_of(&s, "p.px"), p[0], 0, 0);
    assert_close(value_of(&s, "pg.px"), p[0], 1e-12, 1e-12);
    assert_close(value_of(&s, "l.lx"), lx, 1e-13, 0);
    assert_close(value_of(&s, "lg.lx"), lx, 1e-11, 1e-12);
    assert_close(value_of(&s, "k.value"), s.energies.kinetic, 0, 0);
    assert_close(value_of(&s, "kg.value"), s.energies.kinetic, 1e-12, 0);
    assert_close(value_of(&s, "b.value"), 7, 0, 0);
    close_scene(&s);
  }
}

/* Turned as a whole (between the supports), a tet's frame has turned by as much, be it ever so
   little: sines and cosines of a matrix of rounding 1e-16. */
static void frames_turn_with_the_body(void **state) {
  (void)state;
  const double angles[] = {1e-9, 0.3, 2.5};
  scene s = open_scene(1, "  at: {point: [0.13, 0.02, 0.13], of: frame_angle}\n", 0);
  for (int k = 0; k < 3; k++) {
    double R[9];
    const int(*dof)[3] = corot_model_dof(s.model);
    rotation((double[]){1, 2, 3}, angles[k], R);
    for (int n = 0; n < s.mesh->nnode; n++) {
      double Rx[3];
      apply(R, s.mesh->x[n], Rx);
      for (int c = 0; c < 3; c++)
        if (dof[n][c] >= 0) s.u[dof[n][c]] = Rx[c] - s.mesh->x[n][c];
    }
    evaluate(&s);
    assert_close(value_of(&s, "at.value"), angles[k], 0, 1e-14);
  }
  assert_unit(&s, "at.value", "rad");
  close_scene(&s);
}

/* --- Faces --- */

/* Stretched and sheared along z between the supports: F = I + g ez', the same everywhere. */
static scene open_uniform(int order, const char *strain, const char *list, const double g[3]) {
  char text[1500];
  snprintf(text, sizeof text, "%sstrain: %s\n", list, strain);
  scene s = open_scene(order, text, 0);
  const int(*dof)[3] = corot_model_dof(s.model);
  for (int n = 0; n < s.mesh->nnode; n++)
    for (int c = 0; c < 3; c++)
      if (dof[n][c] >= 0) s.u[dof[n][c]] = g[c] * s.mesh->x[n][2];
  corot_nodal(s.model, 0, s.u, s.v, s.x, s.dx);
  evaluate(&s);
  return s;
}

static double component(const scene *s, const char *probe, const char *name) {
  char column[32];
  snprintf(column, sizeof column, "%s.%s", probe, name);
  return value_of(s, column);
}

/* P of green strain on ez or ex: F (lambda tr E + 2 mu E), E = (F'F - I) / 2. */
static void first_piola(const double g[3], int column, double P[3]) {
  const double lambda = 1e5, mu = 1e4, norm = inner(3, g, g);
  double F[3][3] = {{1, 0, g[0]}, {0, 1, g[1]}, {0, 0, 1 + g[2]}};
  double E[3][3] = {{0, 0, g[0] / 2}, {0, 0, g[1] / 2}, {g[0] / 2, g[1] / 2, g[2] + norm / 2}};
  double trace = E[0][0] + E[1][1] + E[2][2];
  for (int i = 0; i < 3; i++) {
    P[i] = 0;
    for (int k = 0; k < 3; k++)
      P[i] += F[i][k] * ((k == column ? lambda * trace : 0) + 2 * mu * E[k][column]);
  }
}

/* Of the base, and of the side x = 0.2 m with the normal cof F ex = (1 + gz, 0, -gx). */
static void uniform_tractions(const scene *s, const double g[3]) {
  static const char *const t[3] = {"tx", "ty", "tz"}, *const f[3] = {"fx", "fy", "fz"};
  double scale = fabs(component(s, "held", "fz")), length = 0;
  for (int c = 0; c < 3; c++) {
    assert_close(component(s, "sum", t[c]), component(s, "held", f[c]), 0, 1e-12 * scale);
    /* the base is where it was: 0.02 m^2 */
    assert_close(component(s, "mean", t[c]), component(s, "sum", t[c]) / 0.02, 0,
                 1e-12 * scale / 0.02);
    length += pow(component(s, "side", t[c]), 2);
  }
  assert_close(component(s, "z", "value"), component(s, "mean", "tz"), 1e-14, 0);
  double n[3] = {1 + g[2], 0, -g[0]}, area = hypot(n[0], n[2]);
  double tx = (component(s, "stress", "xx") * n[0] + component(s, "stress", "zx") * n[2]) / area;
  assert_close(component(s, "side", "tx"), tx, 1e-11, 0);
  assert_close(component(s, "most", "value"), sqrt(length), 1e-11, 0);
  assert_close(component(s, "low", "value"), sqrt(length), 1e-11, 0);
}

/* The force of a uniform stress through a face is what holds the face, of any strain measure: sides
   that are opposite take the same from the nodes of the base. Warp's stress is not symmetric, and
   not the same in all tets: nothing is asked of it but where the largest is. Sums of some hundred
   terms of one size: 1e-12. */
static void tractions_are_what_the_supports_bear(void **state) {
  (void)state;
  static const char list[] =
      "  sum: {group: base, of: traction, take: sum}\n"
      "  held: {group: base, of: reaction, part: internal}\n"
      "  mean: {group: base, of: traction}\n"
      "  side: {group: xmax, of: traction, take: mean}\n"
      "  most: {group: xmax, of: traction, take: max}\n"
      "  low: {group: xmax, of: traction, take: min}\n"
      "  z: {group: base, of: traction, component: z}\n"
      "  stress: {group: xmax, of: stress}\n";
  const double g[3] = {0.3, 0, -0.15};
  for (int order = 1; order <= 2; order++)
    for (int k = 0; corot_strain_traits(k); k++) {
      const corot_strain_kind *kind = corot_strain_traits(k);
      scene s = open_uniform(order, kind->name, list, g);
      bool uniform = !kind->frames || kind->polar;
      if (uniform) uniform_tractions(&s, kind->linear ? (double[3]){0} : g);
      probe_where where = where_of(&s, "most.value");
      assert_true(where.known && where.tet >= 0);
      assert_close(where.x[0], 0.2, 1e-14, 0);
      assert_unit(&s, "sum.tx", "N"), assert_unit(&s, "mean.tx", "Pa");
      assert_unit(&s, "most.value", "Pa");
      close_scene(&s);
    }
}

static void tractions_in_closed_form(void **state) {
  (void)state;
  const double g[3] = {0.3, 0, -0.15};
  for (int order = 1; order <= 2; order++) {
    scene s = open_uniform(order, "green",
                           "  base: {group: base, of: traction, take: sum}\n"
                           "  side: {group: xmax, of: traction, take: sum}\n",
                           g);
    double through_base[3], through_side[3];
    first_piola(g, 2, through_base);
    first_piola(g, 0, through_side);
    for (int c = 0; c < 3; c++) {
      const char *name = (const char *[]){"tx", "ty", "tz"}[c];
      assert_close(component(&s, "base", name), -0.02 * through_base[c], 1e-12, 1e-9);
      assert_close(component(&s, "side", name), 0.03 * through_side[c], 1e-12, 1e-9);
    }
    close_scene(&s);
  }
}

static void tractions_are_of_faces(void **state) {
  (void)state;
  refuse(MINIMAL "probes: {a: {of: traction}}",
         "4:10: probes.a: a traction is of the faces of a group: give a group");
  refuse(MINIMAL "probes: {a: {node: 1, of: traction}}",
         "4:14: probes.a.node: a traction is of the faces of a group: give a group");
  scenario *s =
      accept(MINIMAL "groups: {two: {nodes: [0, 5]}}\nprobes: {a: {group: two, of: traction}}");
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  assert_fails(scenario_build(s, &mesh, NULL, &model), COROT_EFORMAT,
               "5:21: probes.a.group: group 'two' has no faces for a traction (2 nodes, 0 tets)");
  scenario_destroy(s);
}

/* --- Refusals --- */

static void what_does_not_go_together(void **state) {
  (void)state;
  static const refusal r[] = {
      {MINIMAL "probes: {a: {}}", "4:10: probes.a: give a point, a node or a group"},
      {MINIMAL "probes: {a: {group: g, node: 1}}",
       "4:14: probes.a.group: node and group exclude each other"},
      {MINIMAL "probes: {a: {node: 1, of: reacton}}",
       "4:27: probes.a.of: unknown: reacton; did you mean reaction?"},
      {MINIMAL "probes: {a: {group: zmin, take: maximum}}", "4:33: probes.a.take: "},
      {MINIMAL "probes: {a: {node: 1, take: max}}",
       "4:23: probes.a.take: a node has one value: take is for a group or the whole body"},
      {MINIMAL "probes: {a: {point: [0, 0, 0], take: max}}",
       "4:32: probes.a.take: a point has one value"},
      {MINIMAL "probes: {a: {group: zmin, of: reaction, take: max}}",
       "4:47: probes.a.take: a reaction is the sum over its group: it has no max"},
      {MINIMAL "probes: {a: {of: elastic, take: mean}}",
       "4:33: probes.a.take: elastic is the sum over the body: it has no mean"},
      {MINIMAL "probes: {a: {group: zmin, about: [0, 0, 0]}}",
       "4:27: probes.a.about: a displacement has no moment: about is for reaction, force and "
       "angular_momentum"},
      {MINIMAL "probes: {a: {node: 1, of: stress, part: load}}",
       "4:35: probes.a.part: only a reaction has parts, not a stress"},
      {MINIMAL "probes: {a: {node: 1, component: xx}}",
       "4:34: probes.a.component: no component of a displacement, which are x to magnitude"},
      {MINIMAL "probes: {a: {of: reaction, component: x}}",
       "4:28: probes.a.component: a reaction has no components to choose from"},
      {MINIMAL "probes: {a: {node: 1, nearest: true}}",
       "4:23: probes.a.nearest: only a point has a nearest node"},
      {MINIMAL "probes: {a: {point: [0, 0, 0], of: reaction}}",
       "4:14: probes.a.point: a reaction is of nodes: give a node or a group, or neither"},
      {MINIMAL "probes: {a: {node: 1, of: volume}}",
       "4:14: probes.a.node: a volume is of tets: give a group, or none"},
      {MINIMAL "probes: {a: {group: zmin, of: dissipated}}",
       "4:14: probes.a.group: dissipated is of the whole body: leave out the group"},
  };
  for (size_t i = 0; i < sizeof r / sizeof *r; i++) refuse(r[i].text, r[i].message);
}

static void what_does_not_fit_the_mesh(void **state) {
  (void)state;
  static const refusal r[] = {
      {MINIMAL "probes: {a: {group: zmim, of: reaction}}",
       "4:21: probes.a.group: no group zmim; did you mean zmin?"},
      {MINIMAL "probes: {a: {node: 12, of: stress}}", "4:20: probes.a.node: the mesh has 12 nodes"},
      {MINIMAL "groups: {two: {nodes: [0, 5]}}\nprobes: {a: {group: two, of: stress}}",
       "5:21: probes.a.group: group 'two' has neither tets nor faces for a stress (2 nodes)"},
      {MINIMAL "probes: {a: {group: zmin, of: elastic}}",
       "4:21: probes.a.group: group 'zmin' has no tets for elastic (4 nodes, 2 faces)"},
  };
  for (size_t i = 0; i < sizeof r / sizeof *r; i++) {
    corot_mesh *mesh = NULL;
    corot_model *model = NULL;
    scenario *s = accept(r[i].text);
    assert_fails(scenario_build(s, &mesh, NULL, &model), COROT_EFORMAT, r[i].message);
    scenario_destroy(s);
  }
}

/* --- Memory --- */

static corot_status make(void *context) {
  const scene *s = context;
  probes *p = NULL;
  corot_status status = probes_create(s->scenario, s->model, &p);
  probes_destroy(p);
  return status;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  for (int order = 1; order <= 2; order++) {
    scene s = open_scene(order,
                         "  in: {point: [0.03, 0.041, 0.123]}\n  out: {point: [1, 1, 1]}\n"
                         "  r: {of: reaction}\n  v: {of: velocity, take: max}\n"
                         "  k: {group: top, of: kinetic}\n  s: {of: stress, take: max}\n"
                         "  f: {group: base, of: von_mises}\n  n: {node: 3, of: det}\n"
                         "  t: {group: base, of: traction, take: max}\n",
                         0);
    assert_true(assert_survives_failed_allocations(make, &s) >= 40);
    close_scene(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nodes_are_summed),
      cmocka_unit_test(points_are_not_moved_to_nodes),
      cmocka_unit_test(forces_are_summed),
      cmocka_unit_test(tets_are_summed),
      cmocka_unit_test(places_between_tets_have_means),
      cmocka_unit_test(momenta_and_energies_are_those_of_the_ledger),
      cmocka_unit_test(frames_turn_with_the_body),
      cmocka_unit_test(tractions_are_what_the_supports_bear),
      cmocka_unit_test(tractions_in_closed_form),
      cmocka_unit_test(tractions_are_of_faces),
      cmocka_unit_test(what_does_not_go_together),
      cmocka_unit_test(what_does_not_fit_the_mesh),
      cmocka_unit_test(failed_allocations_are_survived),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* What a study makes of its runs, on runs whose errors are known beforehand. */
#include "alloc.h"
#include "app/folder/hash.h"
#include "study/execute/store.h"
#include "study/measure/collect.h"
#include "study/measure/collect_quantities.h"
#include "study/measure/errors.h"
#include "study/measure/fit.h"
#include "study/plan/json_file.h"
#include "study/tables/write_tables.h"
#include "study_text.h"

/* --- Solutions made up: u = (1 + e) t a, v = (1 + 2 e) a --- */

typedef struct solid {
  scenario *s;
  yardstick *y;
  double *a; /* [n] */
  int n;
} solid;

static solid solid_of(const char *more) {
  solid b = {0};
  char text[1024];
  snprintf(text, sizeof text, "%s%s", FREE_CUBE, more);
  assert_ok(scenario_read_text("cube.yaml", text, strlen(text), 0, NULL, &b.s));
  assert_ok(yardstick_create(b.s, &b.y));
  b.n = corot_model_ndof(b.y->model);
  b.a = calloc((size_t)b.n + 1, sizeof *b.a);
  for (int i = 0; i < b.n; i++) b.a[i] = 0.1 * sin(i + 1);
  return b;
}

static void solid_free(solid *b) {
  yardstick_destroy(b->y);
  scenario_destroy(b->s);
  free(b->a);
}

static const double times[] = {0, 0.5, 1};

static void write_solution(const solid *b, const char *dir, double e) {
  double *u = calloc(2 * (size_t)b->n, sizeof *u), *v = u + b->n;
  state_writer *w = NULL;
  assert_ok(states_create(dir, b->y->model, &w));
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < b->n; i++)
      u[i] = (1 + e) * times[k] * b->a[i], v[i] = (1 + 2 * e) * b->a[i];
    assert_ok(states_add(w, times[k], u, v));
  }
  assert_ok(states_close(w));
  free(u);
}

static trajectory solution(const solid *b, double e) {
  char *dir = temporary_folder();
  trajectory t;
  write_solution(b, dir, e);
  assert_ok(states_read(dir, &t));
  remove_folder(dir);
  return t;
}

/* mescd of a solution with this e: -log10 of it. */
static double mixed(const solid *b, double e) {
  double worst = 0, length = 0.01 * corot_model_length(b->y->model);
  double speed = length * corot_model_frequency(b->y->model);
  for (int i = 0; i < b->n; i++) {
    double a = fabs(b->a[i]);
    worst = fmax(worst, fmax(e * a / (length + a), 2 * e * a / (speed + a)));
  }
  return worst;
}

static double at_corner(const solid *b) {
  const int *dof = corot_model_dof(b->y->model)[b->y->probe[0].node[0]];
  double square = 0;
  for (int c = 0; c < 3; c++) square += b->a[dof[c]] * b->a[dof[c]];
  return sqrt(square);
}

/* --- Errors --- */

static void errors_in_closed_form(void **state) {
  (void)state;
  solid b = solid_of("");
  trajectory r = solution(&b, 0), t = solution(&b, 0.01);
  errors e;
  assert_ok(errors_measure(b.y, &t, &r, &e));
  /* differences of numbers of size 0.1, relative to 0.001: 1e-13 */
  assert_close(e.of[ERROR_DISPLACEMENT].max, 0.01, 1e-12, 0);
  assert_close(e.of[ERROR_DISPLACEMENT].end, 0.01, 1e-12, 0);
  assert_close(e.of[ERROR_VELOCITY].max, 0.02, 1e-12, 0);
  assert_close(e.of[ERROR_ENERGY].end, 0.01, 1e-12, 0);
  assert_close(e.of[ERROR_MIXED].end, mixed(&b, 0.01), 1e-12, 0);
  assert_int_equal(e.n, ERROR_PROBES + 1);
  assert_close(e.of[ERROR_PROBES].max, 0.01 * at_corner(&b), 1e-12, 0);
  assert_close(e.parting, 0.5, 0, 0); /* 0.005 is above 1e-3 */
  errors_free(&e);

  /* the largest over time is not that at the end, where the two meet again */
  for (int i = 0; i < t.n; i++) {
    t.record[2 * (size_t)(1 + 2 * t.n) + 1 + (size_t)i] = b.a[i];
    t.record[2 * (size_t)(1 + 2 * t.n) + 1 + (size_t)(t.n + i)] = b.a[i];
  }
  assert_ok(errors_measure(b.y, &t, &r, &e));
  assert_close(e.of[ERROR_DISPLACEMENT].max, 0.005, 1e-12, 0);
  assert_close(e.of[ERROR_DISPLACEMENT].end, 0, 0, 0);
  assert_close(e.of[ERROR_VELOCITY].max, 0.02, 1e-12, 0);
  errors_free(&e);
  states_free(&t);
  states_free(&r);
  solid_free(&b);
}

/* Uniaxial strain e against shear g of a unit volume: energies (lambda / 2 + mu) e^2, mu g^2 / 2.
 */
static void energy_of_homogeneous_strains(void **state) {
  (void)state;
  solid b = solid_of("");
  trajectory r = solution(&b, 0), t = solution(&b, 0);
  const double lambda = 300, mu = 100, stretch = 0.02, shear = 0.003;
  for (int k = 0; k < 3; k++) {
    double *ru = r.record + (size_t)k * (size_t)(1 + 2 * r.n) + 1;
    double *tu = t.record + (size_t)k * (size_t)(1 + 2 * t.n) + 1;
    for (int i = 0; i < r.n; i++) {
      const double *x = b.y->mesh->x[r.place[i] / 3];
      ru[i] = r.place[i] % 3 == 0 ? stretch * x[0] : 0;
      tu[i] = ru[i] + (r.place[i] % 3 == 1 ? shear * x[2] : 0);
    }
  }
  errors e;
  assert_ok(errors_measure(b.y, &t, &r, &e));
  double ratio = shear / stretch * sqrt(mu / (lambda + 2 * mu));
  assert_close(e.of[ERROR_ENERGY].max, ratio, 1e-10, 0);
  errors_free(&e);
  states_free(&t);
  states_free(&r);
  solid_free(&b);
}

/* Nodes of the coarser mesh are the first of the finer: a field linear in space is the same. */
static void against_a_finer_mesh(void **state) {
  (void)state;
  solid coarse = solid_of(""), fine = solid_of("");
  solid_free(&fine);
  char *override[] = {(char *)"mesh.refine=1"};
  assert_ok(scenario_read_text("cube.yaml", FREE_CUBE, strlen(FREE_CUBE), 1, override, &fine.s));
  assert_ok(yardstick_create(fine.s, &fine.y));
  fine.n = corot_model_ndof(fine.y->model);
  fine.a = calloc((size_t)fine.n, sizeof *fine.a);
  assert_true(fine.n > coarse.n);
  for (int i = 0; i < coarse.n; i++) fine.a[i] = coarse.a[i];
  trajectory t = solution(&coarse, 0.01), r = solution(&fine, 0);
  errors e;
  assert_ok(errors_measure(coarse.y, &t, &r, &e));
  assert_close(e.of[ERROR_DISPLACEMENT].max, 0.01, 1e-12, 0);
  errors_free(&e);
  assert_fails(errors_measure(fine.y, &r, &t, &e), COROT_EINVAL, "the reference has no free");
  assert_fails(errors_measure(fine.y, &t, &r, &e), COROT_EINVAL, "of a model of");
  r.count--;
  assert_fails(errors_measure(coarse.y, &t, &r, &e), COROT_EINVAL, "its reference at 0.5 s");
  r.count++;
  states_free(&t);
  states_free(&r);
  solid_free(&coarse);
  solid_free(&fine);
}

static void drift_of_the_books(void **state) {
  (void)state;
  char *dir = temporary_folder();
  solid b = solid_of("");
  drift d;
  /* mass 2 under gravity 10: a momentum of -20 t; the row at 0.5 has 1 % more */
  put_file(in(dir, "energy.csv"),
           "t,kinetic,elastic,dissipated,external_work,balance,frame_energy,px,py,pz,lx,ly,lz\n"
           "0,0,0,0,0,0,0,0,0,0,0,0,0\n"
           "0.5,30,10,0,50,-0.5,0,0,0,-10.1,0,0,0\n"
           "1,70,5,25,100,0.25,0,0,0,-20,0,0,0\n");
  assert_ok(drift_measure(b.y, b.s, dir, &d));
  assert_close(d.energy, 0.5 / 100, 1e-12, 0);
  assert_close(d.momentum, 0.1 / 20, 1e-9, 0); /* the impulse is a sum of forces of the nodes */
  put_file(in(dir, "energy.csv"), "t,kinetic\n");
  assert_fails(drift_measure(b.y, b.s, dir, &d), COROT_EFORMAT, "not a table of energies");
  solid_free(&b);

  b = solid_of("boundary: [{group: zmin, fix: [z]}]\n");
  put_file(in(dir, "energy.csv"),
           "t,kinetic,elastic,dissipated,external_work,balance,frame_energy,px,py,pz,lx,ly,lz\n"
           "0,0,0,0,0,0,0,0,0,0,0,0,0\n");
  assert_ok(drift_measure(b.y, b.s, dir, &d));
  assert_true(isnan(d.momentum) && isnan(d.energy));
  solid_free(&b);
  remove_folder(dir);
}

/* A mass of 2 thrown at 3 along z, under a gravity that falls from -10 to 0 at 0.4 s, and swings
   along x: a momentum of 6 - 20 t up to the fall, and (1 - cos 2 pi t) / pi along x. */
static void drift_under_loads_that_jump_and_swing(void **state) {
  (void)state;
  char *dir = temporary_folder();
  char *set = (char[]){
      "loads=[{gravity: [0, 0, -10], amplitude: [[0.4, 1], [0.4, 0]]}, "
      "{gravity: [1, 0, 0], amplitude: {sine: {frequency: 1}}}]"};
  solid b = {0};
  drift d;
  assert_ok(scenario_read_text("cube.yaml", FREE_CUBE, strlen(FREE_CUBE), 1, &set, &b.s));
  assert_ok(yardstick_create(b.s, &b.y));
  put_file(in(dir, "energy.csv"),
           "t,kinetic,elastic,dissipated,external_work,balance,frame_energy,px,py,pz,lx,ly,lz\n"
           "0,0,0,0,0,0,0,0,0,6,0,0,0\n"
           "0.25,0,0,0,0,0,0,0.318309886183791,0,1,0,0,0\n"
           "0.5,0,0,0,0,0,0,0.636619772367581,0,-2,0,0,0\n"
           "1,0,0,0,0,0,0,0,0,-2,0,0,0\n");
  assert_ok(drift_measure(b.y, b.s, dir, &d));
  assert_below(d.momentum, 1e-10);
  solid_free(&b);
  remove_folder(dir);
}

/* --- Fits --- */

static void power_laws(void **state) {
  (void)state;
  char words[64];
  const double tolerance[] = {1e-2, 1e-3, 1e-4, 1e-5};
  double error[4];
  for (int i = 0; i < 4; i++) error[i] = 7 * pow(tolerance[i], 1.1);
  power_fit f = fit_power(4, tolerance, error);
  assert_close(f.exponent, 1.1, 1e-12, 0);
  assert_close(f.constant, 7, 1e-10, 0);
  assert_close(f.residual, 0, 0, 1e-12);
  fit_verdict(&f, true, sizeof words, words);
  assert_string_equal(words, "proportional");
  fit_verdict(&f, false, sizeof words, words);
  assert_string_equal(words, "order 1.10");

  /* off by a decade, up and down: the line of tolerance^1 stays, and 1 is left */
  for (int i = 0; i < 4; i++) error[i] = tolerance[i] * (i == 0 || i == 3 ? 10 : 0.1);
  f = fit_power(4, tolerance, error);
  assert_close(f.exponent, 1, 1e-12, 0);
  assert_close(f.constant, 1, 1e-10, 0);
  assert_close(f.residual, 1, 1e-12, 0);
  fit_verdict(&f, true, sizeof words, words);
  assert_string_equal(words, "proportional, irregular");

  for (int i = 0; i < 4; i++) error[i] = pow(tolerance[i], 0.5);
  f = fit_power(4, tolerance, error);
  fit_verdict(&f, true, sizeof words, words);
  assert_string_equal(words, "falls slower than the tolerance");
  f = fit_power(1, tolerance, error);
  assert_true(isnan(f.exponent));
  fit_verdict(&f, true, sizeof words, words);
  assert_string_equal(words, "too few points to say: 1");
}

/* --- Known values --- */

/* Of three quantities that should be 10 within 1, -4 within 1 relative to 8, and 2; the fourth has
   no known value. In eighths, which are exact. */
static void errors_against_known_values(void **state) {
  (void)state;
  study_quantity q[] = {{"a@end", "a", true, 10, 1, 10},
                        {"b@end", "b", true, -4, 1, 8},
                        {"c@end", "c", true, 2, 0, 2},
                        {.text = "d@end", .name = "d"}};
  const manifest m = {.nquantity = 4, .quantity = q};
  static const struct {
    double value[4], error[3], total, floor;
    bool rated[4]; /* of the three, and of the total */
  } of[] = {
      /* the largest is rated, and what the others may be is less */
      {{15, -4.5, 2, 7}, {0.5, -0.0625, 0}, 0.5, 0.1, {true, false, true, true}},
      {{5, -4, 2, 7}, {-0.5, 0, 0}, 0.5, 0.1, {true, false, true, true}},
      /* none is larger than what is known of b: the total is at most that */
      {{10, -4.5, 2.125, 7}, {0, -0.0625, 0.0625}, 0.0625, 0.125, {false, false, true, false}},
  };
  for (size_t i = 0; i < sizeof of / sizeof *of; i++) {
    quantity_error *off = NULL;
    assert_ok(quantities_rate(&m, of[i].value, NULL, NULL, &off));
    for (int k = 0; k < 3; k++) {
      assert_true(off[k].known);
      assert_close(off[k].error, of[i].error[k], 1e-15, 0);
      assert_int_equal(quantity_is_rated(&off[k]), of[i].rated[k]);
    }
    assert_true(!off[3].known && isnan(off[3].error));
    assert_close(off[4].error, of[i].total, 1e-15, 0);
    assert_close(off[4].floor, of[i].floor, 1e-15, 0);
    assert_int_equal(quantity_is_rated(&off[4]), of[i].rated[3]);
    free(off);
  }
  /* a value that is not there leaves no total */
  quantity_error *off = NULL;
  const double value[] = {10, NAN, 2, 7}, reference[] = {1, 1, 1, 8}, floor[] = {1e-3, 1, 1, 1e-3};
  assert_ok(quantities_rate(&m, value, reference, floor, &off));
  assert_true(isnan(off[4].error) && !quantity_is_rated(&off[4]));
  /* what has no known value is held against the reference, by ten times its floor */
  assert_close(off[3].error, 0.125, 1e-15, 0);
  assert_true(quantity_is_rated(&off[3]));
  off[3].floor = 0.02;
  assert_false(quantity_is_rated(&off[3]));
  free(off);
}

/* --- A whole study whose runs are made up --- */

static const char two_series[] =
    "axes: [{key: integrator.method, values: [cvode, ida]},\n"
    "       {key: integrator.rtol, values: [1e-1, 1e-2, 1e-3, 1e-4]}]\n";

static void put_result(const char *dir, const manifest *m, const study_run *run, double cpu) {
  scenario *s = NULL;
  corot_mesh *mesh = NULL;
  corot_model *model = NULL;
  char digest[HASH_SIZE];
  assert_ok(scenario_read(m->base, run->nset, (char *const *)run->set, &s));
  assert_ok(scenario_build(s, &mesh, NULL, &model));
  hash_mesh(mesh, digest);
  json_t *result = json_pack("{s:s, s:i, s:{s:s, s:s}, s:O, s:{s:i, s:i, s:i, s:i}, s:{s:f, s:f}}",
                             "status", "ok", "exit_code", 0, "hashes", "run", run->hash, "mesh",
                             digest, "scenario", s->resolved, "statistics", "nst", 10, "nfe", 20,
                             "nfactor", 3, "nsolve", 15, "timings", "cpu", cpu, "wall", 2 * cpu);
  assert_ok(json_file_write(dir, "result.json", result));
  json_decref(result);
  corot_model_destroy(model);
  corot_mesh_destroy(mesh);
  scenario_destroy(s);
}

static void put_run(const solid *b, const char *dir, const manifest *m, int i, double e,
                    double cpu) {
  char *folder = store_path(dir, &m->run[i], "");
  assert_ok(store_clear(dir, &m->run[i]));
  put_result(folder, m, &m->run[i], cpu);
  put_file(in(folder, "energy.csv"),
           "t,kinetic,elastic,dissipated,external_work,balance,frame_energy,px,py,pz,lx,ly,lz\n"
           "0,4,0,0,0,0.01,0,0,0,0,0,0,0\n");
  write_solution(b, folder, e);
  free(folder);
}

/* error = constant * tolerance^exponent, and what each run costs. */
static const struct { double constant, exponent, cpu; } made_up[] = {{0.5, 1, 1}, {3, 2, 3}};

/* The references differ by `apart`. */
static manifest *make_up_of(const solid *b, const char *dir, const char *lines, double apart) {
  manifest *m = planned(dir, lines);
  assert_int_equal(m->ncell, 8);
  assert_int_equal(m->nreference, 1);
  put_run(b, dir, m, m->reference[0].run[0], 0, 100);
  put_run(b, dir, m, m->reference[0].run[1], apart, 100);
  for (int i = 0; i < m->ncell; i++) {
    int series = i / 4;
    put_run(b, dir, m, m->cell[i].run,
            made_up[series].constant * pow(m->cell[i].tolerance, made_up[series].exponent),
            made_up[series].cpu * (1 << i % 4));
  }
  return m;
}

static manifest *make_up(const solid *b, const char *dir, double apart) {
  return make_up_of(b, dir, two_series, apart);
}

static double number(const json_t *object, const char *key) {
  const json_t *value = json_object_get(object, key);
  return json_is_number(value) ? json_number_value(value) : NAN;
}

static const char *text(const json_t *object, const char *key) {
  return json_string_value(json_object_get(object, key));
}

static void errors_fits_and_rankings(void **state) {
  (void)state;
  char *dir = temporary_folder();
  solid b = solid_of("");
  const double floor = 1e-6;
  manifest *m = make_up(&b, dir, floor);
  json_t *table = NULL;
  int ndamaged;
  assert_ok(collect_table(m, dir, false, &table, &ndamaged));

  const json_t *cells = json_object_get(table, "cells");
  for (int i = 0; i < 8; i++) {
    const json_t *c = json_array_get(cells, (size_t)i), *error = json_object_get(c, "error");
    double e = made_up[i / 4].constant * pow(10, -(1 + i % 4) * made_up[i / 4].exponent);
    assert_string_equal(text(c, "series"), i < 4 ? "cvode" : "ida");
    /* 1 + e is rounded */
    assert_close(number(error, "displacement"), e, 1e-12, 1e-15);
    assert_close(number(error, "velocity_end"), 2 * e, 1e-12, 1e-15);
    assert_close(number(error, "probe.corner"), e * at_corner(&b), 1e-12, 1e-16);
    bool rated = e >= 10 * floor;
    assert_int_equal(json_is_true(json_object_get(c, "below_floor")), !rated);
    assert_int_equal(json_array_size(json_object_get(c, "unrated")), rated ? 0 : 5);
    if (rated) assert_close(number(c, "digits"), -log10(mixed(&b, e)), 1e-10, 0);
    if (!rated) assert_true(json_is_null(json_object_get(c, "digits")));
    assert_close(number(json_object_get(c, "cost"), "cpu"), made_up[i / 4].cpu * (1 << i % 4), 0,
                 0);
    assert_close(number(json_object_get(c, "drift"), "energy"), 0.0025, 1e-15, 0);
  }

  const json_t *fits = json_object_get(table, "fits"), *f = json_array_get(fits, 0);
  assert_int_equal(json_array_size(fits), 2);
  assert_int_equal(number(f, "points"), 4);
  assert_close(number(f, "exponent"), 1, 1e-10, 0);
  assert_close(number(f, "constant"), 0.5, 1e-9, 0);
  assert_string_equal(text(f, "verdict"), "proportional");
  f = json_array_get(fits, 1);
  assert_int_equal(number(f, "points"), 2); /* the others are below the floor */
  assert_close(number(f, "exponent"), 2, 1e-10, 0);
  assert_close(number(f, "constant"), 3, 1e-9, 0);

  static const struct {
    double error, tolerance, cost, second_tolerance, second_cost;
  } ranked[] = {{1e-1, 1e-1, 1, 1e-1, 3},
                {1e-2, 1e-2, 2, 1e-2, 6},
                {1e-3, 1e-3, 4, 1e-2, 6},
                {1e-4, 1e-4, 8, 1e-3, 12}};
  const json_t *rankings = json_object_get(table, "rankings");
  for (size_t i = 0; i < 4; i++) {
    const json_t *entry = json_array_get(rankings, i), *best = json_object_get(entry, "best");
    assert_close(number(entry, "error"), ranked[i].error, 0, 0);
    assert_string_equal(text(json_array_get(best, 0), "series"), "cvode");
    assert_close(number(json_array_get(best, 0), "tolerance"), ranked[i].tolerance, 0, 0);
    assert_close(number(json_array_get(best, 0), "cost"), ranked[i].cost, 0, 0);
    assert_string_equal(text(json_array_get(best, 1), "series"), "ida");
    assert_close(number(json_array_get(best, 1), "tolerance"), ranked[i].second_tolerance, 0, 0);
    assert_close(number(json_array_get(best, 1), "cost"), ranked[i].second_cost, 0, 0);
  }
  /* 3e-6, and what the reference is not known by, is at most 1e-5; 3e-8 is not known as 1e-6 */
  assert_int_equal(json_array_size(rankings), 5);

  const json_t *r = json_array_get(json_object_get(table, "references"), 0);
  assert_true(json_is_true(json_object_get(r, "agree")));
  assert_close(number(json_object_get(r, "floor"), "displacement"), floor, 1e-9, 0);
  json_decref(table);
  manifest_destroy(m);
  solid_free(&b);
  remove_folder(dir);
}

/* Gives a run that is there a value; NaN: none. */
static void put_quantity(const char *dir, const study_run *run, const char *name, double value) {
  char *folder = store_path(dir, run, ""), *path = store_path(dir, run, "result.json");
  json_t *result = NULL;
  assert_ok(json_file_read(path, &result));
  json_t *all =
      json_pack("{s:{s:o}}", name, "value", isnan(value) ? json_null() : json_real(value));
  json_object_set_new(result, "quantities", all);
  assert_ok(json_file_write(folder, "result.json", result));
  json_decref(result);
  free(path);
  free(folder);
}

/* A quantity of 4 whose error is 2 tolerance^3, of which the references know a part of 1e-11; the
   last cell has none. The norms say what they say without it. */
static void quantities_are_measured(void **state) {
  (void)state;
  for (int second = 0; second < 2; second++) { /* the study's measure, or beside it */
    char *dir = temporary_folder(), lines[512];
    solid b = solid_of("");
    snprintf(lines, sizeof lines, "%smeasure: [%smax(corner.ux)]\n", two_series,
             second ? "displacement, " : "");
    manifest *m = make_up_of(&b, dir, lines, 1e-6);
    const char *name = m->quantity[0].name, *of = "max(corner.ux)";
    put_quantity(dir, &m->run[m->reference[0].run[0]], name, -4);
    put_quantity(dir, &m->run[m->reference[0].run[1]], name, -4 * (1 + 1e-11));
    for (int i = 0; i < m->ncell; i++)
      put_quantity(dir, &m->run[m->cell[i].run], name,
                   i == 7 ? NAN : -4 * (1 + 2 * pow(m->cell[i].tolerance, 3)));
    json_t *table = NULL;
    int ndamaged;
    assert_ok(collect_table(m, dir, false, &table, &ndamaged));

    for (int i = 0; i < 8; i++) {
      const json_t *c = json_array_get(json_object_get(table, "cells"), (size_t)i);
      double e = 2 * pow(10, -3 * (1 + i % 4)),
             e_norm = number(json_object_get(c, "error"), "displacement");
      assert_close(e_norm,
                   made_up[i / 4].constant * pow(10, -(1 + i % 4) * made_up[i / 4].exponent), 1e-12,
                   1e-15);
      assert_false(json_is_true(json_object_get(c, "below_floor")) &&
                   (second ? e_norm >= 1e-5 : e >= 1e-10));
      if (i == 7) {
        assert_true(json_is_null(json_object_get(json_object_get(c, "quantity"), of)));
        assert_true(json_is_null(json_object_get(json_object_get(c, "error"), of)));
        continue;
      }
      assert_close(number(json_object_get(c, "quantity"), of), -4 * (1 + e), 1e-15, 0);
      assert_close(number(json_object_get(c, "error"), of), e, 0, 1e-15);
    }
    const json_t *r = json_array_get(json_object_get(table, "references"), 0);
    assert_close(number(json_object_get(r, "quantity"), of), -4, 0, 0);
    assert_close(number(json_object_get(r, "floor"), of), 1e-11, 1e-4, 0);

    /* its own fits, of the three points above the floor: where it is no measure, beside those */
    const json_t *fits = json_object_get(table, second ? "quantity_fits" : "fits");
    assert_int_equal(json_array_size(fits), 2);
    assert_int_equal(json_array_size(json_object_get(table, "quantity_fits")), second ? 2 : 0);
    for (size_t i = 0; i < 2; i++) {
      assert_int_equal(number(json_array_get(fits, i), "points"), 3);
      assert_close(number(json_array_get(fits, i), "exponent"), 3, 1e-6, 0);
    }
    if (second) assert_string_equal(text(json_array_get(fits, 0), "measure"), of);
    json_decref(table);

    /* and in the flat tables */
    assert_ok(write_tables(m, dir, false, NULL, &ndamaged));
    char *csv = slurp(in(dir, "table.csv"), NULL);
    assert_non_null(strstr(csv, ",quantity.max(corner.ux),"));
    assert_non_null(strstr(csv, ",error.max(corner.ux),"));
    free(csv);
    manifest_destroy(m);
    solid_free(&b);
    remove_folder(dir);
  }
}

static void a_wrong_reference_is_caught(void **state) {
  (void)state;
  char *dir = temporary_folder();
  solid b = solid_of("");
  manifest *m = make_up(&b, dir, 0.05);
  json_t *table = NULL;
  int ndamaged;
  assert_ok(collect_table(m, dir, false, &table, &ndamaged));
  const json_t *r = json_array_get(json_object_get(table, "references"), 0);
  assert_true(json_is_false(json_object_get(r, "agree")));
  assert_close(number(r, "parts_at"), 0.5, 0, 0);
  assert_non_null(strstr(text(r, "note"), "cvode and arkode part ways: from t = 0.5 s"));
  for (size_t i = 0; i < 8; i++) {
    const json_t *c = json_array_get(json_object_get(table, "cells"), i);
    assert_true(json_is_true(json_object_get(c, "below_floor")));
    assert_true(json_is_null(json_object_get(c, "digits")));
  }
  assert_int_equal(number(json_array_get(json_object_get(table, "fits"), 0), "points"), 0);
  json_decref(table);
  manifest_destroy(m);
  solid_free(&b);
  remove_folder(dir);
}

/* Missing, failed, changed, of another version, without states: said, and no matter to the rest. */
static void what_cannot_be_said(void **state) {
  (void)state;
  char *dir = temporary_folder();
  solid b = solid_of("");
  manifest *m = make_up(&b, dir, 1e-6);
  const study_run *run[4];
  for (int i = 0; i < 4; i++) run[i] = &m->run[m->cell[i].run];
  assert_ok(store_clear(dir, run[0]));
  assert_ok(store_clear(dir, run[1]));
  assert_ok(store_fail(dir, run[0], -11, "killed by signal 11")); /* is tried again */
  assert_ok(store_fail(dir, run[1], 4, "gave up"));
  char *path = store_path(dir, run[2], "states.bin");
  assert_int_equal(truncate(path, 1500), 0);
  free(path);
  study_run other = *run[3]; /* as another version would call it */
  other.hash = run[0]->hash;
  assert_ok(store_clear(dir, run[3]));
  assert_ok(store_fail(dir, &other, 4, "gave up"));

  json_t *table = NULL;
  int ndamaged;
  assert_ok(collect_table(m, dir, false, &table, &ndamaged));
  const json_t *cells = json_object_get(table, "cells"), *c[8];
  for (size_t i = 0; i < 8; i++) c[i] = json_array_get(cells, i);
  assert_string_equal(text(c[0], "status"), "missing");
  assert_string_equal(text(c[0], "reason"), "killed by signal 11");
  assert_true(json_is_null(json_object_get(c[0], "cost")));
  assert_string_equal(text(c[1], "status"), "failed");
  assert_string_equal(text(c[1], "reason"), "gave up");
  assert_string_equal(text(c[2], "status"), "done");
  assert_true(json_is_null(json_object_get(c[2], "error")));
  assert_non_null(strstr(text(c[2], "note"), "its reference at 1 s"));
  assert_string_equal(text(c[3], "status"), "missing");
  assert_close(number(json_object_get(c[4], "error"), "displacement"), 0.03, 1e-12, 0);
  json_decref(table);
  manifest_destroy(m);
  solid_free(&b);
  remove_folder(dir);
}

static void medians_of_repetitions(void **state) {
  (void)state;
  char *dir = temporary_folder();
  solid b = solid_of("");
  manifest *m = make_up(&b, dir, 1e-6);
  const double cpu[] = {3, 1, 2, 8};
  timings t = {0};
  for (int i = 0; i < 4; i++)
    assert_ok(timings_add(dir, &m->run[m->cell[0].run], &t, cpu[i], 10 * cpu[i], NULL));
  timings_free(&t);
  json_t *table = NULL;
  int ndamaged;
  assert_ok(collect_table(m, dir, false, &table, &ndamaged));
  const json_t *c = json_array_get(json_object_get(table, "cells"), 0);
  const json_t *cost = json_object_get(c, "cost");
  assert_int_equal(number(cost, "repeats"), 4);
  assert_close(number(cost, "cpu"), 2.5, 0, 0);
  assert_close(number(cost, "cpu_min"), 1, 0, 0);
  assert_close(number(cost, "wall_max"), 80, 0, 0);
  json_decref(table);
  manifest_destroy(m);
  solid_free(&b);
  remove_folder(dir);
}

/* --- Memory --- */

typedef struct collecting {
  const manifest *m;
  const char *dir;
} collecting;

static corot_status collect_once(void *context) {
  const collecting *c = context;
  int ndamaged;
  return write_tables(c->m, c->dir, false, NULL, &ndamaged);
}

static void failed_allocations(void **state) {
  (void)state;
  char *dir = temporary_folder();
  solid b = solid_of("");
  manifest *m = make_up(&b, dir, 1e-6);
  m->ncell = 2; /* enough, and faster */
  collecting c = {m, dir};
  assert_survives_failed_allocations(collect_once, &c);
  m->ncell = 8;
  manifest_destroy(m);
  solid_free(&b);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(errors_in_closed_form),
      cmocka_unit_test(energy_of_homogeneous_strains),
      cmocka_unit_test(against_a_finer_mesh),
      cmocka_unit_test(drift_of_the_books),
      cmocka_unit_test(drift_under_loads_that_jump_and_swing),
      cmocka_unit_test(power_laws),
      cmocka_unit_test(errors_against_known_values),
      cmocka_unit_test(errors_fits_and_rankings),
      cmocka_unit_test(quantities_are_measured),
      cmocka_unit_test(a_wrong_reference_is_caught),
      cmocka_unit_test(what_cannot_be_said),
      cmocka_unit_test(medians_of_repetitions),
      cmocka_unit_test(failed_allocations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

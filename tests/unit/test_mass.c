/* Lumped and consistent mass: what they are, what they keep, M^-1, and every integrator with them.
 */
#include <corot/integrate.h>
#include <corot/solve.h>
#include <nvector/nvector_serial.h>

#include "alloc.h"
#include "solid.h"
#include "solve/sundials/sun_compat.h"

/* A box of two materials, the upper half heavier and more damped. `hold`: one face held, two more
   in one component each, so that x, y and z have different free nodes. */
static body two_materials(corot_mass mass, bool hold, corot_mesh *mesh) {
  double low[3] = {-10, -10, -10}, high[3] = {10, 10, 10};
  high[2] = mesh->x[mesh->nnode / 2][2];
  assert_ok(corot_mesh_group_box(mesh, "lower", low, high, 0));
  corot_material material[2] = {soft, soft};
  material[0].group = "lower", material[0].damping_mass = 0.3;
  material[1].density *= 3, material[1].damping_mass = 2;
  corot_fix fix[] = {{"zmin", {true, true, true}}, {"xmin", {true}}, {"ymin", {false, true}}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 2, def.material = material, def.mass = mass;
  def.nfix = hold ? 3 : 0, def.fix = fix;
  return make_body(mesh, def);
}

static body crooked(corot_mass mass, bool hold) {
  return two_materials(mass, hold, crooked_box(2, 3, 4));
}

static double *vectors(const body *b, int count) { return calloc(count * b->n, sizeof(double)); }

static void fill(int n, double *x, uint64_t seed) {
  for (int i = 0; i < n; i++) x[i] = noise(&seed);
}

/* Of elements whose lumped mass is not the sum of a row, all rows together. */
static void rows_sum_to_the_lumped_mass(void **state) {
  (void)state;
  for (corot_mass kind = COROT_MASS_LUMPED; kind <= COROT_MASS_CONSISTENT; kind++) {
    body b = crooked(kind, false);
    assert_int_equal(corot_model_mass_kind(b.model), kind);
    const double *lumped = corot_model_mass(b.model);
    double *one = vectors(&b, 2), *sum = one + b.n, total[3] = {0}, whole[3] = {0};
    for (int i = 0; i < b.n; i++) one[i] = 1;
    corot_mass_multiply(b.model, one, sum);
    for (int c = 0; c < 3 && order_of_test() > 1; c++)
      for (int i = c; i < b.n; i += 3) {
        assert_above(lumped[i], 0);
        total[c] += sum[i] - lumped[i], whole[c] += lumped[i];
      }
    for (int c = 0; c < 3; c++) assert_close(total[c], 0, 0, 1e-13 * whole[c]);
    for (int i = 0; i < b.n && (order_of_test() == 1 || kind == COROT_MASS_LUMPED); i++)
      assert_close(sum[i], lumped[i], 1e-14, 0);
    free(one), drop_body(&b);
  }
}

/* M is symmetric and, beside the lumped mass L, no worse than in a single tet, where x' M x is
   between x' L x / 5 and x' L x (Wathen 1987). */
static void consistent_mass_is_symmetric_and_positive(void **state) {
  (void)state;
  body b = crooked(COROT_MASS_CONSISTENT, true);
  const double *lumped = corot_model_mass(b.model);
  double *x = vectors(&b, 4), *y = x + b.n, *Mx = y + b.n, *My = Mx + b.n;
  for (int k = 0; k < 20; k++) {
    fill(2 * b.n, x, k);
    corot_mass_multiply(b.model, x, Mx);
    corot_mass_multiply(b.model, y, My);
    double xLx = 0;
    for (int i = 0; i < b.n; i++) xLx += x[i] * lumped[i] * x[i];
    assert_close(inner(b.n, y, Mx), inner(b.n, x, My), 0, 1e-14 * xLx);
    assert_above(inner(b.n, x, Mx), xLx / 5);
    assert_below(inner(b.n, x, Mx), xLx);
  }
  free(x), drop_body(&b);
}

/* The part of the free degrees of freedom of a held body is that of the free body for the same
   velocities, zero where held. */
static void held_components_drop_out(void **state) {
  (void)state;
  body held = crooked(COROT_MASS_CONSISTENT, true), whole = crooked(COROT_MASS_CONSISTENT, false);
  const int(*dof)[3] = corot_model_dof(held.model), (*all)[3] = corot_model_dof(whole.model);
  double *x = vectors(&held, 2), *Mx = x + held.n, *y = vectors(&whole, 2), *My = y + whole.n;
  fill(held.n, x, 3);
  for (int n = 0; n < held.mesh->nnode; n++)
    for (int c = 0; c < 3; c++) y[all[n][c]] = dof[n][c] >= 0 ? x[dof[n][c]] : 0;
  corot_mass_multiply(held.model, x, Mx);
  corot_mass_multiply(whole.model, y, My);
  for (int n = 0; n < held.mesh->nnode; n++)
    for (int c = 0; c < 3; c++)
      if (dof[n][c] >= 0) assert_close(Mx[dof[n][c]], My[all[n][c]], 1e-15, 0);
  free(x), free(y), drop_body(&held), drop_body(&whole);
}

/* Integrals of x_i and x_i x_j over the box from `low`, of edges `size`. */
static double first_moment(const corot_box *b, int i) {
  double volume = b->size[0] * b->size[1] * b->size[2];
  return volume * (b->origin[i] + b->size[i] / 2);
}

static double second_moment(const corot_box *b, int i, int j) {
  double volume = b->size[0] * b->size[1] * b->size[2];
  double mi = b->origin[i] + b->size[i] / 2, mj = b->origin[j] + b->size[j] / 2;
  return volume * (mi * mj + (i == j) * b->size[i] * b->size[i] / 12);
}

/* Of a field that is linear in a tet of volume V, with the values v_i at its corners, the lumped
   mass makes sum |v|^2 larger by c V sum_{i<j} |v_i - v_j|^2: consistent mass has V/20 (S2 +
   |S1|^2) with the sums S1, S2 of v_i and |v_i|^2, row sums V/4 S2; in proportion to the diagonal,
   and the means of the corners on the edges, it is V (1/36 S2 + 1/27 (2 S2 + |S1|^2)). The sum is 4
   S2 - |S1|^2, so c = 1/20 and 7/540. */
static double lumping_adds(const corot_mesh *mesh, const double *v) {
  double edge[9], sum = 0;
  for (int e = 0; e < mesh->ntet; e++) {
    const int *node = mesh->tet[e];
    double square = 0;
    for (int k = 0; k < 9; k++) edge[k] = mesh->x[node[k / 3 + 1]][k % 3] - mesh->x[node[0]][k % 3];
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < i; j++)
        for (int c = 0; c < 3; c++) square += pow(v[3 * node[i] + c] - v[3 * node[j] + c], 2);
    sum += determinant(edge) / 6 * square;
  }
  return sum * (corot_mesh_order(mesh) == 1 ? 1. / 20 : 7. / 540);
}

/* v = A x + b is in the space of linear elements: consistent mass integrates its kinetic energy
   exactly, and its momenta. Lumping leaves the momentum, and puts a body's mass further out. */
static void linear_fields_are_integrated_exactly(void **state) {
  (void)state;
  static const double spin[9] = {0, -3, 2, 3, 0, -1, -2, 1, 0},
                      strain[9] = {1, 0.5, 0.2, 0.5, -2, 0.3, 0.2, 0.3, 0.7};
  const double *const gradients[] = {spin, strain}, drift[3] = {0.4, -1, 2};
  corot_box box = {.size = {0.5, 0.7, 1.1}, .cells = {2, 2, 3}, .origin = {0.1, -0.2, 0.3}};
  for (corot_mass kind = COROT_MASS_LUMPED; kind <= COROT_MASS_CONSISTENT; kind++)
    for (int g = 0; g < 2; g++) {
      const double *A = gradients[g];
      corot_mesh *mesh = box_of_order(&box);
      corot_model_def def = corot_model_defaults();
      def.nmaterial = 1, def.material = &soft, def.mass = kind;
      body b = make_body(mesh, def);
      double *u = vectors(&b, 2), *v = u + b.n;
      for (int n = 0; n < mesh->nnode; n++) {
        double Ax[3];
        apply(A, mesh->x[n], Ax);
        for (int c = 0; c < 3; c++) v[3 * n + c] = Ax[c] + drift[c];
      }
      corot_energies e;
      assert_ok(corot_energy(b.model, b.state, 0, u, v, &e));

      double kinetic = 0, momentum[3], angular[3] = {0}, xv[3][3]; /* xv = integral of x v' */
      double volume = box.size[0] * box.size[1] * box.size[2];
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
          xv[i][j] = first_moment(&box, i) * drift[j];
          for (int k = 0; k < 3; k++) xv[i][j] += A[3 * j + k] * second_moment(&box, i, k);
        }
      for (int i = 0; i < 3; i++) {
        momentum[i] = volume * drift[i];
        for (int k = 0; k < 3; k++) momentum[i] += A[3 * i + k] * first_moment(&box, k);
        int j = (i + 1) % 3, k = (i + 2) % 3;
        angular[i] = xv[j][k] - xv[k][j];
        kinetic += momentum[i] * drift[i];
        for (int l = 0; l < 3; l++) kinetic += A[3 * i + l] * xv[l][i];
      }
      kinetic *= soft.density / 2;
      bool exact = kind == COROT_MASS_CONSISTENT;
      if (!exact) kinetic += soft.density / 2 * lumping_adds(mesh, v);
      assert_close(e.kinetic, kinetic, 1e-13, 0);
      for (int c = 0; c < 3; c++) {
        assert_close(e.momentum[c], soft.density * momentum[c], 1e-13, 1e-10);
        if (exact) assert_close(e.angular_momentum[c], soft.density * angular[c], 1e-13, 1e-10);
      }
      free(u), drop_body(&b);
    }
}

/* The orders of four corners that do not turn a tet inside out. */
static const int even[12][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2}, {1, 0, 3, 2},
                                {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 0, 1, 3}, {2, 1, 3, 0},
                                {2, 3, 0, 1}, {3, 0, 2, 1}, {3, 1, 0, 2}, {3, 2, 1, 0}};

/* A tet of ten nodes by itself, with curved edges. */
static body single_tet(corot_mass mass, const int order[4]) {
  static const double x[4][3] = {{0, 0, 0}, {1, 0, 0.1}, {0.1, 1, 0}, {0, 0.1, 1}};
  corot_mesh *mesh;
  assert_ok(corot_mesh_create(4, x, 1, (const int(*)[4])order, &mesh));
  mesh = given_order(mesh, 2);
  bend_edges(mesh, 0.05);
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.mass = mass;
  return make_body(mesh, def);
}

/* In whatever order it names its corners: the products of a vector, and forces of a deformed state.
 */
static void a_tet_may_name_its_corners_in_any_order(void **state) {
  (void)state;
  double first[60], now[60], x[30], rest[30] = {0};
  fill(30, x, 12);
  for (int k = 0; k < 12; k++) {
    body b = single_tet(COROT_MASS_CONSISTENT, even[k]);
    corot_mass_multiply(b.model, x, now);
    for (int i = 0; i < 30; i++) x[i] *= 0.03;
    assert_ok(corot_residual(b.model, b.state, 0, x, rest, now + 30));
    for (int i = 0; i < 30; i++) x[i] /= 0.03;
    if (k == 0) memcpy(first, now, sizeof first);
    for (int i = 0; i < 60; i++)
      assert_close(now[i], first[i], 0, 1e-13 * norm_max(30, first + i / 30 * 30));
    drop_body(&b);
  }
}

/* In proportion to the diagonal of the consistent mass, and in sum the mass of the tet. */
static void a_curved_tet_is_lumped_by_its_diagonal(void **state) {
  (void)state;
  body lumped = single_tet(COROT_MASS_LUMPED, even[7]);
  body b = single_tet(COROT_MASS_CONSISTENT, even[7]);
  double *x = vectors(&b, 2), *Mx = x + b.n, diagonal[10], trace = 0;
  double whole = soft.density * corot_mesh_measure(b.mesh).volume;
  for (int n = 0; n < 10; n++) {
    x[3 * n] = 1;
    corot_mass_multiply(b.model, x, Mx);
    trace += diagonal[n] = Mx[3 * n];
    x[3 * n] = 0;
  }
  assert_above(fabs(diagonal[4] / diagonal[9] - 1), 0.01); /* so that it matters whose is whose */
  for (int i = 0; i < 30; i++)
    assert_close(corot_model_mass(lumped.model)[i], whole * diagonal[i / 3] / trace, 1e-13, 0);
  free(x), drop_body(&lumped), drop_body(&b);
}

/* Nodes on inner edges that are off the middle by so little that no shape shows it: a field that is
   linear is in the space still, and its energy that of the box. */
static void edges_that_are_hardly_curved_count(void **state) {
  (void)state;
  corot_box box = {.size = {1, 1, 1}, .cells = {2, 2, 2}};
  for (double bend = 1e-1; bend > 1e-11; bend *= 1e-3) {
    corot_mesh *mesh;
    assert_ok(corot_mesh_box(&box, &mesh));
    mesh = given_order(mesh, 2);
    for (int n = 0; n < mesh->nnode; n++) {
      bool inside = true, middle = false;
      for (int c = 0; c < 3; c++) {
        double quarters = 4 * mesh->x[n][c];
        inside = inside && quarters > 0.5 && quarters < 3.5;
        middle = middle || fabs(fmod(quarters, 2) - 1) < 0.5;
      }
      if (inside && middle) mesh->x[n][0] += bend * 0.25;
    }
    corot_model_def def = corot_model_defaults();
    def.nmaterial = 1, def.material = &soft, def.mass = COROT_MASS_CONSISTENT;
    body b = make_body(mesh, def);
    double *u = vectors(&b, 2), *v = u + b.n;
    for (int n = 0; n < mesh->nnode; n++) v[3 * n] = mesh->x[n][0];
    corot_energies e;
    assert_ok(corot_energy(b.model, b.state, 0, u, v, &e));
    assert_close(e.kinetic, soft.density / 6, 1e-13, 0);
    free(u), drop_body(&b);
  }
}

/* a M + b D + c K as compressed columns, dense, against products with the three; D against the
   residual, which is linear in v. */
static void columns_and_blocks_agree_with_products(void **state) {
  (void)state;
  for (corot_mass kind = COROT_MASS_LUMPED; kind <= COROT_MASS_CONSISTENT; kind++) {
    body b = crooked(kind, true);
    int nblock = corot_model_nblock(b.model), n = b.n;
    double(*K)[9] = malloc(2 * nblock * sizeof *K), (*D)[9] = K + nblock;
    double *u = vectors(&b, 9), *x = u + n, *zero = x + n, *Mx = zero + n, *Dx = Mx + n,
           *Kx = Dx + n, *y = Kx + n, *r = y + n, *r0 = r + n;
    fill(2 * n, u, 6);
    for (int i = 0; i < n; i++) u[i] *= 0.02;
    assert_ok(corot_jacobian(b.model, b.state, 0, u, zero, COROT_TANGENT_EXACT, K, D));
    corot_mass_multiply(b.model, x, Mx);
    corot_block_multiply(b.model, (const double(*)[9])D, x, Dx);
    corot_block_multiply(b.model, (const double(*)[9])K, x, Kx);
    for (corot_triangle triangle = COROT_FULL; triangle <= COROT_LOWER; triangle++) {
      corot_csc *csc;
      assert_ok(corot_csc_create(b.model, triangle, &csc));
      double *value = malloc(csc->nnz * sizeof *value);
      corot_csc_combine(b.model, csc, 2, 3, (const double(*)[9])D, 5, (const double(*)[9])K, value);
      for (int i = 0; i < n; i++) y[i] = 0;
      for (int j = 0; j < n; j++)
        for (int p = csc->colptr[j]; p < csc->colptr[j + 1]; p++) {
          int i = csc->row[p];
          y[i] += value[p] * x[j];
          if (triangle == COROT_LOWER && i != j) y[j] += value[p] * x[i];
        }
      double size = norm_max(n, y);
      for (int i = 0; i < n; i++)
        assert_close(y[i], 2 * Mx[i] + 3 * Dx[i] + 5 * Kx[i], 0, 1e-13 * size);
      free(value), corot_csc_destroy(csc);
    }

    assert_ok(corot_residual(b.model, b.state, 0, u, x, r));
    assert_ok(corot_residual(b.model, b.state, 0, u, zero, r0));
    for (int i = 0; i < n; i++) r0[i] -= r[i];
    double size = norm_max(n, r), power = inner(n, x, Dx);
    for (int i = 0; i < n; i++) assert_close(r0[i], Dx[i], 0, 1e-12 * size);
    assert_ok(corot_jvp(b.model, b.state, 0, u, x, COROT_TANGENT_EXACT, zero, x, r));
    for (int i = 0; i < n; i++) assert_close(r[i], -Dx[i], 0, 1e-12 * size);
    corot_energies e;
    assert_ok(corot_energy(b.model, b.state, 0, u, x, &e));
    assert_close(e.power_dissipated, power, 1e-12, 0);
    assert_close(e.kinetic, inner(n, x, Mx) / 2, 1e-14, 0);
    free(K), free(u), drop_body(&b);
  }
}

/* One material: the mass damping is M times its coefficient. */
static void mass_damping_has_the_matrix_of_the_mass(void **state) {
  (void)state;
  corot_material material = {.lambda = 1e5, .mu = 1e4, .density = 1000, .damping_mass = 0.7};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &material, def.mass = COROT_MASS_CONSISTENT;
  body b = make_body(crooked_box(2, 2, 2), def);
  double *u = vectors(&b, 4), *v = u + b.n, *r = v + b.n, *Mv = r + b.n;
  fill(b.n, v, 8);
  assert_ok(corot_residual(b.model, b.state, 0, u, v, r));
  corot_mass_multiply(b.model, v, Mv);
  for (int i = 0; i < b.n; i++) assert_close(r[i], -0.7 * Mv[i], 1e-12, 1e-12 * norm_max(b.n, Mv));
  free(u), drop_body(&b);
}

static void the_models_size_counts_it(void **state) {
  (void)state;
  body lumped = crooked(COROT_MASS_LUMPED, true), consistent = crooked(COROT_MASS_CONSISTENT, true);
  size_t pairs = corot_model_nblock(lumped.model); /* of the mass, and of its damping */
  assert_int_equal(corot_model_bytes(consistent.model) - corot_model_bytes(lumped.model),
                   2 * pairs * sizeof(double));
  drop_body(&lumped), drop_body(&consistent);
}

/* --- M^-1 --------------------------------------------------------------------------------------
 */

static void the_solver_undoes_the_product(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    body b = crooked(k % 2 ? COROT_MASS_CONSISTENT : COROT_MASS_LUMPED, k / 2);
    double *x = vectors(&b, 3), *y = x + b.n, *z = y + b.n;
    fill(b.n, x, k);
    corot_mass_multiply(b.model, x, y);
    corot_mass_solver *solver;
    assert_ok(corot_mass_solver_create(b.model, &solver));
    assert_ok(corot_mass_solve(solver, y, z));
    for (int i = 0; i < b.n; i++) assert_close(z[i], x[i], 0, 1e-14);
    assert_ok(corot_mass_solve(solver, y, y)); /* in place */
    assert_memory_equal(y, z, b.n * sizeof *y);
    corot_mass_solver_destroy(solver);
    free(x), drop_body(&b);
  }
  corot_mass_solver_destroy(NULL);
}

/* No node is free in x. */
static void a_component_may_be_held_altogether(void **state) {
  (void)state;
  corot_mesh *mesh = crooked_box(2, 2, 2);
  double low[3] = {-10, -10, -10}, high[3] = {10, 10, 10};
  assert_ok(corot_mesh_group_box(mesh, "all", low, high, 0));
  corot_fix fix = {"all", {true, false, false}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.nfix = 1, def.fix = &fix;
  def.mass = COROT_MASS_CONSISTENT;
  body b = make_body(mesh, def);
  double *x = vectors(&b, 2), *y = x + b.n;
  fill(b.n, x, 2);
  corot_mass_multiply(b.model, x, y);
  corot_mass_solver *solver;
  assert_ok(corot_mass_solver_create(b.model, &solver));
  assert_ok(corot_mass_solve(solver, y, y));
  for (int i = 0; i < b.n; i++) assert_close(y[i], x[i], 0, 1e-14);
  corot_mass_solver_destroy(solver);
  free(x), drop_body(&b);
}

static void the_right_hand_side_needs_the_solver(void **state) {
  (void)state;
  body b = crooked(COROT_MASS_CONSISTENT, true);
  SUNContext ctx;
  assert_int_equal(sun_context_create(&ctx), 0);
  double *y = vectors(&b, 6), *ydot = y + 2 * b.n, *r = ydot + 2 * b.n, *Ma = r + b.n;
  fill(2 * b.n, y, 4);
  for (int i = 0; i < b.n; i++) y[i] *= 0.02;
  N_Vector in = N_VMake_Serial(2 * b.n, y, ctx), out = N_VMake_Serial(2 * b.n, ydot, ctx);
  assert_fails(corot_rhs(b.model, b.state, 0, y, ydot), COROT_EINVAL, "corot_mass_solve");
  corot_sun_data data = {b.model, b.state, NULL};
  assert_fails(corot_sun_rhs(0, in, out, &data), COROT_EINVAL, "corot_mass_solver");
  assert_ok(corot_mass_solver_create(b.model, &data.mass));
  assert_ok(corot_sun_rhs(0, in, out, &data));
  assert_ok(corot_residual(b.model, b.state, 0, y, y + b.n, r));
  corot_mass_multiply(b.model, ydot + b.n, Ma);
  for (int i = 0; i < b.n; i++) assert_close(Ma[i], r[i], 0, 1e-13 * norm_max(b.n, r));
  assert_memory_equal(ydot, y + b.n, b.n * sizeof *y);
  corot_mass_solver_destroy(data.mass);
  N_VDestroy(in), N_VDestroy(out), SUNContext_Free(&ctx);
  free(y), drop_body(&b);
}

/* --- refusals ----------------------------------------------------------------------------------
 */

static void unknown_kinds_are_refused(void **state) {
  (void)state;
  corot_mesh *mesh = crooked_box(1, 1, 2);
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.nmaterial = 1, def.material = &soft;
  corot_model *model;
  def.mass = 7;
  assert_fails(corot_model_create(&def, &model), COROT_EINVAL, "number 7");
  def.mass = COROT_MASS_LUMPED;
  assert_ok(corot_model_create(&def, &model));
  corot_model_destroy(model), corot_mesh_destroy(mesh);
}

static corot_status make_model(void *context) {
  corot_material material = soft;
  material.damping_mass = 1;
  corot_model_def def = corot_model_defaults();
  def.mesh = context, def.nmaterial = 1, def.material = &material;
  def.mass = COROT_MASS_CONSISTENT;
  corot_model *model;
  COROT_TRY(corot_model_create(&def, &model));
  corot_model_destroy(model);
  return COROT_OK;
}

static corot_status make_solver(void *context) {
  corot_mass_solver *solver;
  COROT_TRY(corot_mass_solver_create(context, &solver));
  corot_mass_solver_destroy(solver);
  return COROT_OK;
}

static void failed_allocations_are_survived(void **state) {
  (void)state;
  body b = crooked(COROT_MASS_CONSISTENT, true);
  assert_true(assert_survives_failed_allocations(make_model, b.mesh) > 10);
  assert_true(assert_survives_failed_allocations(make_solver, b.model) > 10);
  drop_body(&b);
}

/* --- integrators -------------------------------------------------------------------------------
 */

static const struct {
  const char *method;
  double tolerance; /* of the largest displacement, at the tolerance or step below */
} methods[] = {
    {"cvode", 1e-5},   {"ida", 1e-5},  {"arkode", 1e-5},           {"erk", 1e-5},
    {"bdf2", 3e-3},    {"bdf3", 1e-3}, {"midpoint", 1e-3},         {"backward-euler", 0.3},
    {"newmark", 1e-3}, {"hht", 3e-3},  {"generalized-alpha", 3e-3}};
enum { NMETHOD = sizeof methods / sizeof *methods };

typedef struct outcome {
  double *u;      /* at the end */
  double balance; /* energy unaccounted for, relative to the work done */
} outcome;

/* A bar at rest, pulled sideways at its end from now on, and damped both ways. */
static body pulled_bar(corot_mass mass) {
  corot_box box = {.size = {0.1, 0.1, 0.4}, .cells = {1, 1, 4}};
  corot_mesh *mesh = box_of_order(&box);
  corot_material material = soft;
  material.damping_mass = 1;
  material.damping_lambda *= 100, material.damping_mu *= 100;
  double time[] = {0, 0.2}, value[] = {0, 1};
  corot_fix fix = {"zmin", {true, true, true}};
  corot_load load = {COROT_TRACTION, "zmax", {200, 0, 100}, {2, time, value}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &material, def.mass = mass;
  def.nfix = 1, def.fix = &fix, def.nload = 1, def.load = &load;
  return make_body(mesh, def);
}

static outcome run(const body *b, const corot_integrator_def *def) {
  const double t_end = 0.4;
  double *u = vectors(b, 2), *v = u + b->n, dissipated, external;
  corot_integrator *integrator;
  assert_ok(corot_integrator_create(def, b->model, b->state, 0, u, v, &integrator));
  for (corot_step step = {0}; step.t < t_end - 1e-12;)
    assert_ok(corot_integrator_step(integrator, step.t < 0.2 ? 0.2 : t_end, &step));
  assert_ok(corot_integrator_at(integrator, t_end, u, v));
  assert_ok(corot_integrator_work(integrator, t_end, &dissipated, &external));
  corot_energies e;
  assert_ok(corot_energy(b->model, b->state, t_end, u, v, &e));
  corot_integrator_destroy(integrator);
  return (outcome){u, fabs(e.kinetic + e.elastic + dissipated - external) / external};
}

static void every_method_integrates_with_either(void **state) {
  (void)state;
  corot_integrator_def def = corot_integrator_defaults();
  def.rtol = 1e-9, def.max_order = 5;
  for (corot_mass kind = COROT_MASS_LUMPED; kind <= COROT_MASS_CONSISTENT; kind++) {
    body b = pulled_bar(kind);
    outcome best = run(&b, &def);
    double size = norm_max(b.n, best.u);
    assert_above(size, 0.02);
    assert_below(best.balance, 1e-6);
    for (int m = 0; m < NMETHOD; m++) {
      corot_integrator_def other = corot_integrator_defaults();
      other.method = methods[m].method, other.rtol = 1e-6, other.step = 0.002;
      outcome o = run(&b, &other);
      for (int i = 0; i < b.n; i++) assert_close(o.u[i], best.u[i], 0, methods[m].tolerance * size);
      assert_below(o.balance, methods[m].tolerance);
      free(o.u);
    }
    free(best.u), drop_body(&b);
  }
}

/* Free, bent and spinning: momentum stays to rounding, angular momentum to the solution's error. */
static void a_free_body_keeps_its_momentum(void **state) {
  (void)state;
  corot_box box = {.size = {0.1, 0.1, 0.3}, .cells = {1, 1, 3}, .origin = {-0.05, -0.05, -0.15}};
  corot_mesh *mesh = box_of_order(&box);
  corot_material material = {.lambda = 1e5, .mu = 1e4, .density = 1000};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &material, def.mass = COROT_MASS_CONSISTENT;
  body b = make_body(mesh, def);
  double *u = vectors(&b, 2), *v = u + b.n;
  for (int n = 0; n < mesh->nnode; n++) {
    const double *X = mesh->x[n];
    u[3 * n] = 0.03 * pow(X[2] / 0.15, 2);
    v[3 * n] = 1 - 3 * X[1] + 0.1 * X[2], v[3 * n + 1] = 3 * X[0], v[3 * n + 2] = -0.2 * X[0];
  }
  corot_energies first, last;
  assert_ok(corot_energy(b.model, b.state, 0, u, v, &first));
  corot_integrator_def how = corot_integrator_defaults();
  how.rtol = 1e-6;
  corot_integrator *integrator;
  assert_ok(corot_integrator_create(&how, b.model, b.state, 0, u, v, &integrator));
  for (corot_step step = {0}; step.t < 1;) assert_ok(corot_integrator_step(integrator, 1, &step));
  assert_ok(corot_integrator_at(integrator, 1, u, v));
  assert_ok(corot_energy(b.model, b.state, 1, u, v, &last));
  double momentum = norm_max(3, first.momentum), angular = norm_max(3, first.angular_momentum);
  for (int c = 0; c < 3; c++) {
    assert_close(last.momentum[c], first.momentum[c], 0, 1e-12 * momentum);
    assert_close(last.angular_momentum[c], first.angular_momentum[c], 0, 5e-5 * angular);
  }
  corot_integrator_destroy(integrator);
  free(u), drop_body(&b);
}

/* The frequency nearest to `shift` [rad/s] of a bar that is held at its base, by inverse iteration
   from a twist: (K - shift^2 M) y = M x. */
static double frequency_of_torsion(corot_mass mass, int across, int along, double shift) {
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {across, across, along}};
  corot_fix base = {"zmin", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.nmaterial = 1, def.material = &soft, def.mass = mass, def.nfix = 1, def.fix = &base;
  body b = make_body(box_of_order(&box), def);
  corot_linear_def klu = corot_linear_defaults();
  klu.solver = "klu"; /* the matrix is indefinite */
  corot_pencil *pencil;
  double *u = vectors(&b, 5), *v = u + b.n, *x = v + b.n, *Mx = x + b.n, *y = Mx + b.n;
  double(*twist)[3] = calloc(b.mesh->nnode, sizeof *twist);
  for (int n = 0; n < b.mesh->nnode; n++) {
    const double *X = b.mesh->x[n];
    twist[n][0] = -(X[1] - 0.05) * X[2], twist[n][1] = (X[0] - 0.05) * X[2];
  }
  to_dofs(&b, (const double(*)[3])twist, x);
  assert_ok(corot_pencil_create(b.model, b.state, &klu, &pencil));
  assert_ok(corot_pencil_assemble(pencil, 0, u, v));
  corot_pencil_combine(pencil, -shift * shift, 0, 1);
  assert_ok(corot_pencil_factor(pencil));
  double distance = 0; /* of the eigenvalue from the square of the shift */
  for (int k = 0; k < 20; k++) {
    corot_mass_multiply(b.model, x, Mx);
    assert_ok(corot_pencil_solve(pencil, Mx, y));
    distance = inner(b.n, x, Mx) / inner(b.n, y, Mx);
    double size = norm_max(b.n, y);
    for (int i = 0; i < b.n; i++) x[i] = y[i] / size;
  }
  corot_pencil_destroy(pencil);
  free(twist), free(u), drop_body(&b);
  return sqrt(shift * shift + distance);
}

/* Saint-Venant's torsion of a square of side h, of J = 0.140577 h^4, is that of a rod of length L =
   6 h with pi / (2 L) sqrt(mu J / (rho I)), I = h^4 / 6: 7.603 rad/s. Its stiffness is from above,
   so consistent masses come from there: 2.5 and 0.65 per cent with 2 and 4 cells across. Lumped
   masses of ten-node tets stand too far from the axis: 5.9 and 1.6 per cent less than the
   consistent ones. Four-node tets are much too stiff to show it. */
static void lumping_slows_the_torsion_of_ten_node_tets(void **state) {
  (void)state;
  static const struct {
    int across;
    double above, slower;
  } expected[] = {{2, 0.0254, 0.0594}, {4, 0.0064, 0.0159}};
  for (int k = 0; k < 2 && order_of_test() == 2; k++) {
    int across = expected[k].across, along = 6 * across;
    double consistent = frequency_of_torsion(COROT_MASS_CONSISTENT, across, along, 7.4);
    double lumped = frequency_of_torsion(COROT_MASS_LUMPED, across, along, 7.4);
    assert_close(consistent / 7.603 - 1, expected[k].above, 0, 2e-4);
    assert_close(1 - lumped / consistent, expected[k].slower, 0, 2e-4);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_sum_to_the_lumped_mass),
      cmocka_unit_test(consistent_mass_is_symmetric_and_positive),
      cmocka_unit_test(held_components_drop_out),
      cmocka_unit_test(linear_fields_are_integrated_exactly),
      cmocka_unit_test(a_tet_may_name_its_corners_in_any_order),
      cmocka_unit_test(a_curved_tet_is_lumped_by_its_diagonal),
      cmocka_unit_test(edges_that_are_hardly_curved_count),
      cmocka_unit_test(columns_and_blocks_agree_with_products),
      cmocka_unit_test(mass_damping_has_the_matrix_of_the_mass),
      cmocka_unit_test(the_models_size_counts_it),
      cmocka_unit_test(the_solver_undoes_the_product),
      cmocka_unit_test(a_component_may_be_held_altogether),
      cmocka_unit_test(the_right_hand_side_needs_the_solver),
      cmocka_unit_test(unknown_kinds_are_refused),
      cmocka_unit_test(failed_allocations_are_survived),
      cmocka_unit_test(every_method_integrates_with_either),
      cmocka_unit_test(a_free_body_keeps_its_momentum),
      cmocka_unit_test(lumping_slows_the_torsion_of_ten_node_tets),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

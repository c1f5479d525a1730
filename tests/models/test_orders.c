/* Linear elasticity against a field that is known: orders of convergence in space, by four-node and
   ten-node tets. */
#include "solution.h"

enum { MOST_NODES = 10 };

/* u = size sin(pi x) sin(pi y) sin(pi z) on the unit cube, which vanishes on its sides; its
   gradient and the body force -(lambda + mu) grad div u - mu lap u that holds it. */
static const double size[3] = {1, -0.7, 0.4};
static const corot_material material = {.lambda = 1.5e4, .mu = 1e4, .density = 1000};

static void exact_at(const double X[3], double u[3], double gradient[9], double force[3]) {
  double s[3], c[3], second[9];
  for (int k = 0; k < 3; k++) s[k] = sin(pi * X[k]), c[k] = cos(pi * X[k]);
  double bubble = s[0] * s[1] * s[2];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      gradient[3 * i + j] = size[i] * pi * c[j] * s[(j + 1) % 3] * s[(j + 2) % 3];
      second[3 * i + j] = pi * pi * (i == j ? -bubble : c[i] * c[j] * s[3 - i - j]);
    }
  for (int i = 0; i < 3; i++) {
    u[i] = size[i] * bubble;
    force[i] = 3 * pi * pi * material.mu * u[i];
    for (int j = 0; j < 3; j++)
      force[i] -= (material.lambda + material.mu) * size[j] * second[3 * i + j];
  }
}

/* A point of a rule on a tet, with the nodes' shape functions there and their gradients. */
typedef struct point {
  double weight, X[3], N[MOST_NODES], g[MOST_NODES][3];
  int nnode, node[MOST_NODES];
} point;

/* The gradients of the barycentric coordinates; returns the volume. */
static double barycentric(const corot_mesh *mesh, int e, double grad[4][3]) {
  const double *x[4];
  double edge[9];
  for (int a = 0; a < 4; a++) x[a] = mesh->x[mesh->tet[e][a]];
  for (int a = 0; a < 3; a++)
    for (int c = 0; c < 3; c++) edge[3 * a + c] = x[a + 1][c] - x[0][c];
  double det = determinant(edge);
  for (int c = 0; c < 3; c++) grad[0][c] = 0;
  for (int a = 0; a < 3; a++)
    for (int c = 0; c < 3; c++) {
      const double *p = edge + 3 * ((a + 1) % 3), *q = edge + 3 * ((a + 2) % 3);
      int c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      grad[a + 1][c] = (p[c1] * q[c2] - p[c2] * q[c1]) / det;
      grad[0][c] -= grad[a + 1][c];
    }
  return det / 6;
}

/* Linear shape functions L, or the quadratic (2 L - 1) L and 4 L L' of corners and edges. */
static void shapes_at(const corot_mesh *mesh, int e, const double L[4], const double grad[4][3],
                      point *p) {
  static const int edge[6][2] = {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}};
  bool ten = corot_mesh_order(mesh) == 2;
  p->nnode = ten ? 10 : 4;
  for (int c = 0; c < 3; c++) p->X[c] = 0;
  for (int a = 0; a < 4; a++) {
    p->node[a] = mesh->tet[e][a];
    p->N[a] = ten ? (2 * L[a] - 1) * L[a] : L[a];
    for (int c = 0; c < 3; c++) {
      p->g[a][c] = (ten ? 4 * L[a] - 1 : 1) * grad[a][c];
      p->X[c] += L[a] * mesh->x[p->node[a]][c];
    }
  }
  for (int k = 0; ten && k < 6; k++) {
    int a = edge[k][0], b = edge[k][1];
    p->node[4 + k] = mesh->mid[e][k];
    p->N[4 + k] = 4 * L[a] * L[b];
    for (int c = 0; c < 3; c++) p->g[4 + k][c] = 4 * (L[a] * grad[b][c] + L[b] * grad[a][c]);
  }
}

/* Gauss's four points in each direction of a cube that is collapsed to the tet: right for
   polynomials of degree five. The squared error of a gradient is one of degree four, and that of u
   one of degree six, but for terms of higher order in h: what is left of the latter is a constant
   part of it, which no slope sees. */
enum { RULE = 64 };

static void rule_point(const corot_mesh *mesh, int e, int q, point *p) {
  static const double at[4] = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                               0.93056815579702629};
  static const double weight[4] = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                   0.17392742256872693};
  double a = at[q / 16], b = at[q / 4 % 4], c = at[q % 4], grad[4][3];
  double L[4] = {0, a, (1 - a) * b, (1 - a) * (1 - b) * c};
  L[0] = 1 - L[1] - L[2] - L[3];
  double volume = barycentric(mesh, e, grad);
  shapes_at(mesh, e, L, (const double(*)[3])grad, p);
  p->weight = 6 * volume * weight[q / 16] * weight[q / 4 % 4] * weight[q % 4];
  p->weight *= (1 - a) * (1 - a) * (1 - b);
}

static void body_load(const body *b, double *load) {
  const int(*dof)[3] = corot_model_dof(b->model);
  for (int e = 0; e < b->mesh->ntet; e++)
    for (int q = 0; q < RULE; q++) {
      point p;
      double u[3], gradient[9], force[3];
      rule_point(b->mesh, e, q, &p);
      exact_at(p.X, u, gradient, force);
      for (int k = 0; k < 3 * p.nnode; k++) {
        int i = dof[p.node[k / 3]][k % 3];
        if (i >= 0) load[i] += p.weight * p.N[k / 3] * force[k % 3];
      }
    }
}

/* K x = load, x in the place of load. */
static void solve(const body *b, double *load) {
  double *rest = calloc(b->n, sizeof *rest);
  corot_pencil *K;
  assert_ok(corot_pencil_create(b->model, b->state, NULL, &K));
  assert_ok(corot_pencil_assemble(K, 0, rest, rest));
  corot_pencil_combine(K, 0, 0, 1);
  assert_ok(corot_pencil_factor(K));
  assert_ok(corot_pencil_solve(K, load, load));
  corot_pencil_destroy(K);
  free(rest);
}

/* Errors in L2: [0] of u, [1] of its gradient. */
static void errors(const body *b, const double *x, double error[2]) {
  double(*nodal)[3] = malloc(b->mesh->nnode * sizeof *nodal), square[2] = {0};
  corot_nodal(b->model, 0, x, x, nodal, NULL);
  for (int e = 0; e < b->mesh->ntet; e++)
    for (int q = 0; q < RULE; q++) {
      point p;
      double u[3], gradient[9], force[3];
      rule_point(b->mesh, e, q, &p);
      exact_at(p.X, u, gradient, force);
      for (int i = 0; i < 3; i++) {
        for (int a = 0; a < p.nnode; a++) {
          double value = nodal[p.node[a]][i];
          u[i] -= p.N[a] * value;
          for (int j = 0; j < 3; j++) gradient[3 * i + j] -= p.g[a][j] * value;
        }
      }
      square[0] += p.weight * inner(3, u, u);
      square[1] += p.weight * inner(9, gradient, gradient);
    }
  free(nodal);
  for (int k = 0; k < 2; k++) error[k] = sqrt(square[k]);
}

static void manufactured(int order, int cells, double error[2]) {
  static const char *const sides[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
  corot_box box = {.size = {1, 1, 1}, .cells = {cells, cells, cells}};
  corot_fix fix[6];
  corot_mesh *mesh;
  assert_ok(corot_mesh_box(&box, &mesh));
  for (int k = 0; k < 6; k++) fix[k] = (corot_fix){sides[k], {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.strain = "cauchy", def.nmaterial = 1, def.material = &material, def.nfix = 6, def.fix = fix;
  body b = make_body(given_order(mesh, order), def);
  double *x = calloc(b.n, sizeof *x);
  body_load(&b, x);
  solve(&b, x);
  errors(&b, x, error);
  free(x), drop_body(&b);
}

/* Of a smooth field, elements of order p give u to h^(p + 1) in L2 and its gradient to h^p. What
   the slope lacks are terms of higher order in h, which leave at least half as much from one pair
   of meshes to the next, or nearly so; two thirds are asked for. */
static void elasticity_converges_with_the_orders_of_its_elements(void **state) {
  (void)state;
  static const double slack[2] = {0.15, 0.1};
  for (int order = 1; order <= 2; order++) {
    double error[3][2], off[3][2];
    for (int k = 0; k < 3; k++) {
      int cells = (order == 1 ? 4 : 2) << k;
      manufactured(order, cells, error[k]);
      print_message("order %d, %2d cells: errors %.4e of u, %.4e of its gradient", order, cells,
                    error[k][0], error[k][1]);
      for (int c = 0; c < 2 && k > 0; c++) {
        double slope = order_of(error[k - 1][c], error[k][c], 2);
        print_message(", slope %.3f", slope);
        off[k][c] = fabs(slope - (order + 1 - c));
      }
      print_message("\n");
    }
    for (int c = 0; c < 2; c++) {
      assert_below(off[2][c], slack[c]);
      assert_below(off[2][c], off[1][c] / 1.5);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(elasticity_converges_with_the_orders_of_its_elements),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

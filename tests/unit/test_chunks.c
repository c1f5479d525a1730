/* Meshes of many chunks, whose force buffer is used again and again, against sums over the tets one
   by one in an order of their own. */
#include "core/model/model.h"
#include "solid.h"

/* How the tets are spread over two materials and how the nodes are numbered: what decides which
   chunk completes a node. */
static const struct {
  const char *name;
  bool mixed, shuffled;
} layouts[] = {
    {"one material", false, false}, {"two, mixed", true, false}, {"shuffled", true, true}};
enum { NLAYOUT = 3 };

static const corot_material materials[2] = {
    {.lambda = 1e5, .mu = 1e4, .density = 1000, .damping_lambda = 30, .damping_mu = 20},
    {.group = "some",
     .lambda = 3e4,
     .mu = 2e4,
     .density = 700,
     .damping_lambda = 10,
     .damping_mu = 50}};

typedef struct sample {
  body b;
  char *of_tet;  /* [ntet] its material */
  double *u, *v; /* [n] */
} sample;

/* The same mesh with other numbers for nodes and tets. */
static corot_mesh *shuffle(corot_mesh *mesh, uint64_t *seed) {
  int *place = malloc(mesh->nnode * sizeof *place), (*tet)[4] = malloc(mesh->ntet * sizeof *tet);
  double(*x)[3] = malloc(mesh->nnode * sizeof *x);
  for (int n = 0; n < mesh->nnode; n++) place[n] = n;
  for (int n = mesh->nnode - 1; n > 0; n--) {
    int other = (int)((n + 1) * 0.5 * (1 + noise(seed))), keep = place[n];
    place[n] = place[other], place[other] = keep;
  }
  for (int n = 0; n < mesh->nnode; n++) memcpy(x[place[n]], mesh->x[n], sizeof *x);
  for (int e = 0; e < mesh->ntet; e++)
    for (int a = 0; a < 4; a++) tet[mesh->ntet - 1 - e][a] = place[mesh->tet[e][a]];
  corot_mesh *made;
  assert_ok(corot_mesh_create(mesh->nnode, (const double(*)[3])x, mesh->ntet, (const int(*)[4])tet,
                              &made));
  free(place), free(x), free(tet), corot_mesh_destroy(mesh);
  return made;
}

static sample make(const char *strain, int layout, corot_mass mass) {
  uint64_t seed = 41;
  corot_mesh *mesh = linear_box(4, 5, 24);
  if (layouts[layout].shuffled) mesh = shuffle(mesh, &seed);
  mesh = of_order(mesh);
  if (mass == COROT_MASS_LUMPED) bend_edges(mesh, 5e-4); /* masses are in closed form if straight */
  char *of_tet = calloc(mesh->ntet, 1);
  if (layouts[layout].mixed) { /* a group of half the tets, all over the body */
    double low[3] = {-9, -9, -9}, high[3] = {9, 9, 9};
    assert_ok(corot_mesh_group_box(mesh, "some", low, high, 0));
    corot_group *group = &mesh->group[mesh->ngroup - 1];
    group->ntet = 0;
    for (int e = 0; e < mesh->ntet; e++)
      if (noise(&seed) > 0) of_tet[e] = 1, group->tet[group->ntet++] = e;
  }
  corot_model_def def = corot_model_defaults();
  def.strain = strain, def.mass = mass;
  def.nmaterial = layouts[layout].mixed ? 2 : 1, def.material = materials;
  sample s = {.b = make_body(mesh, def), .of_tet = of_tet};
  s.u = malloc(2 * s.b.n * sizeof *s.u);
  s.v = s.u + s.b.n;
  for (int i = 0; i < s.b.n; i++) s.u[i] = 1e-3 * noise(&seed), s.v[i] = noise(&seed);
  return s;
}

static void drop(sample *s) { free(s->of_tet), free(s->u), drop_body(&s->b); }

/* A = sum x_a g_a' */
static void field_gradient(int nnode, const int *node, double g[10][3], const double *x,
                           double A[9]) {
  for (int k = 0; k < 9; k++) A[k] = 0;
  for (int a = 0; a < nnode; a++)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) A[3 * i + j] += x[3 * node[a] + i] * g[a][j];
}

/* P += B sigma(e): lambda tr(e) B + 2 mu B e. */
static void add_stress(const double B[9], double lambda, double mu, const double e[9],
                       double P[9]) {
  double Be[9];
  multiply(B, e, Be);
  for (int k = 0; k < 9; k++) P[k] += lambda * (e[0] + e[4] + e[8]) * B[k] + 2 * mu * Be[k];
}

/* sym(A' B) */
static void symmetric(const double A[9], const double B[9], double e[9]) {
  double C[9];
  multiply_transposed(A, B, C);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) e[3 * i + j] = 0.5 * (C[3 * i + j] + C[3 * j + i]);
}

/* P of the internal and viscous force for F and V, or of its change for dF at V = 0. Cauchy or
   Green strain. */
static void stress_at(const corot_material *m, bool green, const double F[9], const double V[9],
                      const double *dF, double P[9]) {
  const double *B = green ? F : identity;
  double e[9];
  for (int k = 0; k < 9; k++) P[k] = 0;
  if (dF) {
    symmetric(B, dF, e);
    add_stress(B, m->lambda, m->mu, e, P);
  } else {
    symmetric(B, V, e);
    add_stress(B, m->damping_lambda, m->damping_mu, e, P);
  }
  symmetric(F, green ? F : identity, e); /* the strain itself */
  for (int k = 0; k < 9; k++) e[k] = green ? 0.5 * (e[k] - identity[k]) : e[k] - identity[k];
  if (!dF) add_stress(B, m->lambda, m->mu, e, P);
  if (dF && green) add_stress(dF, m->lambda, m->mu, e, P);
}

/* y = the sum over the tets and their points of w P g_a, last tet first: of the internal and
   viscous force at u, v, or of its change in the direction (du, 0) at v = 0. */
static void sum_tets(const sample *s, bool green, const double *du, double *y) {
  const corot_mesh *mesh = s->b.mesh;
  int nnode = order_of_test() == 1 ? 4 : 10, npoint = points_of_tets(mesh);
  for (int i = 0; i < s->b.n; i++) y[i] = 0;
  for (int k = npoint * mesh->ntet - 1; k >= 0; k--) {
    int t = k / npoint, node[10];
    double g[10][3], F[9], V[9], dF[9], P[9];
    double weight = point_gradients(mesh, t, k % npoint, node, g);
    field_gradient(nnode, node, g, s->u, F);
    field_gradient(nnode, node, g, s->v, V);
    if (du) field_gradient(nnode, node, g, du, dF);
    for (int i = 0; i < 3; i++) F[4 * i] += 1;
    stress_at(&materials[(int)s->of_tet[t]], green, F, V, du ? dF : NULL, P);
    for (int a = 0; a < nnode; a++)
      for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) y[3 * node[a] + i] += weight * P[3 * i + j] * g[a][j];
  }
}

/* The largest sum a node can have is some 24 tets' forces: rounding of that, and of det D. */
static void assert_same(int n, const double *a, const double *b, double sign) {
  double size = norm_max(n, b);
  assert_above(size, 0);
  for (int i = 0; i < n; i++) assert_close(a[i], sign * b[i], 0, 1e-12 * size);
}

/* The layouts do what they are for. */
static void buffers_wrap(void **state) {
  (void)state;
  for (int l = 0; l < NLAYOUT; l++) {
    sample s = make("green", l, COROT_MASS_LUMPED);
    const pattern *p = &solid_of(s.b.model)->pattern;
    assert_true(p->nchunk > 10);
    assert_true(p->window >= CHUNK && p->window <= solid_of(s.b.model)->elements.nblock);
    /* nodes on edges, which follow all corners, are not ready before the last chunk */
    if (!layouts[l].mixed && order_of_test() == 1)
      assert_true(2 * p->window < solid_of(s.b.model)->elements.nblock);
    drop(&s);
  }
}

static void forces_are_the_sum_over_the_tets(void **state) {
  (void)state;
  for (int l = 0; l < NLAYOUT; l++)
    for (int green = 0; green < 2; green++) {
      sample s = make(green ? "green" : "cauchy", l, COROT_MASS_LUMPED);
      double *r = malloc(3 * s.b.n * sizeof *r), *expected = r + s.b.n, *f = expected + s.b.n;
      sum_tets(&s, green, NULL, expected);
      for (int again = 0; again < 2; again++) { /* nothing is left from the last time */
        assert_ok(corot_residual(s.b.model, s.b.state, 0, s.u, s.v, r));
        assert_same(s.b.n, r, expected, -1);
      }
      for (int i = 0; i < s.b.n; i++) s.v[i] = 0;
      sum_tets(&s, green, NULL, expected);
      assert_ok(corot_internal_force(s.b.model, s.b.state, 0, s.u, green ? "green" : "cauchy", 1, 1,
                                     (double(*)[3])f));
      assert_same(s.b.n, f, expected, 1);
      free(r), drop(&s);
    }
}

static void matrices_are_the_sum_over_the_tets(void **state) {
  (void)state;
  for (int l = 0; l < NLAYOUT; l++)
    for (int green = 0; green < 2; green++) {
      sample s = make(green ? "green" : "cauchy", l, COROT_MASS_LUMPED);
      int nblock = corot_model_nblock(s.b.model), n = s.b.n;
      double(*K)[9] = malloc(2 * nblock * sizeof *K), (*D)[9] = K + nblock;
      double *du = calloc(4 * n, sizeof *du), *zero = du + n, *y = zero + n, *expected = y + n;
      uint64_t seed = 2;
      for (int i = 0; i < n; i++) du[i] = noise(&seed);
      for (int again = 0; again < 2; again++)
        assert_ok(corot_jacobian(s.b.model, s.b.state, 0, s.u, s.v, COROT_TANGENT_EXACT, K, D));
      sum_tets(&s, green, du, expected);
      corot_block_multiply(s.b.model, (const double(*)[9])K, du, y);
      assert_same(n, y, expected, 1);
      assert_ok(corot_jvp(s.b.model, s.b.state, 0, s.u, zero, COROT_TANGENT_EXACT, du, zero, y));
      assert_same(n, y, expected, -1);

      sum_tets(&s, green, NULL, expected); /* D v is what the force has more with v than without */
      double *v = s.v;
      s.v = zero;
      sum_tets(&s, green, NULL, y);
      s.v = v;
      for (int i = 0; i < n; i++) expected[i] -= y[i];
      corot_block_multiply(s.b.model, (const double(*)[9])D, v, y);
      assert_same(n, y, expected, 1);
      free(K), free(du), drop(&s);
    }
}

static void masses_are_the_sum_over_the_tets(void **state) {
  (void)state;
  for (int l = 0; l < NLAYOUT; l++) {
    sample s = make("polar", l, COROT_MASS_CONSISTENT);
    const corot_mesh *mesh = s.b.mesh;
    double *y = calloc(2 * s.b.n, sizeof *y), *expected = y + s.b.n, g[10][3];
    const element_kind *kind = &element_kinds[order_of_test() == 1 ? TET4 : TET10];
    for (int t = mesh->ntet - 1; t >= 0; t--) {
      int node[10];
      double part = kind->npoint * point_gradients(mesh, t, 0, node, g) / kind->mass_over;
      part *= materials[(int)s.of_tet[t]].density;
      for (int a = 0; a < kind->nnode; a++)
        for (int b = 0; b < kind->nnode; b++)
          for (int c = 0; c < 3; c++)
            expected[3 * node[a] + c] += part * kind->mass[a][b] * s.v[3 * node[b] + c];
    }
    corot_mass_multiply(s.b.model, s.v, y);
    assert_same(s.b.n, y, expected, 1);
    free(y), drop(&s);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(buffers_wrap),
      cmocka_unit_test(forces_are_the_sum_over_the_tets),
      cmocka_unit_test(matrices_are_the_sum_over_the_tets),
      cmocka_unit_test(masses_are_the_sum_over_the_tets),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

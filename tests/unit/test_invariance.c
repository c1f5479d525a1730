/* What rotations, translations and affine motions do to the forces of a body: nothing, or exactly
   what each strain measure promises. */
#include <float.h>

#include "solid.h"

/* Viscous forces as large as elastic ones. */
static const corot_material thick = {
    .lambda = 1.0e5, .mu = 1.0e4, .density = 1000, .damping_lambda = 1e5, .damping_mu = 1e4};

/* A free body of 3x3x3 cells, no two tets alike, in a rotated and deformed state far from rest.
   Free: the degrees of freedom are the nodal values. */
typedef struct solid {
  body b;
  int nnode;
  double (*u)[3], (*v)[3], (*r)[3], (*s)[3];
} solid;

static void zero(const solid *s, double (*a)[3]) { memset(a, 0, s->nnode * sizeof *a); }

static solid make_of(corot_mesh *mesh, int measure, corot_viscosity viscosity) {
  corot_model_def def = corot_model_defaults();
  def.strain = measures[measure], def.nmaterial = 1, def.material = &thick;
  def.viscosity = viscosity;
  solid s = {.b = make_body(mesh, def)};
  s.nnode = s.b.mesh->nnode;
  assert_int_equal(s.b.n, 3 * s.nnode);
  s.u = calloc(4 * s.nnode, sizeof *s.u);
  s.v = s.u + s.nnode, s.r = s.v + s.nnode, s.s = s.r + s.nnode;
  return s;
}

static solid make_viscous(int measure, corot_viscosity viscosity) {
  return make_of(crooked_box(3, 3, 3), measure, viscosity);
}

static solid make(int measure) { return make_viscous(measure, COROT_COROTATED); }

static void drop(solid *s) {
  free(s->u);
  drop_body(&s->b);
}

/* Displacements of x = A X + c. */
static void affine(const solid *s, const double A[9], const double c[3], double (*u)[3]) {
  for (int n = 0; n < s->nnode; n++) {
    apply(A, s->b.mesh->x[n], u[n]);
    for (int i = 0; i < 3; i++) u[n][i] += c[i] - s->b.mesh->x[n][i];
  }
}

/* A rotation by a radian, growing along z, and strains of a tenth. */
static void deform(const solid *s) {
  uint64_t seed = 3;
  for (int n = 0; n < s->nnode; n++) {
    const double *X = s->b.mesh->x[n], axis[3] = {0.3, 1, -0.2};
    double Q[9];
    rotation(axis, 1 + 0.2 * X[2], Q);
    apply(Q, X, s->u[n]);
    for (int i = 0; i < 3; i++) {
      s->u[n][i] += 0.02 * noise(&seed) - X[i];
      s->v[n][i] = noise(&seed);
    }
  }
}

/* x -> Q x + c for the positions, v -> Q v for the velocities. */
static void turn(const solid *s, const double Q[9], const double c[3]) {
  for (int n = 0; n < s->nnode; n++) {
    double x[3], y[3];
    for (int i = 0; i < 3; i++) x[i] = s->b.mesh->x[n][i] + s->u[n][i];
    apply(Q, x, y);
    for (int i = 0; i < 3; i++) s->u[n][i] = y[i] + c[i] - s->b.mesh->x[n][i];
    apply(Q, s->v[n], y);
    memcpy(s->v[n], y, sizeof y);
  }
}

static void residual(const solid *s, double (*r)[3]) {
  assert_ok(corot_residual(s->b.model, s->b.state, 0, s->u[0], s->v[0], r[0]));
}

/* Viscous forces alone: r = residual(v) - residual(0). */
static void viscous(const solid *s, double (*r)[3]) {
  double(*v)[3] = malloc(2 * s->nnode * sizeof *v), (*at_rest)[3] = v + s->nnode;
  memcpy(v, s->v, s->nnode * sizeof *v);
  residual(s, r);
  zero(s, s->v);
  residual(s, at_rest);
  for (int n = 0; n < s->nnode; n++)
    for (int i = 0; i < 3; i++) r[n][i] -= at_rest[n][i];
  memcpy(s->v, v, s->nnode * sizeof *v);
  free(v);
}

static double largest(const solid *s, double (*r)[3]) { return norm_max(3 * s->nnode, r[0]); }

/* Sum of the forces, and of their moments about the origin; largest component of each. */
static void resultant(const solid *s, double (*r)[3], double *force, double *moment) {
  double f[3] = {0}, m[3] = {0};
  for (int n = 0; n < s->nnode; n++) {
    double x[3];
    for (int i = 0; i < 3; i++) x[i] = s->b.mesh->x[n][i] + s->u[n][i], f[i] += r[n][i];
    for (int i = 0; i < 3; i++) {
      int j = (i + 1) % 3, k = (i + 2) % 3;
      m[i] += x[j] * r[n][k] - x[k] * r[n][j];
    }
  }
  *force = norm_max(3, f);
  *moment = norm_max(3, m);
}

/* Positions of size L are rounded to eps L, so the gradients of tets of size h to eps L / h, the
   stress to (3 lambda + 2 mu) times that; a tet's nodal force is h^2 / 6 of the stress, and a node
   has up to 24 tets. With h = 0.35 and L = 2 + |c|. */
static double rounding(double shift) {
  return 4 * DBL_EPSILON * (3 * thick.lambda + 2 * thick.mu) * 0.35 * (2 + shift);
}

static void rigid_motion_makes_no_force_but_in_cauchy(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    solid s = make(m);
    uint64_t seed = 5;
    for (int repeat = 0; repeat < 20; repeat++) {
      double Q[9], c[3] = {10 * noise(&seed), 10 * noise(&seed), 10 * noise(&seed)};
      affine(&s, identity, c, s.u);
      residual(&s, s.r);
      assert_below(largest(&s, s.r), rounding(10));
      random_rotation(&seed, Q);
      affine(&s, Q, c, s.u);
      residual(&s, s.r);
      if (m == CAUCHY)
        assert_above(largest(&s, s.r), 1e10 * rounding(10)); /* Pa times the area of a face */
      else
        assert_below(largest(&s, s.r), rounding(10));
    }
    drop(&s);
  }
}

/* Rotating a moving, deforming body rotates its forces: r(Q x, Q v) = Q r(x, v). */
static void forces_turn_with_the_body_but_in_cauchy(void **state) {
  (void)state;
  uint64_t seed = 7;
  for (int m = 0; m < NMEASURE; m++) {
    solid s = make(m);
    double Q[9], c[3] = {1, -2, 0.5}, worst = 0;
    random_rotation(&seed, Q);
    deform(&s);
    residual(&s, s.s);
    double size = largest(&s, s.s);
    turn(&s, Q, c);
    residual(&s, s.r);
    for (int n = 0; n < s.nnode; n++) {
      double turned[3];
      apply(Q, s.s[n], turned);
      for (int i = 0; i < 3; i++) worst = fmax(worst, fabs(turned[i] - s.r[n][i]));
    }
    if (m == CAUCHY)
      assert_above(worst, 0.1 * size);
    else
      assert_below(worst, 4 * rounding(3));
    drop(&s);
  }
}

/* P F' is symmetric for polar, hybrid and green, so their internal forces have no moment about any
   point. Cauchy's have none about the rest positions only, and warp's have one. */
static void internal_forces_have_no_resultant(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    solid s = make(m);
    double force, moment;
    deform(&s);
    zero(&s, s.v);
    residual(&s, s.r);
    double size = largest(&s, s.r);
    resultant(&s, s.r, &force, &moment);
    assert_below(force, 64 * rounding(0)); /* of 64 nodes */
    if (m == CAUCHY || m == WARP)
      assert_above(moment, 1e-2 * size); /* warp: strain times the angle between the frames */
    else
      assert_below(moment, 2 * 64 * rounding(0));
    drop(&s);
  }
}

/* Held frames that lag behind F by an angle leave a couple of first order in it. */
static void held_frames_leave_a_couple(void **state) {
  (void)state;
  solid s = make(POLAR);
  double moment[2], force, size = 0;
  deform(&s);
  for (int k = 0; k < 2; k++) {
    double axis[3] = {1, 1, 0}, Q[9], back[9], none[3] = {0, 0, 0}, angle = k ? 1e-3 : 2e-3;
    rotation(axis, angle, Q), rotation(axis, -angle, back);
    assert_ok(corot_frames_update(s.b.model, s.b.state, 0, s.u[0], NULL));
    corot_state_use(s.b.state, COROT_FRAMES_HELD);
    turn(&s, Q, none);
    zero(&s, s.v);
    residual(&s, s.r);
    size = largest(&s, s.r);
    resultant(&s, s.r, &force, &moment[k]);
    turn(&s, back, none);
  }
  assert_above(moment[1], 1e-6 * size);
  assert_close(moment[0] / moment[1], 2, 0.05, 0);
  drop(&s);
}

/* v = w x (x - c): the viscous force and its power must not see it. Only green's do not. Where F is
   a rotation, nor do those of polar, hybrid and warp; elsewhere they see it through the strain. */
static void spin(const solid *s, const double w[3]) {
  for (int n = 0; n < s->nnode; n++) {
    double x[3];
    for (int i = 0; i < 3; i++) x[i] = s->b.mesh->x[n][i] + s->u[n][i] - 0.3;
    for (int i = 0; i < 3; i++) {
      int j = (i + 1) % 3, k = (i + 2) % 3;
      s->v[n][i] = w[j] * x[k] - w[k] * x[j];
    }
  }
}

static void viscous_forces_under_rigid_velocity(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    solid s = make(m);
    double Q[9], c[3] = {0.4, 0.1, 0}, w[3] = {0.5, -1, 2}, axis[3] = {1, 2, 3};
    corot_energies e;
    /* translation, deformed */
    deform(&s);
    for (int n = 0; n < s.nnode; n++) memcpy(s.v[n], w, sizeof w);
    viscous(&s, s.r);
    assert_below(largest(&s, s.r), 4 * rounding(2));
    /* rotation, turned by a radian but not deformed */
    rotation(axis, 1, Q);
    affine(&s, Q, c, s.u);
    spin(&s, w);
    viscous(&s, s.r);
    assert_ok(corot_energy(s.b.model, s.b.state, 0, s.u[0], s.v[0], &e));
    if (m == CAUCHY) {
      assert_above(largest(&s, s.r), 1e10 * rounding(2));
      assert_above(e.power_dissipated, 1e4); /* [W] */
    } else {
      assert_below(largest(&s, s.r), 4 * rounding(2));
      assert_below(e.power_dissipated, 1e-15);
    }
    /* rotation, deformed */
    deform(&s);
    spin(&s, w);
    viscous(&s, s.r);
    assert_ok(corot_energy(s.b.model, s.b.state, 0, s.u[0], s.v[0], &e));
    if (m == GREEN) {
      assert_below(largest(&s, s.r), 8 * rounding(2));
      assert_below(e.power_dissipated, 1e-15);
    } else {
      assert_above(e.power_dissipated, 1e-3);
    }
    drop(&s);
  }
}

/* Viscous forces sum to zero; F T F' is symmetric, R T F' is not, so that only green's have no
   moment. */
static void viscous_forces_have_no_resultant(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    solid s = make(m);
    double force, moment;
    deform(&s);
    viscous(&s, s.r);
    double size = largest(&s, s.r);
    resultant(&s, s.r, &force, &moment);
    assert_below(force, 64 * rounding(2));
    if (m == GREEN)
      assert_below(moment, 2 * 64 * rounding(2));
    else
      assert_above(moment, 1e-3 * size);
    drop(&s);
  }
}

/* The rate of the stretch itself is blind to rotations, and its stress has no moment. */
static void the_objective_law_does_not_feel_rotation(void **state) {
  (void)state;
  static const int objective[] = {POLAR, HYBRID};
  for (int k = 0; k < 2; k++) {
    solid s = make_viscous(objective[k], COROT_OBJECTIVE);
    double w[3] = {0.5, -1, 2}, force, moment;
    corot_energies e, spinning;
    deform(&s);
    viscous(&s, s.r);
    assert_above(largest(&s, s.r), 1e4);
    resultant(&s, s.r, &force, &moment);
    assert_below(force, 64 * rounding(2));
    assert_below(moment, 2 * 64 * rounding(2));
    assert_ok(corot_energy(s.b.model, s.b.state, 0, s.u[0], s.v[0], &e));
    assert_close(e.power_dissipated, -inner(s.b.n, s.r[0], s.v[0]), 1e-12, 0);
    spin(&s, w);
    viscous(&s, s.r);
    assert_below(largest(&s, s.r), 8 * rounding(2));
    assert_ok(corot_energy(s.b.model, s.b.state, 0, s.u[0], s.v[0], &spinning));
    assert_below(fabs(spinning.power_dissipated), 1e-14 * e.power_dissipated);
    drop(&s);
  }
}

/* Dissipation never supplies energy, and is the work of the viscous forces. */
static void viscous_power_is_that_of_the_forces(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    solid s = make(m);
    corot_energies e;
    deform(&s);
    viscous(&s, s.r);
    assert_ok(corot_energy(s.b.model, s.b.state, 0, s.u[0], s.v[0], &e));
    assert_above(e.power_dissipated, 0);
    assert_close(e.power_dissipated, -inner(s.b.n, s.r[0], s.v[0]), 1e-12, 0);
    drop(&s);
  }
}

/* Largest force on a node that is on no side of the box, for x = A X and v = B X: both stresses are
   constant, and the gradients of a node's shape function integrate to zero. */
static double patch(const solid *s, const double A[9], const double B[9]) {
  static const double none[3] = {0, 0, 0};
  const corot_mesh *mesh = s->b.mesh;
  double worst = 0;
  affine(s, A, none, s->u);
  for (int n = 0; n < s->nnode; n++) apply(B, mesh->x[n], s->v[n]);
  residual(s, s->r);
  memcpy(s->s, s->r, s->nnode * sizeof *s->r);
  for (int g = 0; g < mesh->ngroup; g++)
    for (int k = 0; k < mesh->group[g].nnode; k++)
      memset(s->s[mesh->group[g].node[k]], 0, sizeof *s->s);
  for (int n = 0; n < s->nnode; n++) worst = fmax(worst, norm_max(3, s->s[n]));
  return worst;
}

static void random_motion(double A[9], double B[9]) {
  double Q[9], T[9], axis[3] = {1, -1, 2};
  uint64_t seed = 11;
  rotation(axis, 0.8, Q);
  random_gradient(&seed, 0.2, T);
  multiply(Q, T, A);
  for (int k = 0; k < 9; k++) B[k] = noise(&seed);
}

/* Moves each node on an edge along e_x, by an amount of its own. */
static corot_mesh *bent_one_way(void) {
  corot_mesh *mesh = straight_box(3, 3, 3), *bent = crooked_box(3, 3, 3);
  for (int n = 0; n < mesh->nnode; n++) mesh->x[n][0] = bent->x[n][0];
  corot_mesh_destroy(bent);
  return mesh;
}

/* Where edges are straight, or all offsets of an element's nodes from the middles of its edges are
   parallel: see core/element/element.h. */
static void an_affine_motion_is_in_equilibrium(void **state) {
  (void)state;
  double A[9], B[9];
  random_motion(A, B);
  for (int m = 0; m < NMEASURE; m++)
    for (int bent = 0; bent < order_of_test(); bent++) {
      solid s = make_of(bent ? bent_one_way() : straight_box(3, 3, 3), m, COROT_COROTATED);
      double force = patch(&s, A, B), size = largest(&s, s.r);
      if (m == WARP) /* each tet's edges make a frame of their own out of the same F */
        assert_above(force, 1e-2 * size);
      else
        assert_below(force, 4 * rounding(0));
      corot_state_use(s.b.state, COROT_FRAMES_HELD); /* those of rest: all alike */
      assert_below(patch(&s, A, B), 4 * rounding(0));
      drop(&s);
    }
}

/* Edges that are curved every way leave forces of second order in their offsets. */
static void curved_edges_are_in_equilibrium_to_second_order(void **state) {
  (void)state;
  if (order_of_test() == 1) return;
  double A[9], B[9], force[2];
  random_motion(A, B);
  for (int m = 0; m < NMEASURE; m++) {
    if (m == WARP) continue;
    for (int k = 0; k < 2; k++) {
      corot_mesh *mesh = straight_box(3, 3, 3);
      bend_edges(mesh, k ? 0.001 : 0.002);
      solid s = make_of(mesh, m, COROT_COROTATED);
      force[k] = patch(&s, A, B);
      drop(&s);
    }
    assert_above(force[1], 1e3 * rounding(0));
    assert_close(force[0] / force[1], 4, 0.02, 0); /* products of three are left out: zero */
  }
}

/* With an energy, dr/du is symmetric: a' (dr/du) b = b' (dr/du) a. Warp has none unless its frames
   are held. */
static void the_derivative_of_the_elastic_force_is_symmetric(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++)
    for (corot_tangent t = COROT_TANGENT_HELD; t <= COROT_TANGENT_EXACT; t++) {
      solid s = make(m);
      int n = s.b.n;
      double *a = malloc(4 * n * sizeof *a), *b = a + n, *Ka = b + n, *Kb = Ka + n;
      uint64_t seed = 13;
      for (int i = 0; i < 2 * n; i++) a[i] = noise(&seed);
      deform(&s);
      zero(&s, s.v);
      double *none = s.v[0];
      assert_ok(corot_jvp(s.b.model, s.b.state, 0, s.u[0], none, t, a, none, Ka));
      assert_ok(corot_jvp(s.b.model, s.b.state, 0, s.u[0], none, t, b, none, Kb));
      double size = sqrt(inner(n, a, a) * inner(n, Kb, Kb));
      double skew = fabs(inner(n, a, Kb) - inner(n, b, Ka)) / size;
      if (m == WARP && t == COROT_TANGENT_EXACT)
        assert_above(skew, 1e-4);
      else
        assert_below(skew, 1e-14);
      free(a), drop(&s);
    }
}

/* The same (t, u, v) gives the same bits, whatever was evaluated before and by whichever state. */
static void evaluations_leave_no_trace(void **state) {
  (void)state;
  for (int m = 0; m < NMEASURE; m++) {
    solid s = make(m);
    corot_state *other;
    corot_energies e;
    size_t bytes = s.nnode * sizeof *s.r;
    deform(&s);
    residual(&s, s.r);
    assert_ok(corot_frames_update(s.b.model, s.b.state, 0, s.u[0], NULL));
    corot_status status = corot_energy(s.b.model, s.b.state, 1, s.v[0], s.u[0], &e); /* wild */
    assert_int_equal(status, m == CAUCHY ? COROT_OK : COROT_RETRY);
    assert_true((corot_state_inverted(s.b.state) >= 0) == (m != CAUCHY));
    residual(&s, s.s);
    assert_memory_equal(s.r, s.s, bytes);
    assert_int_equal(corot_state_inverted(s.b.state), -1);
    assert_ok(corot_state_create(s.b.model, &other));
    assert_ok(corot_residual(s.b.model, other, 0, s.u[0], s.v[0], s.s[0]));
    assert_memory_equal(s.r, s.s, bytes);
    corot_state_destroy(other), drop(&s);
  }
}

/* Uniaxial stretch by `a` and any rotation of it: frames, strains and stresses in closed form. */
static void fields_of_uniaxial_stretch(void **state) {
  (void)state;
  double a = 1.3, lambda = thick.lambda, mu = thick.mu, e = a - 1, green = (a * a - 1) / 2;
  const double mises[NMEASURE] = {
      [CAUCHY] = 2 * mu * e,
      [WARP] = fabs((lambda + 2 * mu) * e - lambda * e / a),
      [POLAR] = fabs((lambda + 2 * mu) * e - lambda * e / a),
      [HYBRID] = fabs(2 * mu * e + lambda * green * (a - 1 / a)),
      [GREEN] = fabs((lambda + 2 * mu) * green * a - lambda * green / a)};
  for (int m = 0; m < NMEASURE; m++)
    for (int turned = 0; turned < 2; turned++) {
      if (turned && m == CAUCHY) continue;
      solid s = make(m);
      int ntet = s.b.mesh->ntet;
      double U[9] = {a, 0, 0, 0, 1, 0, 0, 0, 1}, Q[9], F[9], none[3] = {0}, axis[3] = {1, 2, -1};
      rotation(axis, turned ? 2 : 0, Q);
      multiply(Q, U, F);
      affine(&s, F, none, s.u);
      double(*frame)[9] = malloc(ntet * sizeof *frame),
      (*strain)[6] = malloc(ntet * sizeof *strain);
      double *stress = malloc(2 * ntet * sizeof *stress), *det = stress + ntet;
      corot_element_fields fields = {frame, strain, stress, det};
      assert_ok(corot_elements(s.b.model, s.b.state, 0, s.u[0], &fields));
      for (int k = 0; k < ntet; k++) {
        double G[9];
        multiply_transposed(frame[k], frame[k], G);
        assert_below(distance(G, identity), 1e-14);
        assert_close(determinant(frame[k]), 1, 0, 1e-14);
        assert_close(det[k], a, 1e-13, 0);
        if (m == WARP) continue; /* its frame is its edges' and so are strain and stress */
        assert_below(distance(frame[k], m == GREEN ? identity : Q), 1e-13);
        assert_close(strain[k][0], m == GREEN ? green : e, 0, 1e-13);
        assert_below(norm_max(5, strain[k] + 1), 1e-13);
        assert_close(stress[k], mises[m], 1e-12, 0);
      }
      free(frame), free(strain), free(stress), drop(&s);
    }
}

/* Shear strain stands where the layout says: xx yy zz xy yz xz. */
static void fields_name_their_components(void **state) {
  (void)state;
  solid s = make(CAUCHY);
  int ntet = s.b.mesh->ntet;
  double F[9] = {1.01, 0.08, 0.10, 0, 1.02, 0.12, 0, 0, 1.03}, none[3] = {0};
  static const double expected[6] = {0.01, 0.02, 0.03, 0.04, 0.06, 0.05};
  double(*strain)[6] = malloc(ntet * sizeof *strain);
  affine(&s, F, none, s.u);
  assert_ok(
      corot_elements(s.b.model, s.b.state, 0, s.u[0], &(corot_element_fields){.strain = strain}));
  for (int k = 0; k < ntet; k++)
    for (int c = 0; c < 6; c++) assert_close(strain[k][c], expected[c], 0, 1e-13);
  free(strain), drop(&s);
}

/* The fields show the frames in use: held ones stay where they were. */
static void fields_show_the_frames_in_use(void **state) {
  (void)state;
  solid s = make(POLAR);
  int ntet = s.b.mesh->ntet;
  double Q[9], axis[3] = {0, 0, 1}, none[3] = {0}, (*frame)[9] = malloc(ntet * sizeof *frame);
  corot_frames_change change;
  corot_element_fields fields = {.frame = frame};
  rotation(axis, 0.5, Q);
  affine(&s, Q, none, s.u);
  corot_state_use(s.b.state, COROT_FRAMES_HELD);
  assert_ok(corot_elements(s.b.model, s.b.state, 0, s.u[0], &fields));
  for (int k = 0; k < ntet; k++) assert_memory_equal(frame[k], identity, sizeof identity);
  assert_ok(corot_frames_update(s.b.model, s.b.state, 0, s.u[0], &change));
  assert_close(change.angle_max, 0.5, 1e-13, 0);
  assert_close(change.angle_mean, 0.5, 1e-13, 0);
  assert_ok(corot_elements(s.b.model, s.b.state, 0, s.u[0], &fields));
  for (int k = 0; k < ntet; k++) assert_below(distance(frame[k], Q), 1e-14);
  free(frame), drop(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rigid_motion_makes_no_force_but_in_cauchy),
      cmocka_unit_test(forces_turn_with_the_body_but_in_cauchy),
      cmocka_unit_test(internal_forces_have_no_resultant),
      cmocka_unit_test(held_frames_leave_a_couple),
      cmocka_unit_test(viscous_forces_under_rigid_velocity),
      cmocka_unit_test(viscous_forces_have_no_resultant),
      cmocka_unit_test(the_objective_law_does_not_feel_rotation),
      cmocka_unit_test(viscous_power_is_that_of_the_forces),
      cmocka_unit_test(an_affine_motion_is_in_equilibrium),
      cmocka_unit_test(curved_edges_are_in_equilibrium_to_second_order),
      cmocka_unit_test(the_derivative_of_the_elastic_force_is_symmetric),
      cmocka_unit_test(evaluations_leave_no_trace),
      cmocka_unit_test(fields_of_uniaxial_stretch),
      cmocka_unit_test(fields_name_their_components),
      cmocka_unit_test(fields_show_the_frames_in_use),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* The solid as an ordinary differential equation, for an integrator of your own: here the leapfrog
   (Stoermer-Verlet) method, which keeps angular momentum and hardly loses energy. A free bar is set
   spinning. Needs corot::core. */
#include <corot/ode.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void check(corot_status status) {
  if (status == COROT_OK) return;
  fprintf(stderr, "corot: %s\n", corot_error());
  exit(1);
}

static corot_model *create_bar(void) {
  corot_box box = {.size = {0.1, 0.1, 0.6}, .cells = {1, 1, 6}, .origin = {-0.05, -0.05, -0.3}};
  const corot_material rubber = {.lambda = 1e5, .mu = 1e4, .density = 1000};
  corot_mesh *mesh;
  corot_model *model;
  check(corot_mesh_box(&box, &mesh));
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.nmaterial = 1, def.material = &rubber;
  check(corot_model_create(&def, &model));
  corot_mesh_destroy(mesh);
  return model;
}

/* v = omega x position, about the y axis, for each degree of freedom. */
static void spin(const corot_model *model, double omega, double *v) {
  const corot_mesh *mesh = corot_model_mesh(model);
  const int(*dof)[3] = corot_model_dof(model);
  for (int i = 0; i < mesh->nnode; i++) { /* nothing is held, or dof would be -1 there */
    v[dof[i][0]] = omega * mesh->x[i][2];
    v[dof[i][2]] = -omega * mesh->x[i][0];
  }
}

int main(void) {
  corot_model *model = create_bar();
  corot_state *state; /* frames and scratch; one for each thread */
  check(corot_state_create(model, &state));
  int n = corot_model_ndof(model);
  double *u = calloc(3 * (size_t)n, sizeof *u), *v = u + n, *r = u + 2 * n;
  if (!u) return 1;
  const double *mass = corot_model_mass(model);
  corot_energies start, end;
  spin(model, 5, v);
  check(corot_energy(model, state, 0, u, v, &start));

  double h = 1e-4; /* [s] below 2 over the largest frequency */
  for (int step = 0; step < 10000; step++) {
    double t = step * h;
    for (int i = 0; i < n; i++) u[i] += h / 2 * v[i];
    check(corot_residual(model, state, t + h / 2, u, v, r)); /* COROT_RETRY: a tet is inverted */
    for (int i = 0; i < n; i++) v[i] += h * r[i] / mass[i];
    for (int i = 0; i < n; i++) u[i] += h / 2 * v[i];
  }
  check(corot_energy(model, state, 1, u, v, &end));

  double before = start.kinetic + start.elastic, after = end.kinetic + end.elastic;
  printf("energy [J]: %.9g, at the end %.9g, of which elastic %.3g\n", before, after, end.elastic);
  printf("angular momentum [kg m^2/s]: %.9g, at the end %.9g\n", start.angular_momentum[1],
         end.angular_momentum[1]);

  free(u);
  corot_state_destroy(state);
  corot_model_destroy(model);
}

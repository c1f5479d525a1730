/* Equilibria of another program: CalculiX on the same meshes, large displacements of the linear
   elastic solid of St. Venant and Kirchhoff, which is strain green (references/README.md). */
#include <corot/statics.h>

#include "solid.h"

enum { MOST_POINTS = 4 };

typedef struct tip {
  const char *mesh; /* in references */
  int order;
  double E, nu;    /* [Pa] */
  int axis;        /* clamped on the plane across it ... */
  double at;       /* ... there [m] */
  double force[3]; /* on each of the points [N] */
  int npoint;
  double point[MOST_POINTS][3]; /* nodes at rest [m] */
  double u[3];                  /* of the last one [m] */
} tip;

static const tip tips[] = {
#include "calculix_tips.h"
};

static corot_mesh *read_mesh(const tip *of) {
  char path[512];
  corot_mesh *file, *mesh;
  snprintf(path, sizeof path, SOURCE_DIR "/tests/references/%s.msh", of->mesh);
  assert_ok(corot_mesh_read(path, &file));
  assert_ok(corot_mesh_change_order(file, of->order, &mesh));
  corot_mesh_destroy(file);
  return mesh;
}

static body body_of(const tip *of) {
  static const char *const name[MOST_POINTS] = {"p0", "p1", "p2", "p3"};
  corot_mesh *mesh = read_mesh(of);
  assert_ok(corot_mesh_group_plane(mesh, "clamp", of->axis, of->at, 0));
  corot_load load[MOST_POINTS];
  for (int k = 0; k < of->npoint; k++) {
    int node = corot_mesh_nearest(mesh, of->point[k]);
    assert_ok(corot_mesh_group_nodes(mesh, name[k], 1, &node));
    load[k] = (corot_load){.kind = COROT_FORCE, .group = name[k]};
    memcpy(load[k].value, of->force, sizeof of->force);
  }
  corot_material material = {.lambda = of->E * of->nu / (1 + of->nu) / (1 - 2 * of->nu),
                             .mu = of->E / 2 / (1 + of->nu),
                             .density = 1000};
  corot_fix fix = {"clamp", {true, true, true}};
  corot_model_def def = corot_model_defaults();
  def.strain = "green";
  def.nmaterial = 1, def.material = &material;
  def.nfix = 1, def.fix = &fix;
  def.nload = of->npoint, def.load = load;
  return make_body(mesh, def);
}

/* CalculiX prints seven digits, and goes on until corrections are 1e-9. */
static void tips_are_where_calculix_puts_them(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof tips / sizeof *tips; i++) {
    const tip *of = &tips[i];
    body b = body_of(of);
    corot_statics_def def = corot_statics_defaults();
    def.max_step = 0.25;
    corot_statics *s;
    assert_ok(corot_statics_create(&def, b.model, 1, NULL, &s));
    assert_ok(corot_statics_solve(s));
    double *u = malloc(b.n * sizeof *u);
    corot_statics_at(s, u);
    int node = corot_mesh_nearest(b.mesh, of->point[of->npoint - 1]);
    double length = sqrt(of->u[0] * of->u[0] + of->u[1] * of->u[1] + of->u[2] * of->u[2]);
    for (int c = 0; c < 3; c++)
      assert_close(u[corot_model_dof(b.model)[node][c]], of->u[c], 0, 1e-6 * length);
    free(u);
    corot_statics_destroy(s);
    drop_body(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tips_are_where_calculix_puts_them),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

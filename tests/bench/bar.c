/* The bar of the second example of Hauth & Strasser (2004). */
#include <math.h>

#include "bench.h"

bar_source bar_source_default(const char *strain) {
  return (bar_source){.box = {.size = {0.1, 0.1, 0.6}, .cells = {2, 2, 12}}, .strain = strain};
}

static void grade(const bar_source *source, corot_mesh *mesh) {
  double height = source->box.size[2];
  for (int k = 0; k < mesh->nnode; k++)
    mesh->x[k][2] = height * pow(mesh->x[k][2] / height, source->grading);
}

/* What there is before it is refined. */
static corot_status get_coarse(const bar_source *source, corot_mesh **mesh) {
  corot_mesh *m;
  COROT_TRY(source->mesh ? corot_mesh_read(source->mesh, &m) : corot_mesh_box(&source->box, &m));
  if (!source->mesh && source->grading > 0) grade(source, m);
  corot_status status = COROT_OK;
  *mesh = m;
  if (source->order) {
    status = corot_mesh_change_order(m, source->order, mesh);
    corot_mesh_destroy(m);
  }
  return status;
}

static corot_status get_mesh(const bar_source *source, int nlevel, corot_mesh **mesh,
                             corot_refinement **levels) {
  corot_mesh *coarse, *m;
  COROT_TRY(get_coarse(source, &coarse));
  corot_status refined = corot_mesh_refine(coarse, nlevel, COROT_DIAGONAL_CONSISTENT, &m, levels);
  corot_mesh_destroy(coarse);
  COROT_TRY(refined);
  corot_mesh_quality q = corot_mesh_measure(m);
  corot_status status = corot_mesh_group_plane(m, "lowest face", 2, q.min[2], 0);
  if (!status) status = corot_mesh_group_plane(m, "highest face", 2, q.max[2], 0);
  if (status) {
    corot_mesh_destroy(m);
    if (levels) corot_refinement_destroy(*levels);
    return status;
  }
  *mesh = m;
  return COROT_OK;
}

static corot_status make_model(corot_mesh *mesh, const char *strain, corot_model **model) {
  static const double time[] = {0, 10}, value[] = {0, 1};
  corot_material material = {
      .lambda = 1e5, .mu = 1e4, .density = 1000, .damping_lambda = 10, .damping_mu = 1};
  corot_fix fix = {"lowest face", {true, true, true}};
  corot_load load = {COROT_TRACTION, "highest face", {200, 0, 0}, {2, time, value}};
  corot_model_def def = corot_model_defaults();
  def.mesh = mesh, def.strain = strain;
  def.viscosity = COROT_COROTATED; /* the paper's */
  def.nmaterial = 1, def.material = &material;
  def.nfix = 1, def.fix = &fix;
  def.nload = 1, def.load = &load;
  return corot_model_create(&def, model);
}

corot_status bar_model(const bar_source *source, corot_model **model) {
  return bar_model_refined(source, 0, model, NULL);
}

corot_status bar_model_refined(const bar_source *source, int nlevel, corot_model **model,
                               corot_refinement **levels) {
  corot_mesh *mesh;
  COROT_TRY(get_mesh(source, nlevel, &mesh, levels));
  corot_status status = make_model(mesh, source->strain, model);
  corot_mesh_destroy(mesh);
  if (status && levels) corot_refinement_destroy(*levels);
  return status;
}

static int parse_cells(const char *program, const char *text, int cells[3]) {
  double number[3];
  bool good = parse_three(text, number);
  for (int i = 0; i < 3 && good; i++) {
    good = number[i] >= 1 && number[i] <= 1000 && number[i] == (int)number[i];
    if (good) cells[i] = (int)number[i];
  }
  if (good) return EXIT_OK;
  return usage_error(program, "--cells %s: expected three whole numbers I,J,K > 0", text);
}

int take_bar_option(const char *program, int answer, bar_source *source) {
  if (answer == 'c') return parse_cells(program, optarg, source->box.cells);
  if (answer != 'm' && answer != 's') return -1;
  *(answer == 'm' ? &source->mesh : &source->strain) = optarg;
  return EXIT_OK;
}

int take_repeat(const char *program, int most, int *nrun) {
  if (parse_count(optarg, most, nrun)) return EXIT_OK;
  return usage_error(program, "--repeat %s: expected a whole number from 1 to %d", optarg, most);
}

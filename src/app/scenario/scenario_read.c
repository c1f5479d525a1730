/* Reads the tree of a file, which the schema has checked, into a scenario. */
#include "scenario.h"

#include <stdlib.h>
#include <string.h>

#include "core/model/definition.h"
#include "scenario_fault.h"
#include "scenario_parts.h"

/* --- Mesh --- */

static corot_status read_order(scenario *s) {
  config_node *order = config_find(s->source->root, "mesh.order");
  if (order && order->number > 2)
    return config_fail(order, "order %.0f: tets are of order 1, with four nodes, or 2, with ten",
                       order->number);
  s->order = order ? (int)order->number : 0;
  return COROT_OK;
}

/* A file of the mesh as seen from the scenario's folder. */
static corot_status read_path(scenario *s, const config_node *file, const char **path) {
  if (!*file->text) return config_fail(file, "the name is empty");
  *path = config_beside(s->source, s->path, file->text);
  return *path ? COROT_OK : no_memory();
}

/* The unit that the file is in. */
static corot_status read_unit(scenario *s) {
  config_node *root = s->source->root, *unit = config_find(root, "mesh.unit"),
              *scale = config_find(root, "mesh.scale");
  if (unit && scale)
    return config_fail_key(scale,
                           "mesh.unit and mesh.scale exclude each other: the scale is what a "
                           "unit of the file has in metres");
  if ((unit || scale) && config_find(root, "mesh.box"))
    return config_fail_key(unit ? unit : scale, "a mesh.file has a unit; a box is in metres");
  if (unit) s->scale = length_in_metres(choice_at(root, "mesh.unit", words_length));
  if (scale) s->scale = scale->number;
  return COROT_OK;
}

static corot_status read_mesh(scenario *s) {
  config_node *root = s->source->root, *marks = config_find(root, "mesh.marks");
  COROT_TRY(read_order(s));
  COROT_TRY(read_unit(s));
  const config_node *cut = config_find(root, "mesh.cut");
  s->cut = cut && strcmp(cut->text, "true") == 0;
  if (marks) COROT_TRY(read_path(s, marks, &s->marks));
  config_node *box = config_find(root, "mesh.box");
  s->refine = (int)number_at(root, "mesh.refine");
  s->diagonal = (corot_diagonal)choice_at(root, "mesh.diagonal", words_diagonal);
  if (!box) return read_path(s, config_find(root, "mesh.file"), &s->mesh_file);
  double cells[3];
  vector_at(box, "size", s->box.size);
  vector_at(box, "cells", cells);
  vector_at(box, "origin", s->box.origin);
  for (int i = 0; i < 3; i++) s->box.cells[i] = (int)cells[i];
  s->box.split = (corot_box_split)choice_at(box, "split", words_box_split);
  return COROT_OK;
}

/* --- Material --- */

/* Puts lambda and mu in the place of E and nu, or mu and nu. */
static corot_status use_lame(config *tree, config_node *node) {
  config_node *lambda = config_find(node, "lambda"), *mu = config_find(node, "mu");
  config_node *E = config_find(node, "E"), *nu = config_find(node, "nu");
  bool lame = lambda && mu && !E && !nu, young = E && nu && !lambda && !mu;
  bool shear = mu && nu && !lambda && !E;
  if (!lame && !young && !shear)
    return config_fail_key(node, "give lambda and mu, or E and nu, or mu and nu");
  if (lame) return COROT_OK;

  double n = nu->number, m = young ? E->number / (2 * (1 + n)) : mu->number;
  double l = 2 * m * n / (1 - 2 * n);
  if (!(l - l == 0)) return config_fail(nu, "too near to 0.5: lambda overflows");
  config_remove(nu);
  config_remove(young ? E : mu);
  COROT_TRY(config_add_number(tree, node, "lambda", l));
  return config_add_number(tree, node, "mu", m);
}

static corot_status read_material(config *tree, config_node *node, corot_material *material) {
  COROT_TRY(use_lame(tree, node));
  *material = (corot_material){
      .group = text_at(node, "group"),
      .lambda = number_at(node, "lambda"),
      .mu = number_at(node, "mu"),
      .density = number_at(node, "density"),
      .damping_lambda = number_at(node, "damping.lambda"),
      .damping_mu = number_at(node, "damping.mu"),
      .damping_mass = number_at(node, "damping.mass"),
  };
  return COROT_OK;
}

static corot_status read_materials(scenario *s) {
  config_node *node = config_find(s->source->root, "material");
  bool list = node->kind == CONFIG_LIST;
  int n = list ? node->nchild : 1;
  corot_material *material = config_alloc(s->source, (size_t)n, sizeof *material);
  if (!material) return no_memory();
  s->model.material = material;
  for (config_node *c = list ? node->child : node; c; c = list ? c->next : NULL)
    COROT_TRY(config_keep(s->source, read_material(s->source, c, &material[s->model.nmaterial++])));
  return COROT_OK;
}

/* --- Time and output --- */

static corot_status read_time(scenario *s) {
  config_node *time = config_find(s->source->root, "time");
  s->t_end = number_at(time, "end");
  if (!config_find(time, "output"))
    COROT_TRY(config_add_number(s->source, time, "output", s->t_end / 100));
  s->output_step = number_at(time, "output");
  if (!(s->output_step > 0)) return config_fail(config_find(time, "end"), "too small");
  return COROT_OK;
}

bool scenario_is_column_name(const char *name) {
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  return name[strspn(name, letters)] == '\0';
}

/* The measure of the run itself is compared in any case, but for green, the reference. */
static corot_status read_compare(scenario *s) {
  const config_node *list = config_find(s->source->root, "compare");
  if (!list) return COROT_OK;
  const char **measure = config_alloc(s->source, (size_t)list->nchild + 1, sizeof *measure);
  if (!measure) return no_memory();
  s->compare = measure;
  bool listed = corot_strain_find(s->model.strain)->exact;
  for (const config_node *c = list->child; c; c = c->next) {
    measure[s->ncompare++] = c->text;
    listed |= strcmp(c->text, s->model.strain) == 0;
  }
  if (!listed) measure[s->ncompare++] = s->model.strain;
  return COROT_OK;
}

static void read_output(scenario *s) {
  config_node *root = s->source->root;
  s->title = text_at(root, "title");
  s->write_fields = text_is(root, "output.fields", "vtu");
  s->write_history = text_is(root, "output.history", "true");
  s->write_all_steps = config_find(root, "output.steps") && text_is(root, "output.steps", "all");
  s->write_states = text_is(root, "output.states", "binary");
  s->space_error = text_is(root, "output.space_error", "auto")   ? SPACE_ERROR_AUTO
                   : text_is(root, "output.space_error", "true") ? SPACE_ERROR_ON
                                                                 : SPACE_ERROR_OFF;
  s->compress_fields = text_is(root, "output.compression", "zlib");
  s->field_every = (int)number_at(root, "output.every");
}

static corot_status read_threads(scenario *s) {
  const config_node *node = config_find(s->source->root, "threads");
  if (!node) return COROT_OK;
  double n = number_at(s->source->root, "threads");
  if (n > COROT_MOST_THREADS)
    return config_fail(node, "must be at most %d, found %.0f", COROT_MOST_THREADS, n);
  s->threads = (int)n;
  return COROT_OK;
}

static void read_checkpoint(scenario *s) {
  config_node *node = config_find(s->source->root, "checkpoint");
  if (!node) return;
  s->checkpoint_every = number_at(node, "every");
  s->checkpoint_steps = (long)number_at(node, "steps");
}

/* --- All of it --- */

/* What is to be put in the place of the file's values: the texts, or the nodes. */
typedef struct overrides {
  int ntext;
  char *const *text;
  int nset;
  const setting *set;
} overrides;

static corot_status apply_overrides(config *tree, const overrides *o) {
  for (int i = 0; i < o->ntext; i++) {
    COROT_TRY(schema_expand(&scenario_schema, tree));
    COROT_TRY(config_override(tree, o->text[i]));
  }
  for (int i = 0; i < o->nset; i++) {
    COROT_TRY(schema_expand(&scenario_schema, tree));
    COROT_TRY(config_set(tree, o->set[i].key, o->set[i].value));
  }
  return COROT_OK;
}

/* What is read from the tree alone: a fault in one part is none in another. */
static corot_status read_body(scenario *s) {
  config *tree = s->source;
  COROT_TRY(config_keep(tree, read_mesh(s)));
  COROT_TRY(scenario_read_groups(s));
  COROT_TRY(read_materials(s));
  s->model.strain = text_at(tree->root, "strain");
  COROT_TRY(scenario_read_conditions(s));
  COROT_TRY(config_keep(tree, read_time(s)));
  COROT_TRY(config_keep(tree, scenario_read_method(s)));
  return config_kept(tree);
}

/* What is about a body. */
static corot_status read_question(scenario *s) {
  config *tree = s->source;
  COROT_TRY(config_keep(
      tree, scenario_told(s, NULL, corot_definition_check(&s->model, scenario_levels(s)))));
  COROT_TRY(config_keep(tree, scenario_read_statics(s)));
  COROT_TRY(config_keep(tree, scenario_read_start(s)));
  COROT_TRY(read_compare(s));
  COROT_TRY(config_keep(tree, scenario_read_inputs(s)));
  COROT_TRY(scenario_read_probes(s));
  COROT_TRY(scenario_read_quantities(s));
  read_output(s);
  COROT_TRY(config_keep(tree, read_threads(s)));
  read_checkpoint(s);
  return config_kept(tree);
}

static corot_status read_all(scenario *s, const char *path, const overrides *o) {
  COROT_TRY(apply_overrides(s->source, o));
  COROT_TRY(schema_apply(&scenario_schema, s->source));
  s->path = config_copy(s->source, path, strlen(path));
  if (!s->path) return no_memory();
  COROT_TRY(read_body(s));
  COROT_TRY(scenario_read_hierarchy(s));
  COROT_TRY(read_question(s));
  s->resolved = schema_resolve(s->source);
  return s->resolved ? COROT_OK : no_memory();
}

/* Takes over the tree. */
static corot_status from_tree(config *tree, const char *path, const overrides *o, scenario **out) {
  scenario *s = calloc(1, sizeof *s);
  if (!s) {
    config_destroy(tree);
    return no_memory();
  }
  s->source = tree;
  s->model = corot_model_defaults();
  s->hierarchy = corot_hierarchy_defaults();
  corot_status status = read_all(s, path, o);
  if (status == COROT_OK)
    *out = s;
  else
    scenario_destroy(s);
  return status;
}

corot_status scenario_read(const char *path, int noverride, char *const *override, scenario **out) {
  config *tree = NULL;
  COROT_TRY(config_read(path, &tree));
  return from_tree(tree, path, &(overrides){.ntext = noverride, .text = override}, out);
}

corot_status scenario_read_with(const char *path, int nset, const setting *set, scenario **out) {
  config *tree = NULL;
  COROT_TRY(config_read(path, &tree));
  return from_tree(tree, path, &(overrides){.nset = nset, .set = set}, out);
}

corot_status scenario_read_text(const char *path, const char *text, size_t size, int noverride,
                                char *const *override, scenario **out) {
  config *tree = NULL;
  COROT_TRY(config_read_text(path, text, size, &tree));
  return from_tree(tree, path, &(overrides){.ntext = noverride, .text = override}, out);
}

void scenario_destroy(scenario *s) {
  if (!s) return;
  json_decref(s->resolved);
  config_destroy(s->source);
  free(s);
}

/* How the body is taken through time: mass, frames, viscous law, integrator. */
#include "costs_file.h"
#include "scenario_parts.h"

static const struct {
  const char *name;
  corot_frames frames;
  bool every_step;
  bool conditions; /* updates at an interval or an angle */
} policies[] = {
    {.name = "exact", .frames = COROT_FRAMES_EXACT},
    {.name = "step", .frames = COROT_FRAMES_HELD, .every_step = true},
    {.name = "hold", .frames = COROT_FRAMES_HELD, .conditions = true},
    {.name = "extrapolate", .frames = COROT_FRAMES_EXTRAPOLATED, .conditions = true},
};

static corot_status read_frames(scenario *s) {
  config_node *frames = config_find(s->source->root, "frames");
  const config_node *policy = config_find(frames, "policy");
  const config_node *interval = config_find(frames, "interval");
  const config_node *angle = config_find(frames, "max_angle"), *given = interval ? interval : angle;
  int p = 0;
  while (strcmp(policies[p].name, policy->text) != 0) p++;
  /* a condition is given where the policy has one, and only there */
  if (policies[p].conditions && !given)
    return config_fail(policy, "%s needs frames.interval or frames.max_angle", policy->text);
  if (policies[p].every_step && given)
    return config_fail_key(given, "has no effect with policy: step, which updates at every step");
  if (!policies[p].conditions && given && !policy->source)
    return config_fail_key(given,
                           "has an effect with policy: hold or extrapolate only, and none "
                           "is given");

  s->frame_policy = policies[p].name;
  s->frames = corot_frame_policy_defaults();
  s->frames.frames = policies[p].frames;
  s->frames.every_step = policies[p].every_step;
  if (policies[p].conditions && interval) s->frames.interval = interval->number;
  if (policies[p].conditions && angle) s->frames.max_angle = angle->number;
  s->frames.history = (corot_history)choice_at(frames, "history", words_frame_history);
  return COROT_OK;
}

static corot_status read_constant_step(config_node *node, corot_integrator_def *def) {
  const config_node *step = config_find(node, "step"), *method = config_find(node, "method");
  const config_node *radius = config_find(node, "spectral_radius");
  bool controlled = corot_integrator_controls_error(def->method);
  if (step && controlled)
    return config_fail_key(step, "%s chooses its own steps; see first_step, max_step", def->method);
  if (!step && !controlled) return config_fail(method, "%s needs integrator.step", def->method);
  double least = corot_method_traits(def->method)->radius_min;
  if (radius->number < least)
    return config_fail(radius, "must be %g to 1 for %s, found %s", least, def->method,
                       radius->text);
  if (step) def->step = step->number;
  def->solution = (corot_solution)choice_at(node, "solution", words_solution);
  def->newton_tolerance = number_at(node, "newton.tolerance");
  def->newton_iterations = (int)number_at(node, "newton.iterations");
  def->spectral_radius = radius->number;
  return COROT_OK;
}

/* Of one Runge-Kutta method, which has one order. */
static corot_status read_stages(config_node *node, corot_integrator_def *def) {
  const config_node *order = config_find(node, "order"), *table = config_find(node, "table");
  const config_node *max_order = config_find(node, "max_order");
  const corot_method_kind *kind = corot_method_traits(def->method);
  bool stages = kind->stages;
  def->order = (int)number_at(node, "order");
  def->table = table ? table->text : NULL;
  if (!text_is(node, "predictor", "auto")) def->predictor = (int)number_at(node, "predictor");
  const config_node *predictor = config_find(node, "predictor");
  /* settings that are another method's */
  if (!stages && def->order > 0)
    return config_fail_key(order, "%s has none: see integrator.max_order", def->method);
  if (!stages && table) return config_fail_key(table, "%s has none", def->method);
  if ((!stages || kind->explicit_steps) && def->predictor >= 0)
    return config_fail_key(predictor, "%s has none", def->method);
  if (stages && def->max_order > 0)
    return config_fail_key(max_order, "%s has one order: see integrator.order", def->method);
  if (stages && def->order > 0 && table)
    return config_fail_key(table, "has an order of its own: give order or table");
  /* and values that this one cannot take */
  if (kind->gamma_change_below > 0 && def->gamma_change >= kind->gamma_change_below)
    return config_fail(config_find(node, "jacobian.gamma_change"), "must be < %g for %s, found %g",
                       kind->gamma_change_below, def->method, def->gamma_change);
  if (stages && def->order > kind->order_max)
    return config_fail(order, "must be %d to %d for %s, found %s", kind->order_min, kind->order_max,
                       def->method, order->text);
  return COROT_OK;
}

bool scenario_solves_by_levels(const scenario *s) {
  const char *preconditioner = s->integrator.linear.preconditioner;
  return strcmp(preconditioner, "hierarchical") == 0 || strcmp(preconditioner, "multigrid") == 0;
}

corot_status scenario_refuse_levels(const scenario *s) {
  return config_fail(config_find(s->source->root, "linear_solver.preconditioner"),
                     "%s needs mesh.refine%s", s->integrator.linear.preconditioner,
                     s->marks ? " without mesh.marks, or ten-node tets" : "");
}

/* Whether the costs of solvers have a say. */
static bool is_to_choose(const corot_linear_def *def) {
  const char *open = strcmp(def->solver, "pcg") == 0 ? def->preconditioner : def->solver;
  return strcmp(open, "auto") == 0;
}

/* The costs stay in the scenario. */
static corot_status read_linear_solver(scenario *s, corot_linear_def *def) {
  config_node *node = config_find(s->source->root, "linear_solver");
  def->solver = text_at(node, "name");
  def->ordering = text_at(node, "ordering");
  def->factor = text_at(node, "factor");
  def->preconditioner = text_at(node, "preconditioner");
  def->tolerance = number_at(node, "tolerance");
  if (is_to_choose(def)) COROT_TRY(costs_file_read(&s->costs, &s->tuned));
  if (s->tuned) def->costs = &s->costs;
  return COROT_OK;
}

static corot_status read_controlled_step(config_node *node, corot_integrator_def *def) {
  def->rtol = number_at(node, "rtol");
  def->atol_displacement = number_at(node, "atol.displacement");
  def->atol_velocity = number_at(node, "atol.velocity");
  def->max_order = (int)number_at(node, "max_order");
  def->first_step = number_at(node, "first_step");
  def->min_step = number_at(node, "min_step");
  def->max_step = number_at(node, "max_step");
  if (def->max_step > 0 && def->min_step > def->max_step)
    return config_fail(config_find(node, "min_step"), "larger than max_step");
  if (def->max_step > 0 && def->first_step > def->max_step)
    return config_fail(config_find(node, "first_step"), "larger than max_step");
  return COROT_OK;
}

static corot_status read_integrator(scenario *s) {
  config_node *root = s->source->root, *node = config_find(root, "integrator");
  corot_integrator_def def = corot_integrator_defaults();
  def.method = text_at(node, "method");
  def.max_steps = (long)number_at(node, "max_steps");
  def.tangent = (corot_tangent)choice_at(node, "jacobian.tangent", words_tangent);
  def.reassembly = (int)number_at(node, "jacobian.reassembly");
  def.refactorisation = (int)number_at(node, "jacobian.refactorisation");
  def.gamma_change = number_at(node, "jacobian.gamma_change");
  def.convergence = number_at(node, "jacobian.convergence");
  COROT_TRY(read_linear_solver(s, &def.linear));
  COROT_TRY(read_controlled_step(node, &def));
  COROT_TRY(read_stages(node, &def));
  COROT_TRY(read_constant_step(node, &def));
  s->integrator = def;
  bool by_file = s->mesh_file && s->order == 0; /* which may be of ten-node tets */
  bool none = scenario_levels(s) == 0 && !by_file && scenario_solves_by_levels(s);
  return none ? scenario_refuse_levels(s) : COROT_OK;
}

static void read_dilatation(scenario *s) {
  config_node *node = config_find(s->source->root, "dilatation");
  s->model.dilatation = (corot_dilatation)choice_at(node, "name", words_dilatation);
  s->model.dilatation_local = number_at(node, "local");
}

corot_status scenario_read_method(scenario *s) {
  s->model.mass = (corot_mass)choice_at(s->source->root, "mass", words_mass);
  read_dilatation(s);
  s->model.viscosity = (corot_viscosity)choice_at(s->source->root, "viscosity", words_viscosity);
  COROT_TRY(read_frames(s));
  return read_integrator(s);
}

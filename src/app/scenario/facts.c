/* Gathers the facts, then shows them as text or as JSON. */
#include "facts.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/config/config.h"
#include "app/text/json_text.h"
#include "app/text/plural.h"
#include "core/mesh/mesh.h"
#include "field_frames.h"
#include "probe_location.h"
#include "words.h"

/* --- Finding --- */

static double group_volume(const corot_mesh *mesh, const corot_group *group) {
  double volume = 0;
  for (int i = 0; i < group->ntet; i++) volume += corot_mesh_volume_of(mesh, group->tet[i]);
  return volume;
}

/* Each tet has one material: that of its group, or else the one without a group. */
static double total_mass(const scenario *s, const facts *f) {
  double mass = 0, rest = f->quality.volume, density = 0;
  for (int i = 0; i < s->model.nmaterial; i++) {
    const corot_material *m = &s->model.material[i];
    if (!m->group) {
      density = m->density;
      continue;
    }
    double volume = group_volume(f->mesh, corot_mesh_find_group(f->mesh, m->group));
    mass += m->density * volume;
    rest -= volume;
  }
  return mass + density * rest;
}

static corot_status choose(const scenario *s, facts *f, corot_state *state) {
  size_t n = (size_t)corot_model_ndof(f->model);
  double *zero = calloc(n + 1, sizeof *zero);
  if (!zero) return corot_fail(COROT_ENOMEM, "%zu degrees of freedom: out of memory", n);
  corot_integrator *integrator = NULL;
  corot_integrator_def def = s->integrator;
  def.linear.refinement = f->refinement;
  corot_status status = corot_integrator_create(&def, f->model, state, 0, zero, zero, &integrator);
  if (status == COROT_OK) f->chosen = corot_integrator_chosen(integrator);
  corot_integrator_destroy(integrator);
  free(zero);
  return status;
}

static corot_status locate_probes(const scenario *s, facts *f) {
  f->probe = calloc((size_t)s->nprobe + 1, sizeof *f->probe);
  if (!f->probe) return corot_fail(COROT_ENOMEM, "the probes: out of memory");
  for (int i = 0; i < s->nprobe; i++)
    if (probe_is_local(&s->probe[i])) COROT_TRY(probe_locate(&s->probe[i], f->mesh, &f->probe[i]));
  return COROT_OK;
}

corot_status facts_find(const scenario *s, facts *f) {
  corot_state *state = NULL;
  COROT_TRY(scenario_build_warned(s, &f->mesh, &f->refinement, &f->model, &f->warnings));
  f->quality = corot_mesh_measure(f->mesh);
  COROT_TRY(warnings_before(s, f->model, false, &f->warnings));
  COROT_TRY(locate_probes(s, f));
  f->mass = total_mass(s, f);
  COROT_TRY(corot_state_create(f->model, &state));
  f->bytes = corot_model_bytes(f->model) + corot_state_bytes(state);
  corot_status status = choose(s, f, state);
  corot_state_destroy(state);
  if (status != COROT_EINVAL) return status;
  return config_fail(config_find(s->source->root, "linear_solver"), "%s", corot_error());
}

void facts_free(facts *f) {
  warnings_free(&f->warnings);
  free(f->probe);
  corot_model_destroy(f->model);
  corot_refinement_destroy(f->refinement);
  corot_mesh_destroy(f->mesh);
}

/* --- What both reports say --- */

/* "stress, max" of what is not a displacement at a point or node. */
static void describe_probe(const probe_def *p, size_t size, char *text) {
  const probe_quantity *q = &probe_quantities[p->of];
  bool takes = !probe_is_local(p) && q->carrier < SUM_OVER_NODES;
  snprintf(text, size, "%s%s%s%s%s", q->word, p->component ? " " : "",
           probe_components[p->component], takes ? ", " : "", takes ? probe_takes[p->take] : "");
}

/* --- Text --- */

static bool is_named(const char *name, const char *group) {
  return name && strcmp(name, group) == 0;
}

static const char *const motion_words[] = {
    [COROT_ROTATE] = "rotated",
    [COROT_TRANSLATE] = "translated",
    [COROT_TURN] = "turned by an amplitude",
    [COROT_MOVE] = "moved by an amplitude",
};

static void print_uses(const scenario *s, const char *group, FILE *out) {
  for (int i = 0; i < s->model.nfix; i++) {
    if (!is_named(s->model.fix[i].group, group)) continue;
    fputs("; fixed", out);
    for (int k = 0; k < 3; k++)
      if (s->model.fix[i].component[k]) fprintf(out, " %c", "xyz"[k]);
  }
  for (int i = 0; i < s->model.nmotion; i++)
    if (is_named(s->model.motion[i].group, group))
      fprintf(out, "; %s", motion_words[s->model.motion[i].kind]);
  for (int i = 0; i < s->model.nload; i++)
    if (is_named(s->model.load[i].group, group))
      fprintf(out, "; %s", words_load[s->model.load[i].kind]);
  for (int i = 0; i < s->model.nmaterial; i++)
    if (is_named(s->model.material[i].group, group)) fputs("; material", out);
}

/* A symmetric split cuts the middle one of an odd number of cells in halves. */
static void print_box(const corot_box *box, FILE *out) {
  const char *before = ", middle cells halved along ";
  fputs("box", out);
  for (int k = 0; k < 3 && box->split == COROT_BOX_SYMMETRIC; k++)
    if (box->cells[k] % 2 == 1) {
      fprintf(out, "%s%c", before, "xyz"[k]);
      before = " ";
    }
}

static void print_mesh(const scenario *s, const facts *f, FILE *out) {
  const corot_mesh_quality *q = &f->quality;
  fprintf(out, "mesh           %s", s->mesh_file ? s->mesh_file : "");
  if (!s->mesh_file) print_box(&s->box, out);
  if (s->scale > 0) fprintf(out, ", times %g m", s->scale);
  if (s->refine > 0) fprintf(out, ", refine %d", s->refine);
  if (s->marks) fprintf(out, ", marks %s", s->marks);
  fprintf(out, ": %d nodes, %d %stets, %.6g m^3\n", f->mesh->nnode, f->mesh->ntet,
          f->mesh->mid ? "ten-node " : "", q->volume);
  fprintf(out, "extent         [%g, %g] x [%g, %g] x [%g, %g] m\n", q->min[0], q->max[0], q->min[1],
          q->max[1], q->min[2], q->max[2]);
  fprintf(out, "shape          mean %.3f, worst %.3f (tet %d)\n", q->shape_mean, q->shape_min,
          q->shape_worst);
  for (int i = 0; i < f->mesh->ngroup; i++) {
    const corot_group *g = &f->mesh->group[i];
    fprintf(out, "group          %s: %d nodes, %d triangles, %d tets", g->name, g->nnode, g->ntri,
            g->ntet);
    print_uses(s, g->name, out);
    fputc('\n', out);
  }
}

static void print_frames(const scenario *s, FILE *out) {
  const corot_frame_policy *p = &s->frames;
  fprintf(out, "strain         %s, frames: %s", s->model.strain, s->frame_policy);
  if (p->interval > 0) fprintf(out, ", every %g s", p->interval);
  if (p->max_angle > 0) fprintf(out, ", beyond %g rad", p->max_angle);
  fputc('\n', out);
}

static const char *viscosity_name(const facts *f) {
  return words_viscosity[corot_model_viscosity(f->model)];
}

static void print_viscosity(const scenario *s, const facts *f, FILE *out) {
  bool viscous = false;
  for (int i = 0; i < s->model.nmaterial; i++)
    viscous |= s->model.material[i].damping_lambda > 0 || s->model.material[i].damping_mu > 0;
  if (viscous) fprintf(out, "viscosity      %s\n", viscosity_name(f));
}

static void print_dilatation(const scenario *s, FILE *out) {
  if (s->model.dilatation == COROT_DILATATION_NODAL)
    fprintf(out, "dilatation     averaged at the nodes, but for %g mu of lambda\n",
            s->model.dilatation_local);
  if (s->model.dilatation == COROT_DILATATION_ELEMENT)
    fprintf(out, "dilatation     averaged over each tet\n");
}

static void print_amplitude(const corot_amplitude *a, FILE *out) {
  char text[160];
  scenario_describe_amplitude(a, sizeof text, text);
  fprintf(out, "%s%s\n", *text ? ", amplitude: " : "", text);
}

static void print_vector(const double x[3], const char *unit, FILE *out) {
  fprintf(out, "(%g, %g, %g) %s", x[0], x[1], x[2], unit);
}

static void print_load(const corot_load *l, FILE *out) {
  static const char *const unit[] = {
      [COROT_TRACTION] = "Pa",
      [COROT_GRAVITY] = "m/s^2",
      [COROT_FORCE] = "N",
      [COROT_PRESSURE] = "Pa",
  };
  fprintf(out, "load           %s%s%s: ", words_load[l->kind], l->group ? " on " : "",
          l->group ? l->group : "");
  if (l->kind == COROT_PRESSURE)
    fprintf(out, "%g Pa", l->value[0]);
  else
    print_vector(l->value, unit[l->kind], out);
  print_amplitude(&l->amplitude, out);
}

static void print_input(const input_def *in, FILE *out) {
  fprintf(out, "input          %s: factor of %s[%d]", in->name,
          in->of == INPUT_LOAD ? "loads" : "material", in->index);
  print_amplitude(&in->values, out);
}

static void print_motion(const corot_motion *m, FILE *out) {
  fprintf(out, "motion         of %s: ", m->group);
  switch (m->kind) {
    case COROT_ROTATE:
      fprintf(out, "turned at %g rad/s from t = %g to %g s\n", m->rate, m->from, m->to);
      break;
    case COROT_TRANSLATE:
      print_vector(m->velocity, "m/s", out);
      fprintf(out, " from t = %g to %g s\n", m->from, m->to);
      break;
    case COROT_TURN:
      fprintf(out, "turned by %g rad", m->angle);
      print_amplitude(&m->amplitude, out);
      break;
    case COROT_MOVE:
      print_vector(m->direction, "m", out);
      print_amplitude(&m->amplitude, out);
  }
}

static void print_start(const start_def *start, FILE *out) {
  fprintf(out, "start          %s at ", start->group ? start->group : "body");
  print_vector(start->velocity, "m/s", out);
  if (start->rate != 0) {
    fprintf(out, ", spinning at %g rad/s about ", start->rate);
    print_vector(start->axis, "through ", out);
    print_vector(start->center, "m", out);
  }
  fputc('\n', out);
}

/* What acts on the body from outside, and what it begins with. */
static void print_inputs(const scenario *s, FILE *out) {
  for (int i = 0; i < s->model.nload; i++) print_load(&s->model.load[i], out);
  for (int i = 0; i < s->model.nmotion; i++) print_motion(&s->model.motion[i], out);
  for (int i = 0; i < s->ninput; i++) print_input(&s->input[i], out);
  if (s->start_at_equilibrium) fputs("start          in equilibrium\n", out);
  for (int i = 0; i < s->nstart; i++) print_start(&s->start[i], out);
}

static void print_model(const scenario *s, const facts *f, FILE *out) {
  int ndof = corot_model_ndof(f->model), all = 3 * f->mesh->nnode;
  for (int i = 0; i < s->model.nmaterial; i++) {
    const corot_material *m = &s->model.material[i];
    fprintf(out, "material       %s%slambda %g, mu %g Pa; %g kg/m^3; damping %g, %g Pa s",
            m->group ? m->group : "", m->group ? ": " : "", m->lambda, m->mu, m->density,
            m->damping_lambda, m->damping_mu);
    if (m->damping_mass > 0) fprintf(out, ", %g 1/s", m->damping_mass);
    fputc('\n', out);
  }
  fprintf(out, "mass           %.6g kg\n", f->mass);
  fprintf(out, "freedom        %d of %d components%s\n", ndof, all,
          ndof == all ? ": a free body" : "");
  fprintf(out, "loads          %d\n", s->model.nload);
  print_inputs(s, out);
  print_frames(s, out);
  print_viscosity(s, f, out);
  print_dilatation(s, out);
  fprintf(out, "memory         %.3g MB, %.0f bytes a tet\n", 1e-6 * (double)f->bytes,
          (double)f->bytes / f->mesh->ntet);
}

static void print_integrator(const scenario *s, const corot_integrator_choice *c, FILE *out) {
  const corot_integrator_def *d = &s->integrator;
  fprintf(out, "integrator     %s, ", c->method);
  if (d->step > 0)
    fprintf(out, "steps of %g s, %s", d->step,
            d->solution == COROT_SOLUTION_LINEAR ? "one linear solve each" : "Newton");
  else if (*c->table)
    fprintf(out, "order %d, %s", c->max_order, c->table);
  else
    fprintf(out, "order up to %d", c->max_order);
  if (!corot_method_traits(d->method)->explicit_steps)
    fprintf(out, ", linear solver %s", c->linear_solver);
  fputc('\n', out);
  if (d->step > 0)
    fprintf(out, "tolerances     Newton %g\n", d->newton_tolerance);
  else
    fprintf(out, "tolerances     relative %g; absolute %g m, %g m/s\n", d->rtol,
            c->atol_displacement, c->atol_velocity);
}

static void print_probe(const probe_def *p, const corot_location *at, const corot_mesh *mesh,
                        FILE *out) {
  char what[96];
  describe_probe(p, sizeof what, what);
  fprintf(out, "probe          %s: ", p->name);
  if (!probe_is_plain(p)) fprintf(out, "%s, ", what);
  const corot_group *group = p->group ? corot_mesh_find_group(mesh, p->group) : NULL;
  if (group)
    fprintf(out, "%s (%d node%s)", p->group, group->nnode, plural(group->nnode));
  else if (p->body)
    fputs("the whole body", out);
  else
    fprintf(out, "%s %d at (%g, %g, %g)", at->nnode == 1 ? "node" : "tet",
            at->nnode == 1 ? at->node[0] : at->tet, at->x[0], at->x[1], at->x[2]);
  if (at->distance > 0) fprintf(out, ", %.3g m from its point", at->distance);
  fputc('\n', out);
}

static void print_fields(const scenario *s, const facts *f, FILE *out) {
  char text[160];
  const field_frames frames = field_frames_of(s, f->mesh);
  field_frames_words(&frames, sizeof text, text);
  if (frames.thinned) fprintf(out, "fields         %s\n", text);
}

static void print_run(const scenario *s, const facts *f, FILE *out) {
  print_integrator(s, &f->chosen, out);
  fprintf(out, "time           0 to %g s, output every %g s\n", s->t_end, s->output_step);
  print_fields(s, f, out);
  if (s->checkpoint_steps > 0)
    fprintf(out, "checkpoint     after each %ld step%s, written every %g s of the clock\n",
            s->checkpoint_steps, plural(s->checkpoint_steps), s->checkpoint_every);
  for (int i = 0; i < s->nprobe; i++) print_probe(&s->probe[i], &f->probe[i], f->mesh, out);
}

static void print_quantities(const scenario *s, FILE *out) {
  for (int i = 0; i < s->nquantity; i++)
    fprintf(out, "quantity       %s: %s\n", s->quantity[i].name, s->quantity[i].quantity.text);
}

void facts_print(const scenario *s, const facts *f, FILE *out) {
  fprintf(out, "scenario       %s: ok\n", s->path);
  if (*s->title) fprintf(out, "title          %s\n", s->title);
  print_mesh(s, f, out);
  print_model(s, f, out);
  print_run(s, f, out);
  print_quantities(s, out);
  warnings_print(&f->warnings, 0, "warning        ", out);
}

/* --- JSON --- */

json_t *facts_groups(const corot_mesh *mesh) {
  json_t *list = json_array();
  for (int i = 0; i < mesh->ngroup; i++) {
    const corot_group *g = &mesh->group[i];
    list =
        json_text_push(list, json_pack("{s:o, s:i, s:i, s:i}", "name", json_text_string(g->name),
                                       "nodes", g->nnode, "triangles", g->ntri, "tets", g->ntet));
  }
  return list;
}

static json_t *probe_json(const probe_def *p, const corot_location *at) {
  json_t *j = json_pack("{s:s}", "name", p->name);
  if (!probe_is_plain(p)) j = json_text_with(j, "of", json_string(probe_quantities[p->of].word));
  if (!probe_is_local(p)) {
    j = json_text_with(j, "take", json_string(probe_takes[p->take]));
    return json_text_with(j, "group", p->group ? json_text_string(p->group) : json_null());
  }
  j = json_text_with(j, "node", at->nnode == 1 ? json_integer(at->node[0]) : json_null());
  if (at->nnode > 1) j = json_text_with(j, "tet", json_integer(at->tet));
  j = json_text_with(j, "x", json_pack("[f, f, f]", at->x[0], at->x[1], at->x[2]));
  return json_text_with(j, "distance", json_real(at->distance));
}

static json_t *probes_json(const scenario *s, const facts *f) {
  json_t *list = json_array();
  for (int i = 0; i < s->nprobe; i++)
    list = json_text_push(list, probe_json(&s->probe[i], &f->probe[i]));
  return list;
}

static json_t *mesh_json(const scenario *s, const facts *f) {
  const corot_mesh_quality *q = &f->quality;
  json_t *j = json_pack("{s:i, s:i, s:i, s:f}", "order", corot_mesh_order(f->mesh), "nodes",
                        f->mesh->nnode, "tets", f->mesh->ntet, "volume", q->volume);
  j = json_text_with(j, "file", s->mesh_file ? json_text_string(s->mesh_file) : json_null());
  j = json_text_with(j, "refine", json_integer(s->refine));
  if (s->marks) j = json_text_with(j, "marks", json_text_string(s->marks));
  j = json_text_with(j, "min", json_pack("[f, f, f]", q->min[0], q->min[1], q->min[2]));
  j = json_text_with(j, "max", json_pack("[f, f, f]", q->max[0], q->max[1], q->max[2]));
  return json_text_with(j, "shape",
                        json_pack("{s:f, s:f}", "mean", q->shape_mean, "min", q->shape_min));
}

static void add_amplitude(json_t *list, const char *key, const corot_amplitude *a) {
  char text[160];
  scenario_describe_amplitude(a, sizeof text, text);
  json_array_append_new(list, json_pack("{s:s, s:s}", "of", key, "amplitude", text));
}

/* Where there are amplitudes, in words; a scenario resolved has all of their numbers. */
static json_t *amplitudes_json(const scenario *s) {
  json_t *list = json_array();
  char key[32];
  for (int i = 0; i < s->model.nload; i++) {
    snprintf(key, sizeof key, "loads[%d]", i);
    add_amplitude(list, key, &s->model.load[i].amplitude);
  }
  for (int i = 0; i < s->model.nmotion; i++) {
    if (s->model.motion[i].kind != COROT_MOVE && s->model.motion[i].kind != COROT_TURN) continue;
    snprintf(key, sizeof key, "motion of %.20s", s->model.motion[i].group);
    add_amplitude(list, key, &s->model.motion[i].amplitude);
  }
  for (int i = 0; i < s->ninput; i++) {
    snprintf(key, sizeof key, "inputs.%.20s", s->input[i].name);
    add_amplitude(list, key, &s->input[i].values);
  }
  return list;
}

static json_t *integrator_json(const scenario *s, const corot_integrator_choice *c) {
  double step = s->integrator.step;
  return json_pack("{s:s, s:s, s:i, s:f, s:f, s:f, s:o}", "method", c->method, "linear_solver",
                   c->linear_solver, "max_order", c->max_order, "rtol", s->integrator.rtol,
                   "atol_displacement", c->atol_displacement, "atol_velocity", c->atol_velocity,
                   "step", step > 0 ? json_real(step) : json_null());
}

static json_t *quantities_json(const scenario *s) {
  json_t *all = json_object();
  for (int i = 0; i < s->nquantity; i++)
    all = json_text_with(all, s->quantity[i].name, json_string(s->quantity[i].quantity.text));
  return all;
}

json_t *facts_json(const scenario *s, const facts *f) {
  json_t *j = json_object();
  j = json_text_with(j, "scenario", json_text_string(s->path));
  j = json_text_with(j, "title", json_string(s->title));
  j = json_text_with(j, "mesh", mesh_json(s, f));
  j = json_text_with(j, "groups", facts_groups(f->mesh));
  j = json_text_with(j, "mass", json_real(f->mass));
  j = json_text_with(j, "dofs", json_integer(corot_model_ndof(f->model)));
  j = json_text_with(j, "loads", json_integer(s->model.nload));
  j = json_text_with(j, "amplitudes", amplitudes_json(s));
  j = json_text_with(j, "strain", json_string(s->model.strain));
  j = json_text_with(j, "dilatation", json_string(words_dilatation[s->model.dilatation]));
  j = json_text_with(j, "viscosity", json_string(viscosity_name(f)));
  j = json_text_with(j, "frames", json_string(s->frame_policy));
  j = json_text_with(j, "bytes", json_integer((json_int_t)f->bytes));
  j = json_text_with(j, "integrator", integrator_json(s, &f->chosen));
  j = json_text_with(j, "time", json_pack("{s:f, s:f}", "end", s->t_end, "output", s->output_step));
  const field_frames frames = field_frames_of(s, f->mesh);
  j = json_text_with(
      j, "fields",
      json_pack("{s:i, s:I, s:f, s:b}", "every", frames.every, "frames", (json_int_t)frames.n,
                "bytes", frames.bytes * (double)frames.n, "thinned", frames.thinned));
  if (s->checkpoint_steps > 0)
    j = json_text_with(j, "checkpoint",
                       json_pack("{s:f, s:I}", "every", s->checkpoint_every, "steps",
                                 (json_int_t)s->checkpoint_steps));
  j = json_text_with(j, "probes", probes_json(s, f));
  j = json_text_with(j, "quantities", quantities_json(s));
  return json_text_with(j, "warnings", warnings_json(&f->warnings));
}

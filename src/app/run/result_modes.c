/* Frequencies and what they were found by, as JSON. */
#include "result_modes.h"

#include "app/folder/provenance.h"
#include "app/text/json_text.h"

static json_t *mode_entry(int number, const corot_mode *m) {
  const double *mass = m->effective_mass;
  return json_pack("{s:i, s:o, s:o, s:o, s:[o, o, o], s:o}", "mode", number, "frequency",
                   json_text_real(m->frequency), "growth", json_text_real(m->growth), "eigenvalue",
                   json_text_real(m->eigenvalue), "effective_mass", json_text_real(mass[0]),
                   json_text_real(mass[1]), json_text_real(mass[2]), "residual",
                   json_text_real(m->residual));
}

static json_t *modes_part(const modes_summary *run) {
  const corot_modes *modes = run->modes;
  corot_modes_facts f = corot_modes_known(modes);
  json_t *list = json_array();
  for (int k = 0; k < corot_modes_count(modes); k++) {
    corot_mode mode = corot_modes_at(modes, k);
    list = json_text_push(list, mode_entry(k + 1, &mode));
  }
  return json_pack("{s:s, s:o, s:i, s:i, s:o, s:o, s:o, s:s, s:o}", "about", run->about, "t",
                   json_text_real(run->t), "count", corot_modes_count(modes), "rigid", f.nrigid,
                   "zero_below", json_text_real(f.zero), "shift", json_text_real(f.shift),
                   "asymmetry", json_text_real(f.asymmetry), "linear_solver", f.solver, "list",
                   list);
}

static json_t *statistics_part(const modes_summary *run) {
  corot_modes_facts f = corot_modes_known(run->modes);
  return json_pack("{s:I, s:I, s:I}", "nfactor", (json_int_t)f.nfactor, "nsolve",
                   (json_int_t)f.nsolve, "nrestart", (json_int_t)f.nrestart);
}

static json_t *timings_part(const modes_summary *run) {
  corot_modes_facts f = corot_modes_known(run->modes);
  double known = run->setup_s + run->equilibrium_s + f.assembly_s + f.factor_s + f.solve_s +
                 f.other_s + run->output_s;
  return json_pack("{s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "setup",
                   json_text_real(run->setup_s), "equilibrium", json_text_real(run->equilibrium_s),
                   "assembly", json_text_real(f.assembly_s), "factor", json_text_real(f.factor_s),
                   "solve", json_text_real(f.solve_s), "iteration", json_text_real(f.other_s),
                   "output", json_text_real(run->output_s), "other",
                   json_text_real(run->wall_s - known), "wall", json_text_real(run->wall_s), "cpu",
                   json_text_real(run->cpu_s));
}

/* In the order of the file. */
corot_status result_modes_make(const scenario *s, const modes_summary *run, json_t **out) {
  const hashes *h = &run->hashes;
  json_t *provenance;
  COROT_TRY(provenance_make(&provenance));
  json_t *result = json_pack(
      "{s:o, s:s, s:o, s:o, s:i, s:o, s:o, s:o, s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:{s:s, s:s, "
      "s:s}, s:O}",
      "title", json_text_string(s->title ? s->title : ""), "status", run->status, "reason",
      run->reason ? json_text_string(run->reason) : json_null(), "failure",
      run_failure_json(run->failure), "exit_code", run->exit_code, "t_reached",
      json_text_real(run->t), "t_end", json_text_real(s->t_end), "warnings",
      warnings_json(run->warnings), "strain", corot_model_strain(run->model), "mesh",
      result_mesh(s, run->model), "modes", modes_part(run), "statistics", statistics_part(run),
      "timings", timings_part(run), "versions", result_versions(), "provenance", provenance,
      "hashes", "scenario", h->scenario, "mesh", h->mesh, "run", h->run, "scenario", s->resolved);
  if (!result) return corot_fail(COROT_ENOMEM, "result.json: out of memory");
  *out = result;
  return COROT_OK;
}

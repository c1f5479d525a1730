/* What a run has shown. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/scenario/warnings.h"
#include "app/scenario/warnings_parts.h"
#include "outputs.h"

/* --- Energy --- */

/* The part of the energy that may go astray: a hundred tolerances, for the errors of steps add up
   (a clamped bar without damping loses 30 of them in twelve of its periods with cvode, of any
   rtol), but not more than 2 %, at which a vibration has lost 1 % of its width; one that is damped
   or held loses one to three tolerances. A constant step has no tolerance: 1 %. */
static double energy_share(const scenario *s) {
  if (s->integrator.step > 0) return 0.01;
  return fmax(1e-4, fmin(0.02, 100 * s->integrator.rtol));
}

/* What helps: arkode errs less at the same tolerance, and costs more (warnings_integrator.c). */
static const char *energy_remedy(const scenario *s) {
  if (s->integrator.step > 0) return "take shorter steps, or a method with error control";
  if (corot_method_traits(s->integrator.method)->multistep)
    return "lower integrator.rtol, or take integrator.method: arkode";
  return "lower integrator.rtol";
}

/* Whether the body moves so slowly that the error is no vibration's. */
static bool is_slow(const history_facts *h, double error) { return h->kinetic < 0.1 * error; }

/* A loss that is still there in the end is damping by the method. A gain, or an error that comes
   and goes, is not, nor is one of a body that hardly swings. */
static corot_status find_energy(const scenario *s, const history_facts *h, warnings *w) {
  double gain = h->balance_max.value, loss = -h->balance_min.value, share = energy_share(s);
  double worst = fmax(gain, loss);
  if (!(worst > share * h->energy)) return COROT_OK;
  bool damped = loss > gain && -h->balance >= 0.5 * loss && !is_slow(h, loss);
  if (damped)
    return warnings_add(w, WARNING_DISSIPATION,
                        "the method itself took %.3g J from the motion by t = %.4g s, %.2g %% of "
                        "the largest energy, %.3g J (%.3g J went by damping; %.2g %% would pass): "
                        "vibrations die away faster than they should; %s",
                        loss, h->balance_min.t, 100 * loss / h->energy, h->energy, h->dissipated,
                        100 * share, energy_remedy(s));
  return warnings_add(w, WARNING_LEDGER,
                      "energies and work do not add up: at t = %.4g s there are %.3g J too %s, "
                      "%.2g %% of the largest energy, %.3g J (%.2g %% would pass); %s",
                      gain > loss ? h->balance_max.t : h->balance_min.t, worst,
                      gain > loss ? "many" : "few", 100 * worst / h->energy, h->energy, 100 * share,
                      s->integrator.step > 0 ? "take shorter steps" : energy_remedy(s));
}

/* --- Strains --- */

/* A corner where the stress has no bound is strained beyond any limit on a mesh that is fine
   enough: it takes more of the body than that to count. */
#define MOST_STRAINED 0.01

/* What the measure makes of strains beyond the limit: between uniaxial stresses of laws with the
   same E and nu there are terms of second order in the strain. */
static const char *about_measure(const scenario *s) {
  if (corot_strain_find(s->model.strain)->exact)
    return "green's law (St. Venant-Kirchhoff) gets stiffer in tension, and softer in compression "
           "until it gives way at a stretch of 0.577";
  if (corot_strain_find(s->model.strain)->linear)
    return "cauchy is linear, which holds for small strains";
  return "the law is linear in the strain, and others with the same E and nu differ from it by "
         "then "
         "by about as many per cent";
}

#define LOOKED "(looked at: output times, and the step of most elastic energy)"

static corot_status find_strains(const scenario *s, const observed *o, warnings *w) {
  const corot_deformation *d = &o->strained;
  if (d->strained > MOST_STRAINED)
    COROT_TRY(
        warnings_add(w, WARNING_STRAIN,
                     "at t = %.4g s %.3g %% of the body is strained by more than %g %%, with "
                     "principal stretches from %.3g to %.3g: %s; another strain measure shows "
                     "whether the answer depends on the law " LOOKED,
                     o->t_strained, 100 * d->strained, 100 * STRAIN_LIMIT, d->stretch_min,
                     d->stretch_max, about_measure(s)));
  d = &o->turned;
  if (d->turned > MOST_STRAINED)
    COROT_TRY(warnings_add(w, WARNING_STRAIN,
                           "at t = %.4g s %.3g %% of the body is turned by more than %g rad, at "
                           "most by %.3g rad: cauchy takes such a turn for a strain of %.2g %%; "
                           "take strain: polar " LOOKED,
                           o->t_turned, 100 * d->turned, TURN_LIMIT, d->turn_max,
                           100 * (1 - cos(d->turn_max))));
  return COROT_OK;
}

static corot_status find_inverted(const scenario *s, const observed *o, warnings *w) {
  const corot_deformation *d = &o->inverted;
  if (d->ninverted == 0 || !corot_strain_find(s->model.strain)->linear) return COROT_OK;
  return warnings_add(w, WARNING_INVERTED,
                      "at t = %.4g s %d tet%s turned inside out, tet %d the furthest (det F = "
                      "%.3g): no body does that, but cauchy, which is linear, does not notice; "
                      "strain: polar ends such a run " LOOKED,
                      o->t_inverted, d->ninverted, d->ninverted == 1 ? " is" : "s are", d->det_tet,
                      d->det_min);
}

/* --- The mesh --- */

/* On cantilevers of square and of flat section, in boxes of 1, 2, 4 and 8 cells across, the jumps
   are 0.6, 0.6, 0.4 to 0.5 and 0.25 to 0.35 where the true error, in the same norm, is 0.9, 0.7 to
   0.8, 0.45 to 0.6 and 0.2 to 0.3; pulled, where even one cell will do, they are below 0.1. Of
   ten-node tets they are 0.22 to 0.24, 0.10 to 0.14 and 0.05 to 0.06 with 1, 2 and 4 cells where
   the error is 0.21, 0.09 to 0.14 and 0.05 to 0.07. The square of the error is the part of the
   deflection that is missing: at 0.3 one in ten. */
#define MOST_JUMPS 0.3

static corot_status find_jumps(const scenario *s, const corot_mesh *mesh, const observed *o,
                               warnings *w) {
  const char *remedy = corot_mesh_order(mesh) == 2 ? ""
                                                   : "linear tets want four and more cells "
                                                     "across what bends: mesh.order: 2, ";
  if (!(o->jumps > MOST_JUMPS)) return COROT_OK;
  return warnings_add(w, WARNING_BENDING,
                      "the mesh is too coarse: the stress jumps between tets by %.0f %% of itself, "
                      "in energy, at t = %.4g s, where the body stores most of it (%.0f %% would "
                      "pass), so that deflections are too small by about %.0f %% or more; "
                      "%smesh.refine: %d, or a finer mesh, shows how much it matters",
                      100 * o->jumps, o->history.t_elastic, 100 * MOST_JUMPS,
                      100 * o->jumps * o->jumps, remedy, s->refine + 1);
}

/* --- What the next order of elements says --- */

#define MOST_SPACE_ERROR 0.05
#define MOST_LINEAR 0.3 /* on strongly bent bars one solve said 1.6 to 2 times what is missing */

/* Below the tolerance of the steps there is no displacement to speak of. */
static double least_displacement(const scenario *s, const corot_model *model, bool statics) {
  if (statics) return 0;
  if (s->integrator.step > 0)
    return 100 * s->integrator.newton_tolerance * corot_model_length(model);
  return warnings_atol(s, model);
}

/* A body that gives way by too little by that part is too stiff, and swings too fast by half of it.
 */
static corot_status find_space(const scenario *s, const corot_model *model, const observed *o,
                               bool statics, warnings *w) {
  const space_seen *seen = &o->space;
  const corot_space_estimate *e = &seen->estimate;
  if (!(e->relative > MOST_SPACE_ERROR)) return COROT_OK;
  if (!(e->displacement > least_displacement(s, model, statics))) return COROT_OK;
  const char *guess = e->relative > MOST_LINEAR
                          ? " (so much is a guess: one linear solve may say twice too much)"
                          : "";
  return warnings_add(w, WARNING_SPACE,
                      "the mesh is too coarse: its four-node tets leave out about %.2g %%%s of the "
                      "displacement under the loads of t = %.4g s, where the body stores most "
                      "elastic energy (%g %% would pass)%s%s; mesh.order: 2 puts that right at "
                      "the least cost, and where it changes more than this, mesh.refine: %d",
                      100 * e->relative, guess, seen->t, 100 * MOST_SPACE_ERROR, seen->worst,
                      o->history.period > 0 ? "; it swings too fast, too" : "", s->refine + 1);
}

/* How the stress jumps says the same with less certainty, where that is not known. */
static corot_status find_coarseness(const scenario *s, const corot_model *model, const observed *o,
                                    bool statics, warnings *w) {
  if (o->space.left_out) return find_jumps(s, corot_model_mesh(model), o, w);
  return find_space(s, model, o, statics, w);
}

/* --- Time --- */

#define LEAST_A_PERIOD 8

static corot_status find_sparse(const scenario *s, const history_facts *h, warnings *w) {
  double step = s->integrator.step, output = s->output_step;
  if (!(h->period > 0)) return COROT_OK;
  if (step > 0 && h->period < LEAST_A_PERIOD * step)
    COROT_TRY(warnings_add(w, WARNING_STEP,
                           "integrator.step = %g s is long for the motion, which swings with a "
                           "period of %.3g s as it was computed, %.2g steps (%d would pass): its "
                           "period is off, too; take a step of at most %.2g s",
                           step, h->period, h->period / step, LEAST_A_PERIOD,
                           h->period / LEAST_A_PERIOD));
  if (output > 0 && output < s->t_end && h->period < LEAST_A_PERIOD * output)
    return warnings_add(
        w, WARNING_OUTPUT,
        "time.output = %g s is long for the motion, which swings with a period of "
        "%.3g s: %.2g rows of probes.csv and energy.csv a period (%d would pass) do "
        "not show it%s; time.output: %.2g does",
        output, h->period, h->period / output, LEAST_A_PERIOD,
        s->write_history ? "; history.csv, with every step, does" : "", h->period / LEAST_A_PERIOD);
  return COROT_OK;
}

/* --- The absolute tolerance --- */

/* Where a stiff body hardly moves, the default of the absolute tolerance, a part of the body's
   length, may be the larger one by far, and rtol says nothing of the error. */
#define MOST_ATOL 0.01 /* of the displacement */

static corot_status find_atol(const scenario *s, const corot_model *model, double displacement,
                              warnings *w) {
  double atol = warnings_atol(s, model), rtol = s->integrator.rtol;
  if (!(displacement > 0) || !(atol > fmax(MOST_ATOL, 10 * rtol) * displacement)) return COROT_OK;
  return warnings_add(
      w, WARNING_ATOL,
      "nothing moves by more than %.3g m, of which the absolute tolerance of each "
      "step, %.2g m, is %.2g %%: the error is not held to integrator.rtol = %g, but "
      "to that; integrator.atol.displacement: %.0e holds it",
      displacement, atol, 100 * atol / displacement, rtol, rtol * displacement);
}

/* --- All of it --- */

static bool is_given(const warnings *w, warning_code code) {
  for (int i = 0; i < w->n; i++)
    if (w->item[i].code == code) return true;
  return false;
}

corot_status warnings_after(const scenario *s, const corot_model *model, const observed *seen,
                            bool statics, warnings *w) {
  if (!statics) COROT_TRY(find_energy(s, &seen->history, w));
  COROT_TRY(find_strains(s, seen, w));
  COROT_TRY(find_inverted(s, seen, w));
  COROT_TRY(find_coarseness(s, model, seen, statics, w));
  if (statics) return COROT_OK;
  COROT_TRY(find_sparse(s, &seen->history, w));
  COROT_TRY(find_atol(s, model, seen->displacement, w));
  if (is_given(w, WARNING_RTOL)) return COROT_OK;
  return warnings_find_rtol(s, model, seen->displacement, w);
}

/* What modes leave out, and what they show. */
#include "warnings_parts.h"

static corot_status find_unstable(const corot_modes *modes, warnings *w) {
  int n = 0;
  while (n < corot_modes_count(modes) && corot_modes_at(modes, n).growth > 0) n++;
  if (n == 0) return COROT_OK;
  double growth = corot_modes_at(modes, 0).growth;
  return warnings_add(w, WARNING_UNSTABLE,
                      "the equilibrium is unstable: %d of the modes grow%s, the fastest as "
                      "e^(%.4g t), by a factor of e in %.3g s; the least disturbance leads away",
                      n, n == 1 ? "s" : "", growth, 1 / growth);
}

/* Rounding of forces over the square of a low frequency. */
static const double ASYMMETRY_SEEN = 1e-5;

corot_status warnings_of_modes(const scenario *s, const corot_modes *modes, warnings *w) {
  double left = corot_modes_known(modes).asymmetry;
  if (!warnings_undamped(s))
    COROT_TRY(warnings_add(w, WARNING_UNDAMPED,
                           "modes are those of the body without damping, which the scenario has: "
                           "light damping hardly changes frequencies, heavy damping does"));
  COROT_TRY(find_unstable(modes, w));
  if (!(left > ASYMMETRY_SEEN)) return COROT_OK;
  return warnings_add(
      w, WARNING_SYMMETRIC,
      "the stiffness is not symmetric, because a pressure acts on a surface with a "
      "free edge; modes are those of its symmetric part, which leaves out up to "
      "%.1e of an eigenvalue: frequencies are off by at most half of that, flutter is "
      "not seen",
      left);
}

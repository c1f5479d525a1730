#include "solve/linsol.h"

#include <string.h>

corot_linear_def corot_linear_defaults(void) {
  return (corot_linear_def){"auto", "auto", "auto", "auto", 1e-10, COROT_ROLE_DYNAMIC};
}

/* Up to here KLU's simplicity costs little; beyond, CHOLMOD's dense blocks win by a factor that
   grows with the size: 4 at 3 000 unknowns, 40 at 20 000. */
enum { KLU_MAX = 3000 };

corot_status corot_linsol_find(const char *name, int n, const linsol_ops **ops) {
  static const linsol_ops *const built[] = {
      &corot_linsol_pcg,
      &corot_linsol_klu,
#ifdef COROT_HAVE_CHOLMOD
      &corot_linsol_cholmod,
#endif
  };
  int nbuilt = sizeof built / sizeof *built;
  const linsol_ops *largest = built[nbuilt - 1];
  if (name && strcmp(name, "auto") == 0) {
    *ops = n > KLU_MAX ? largest : &corot_linsol_klu;
    return COROT_OK;
  }
  for (int k = 0; k < nbuilt; k++)
    if (name && strcmp(name, built[k]->name) == 0) {
      *ops = built[k];
      return COROT_OK;
    }
  if (name && strcmp(name, "cholmod") == 0)
    return corot_fail(
        COROT_EINVAL,
        "linear solver cholmod is not in this build (configure with COROT_CHOLMOD=ON)");
  return corot_fail(COROT_EINVAL, "no linear solver '%s': auto, klu, cholmod or pcg",
                    name ? name : "");
}

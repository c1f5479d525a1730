/* Load steps, residuals and stability as JSON. */
#include "result_statics.h"

#include <math.h>

#include "app/scenario/words.h"

json_t *result_statics(const scenario *s, const statics_summary *statics) {
  const corot_statics_def *d = &s->statics;
  json_t *critical = isnan(statics->unstable)
                         ? json_null()
                         : json_pack("[f, f]", statics->stable, statics->unstable);
  return json_pack("{s:s, s:s, s:f, s:i, s:f, s:f, s:f, s:f, s:o, s:O, s:O}", "linear_solver",
                   statics->linear_solver, "frames", words_statics_frames[d->frames], "tolerance",
                   d->tolerance, "max_iterations", d->max_iterations, "first_step", d->first_step,
                   "min_step", d->min_step, "max_step", d->max_step, "factor", statics->factor,
                   "critical", critical, "steps", statics->steps, "reactions", statics->reactions);
}

json_t *result_statics_counts(const corot_statics_counts *n) {
  return json_pack("{s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I, s:I}", "nni",
                   (json_int_t)n->nni, "nfe", (json_int_t)n->nfe, "nje", (json_int_t)n->nje,
                   "nbcfails", (json_int_t)n->nbcfails, "nbacktrack", (json_int_t)n->nbacktrack,
                   "nstep", (json_int_t)n->nstep, "nrejected", (json_int_t)n->nrejected, "nframes",
                   (json_int_t)n->nframes, "nfactor", (json_int_t)n->nfactor, "nsolve",
                   (json_int_t)n->nsolve, "nli", (json_int_t)n->nli, "nlsfail",
                   (json_int_t)n->nlsfail, "nindefinite", (json_int_t)n->nindefinite);
}

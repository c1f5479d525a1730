/* The error budget of a run: what each of its approximations does to the displacement.

   One approximation after the other is taken away (budget_plan.h), so that two neighbours in this
   chain of runs differ in one thing, and what the coarser ones hide is gone before the finer ones
   are looked at. An error is that of errors.h for the displacement, between the two neighbours. As
   a check of their independence each approximation is also taken away alone (with the measure the
   hierarchy goes, too, which green does not fit).

   DIR/budget.json:
     {"title", "scenario", "measure",
      "parts": [{"part", "pair": the settings that take it away, "error", "end": largest over time,
                 at the end; "alone", "alone_end": where nothing else is taken away; "probes":
                 {NAME: {"max", "end"}} [m]; "cost": CPU time of that run over that of the run as
                 given; "advice"}],
      "total", "total_end": first run against the last; "sum": of the parts; "interaction": total
      less sum; "check": how far two independent methods of integration differ, of time's part;
      "first": what to change first, in words; "runs": [{"run", "id", "status", "cpu"}]}
   What is not known, as where a run failed, is null. */
#ifndef COROT_STUDY_BUDGET_H
#define COROT_STUDY_BUDGET_H

#include "budget_plan.h"
#include "execute.h"

/* Makes the runs that are missing in options->dir, and *out, the caller's to json_decref. set
   [nset]: "KEY=VALUE" on top of the scenario, which has them already. skip [BUDGET_KINDS]: parts
   that are not looked at. COROT_EINVAL: no part is left. */
corot_status budget_make(const scenario *s, int nset, const char *const *set, const bool *skip,
                         const execute_options *options, json_t **out, int *signal_number);

void budget_print(const json_t *budget, FILE *out);

#endif

/* The error budget of a run: what each of its approximations does to the displacement.

   One approximation after the other is taken away (budget_plan.h), so that two neighbours in this
   chain of runs differ in one thing, and what the coarser ones hide is gone before the finer ones
   are looked at. An error is that of errors.h for the displacement, between the two neighbours. As
   a check of their independence each approximation is also taken away alone (with the measure the
   hierarchy goes, too, which green does not fit); that is a bare difference of two runs, in which
   the errors of all others remain.

   Nothing is claimed that is not known:
   * Every part has a floor, ten times what its reference is known by (errors.h): for time, how far
     two independent methods are apart at its tolerance; where that is not better than what it is to
     judge, the tolerance is made a hundredth, up to BUDGET_TRIES times; for the parts that come
     after time, the same of their tolerance; for the algebra, a run of ten times its tolerances. A
     part below its floor is "at most" something.
   * A mesh of four-node tets is measured by order, against the same tets with ten nodes and, where
     that can be paid for, against these refined once. Then the part is about that far from the
     latter, and known by what the octasection changed; where that is more than half of it, or where
     it was left out, the part is "at least" so large.
   * A mesh of ten-node tets is measured by refinement. It has three levels where they can be paid
     for, and the part is what they tend to, if they do (convergence.h); else it is "at least" what
     they have shown.
   * Where a run failed a part is missing, and which is the largest is not known.

   DIR/budget.json:
     {"title", "scenario", "measure", "static": of the equilibrium,
      "hashes": {"solution", "mesh"}: of the run that it is of, see app/folder/hash.h,
      "parts": [{"part", "pair": the settings that take it away, "error", "end": largest over time,
                 at the end; "bound": "about", "at least", "at most" (below the floor), "unchecked"
                 or "missing"; "low", "high": between which it is; "floor"; "end_bound", "end_low",
                 "end_high", "end_floor"; "verdict": in words;
                 "difference", "difference_end": of the bare two neighbours;
                 "order", "levels": of space, observed and made; "by": it was measured by "order"
                 or "refinement";
                 "share": signed, of the total at the end: the part's product with the total in the
                 norm of the mass over the total's square; all together are 1;
                 "alone", "alone_end": where nothing else is taken away; "alone_bound": "about",
                 "at least" (space) or "doubtful": less than ten times the errors of time and
                 algebra that both runs have;
                 "probes": {NAME: {"max", "end" [m]; "bound", "low", "high", "floor"; "signed": the
                 change of the displacement at the end, a vector; "difference",
                 "difference_end"}};
                 "cost": CPU time of that run over that of the run as given; "advice"}],
      "total", "total_end", "total_probes", "total_bound", "total_low", "total_high",
      "total_floor", "total_end_bound" and so on: the run as given against what all parts together
      lead to; "sum": of the parts; "interaction": total less sum;
      "check": how far two independent methods of integration differ, of time's part;
      "check_rtol": at that tolerance; "complete": no part is missing; "missing": their names;
      "quantities": the scenario's, see budget_quantities.h;
      "first": what to change first, in words, and "verdict": the same;
      "runs": [{"run", "id", "status", "cpu", "spare": a try whose failure is no matter}],
      "builds", "mixed": as in a study's table (collect.h)}
   What is not known, as where a run failed, is null. */
#ifndef COROT_STUDY_BUDGET_BUDGET_H
#define COROT_STUDY_BUDGET_BUDGET_H

#include "budget_plan.h"
#include "study/execute/execute.h"

/* Makes the runs that are missing in execute->dir, and *out, the caller's to json_decref. set
   [nset]: "KEY=VALUE" on top of the scenario, which has them already. COROT_EINVAL: no part is
   left. */
corot_status budget_make(const scenario *s, int nset, const char *const *set,
                         const budget_options *options, const execute_options *execute,
                         json_t **out, int *signal_number);

#endif

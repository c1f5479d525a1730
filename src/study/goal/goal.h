/* A quantity with an error that is asked for.

   Runs of the scenario are made until the parts of the error of this quantity sum up to less than
   what is allowed, each where it pays:

   * time: on four-node tets as given, where runs are cheap, the scenario's method and a second one
     at falling tolerances, until one is good enough by both; on the first mesh of ten-node tets it
     is checked: a multistep method beside a Runge-Kutta one, that at ten times the tolerance;
     and once more on the second mesh, as finer meshes carry waves that coarser ones do not.
   * space: ten-node tets on the same mesh, then finer ones: everywhere (octasection), or where the
     estimator marks them (mesh.marks), of equilibria and of motion that is nearly a row of these.
     The values on the last three meshes tell order and error (goal_rule.h). Of an extreme that is
     reached early, or is like an early one, finer meshes are integrated no further than past that;
     what a later one could add is measured on the first two.
   * algebra: with a hundred times smaller tolerances of all equations.
   * frames: found in every evaluation, without a hierarchy, in all attempts: no part.
   * the strain measure, which is the user's choice: against green, on the first mesh of
     ten-node tets.

   DIR/solve.json, and what --json prints:
     {"title", "scenario", "static", "goal": the quantity, "unit", "value", "low", "high": the truth
      is between them; null where there is no value; "within": what was asked for, "within_abs":
      whether in the unit, "met", "asymptotic": the error of the mesh is extrapolated from values
      that look as if that were allowed, "why_not": else, "order": observed; "parts": {"space",
      "time", "algebra", "frames", "model": the estimated size of each in the unit, null: not
      known}, "half": {"space", "time", "algebra", "frames", "tail", "model" where it counts}: what
      each widens the interval by; "limit": what the values of the meshes tend to, null: not known;
      "allowed": "within" in the unit; "measured": {"space", "time", "algebra", "model", "tail"}:
      labels of the attempts that a part is known by; "model_counts", "obstacle": what stands in the
      way, "advice": what would be well posed; null where it was met; "levels": [{"label", "tets",
      "dofs", "value", "cpu_s"}] of the meshes, "attempts": [{"label", "order", "refine", "passes",
      "tets", "dofs", "method", "rtol", "until", "value", "status", "reason", "id", "cpu_s"}],
      "cpu_s": of all, "overhead": that over the cost of the last mesh} */
#ifndef COROT_STUDY_GOAL_GOAL_H
#define COROT_STUDY_GOAL_GOAL_H

#include <jansson.h>

#include "goal_request.h"
#include "study/execute/execute_options.h"

/* Makes the attempts in execute->dir, the scenario having the settings and the quantity, and
   solve.json. *out is the caller's to json_decref; NULL where *signal_number is not 0. */
corot_status goal_solve(const goal_request *r, const scenario *s, int nset, const char *const *set,
                        const execute_options *execute, goal_result *result, json_t **out,
                        int *signal_number);

#endif

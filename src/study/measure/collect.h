/* What the runs of a study say together: the table that write_tables.h puts into its folder.

   table.json
     title, cost, measure   as in the study file; corot: the version that made the runs
     builds      of the runs that are done, the build of most runs first (builds.h)
     mixed       a sentence where there are several: which runs are of which; null: there are not
     quantities  those that all runs are asked for, as text
     known       of some of them {measure, value, within, scale}, as in the study file
     static      true: of equilibria, as of corot static
     columns     names of the cells' coordinates
     series      names, in alphabetical order
     shared      a sentence: what errors are of, and what the runs have in common with their
                 references, so that no error says anything of it
     cells       by series, each from coarse to fine:
       id, series, settings {column: value}, tolerance, tolerance_key; of
                  mesh.refine the tolerance is 2^-refine
       status      done | failed | missing;  reason: of a failure, or why it was lost
       cost        cpu, cpu_min, cpu_max, wall, wall_min, wall_max [s]: median and extremes of
                   `repeats` timed repetitions, or of the one run if that is 0;
                   steps, rhs, factorisations, solves
       quantity    values by text; null: the run has none
       error       by name, as in errors.h: the largest over time, and NAME_end at the end; of a
                   quantity, by its text, relative to the reference's value, or against a known
                   value, signed, relative to its scale; total: the largest of the latter
       digits      mescd
       below_floor the study's measure is not rated, as it is below ten times the floor
       unrated     all errors of which that is true, of those against known values below `within`
       at_most     what these are at most, by name, of known values alone
       drift       energy, momentum
       reference   number in the list of references
       note        why there are no errors, though the run is done
       shared      approximations that it has in common with its reference, in words
       warnings    the codes of what the run warns of, each once: a list (app/scenario/warnings.h)
     references  {runs: [two ids], methods, rtol, settings, status, reason, agree, parts_at [s],
                  quantity: values of the first run, floor: error of the one against the other,
                  digits, note}
     space       of the meshes, where mesh.refine is varied: by references of neighbouring levels,
                 {measure: displacement or a quantity, reference, refine, levels, error, bound, low,
                 high, floor, order, verdict} as in a budget (budget.h)
     fits        {series, tolerance_key, exponent, constant, residual, points, verdict} of the
                 study's measure, over the points that are rated
     quantity_fits  the same, and {measure}, of each quantity that is not the study's measure
     rankings    {error, best: [{series, id, cost, tolerance}]}: for each power of ten the
                 cheapest cell of each series that is at least so good, the cheapest series first

   What is not known is null. */
#ifndef COROT_STUDY_MEASURE_COLLECT_H
#define COROT_STUDY_MEASURE_COLLECT_H

#include "study/plan/manifest.h"

/* *table is the caller's to json_decref. `looked`: the files of the runs have just been verified
   (study/execute/store.h), else they are now. *ndamaged: how often the files of a run are not those
   that it left; it is missing then. */
corot_status collect_table(const manifest *m, const char *dir, bool looked, json_t **table,
                           int *ndamaged);

#endif

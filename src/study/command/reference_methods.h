/* By which methods references are found, where the study does not say. */
#ifndef COROT_STUDY_COMMAND_REFERENCE_METHODS_H
#define COROT_STUDY_COMMAND_REFERENCE_METHODS_H

#include "study/execute/execute_options.h"
#include "study/plan/manifest.h"

/* Makes the choice that a folder's study.json has recorded that of the study; without one, or where
   it is damaged, nothing. COROT_EIO, COROT_ENOMEM: it cannot be read. */
corot_status reference_methods_recall(study *s, const char *dir);

/* Of what references take by cvode, arkode and erk [s], NaN: one failed, the two methods to take.
 */
void reference_methods_take(const double cost[3], const char *taken[2]);

/* Where it is open: pilots by cvode, arkode and erk. If the dearer of cvode and arkode takes longer
   than ten seconds, and erk less than half of that, erk takes its place. *m is planned anew with
   the choice, and written to the folder; o->reference_unit is what it costs. Tells stderr.
   *signal_number: 0, or what ended it early. */
corot_status reference_methods_choose(study *s, execute_options *o, manifest **m,
                                      int *signal_number);

#endif

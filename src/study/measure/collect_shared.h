/* What a study's runs have in common with the references that they are held against, and what their
   errors therefore say nothing of. */
#ifndef COROT_STUDY_MEASURE_COLLECT_SHARED_H
#define COROT_STUDY_MEASURE_COLLECT_SHARED_H

#include "collect_rows.h"

/* The approximations that a run makes beside that of time, a list of words by kind: "" none of that
   kind. The caller's. */
json_t *approximations_of(const json_t *result);

/* Whether a row, which is measured, has the mesh of its reference; and whether some do not. */
bool cell_shares_mesh(const table_rows *t, const table_row *r);
bool table_is_total(const table_rows *t);

/* Those that a row has in common with its reference, in words; and a sentence for all rows. */
json_t *cell_shared(const table_rows *t, const table_row *r);
json_t *table_shared(const table_rows *t);

#endif

/* The tables in a study's folder: table.json (study/measure/collect.h), table.csv and index.sqlite.
 */
#ifndef COROT_STUDY_TABLES_WRITE_TABLES_H
#define COROT_STUDY_TABLES_WRITE_TABLES_H

#include "study/plan/manifest.h"

/* Collects what the runs say, and writes all three files. `looked`: the files of the runs have just
   been verified (study/execute/store.h), else they are now. To `remarks` (or NULL): references that
   part ways or are not known, how many cells are not rated, and which cells carry which warnings.
   *ndamaged: how often the files of a run are not those that it left; it is missing then. */
corot_status write_tables(const manifest *m, const char *dir, bool looked, FILE *remarks,
                          int *ndamaged);

#endif

/* Which builds of the program the runs of a study are of (app/folder/provenance.h): a list

     [{provenance, runs: [ids, and "ID, timed" of repetitions for the clock], references: how many
   of them are runs of references}, ...]

   with the build of most runs first. Numbers and times of one build need not be those of another,
   though scenario, mesh and version are the same. */
#ifndef COROT_STUDY_EXECUTE_BUILDS_H
#define COROT_STUDY_EXECUTE_BUILDS_H

#include "study/plan/manifest.h"

typedef struct builds {
  json_t *list;    /* NULL: memory ran out */
  json_t *entered; /* an object with what is in their "runs" as keys */
} builds;

builds builds_begin(void);
void builds_free(builds *b);

/* Enters a run that is done, unless it is there. */
void builds_add(builds *b, const study_run *run, const json_t *result, bool reference);

/* Enters a timed repetition of it if another build made that, as "ID, timed". */
void builds_add_timed(builds *b, const study_run *run, const json_t *result,
                      const json_t *provenance);

/* Puts the build of most runs first. */
void builds_sort(builds *b);

/* "The runs are of 2 different builds: ...", and which of all but the first; null: there is one at
   most. NULL: no memory. */
json_t *builds_sentence(const json_t *list);

/* Tells stderr how many of the runs in the list this program did not make; nothing if there are
   none. */
corot_status builds_tell(const char *dir, const json_t *list);

#endif

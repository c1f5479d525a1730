/* The folder of a study:

     study.json            what it consists of (manifest.h)
     runs/ID/              one run each, as `corot run` leaves it; result.json says that it is over
     runs/ID/checkpoint.bin  what a run that was cut goes on from, if its scenario asks for it
     runs/ID/failure.json  why there is no result.json: {"hash", "reason", "exit_code" | "signal",
                           "failure": {"kind", "retry"}} as in result.json; the kind is "crash" or
                           "timeout", too
     runs/ID/timings.json  timed repetitions: {"hash", "runs": [{"cpu", "wall",
                           "provenance" as in result.json}, ...]} [s]
     runs/ID/messages.txt  what the run had to say, if anything
     names/NAME            links to the folders of runs (run_names.h)
     pilot/METHOD/         short runs by which the methods of references were chosen (pilot.h)
     table.json, table.csv, index.sqlite   collected from them (collect.h)
     .lock                 held while a study is at work here

   What result.json, failure.json and timings.json say counts only if their hash is that of the run:
   of scenario, mesh and version of the program. */
#ifndef COROT_STUDY_EXECUTE_STORE_H
#define COROT_STUDY_EXECUTE_STORE_H

#include <stdbool.h>

#include "app/run/failure.h"
#include "study/plan/manifest.h"

typedef enum run_state {
  RUN_MISSING, /* not begun, or lost on the way: trying again may help */
  RUN_DONE,
  RUN_FAILED, /* for a reason of its own: the same would happen again */
} run_state;

/* What the folder says of a run. */
typedef struct run_record {
  run_state state;
  char *reason;   /* of a failure, or why it was lost; NULL otherwise */
  int exit_code;  /* of a failure; 0: it is not known, or there is none */
  bool timed_out; /* a failure by the time that it was given */
  json_t *result; /* result.json of one that is done; NULL otherwise */
  bool damaged;   /* it was done, and is missing now: its files are not what result.json lists */
} run_record;

/* By the sizes of its files; and by their contents, which takes as long as reading them. */
corot_status store_look(const char *dir, const study_run *run, run_record *record);
corot_status store_verify(const char *dir, const study_run *run, run_record *record);
void run_record_free(run_record *record);

/* "DIR/runs/ID" or "DIR/runs/ID/NAME", the caller's to free; NULL: no memory. */
char *store_path(const char *dir, const study_run *run, const char *name);

/* Makes the folder of a run and takes away what earlier attempts said. */
corot_status store_clear(const char *dir, const study_run *run);

/* What a run died of, by how it ended: an exit code, or minus a signal's number. */
run_failure store_failure(int ended);

/* The time limit of the study, or that of the system for a process. */
bool store_is_timeout(int ended);

/* Records that it failed: an exit code, or minus a signal's number. */
corot_status store_fail(const char *dir, const study_run *run, int ended, const char *reason);

/* Timed repetitions, all of the same run. */
typedef struct timings {
  int n;
  double *cpu, *wall;  /* [n] [s] */
  json_t **provenance; /* [n] what each was made by; NULL: it does not say */
} timings;

/* None recorded: n = 0. */
corot_status timings_read(const char *dir, const study_run *run, timings *out);
corot_status timings_add(const char *dir, const study_run *run, timings *t, double cpu, double wall,
                         json_t *provenance);
void timings_free(timings *t);

/* Makes the folder the study's own, or fails with COROT_EINVAL: it is another study's, or one is at
   work there. Or with COROT_EIO: it is no study's, and has files of the names above; unless
   `force`, which replaces them. Several shards may be (1 to `nshard` > 1), all of one `nshard`.
   Runs that were started hold the locks, too: the folder is free when all are over. */
typedef struct store_lock {
  int whole, part; /* descriptors; -1: none */
} store_lock;

corot_status store_enter(const char *dir, const manifest *m, int shard, int nshard, bool force,
                         store_lock *lock);
void store_leave(store_lock lock);

/* COROT_EIO: somebody has removed the folder, or its lock, since it was entered. */
corot_status store_check(const char *dir, store_lock lock);

#endif

/* What `corot run --resume` finds in its folder. */
#ifndef COROT_APP_RUN_RESUME_H
#define COROT_APP_RUN_RESUME_H

#include "app/folder/checkpoint_file.h"
#include "run_options.h"

typedef enum resume_found {
  RESUME_NOTHING,    /* of this run: it begins */
  RESUME_CHECKPOINT, /* to go on from */
  RESUME_FINISHED,   /* it is over, and there is nothing to do; a checkpoint beside it goes */
} resume_found;

typedef struct resume {
  resume_found found;
  checkpoint_file file; /* of RESUME_CHECKPOINT, once it is read: to be freed */
  int exit_code;        /* of RESUME_FINISHED: the run's own */
} resume;

/* Looks into the folder of the options for the run of this hash, and says what it finds; nothing is
   changed. COROT_EIO, COROT_ENOMEM. */
corot_status resume_find(const scenario *s, const char run[HASH_SIZE], const run_options *options,
                         resume *out);

/* Reads the checkpoint that it has found, in a folder that this process holds by now.
   COROT_EFORMAT: it is damaged, of another run or of another program; with --force that is said,
   and the run begins. COROT_EIO, COROT_ENOMEM. */
corot_status resume_read(const scenario *s, const char run[HASH_SIZE], const run_options *options,
                         resume *out);

/* Whether a run has ended well in this folder, whichever it was. */
bool resume_is_over(const char *dir);

#endif

/* checkpoint.bin: the state of a run as bytes, of which the run itself knows what they mean
   (app/run/run_checkpoint.h).

     magic     16 bytes, "corot checkpoint"
     order      8 bytes, a number that reads otherwise in another byte order
     format     8 bytes, the version of all that follows
     bytes      8 bytes, of the whole file
     run       64 bytes, the sum of the run (hash.h)
     program   length and text: provenance.h as JSON
     t          8 bytes, the time reached [s]
     ...        the state
     sum       64 bytes, SHA-256 of all before it, in hexadecimal

   Numbers stand as they do in memory. The sum tells damage, not malice: what somebody has made up
   may do to the program whatever it likes. The file is put in place as a whole, and is on the disk
   by then, as are the files of the run as far as they belong to it. */
#ifndef COROT_APP_FOLDER_CHECKPOINT_FILE_H
#define COROT_APP_FOLDER_CHECKPOINT_FILE_H

#include <stdbool.h>

#include "core/base/pack.h"
#include "hash.h"
#include "inventory.h"

/* How the file begins: whoever finds this has one of corot's. */
#define CHECKPOINT_MARK "corot checkpoint"

/* Begins one in an empty pack that writes: what is packed then is the state. */
void checkpoint_file_begin(pack *p, const char run[HASH_SIZE], const char *program, double t);

/* Ends it. COROT_ENOMEM, also of what was packed. */
corot_status checkpoint_file_seal(pack *p);

/* What was read, and a pack that reads its state. */
typedef struct checkpoint_file {
  char *data; /* the caller's to free */
  pack state;
  char run[HASH_SIZE];
  json_t *program; /* the caller's to json_decref */
  double t;        /* [s] */
} checkpoint_file;

/* Reads it and makes sure that it is whole. COROT_EFORMAT: it is not, or is of another machine or
   format; COROT_EIO, COROT_ENOMEM. The message is a sentence that begins with `path`. */
corot_status checkpoint_file_read(const char *path, checkpoint_file *out);
void checkpoint_file_free(checkpoint_file *file);

/* Whether DIR has a file of that name that begins as one does. */
corot_status checkpoint_file_stands(const char *dir, bool *stands);

#endif

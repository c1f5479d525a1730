/* A folder of a fuzz target's own, in memory where the system has such a place. */
#ifndef FUZZ_SCRATCH_H
#define FUZZ_SCRATCH_H

#include <stdbool.h>
#include <stddef.h>

/* Makes the folder, in TMPDIR, else in /dev/shm, else in /tmp; it is removed when the process ends
   well. The path is valid until then. */
const char *scratch_make(void);

/* "SCRATCH/NAME"; the last eight answers are valid. */
const char *scratch_path(const char *name);

/* A file in it, as a whole; all that is there, ended by a 0 and the caller's to free, NULL: there
   is no such file. */
void scratch_write(const char *name, const void *data, size_t size);
char *scratch_read(const char *name, size_t *size);
void scratch_remove(const char *name);

/* Ends the process with the message of the last failure unless the condition holds. */
void require(bool condition, const char *what);

#endif

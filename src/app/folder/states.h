/* states.bin: displacement and velocity of the whole solid at the output times, to the last bit.

     8 bytes   "corot-st"
     uint32    1, the version of this layout
     uint32    0x01020304, in the byte order of all that follows: that of the machine
     int64     n, degrees of freedom
     int32[n]  place of each: 3 * node + component; ascending; then, if n is odd, four zero bytes
     then for each output time, ascending, doubles:  t [s],  u[n] [m],  v[n] [m/s]

   Records are handed to the system whole. A program that is killed may leave a piece of one at the
   end, which the reader drops. */
#ifndef COROT_APP_FOLDER_STATES_H
#define COROT_APP_FOLDER_STATES_H

#include <corot/model.h>

#include "growth.h"

typedef struct state_writer state_writer;

/* Makes DIR/states.bin. */
corot_status states_create(const char *dir, const corot_model *model, state_writer **out);

corot_status states_add(state_writer *file, double t, const double *u, const double *v);

/* How far it has come; then the file as it was, which changes nothing until states_cut() takes away
   the records since; and what is written is on the disk. As the functions of tables in write_csv.h,
   but that only the size is looked at. */
corot_status states_pack(state_writer *file, pack *p);
corot_status states_resume(const char *dir, const corot_model *model, pack *p, state_writer **out);
corot_status states_cut(state_writer *file);
corot_status states_synchronise(state_writer *file);

/* Reports an error that shows up on closing. Takes NULL; the file is closed either way. */
corot_status states_close(state_writer *file);

/* All of a file. */
typedef struct trajectory {
  int n, count;
  int *place;     /* [n] */
  double *record; /* [count][1 + 2 n] */
} trajectory;

/* COROT_EIO: it cannot be read; COROT_EFORMAT: it is not such a file. The caller's to free. */
corot_status states_read(const char *dir, trajectory *out);

void states_free(trajectory *t);

static inline double states_t(const trajectory *t, int k) {
  return t->record[(size_t)k * (1 + 2 * (size_t)t->n)];
}
static inline const double *states_u(const trajectory *t, int k) {
  return t->record + (size_t)k * (1 + 2 * (size_t)t->n) + 1;
}
static inline const double *states_v(const trajectory *t, int k) { return states_u(t, k) + t->n; }

#endif

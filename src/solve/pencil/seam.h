/* Whether what a host hands over is what it should be: a status and a message in place of a crash.
   `who` is the function that was called. */
#ifndef COROT_SOLVE_PENCIL_SEAM_H
#define COROT_SOLVE_PENCIL_SEAM_H

#include <corot/solve.h>

/* COROT_EINVAL: it is NULL, or has no model or no state, or a state of another model. */
corot_status corot_seam_data(const corot_sun_data *data, const char *who);

/* COROT_EINVAL: it is NULL, or not of the model and state of `data` (NULL: any will do). */
corot_status corot_seam_pencil(const corot_pencil *pencil, const corot_sun_data *data,
                               const char *who);

/* The pencil of a matrix that corot_sun_matrix has made. COROT_EINVAL: it is no such matrix. */
corot_status corot_seam_matrix(SUNMatrix A, const char *who, corot_pencil **pencil);

/* COROT_EINVAL: one of the x [count] is NULL, has no array of doubles in this process's memory, or
   not n of them. */
corot_status corot_seam_vectors(const char *who, int n, int count, const N_Vector *x);

#endif

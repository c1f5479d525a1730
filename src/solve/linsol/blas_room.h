/* Room for the BLAS where address space is limited (RLIMIT_AS). */
#ifndef COROT_SOLVE_LINSOL_BLAS_ROOM_H
#define COROT_SOLVE_LINSOL_BLAS_ROOM_H

#include <corot/base.h>

/* To be called before the first product of dense blocks. OpenBLAS takes a buffer at its first, and
   asks for it for ever if there is no room: here it is looked whether there is, and the buffer
   taken. COROT_ENOMEM: there is none. Without a limit it does nothing. */
corot_status corot_blas_room(void);

#endif

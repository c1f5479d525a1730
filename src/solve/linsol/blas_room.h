/* Room for the BLAS where address space is limited (RLIMIT_AS). */
#ifndef COROT_SOLVE_LINSOL_BLAS_ROOM_H
#define COROT_SOLVE_LINSOL_BLAS_ROOM_H

#include <corot/base.h>

#include "core/base/sisters.h"

/* Call this before the first product of dense blocks. OpenBLAS takes a buffer at its first product,
   and asks for it for ever if there is no room: this looks whether there is, and takes the buffer.
   COROT_ENOMEM: there is no room. Without a limit of the address space it does nothing. */
COROT_SISTERS corot_status corot_blas_room(void);

#endif

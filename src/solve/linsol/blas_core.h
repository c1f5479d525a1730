/* The kernels of OpenBLAS that suit this processor. */
#ifndef COROT_SOLVE_LINSOL_BLAS_CORE_H
#define COROT_SOLVE_LINSOL_BLAS_CORE_H

/* OpenBLAS knows processors by their number, and runs those that are newer than itself by kernels
   of 2004 (SSE3), though they can do more. The name of the kernels to ask for by OPENBLAS_CORETYPE,
   which it reads when it is loaded; NULL where its own choice is as good: it knows the processor,
   the processor can do no more, the variable is set, or the BLAS is another. */
const char *corot_blas_better_core(void);

#endif

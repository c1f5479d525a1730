/* The kernels of OpenBLAS that suit this processor, and how many threads it takes. */
#ifndef COROT_SOLVE_LINSOL_BLAS_CORE_H
#define COROT_SOLVE_LINSOL_BLAS_CORE_H

/* OpenBLAS knows processors by their number, and runs those that are newer than itself by kernels
   of 2004 (SSE3), though they can do more. The name of the kernels to ask for by OPENBLAS_CORETYPE,
   which it reads when it is loaded; NULL where its own choice is as good: it knows the processor,
   the processor can do no more, the variable is set, or the BLAS is another. */
const char *corot_blas_better_core(void);

/* From now on OpenBLAS stays in the calling thread, unless the environment says how many it may
   have (OPENBLAS_NUM_THREADS, GOTO_NUM_THREADS, OMP_NUM_THREADS). Its own are one a core, which
   wait for each other by turning in a loop: in the small products of most factors they gain
   nothing, and on a busy machine they take up to a hundred times as long. Of another BLAS nothing
   changes. */
void corot_blas_keep_to_one_thread(void);

#endif

/* What this machine can do at best: the floor under a kernel's time. */
#ifndef BENCH_MACHINE_H
#define BENCH_MACHINE_H

#include <stddef.h>

/* As the system names it; "unknown" if it does not. */
const char *machine_cpu(void);

/* Bytes a second of a triad a = b + s c over three arrays of `bytes` in all, the best of several
   sweeps. Each element counts 24 bytes: what a cache reads in order to write is not counted. */
double machine_bandwidth(size_t bytes);

/* Floating-point operations a second of independent fused multiply-adds (two operations each) on
   the widest vectors in use, the best of several loops. Without such an instruction it is that of
   multiplications and additions. Measured once. */
double machine_peak(void);

#endif

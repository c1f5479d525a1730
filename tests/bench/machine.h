/* What this machine can do at best: the floor under a kernel's time. */
#ifndef BENCH_MACHINE_H
#define BENCH_MACHINE_H

#include <stddef.h>

/* As the system names it; "unknown" if it does not. */
const char *machine_cpu(void);

/* Bytes a second over arrays of `bytes` in all, the best of several sweeps of two kinds: a triad a
   = b + s c, which counts 24 bytes an element (what a cache reads in order to write does not
   count), and a sum, which only reads. */
double machine_bandwidth(size_t bytes);

/* Floating-point operations a second of independent fused multiply-adds (two operations each), the
   best of several loops as wide as the kernels. Without such an instruction it is that of
   multiplications and additions. Measured once. */
double machine_peak(void);

/* From now on it is this. */
void machine_set_peak(double flops);

#endif

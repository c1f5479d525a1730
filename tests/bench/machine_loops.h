/* The loops by which machine.c measures; each build of the kernels has its own. */
#ifndef BENCH_MACHINE_LOOPS_H
#define BENCH_MACHINE_LOOPS_H

#include <stddef.h>

#include "core/lanes/simd.h"

#ifdef COROT_KERNELS
#define MACHINE_JOINED(name, suffix) name##suffix
#define MACHINE_NAME(name, suffix) MACHINE_JOINED(name, suffix)
#define machine_triad MACHINE_NAME(machine_triad, COROT_KERNELS)
#define machine_total MACHINE_NAME(machine_total, COROT_KERNELS)
#define machine_chains MACHINE_NAME(machine_chains, COROT_KERNELS)
#endif

/* a = b + s c; n is a multiple of 64, and so in the next one, the sum of all. */
void machine_triad(size_t n, double *a, const double *b, const double *c, double s);
double machine_total(size_t n, const double *a);

/* Independent chains of fused multiply-adds; returns the number of operations. k < MACHINE_CHAINS
   says how many chains. */
enum { MACHINE_CHAINS = 4 };
double machine_chains(int k, double factor, double *result);

#endif

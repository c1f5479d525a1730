/* Which build of the kernels is in use: see simd.h. */
#ifndef COROT_CORE_LANES_WIDTHS_H
#define COROT_CORE_LANES_WIDTHS_H

/* Lanes of the widest build of the kernels that this processor has the instructions for. */
int corot_lanes_in_use(void);

/* Of the whole process, from now on, not while a kernel runs: no more than so many; 0: no limit. So
   that tests and benchmarks see every build; bits differ between them. */
void corot_lanes_limit(int most);

/* The instruction set of the build in use, by name. */
const char *corot_lanes_instruction_set(void);

#endif

/* What a kernel has to do at least, for the floor under its time.

   Bytes: every array that holds input, output or tables counts once, as if each were read or
   written in one sweep; scratch that is used again at once (nodal copies, the window of element
   forces, matrix blocks while they grow) stays in the cache and does not count.

   Floating-point operations: additions, multiplications, divisions and roots count one each, a
   fused multiply-add two, as the formulas in src/core stand, with what is common to two of them
   counted once. The floor takes all of them to run at the rate of fused multiply-adds. */
#ifndef BENCH_COST_H
#define BENCH_COST_H

#include "solid.h"

typedef struct cost {
  double bytes, flops; /* of one call */
  double data;         /* bytes of the data, where it is swept more than once; else 0 */
} cost;

/* Newton steps that the polar iteration takes for the solid, mean over the points of all blocks,
   each of which waits for its slowest. */
double cost_polar_steps(const specimen *s);

/* `steps` as above; looked at only where polar factors are found. */
cost cost_force(const specimen *s, bool held, double steps);
cost cost_rhs(const specimen *s, double steps);
cost cost_jacobian(const specimen *s, bool exact, double steps);
cost cost_jvp(const specimen *s, double steps);
cost cost_frames(const specimen *s, double steps);
cost cost_energy(const specimen *s, double steps);
cost cost_combine(const specimen *s, const corot_csc *csc);

/* Making a factor or a preconditioner, and one solution with it. */
typedef struct solver_cost {
  cost factor, solve;
} solver_cost;

/* Of a symmetric pattern in an order of minimum degree (AMD): a Cholesky factor or, with twice the
   numbers of everything, an LU factor. */
corot_status cost_direct(const corot_csc *full, bool cholesky, solver_cost *out);

/* Conjugate gradients with incomplete Cholesky, after so many iterations. */
solver_cost cost_pcg(const corot_csc *full, double iterations);

#endif

/* What the hosts of SUNDIALS share: failures, and a context. */
#ifndef SUN_H
#define SUN_H

#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sundials/sundials_context.h>

#ifndef SUN_COMM_NULL /* SUNDIALS before 7 */
#define SUN_COMM_NULL NULL
#endif

static inline void sun(int flag, const char *call) {
  if (flag >= 0) return;
  fprintf(stderr, "%s: %d\n", call, flag);
  exit(1);
}
#define SUN(call) sun(call, #call)

/* A serial vector of n zeros. */
static inline N_Vector zeros(int n, SUNContext ctx) {
  N_Vector y = N_VNew_Serial(n, ctx);
  if (!y) exit(1);
  N_VConst(0, y);
  return y;
}

#endif

/* Every difference between SUNDIALS 6.4 (Debian 12) and 7.x stands here. Return values are only
   ever compared with zero, whose meaning never changed. */
#ifndef COROT_SOLVE_SUN_COMPAT_H
#define COROT_SOLVE_SUN_COMPAT_H

#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_version.h>

#if SUNDIALS_VERSION_MAJOR >= 7
typedef SUNErrCode sun_status; /* of an operation of our own */
static inline int sun_context_create(SUNContext *ctx) {
  return SUNContext_Create(SUN_COMM_NULL, ctx);
}
#else
typedef int sun_status;
static inline int sun_context_create(SUNContext *ctx) { return SUNContext_Create(NULL, ctx); }
#endif

#endif

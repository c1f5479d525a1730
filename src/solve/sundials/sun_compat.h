/* Every difference between SUNDIALS 6.4 (Debian 12) and 7.x (Debian 13: 7.1.1) stands here, those
   of ARKODE in sun_ark.h. Return values are only ever compared with zero, whose meaning never
   changed. What our functions return is in sun_status.h. */
#ifndef COROT_SOLVE_SUNDIALS_SUN_COMPAT_H
#define COROT_SOLVE_SUNDIALS_SUN_COMPAT_H

#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_version.h>

/* Error handlers: one function of these arguments, installed on an integrator's memory in 6.4 by
   the integrator's own setter, on the context in 7.x. `data` and SUN_ERROR_TEXT are what both
   have. */
#if SUNDIALS_VERSION_MAJOR >= 7
#include <sundials/sundials_errors.h>
#include <sundials/sundials_logger.h>

typedef SUNErrCode sun_status; /* of an operation of our own */

/* A context that prints nothing. As it comes it has a handler that writes errors to stderr, which
   one of ours would not replace but precede; and its logger writes warnings to stdout. */
static inline int sun_context_create(SUNContext *ctx) {
  SUNLogger logger = NULL;
  if (SUNContext_Create(SUN_COMM_NULL, ctx)) return -1;
  SUNContext_ClearErrHandlers(*ctx);
  SUNContext_GetLogger(*ctx, &logger);
  if (logger) SUNLogger_SetWarningFilename(logger, "/dev/null");
  return 0;
}

/* Failures of a linear solver's solve for which there is no remedy: SUNLS_* of 6.4 that 7.x renamed
   (SUNLS_CONV_FAIL is the same in both). */
enum { SUN_SOLVE_NO_MEMORY = SUN_ERR_MEM_FAIL, SUN_SOLVE_FATAL = SUN_ERR_EXT_FAIL };

#define SUN_ERROR_HANDLER_ARGUMENTS                                                                \
  int line, const char *function, const char *file, const char *text, SUNErrCode code, void *data, \
      SUNContext ctx
#define SUN_ERROR_HANDLER_UNUSED (void)line, (void)function, (void)file, (void)code, (void)ctx
#define SUN_ERROR_TEXT (text ? text : SUNGetErrMsg(code))
#define SUN_CATCH_ERRORS(setter, memory, ctx, handler, data) \
  SUNContext_PushErrHandler(ctx, handler, data)
#else
typedef int sun_status;
enum { SUN_SOLVE_NO_MEMORY = SUNLS_MEM_FAIL, SUN_SOLVE_FATAL = SUNLS_PACKAGE_FAIL_UNREC };
static inline int sun_context_create(SUNContext *ctx) { return SUNContext_Create(NULL, ctx); }
#define SUN_ERROR_HANDLER_ARGUMENTS \
  int code, const char *module, const char *function, char *text, void *data
#define SUN_ERROR_HANDLER_UNUSED (void)code, (void)module, (void)function
#define SUN_ERROR_TEXT text
#define SUN_CATCH_ERRORS(setter, memory, ctx, handler, data) setter(memory, handler, data)
#endif

#endif

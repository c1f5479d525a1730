/* Status and error message: what every fallible function of corot returns, and why it failed.

   The comment of each function that returns a status says which failures there are, and when. All
   others cannot fail, but for those whose comment says what they return then. A function sets its
   outputs on success only, unless it says otherwise.

   A complete program: tests/examples/base.c. */
#ifndef COROT_BASE_H
#define COROT_BASE_H

#ifdef __cplusplus
extern "C" {
#endif

/* The version of these headers, as numbers for #if and as "MAJOR.MINOR.PATCH". While MAJOR is 0 a
   higher MINOR may change anything; else a library of the same MAJOR, and no lower MINOR, will do. */
#define COROT_VERSION_MAJOR 1
#define COROT_VERSION_MINOR 0
#define COROT_VERSION_PATCH 0
#define COROT_VERSION "1.0.0"

/* Stands before each function that a host may call: these, and no others, a shared library exports.
   Nothing has to be defined by a host. */
#if defined(COROT_EXPORTS) && defined(__GNUC__)
#define COROT_API __attribute__((visibility("default")))
#else
#define COROT_API
#endif

/* Definitions, which a host fills, may grow from one version to the next. Their size is their first
   member, `bytes`; corot_X_defaults() sets it, as the host's own headers have it, by way of
   corot_X_set_defaults(), which writes no more than that (for hosts in other languages). A definition
   of another size than the library's is refused with COROT_EINVAL. One that is written down without
   defaults may leave it 0, and goes unrecognised. Where a pointer that must be given is NULL, what
   returns a status returns COROT_EINVAL; a function that returns something else, or nothing, takes no
   NULL unless it says so. */

/* Status of a call: 0 ok, >0 recoverable (retry with a smaller step), <0 fatal.
   The signs are those of a SUNDIALS callback, so a status can be returned by one as is; but not by
   the solve of a SUNLinearSolver, of which the integrators take values they do not know (and all of
   these are) for a success. */
typedef enum corot_status {
  COROT_OK = 0,
  COROT_RETRY = 1,       /* e.g. an inverted element: the step was too long */
  COROT_ENOMEM = -1,     /* an allocation failed */
  COROT_EINVAL = -2,     /* an argument or a definition makes no sense */
  COROT_EFORMAT = -3,    /* a file does not say what it should */
  COROT_ESINGULAR = -4,  /* a matrix has no usable factor */
  COROT_EIO = -5,        /* the operating system refused to read or write */
  COROT_EINTEGRATE = -6, /* the integrator gave up; the message names its reason */
} corot_status;

/* Message of the last failure on this thread; never NULL, "" before the first failure.
   A later success does not clear it: read it only after a call that returned non-zero. */
COROT_API const char *corot_error(void);

/* Sets this thread's message (printf rules, cut at 4095 characters) and returns `status`, so that
   a failure is one statement: `return corot_fail(COROT_EINVAL, "tet %d: ...", e);`
   The old message may be among the arguments: `corot_fail(s, "%s: %s", path, corot_error())`. */
COROT_API corot_status corot_fail(corot_status status, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;

/* Returns from the calling function with the status of `call` unless it is COROT_OK. */
#define COROT_TRY(call)                                  \
  do {                                                   \
    corot_status corot_try_ = (call);                    \
    if (corot_try_ != COROT_OK) return corot_try_;       \
  } while (0)

/* The version of the library that was linked, "MAJOR.MINOR.PATCH". */
COROT_API const char *corot_version(void);

#ifdef __cplusplus
}
#endif
#endif

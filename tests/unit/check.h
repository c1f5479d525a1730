/* What every unit test starts with: cmocka, and comparison of floating-point numbers. */
#ifndef CHECK_H
#define CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <corot/base.h>

/* |actual - expected| <= atol + rtol |expected|; NaN fails. */
#define assert_close(actual, expected, rtol, atol)                                       \
  do {                                                                                   \
    double a_ = (actual), e_ = (expected), tol_ = (atol) + (rtol)*fabs(e_);              \
    if (!(fabs(a_ - e_) <= tol_))                                                        \
      fail_msg("%s = %.17g, expected %.17g: off by %.3g, allowed %.3g", #actual, a_, e_, \
               fabs(a_ - e_), tol_);                                                     \
  } while (0)

/* actual < bound; NaN fails. */
#define assert_below(actual, bound)                                           \
  do {                                                                        \
    double a_ = (actual), b_ = (bound);                                       \
    if (!(a_ < b_)) fail_msg("%s = %.17g, not below %.17g", #actual, a_, b_); \
  } while (0)

#define assert_above(actual, bound)                                           \
  do {                                                                        \
    double a_ = (actual), b_ = (bound);                                       \
    if (!(a_ > b_)) fail_msg("%s = %.17g, not above %.17g", #actual, a_, b_); \
  } while (0)

/* The call succeeds; the message is shown if not. */
#define assert_ok(call)                                                               \
  do {                                                                                \
    corot_status s_ = (call);                                                         \
    if (s_ != COROT_OK) fail_msg("%s: status %d: %s", #call, (int)s_, corot_error()); \
  } while (0)

/* The call fails with this status and a message that contains `words`. */
#define assert_fails(call, status, words)                                                      \
  do {                                                                                         \
    corot_status s_ = (call);                                                                  \
    if (s_ != (status)) fail_msg("%s: status %d, expected %d", #call, (int)s_, (int)(status)); \
    if (!strstr(corot_error(), (words)))                                                       \
      fail_msg("%s: message '%s' lacks '%s'", #call, corot_error(), (words));                  \
  } while (0)

#endif

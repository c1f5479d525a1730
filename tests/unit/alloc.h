/* Allocations that fail on demand, in programs made by corot_alloc_test(): there malloc, calloc,
   realloc, aligned_alloc and free of the program and of our static libraries pass through here.
   Those inside shared libraries (the C library, SUNDIALS, jansson) do not. */
#ifndef ALLOC_H
#define ALLOC_H

#include <corot/base.h>
#include <stddef.h>

/* Starts counting anew, and makes the k-th allocation from now on fail; 0: none. */
void alloc_fail_at(long k);

/* Allocations since then, the failed one included. */
long alloc_count(void);

/* Blocks allocated since then and not freed. */
long alloc_live(void);

/* Bytes in these blocks, as they were asked for. */
size_t alloc_live_bytes(void);

/* With a sanitizer, which takes ten times as long, every third after the first fifty has to do
   where else each allocation fails. */
#ifdef __SANITIZE_ADDRESS__
enum { SANITIZED = 1, ALLOC_STRIDE = 3 };
#else
enum { SANITIZED = 0, ALLOC_STRIDE = 1 };
#endif

/* Makes whatever is to be tested, destroys it if that succeeded, returns the status of making. */
typedef corot_status (*alloc_case)(void *context);

/* Runs the case with its first, second, ... allocation failing, see above, until none is left to
   fail: each time the status must be COROT_ENOMEM with a message, and nothing be left allocated;
   the last time COROT_OK. The value is the number of allocations. */
long assert_survives_failed_allocations(alloc_case make, void *context);

#endif

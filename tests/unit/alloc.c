#include "alloc.h"

#include <pthread.h>

#include "check.h"

void *__real_malloc(size_t size);
void *__real_calloc(size_t n, size_t size);
void *__real_realloc(void *p, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
void __real_free(void *p);

void *__wrap_malloc(size_t size);
void *__wrap_calloc(size_t n, size_t size);
void *__wrap_realloc(void *p, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void __wrap_free(void *p);

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static long fail_at, count;

/* The live blocks, so that blocks from before and of others, which are freed here as well, are not
   counted: a table with linear probing. */
typedef struct block {
  void *p; /* NULL: empty */
  size_t size;
} block;

static struct {
  block *slot; /* [room] */
  size_t room, n, bytes;
} live;

static size_t home(void *p) { return ((uintptr_t)p >> 4) * 2654435761u % live.room; }

static size_t find(void *p) {
  size_t i = home(p);
  while (live.slot[i].p && live.slot[i].p != p) i = (i + 1) % live.room;
  return i;
}

static void add(void *p, size_t size) {
  if (2 * live.n >= live.room) {
    block *old = live.slot;
    size_t room = live.room;
    live.room = room ? 2 * room : 1024;
    live.slot = __real_calloc(live.room, sizeof *live.slot);
    if (!live.slot) abort();
    for (size_t i = 0; i < room; i++)
      if (old[i].p) live.slot[find(old[i].p)] = old[i];
    __real_free(old);
  }
  live.slot[find(p)] = (block){p, size};
  live.n++;
  live.bytes += size;
}

static void take_away(void *p) {
  size_t i = live.room ? find(p) : 0;
  if (!live.room || !live.slot[i].p) return;
  live.n--;
  live.bytes -= live.slot[i].size;
  live.slot[i].p = NULL;
  for (size_t j = (i + 1) % live.room; live.slot[j].p; j = (j + 1) % live.room) {
    block moved = live.slot[j];
    live.slot[j].p = NULL;
    live.slot[find(moved.p)] = moved;
  }
}

void alloc_fail_at(long k) {
  pthread_mutex_lock(&lock);
  fail_at = k;
  count = 0;
  live.n = live.bytes = 0;
  if (live.room) memset(live.slot, 0, live.room * sizeof *live.slot);
  pthread_mutex_unlock(&lock);
}

long alloc_count(void) { return count; }

long alloc_live(void) { return (long)live.n; }

size_t alloc_live_bytes(void) { return live.bytes; }

static int fails(void) { return ++count == fail_at; }

void *__wrap_malloc(size_t size) {
  pthread_mutex_lock(&lock);
  void *p = fails() ? NULL : __real_malloc(size);
  if (p) add(p, size);
  pthread_mutex_unlock(&lock);
  return p;
}

void *__wrap_calloc(size_t n, size_t size) {
  pthread_mutex_lock(&lock);
  void *p = fails() ? NULL : __real_calloc(n, size);
  if (p) add(p, n * size);
  pthread_mutex_unlock(&lock);
  return p;
}

void *__wrap_aligned_alloc(size_t alignment, size_t size) {
  pthread_mutex_lock(&lock);
  void *p = fails() ? NULL : __real_aligned_alloc(alignment, size);
  if (p) add(p, size);
  pthread_mutex_unlock(&lock);
  return p;
}

void *__wrap_realloc(void *old, size_t size) {
  pthread_mutex_lock(&lock);
  void *p = NULL;
  if (!fails()) {
    p = __real_realloc(old, size);
    if (p && old) take_away(old);
    if (p) add(p, size);
  }
  pthread_mutex_unlock(&lock);
  return p;
}

void __wrap_free(void *p) {
  pthread_mutex_lock(&lock);
  if (p) take_away(p);
  __real_free(p);
  pthread_mutex_unlock(&lock);
}

long assert_survives_failed_allocations(alloc_case make, void *context) {
  for (long k = 1;; k += k < 50 ? 1 : ALLOC_STRIDE) {
    corot_fail(COROT_OK, "%s", "");
    alloc_fail_at(k);
    corot_status status = make(context);
    long n = alloc_count(), left = alloc_live();
    alloc_fail_at(0);
    if (left != 0)
      fail_msg("allocation %ld failed: %ld blocks leaked (status %d: %s)", k, left, (int)status,
               corot_error());
    if (n < k) {
      if (status) fail_msg("no allocation failed: status %d: %s", (int)status, corot_error());
      return n;
    }
    if (status != COROT_ENOMEM || !*corot_error())
      fail_msg("allocation %ld failed: status %d: %s", k, (int)status, corot_error());
  }
}

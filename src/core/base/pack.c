/* Bytes of a state: a buffer that grows, or one that is read to its end. */
#include "pack.h"

#include <stdlib.h>
#include <string.h>

void corot_pack_clear(pack *p) {
  if (!p->reading) free(p->data);
  *p = (pack){0};
}

/* Room for so many more. */
static bool grow(pack *p, size_t bytes) {
  size_t needed = p->bytes + bytes;
  if (needed <= p->room) return true;
  size_t room = needed > 2 * p->room ? needed : 2 * p->room;
  unsigned char *data = realloc(p->data, room);
  if (!data) return false;
  p->data = data;
  p->room = room;
  return true;
}

static void write_bytes(pack *p, const void *x, size_t bytes) {
  if (!grow(p, bytes)) {
    p->status = corot_fail(COROT_ENOMEM, "no memory for a state of %zu bytes", p->bytes + bytes);
    return;
  }
  memcpy(p->data + p->bytes, x, bytes);
  p->bytes += bytes;
}

static void read_bytes(pack *p, void *x, size_t bytes) {
  if (bytes > corot_pack_left(p)) {
    p->status = corot_fail(COROT_EINVAL, "the state is cut short: %zu bytes where %zu more follow",
                           corot_pack_left(p), bytes);
    return;
  }
  memcpy(x, p->data + p->at, bytes);
  p->at += bytes;
}

void corot_pack_bytes(pack *p, void *x, size_t bytes) {
  if (p->status || bytes == 0) return;
  if (p->reading)
    read_bytes(p, x, bytes);
  else
    write_bytes(p, x, bytes);
}

void corot_pack_double(pack *p, double *x) { corot_pack_bytes(p, x, sizeof *x); }

void corot_pack_doubles(pack *p, double *x, size_t n) { corot_pack_bytes(p, x, n * sizeof *x); }

void corot_pack_long(pack *p, long *x) {
  int64_t wide = p->reading ? 0 : *x;
  corot_pack_bytes(p, &wide, sizeof wide);
  if (p->reading && !p->status) *x = (long)wide;
}

void corot_pack_int(pack *p, int *x) {
  long wide = *x;
  corot_pack_long(p, &wide);
  *x = (int)wide;
}

void corot_pack_bool(pack *p, bool *x) {
  long wide = *x;
  corot_pack_long(p, &wide);
  *x = wide != 0;
}

void corot_pack_block(pack *p, const void **x, size_t *bytes) {
  long length = p->reading ? 0 : (long)*bytes;
  corot_pack_long(p, &length);
  if (!p->reading) corot_pack_bytes(p, (void *)*x, *bytes);
  if (!p->reading || p->status) return;
  if (length < 0 || (size_t)length > corot_pack_left(p)) {
    p->status =
        corot_fail(COROT_EINVAL, "the state is cut short: a block of %ld bytes where %zu follow",
                   length, corot_pack_left(p));
    return;
  }
  *x = p->data + p->at;
  *bytes = (size_t)length;
  p->at += *bytes;
}

void corot_pack_same(pack *p, uint64_t x, const char *what) {
  uint64_t found = x;
  corot_pack_bytes(p, &found, sizeof found);
  if (!p->status && found != x)
    p->status = corot_fail(COROT_EINVAL, "the state is another one: %s is %llu, not %llu", what,
                           (unsigned long long)found, (unsigned long long)x);
}

corot_status corot_pack_status(const pack *p) { return p->status; }

uint64_t corot_checksum(uint64_t sum, const void *x, size_t bytes) {
  const unsigned char *byte = x;
  for (size_t k = 0; k < bytes; k++) sum = (sum ^ byte[k]) * 0x100000001b3u;
  return sum;
}

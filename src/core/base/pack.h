/* A state as bytes. The same functions write it and read it back, so that the two cannot differ:

     static void exchange(pack *p, thing *x) { corot_pack_double(p, &x->a); ... }

   Numbers stand as they do in memory, doubles and 64-bit integers one after another; a reader that
   finds another byte order has to refuse the whole before. Failures stick: after one, nothing is
   written or read any more, and corot_pack_status tells. */
#ifndef COROT_CORE_BASE_PACK_H
#define COROT_CORE_BASE_PACK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "sisters.h"

typedef struct pack {
  bool reading;
  corot_status status;
  unsigned char *data; /* [bytes]; of a reader the caller's, which it does not write to */
  size_t bytes;        /* written so far, or there are to read */
  size_t at;           /* read so far */
  size_t room;         /* of a writer, allocated */
} pack;

static inline pack corot_pack_reader(const void *data, size_t bytes) {
  return (pack){.reading = true, .data = (unsigned char *)data, .bytes = bytes};
}

/* What stands at the head of bytes that another machine may read: a number that is another one in
   another byte order. */
#define COROT_BYTE_ORDER UINT64_C(0x0102030405060708)

/* Frees what a writer holds. */
COROT_SISTERS void corot_pack_clear(pack *p);

/* Writes or reads: raw bytes, one number, an array [n] of them. Where a reader has failed, what it
   was to fill stays as it is. */
COROT_SISTERS void corot_pack_bytes(pack *p, void *x, size_t bytes);
COROT_SISTERS void corot_pack_double(pack *p, double *x);
COROT_SISTERS void corot_pack_doubles(pack *p, double *x, size_t n);
COROT_SISTERS void corot_pack_long(pack *p, long *x);
COROT_SISTERS void corot_pack_int(pack *p, int *x);
COROT_SISTERS void corot_pack_bool(pack *p, bool *x);

/* Bytes of a length that the reader does not know: theirs is written before them. A reader finds
   them where they stand in what it reads. */
void corot_pack_block(pack *p, const void **x, size_t *bytes);

/* A number that the reader knows beforehand: a length, a kind. A reader that finds another fails,
   and names `what`. */
COROT_SISTERS void corot_pack_same(pack *p, uint64_t x, const char *what);

/* COROT_ENOMEM: there was no room to write. COROT_EINVAL: there is less to read than expected, or
   it is something else; the message says so. */
COROT_SISTERS corot_status corot_pack_status(const pack *p);

/* What a reader has not read yet. */
static inline size_t corot_pack_left(const pack *p) { return p->bytes - p->at; }

/* Checksum of `bytes` at x, going on from `sum`; begin with COROT_CHECKSUM. Any change of a single
   byte shows (FNV-1a of 64 bits: Fowler, Noll and Vo). */
#define COROT_CHECKSUM 0xcbf29ce484222325u
COROT_SISTERS uint64_t corot_checksum(uint64_t sum, const void *x, size_t bytes);

#endif

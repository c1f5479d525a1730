/* One stream of zlib, begun anew for each block. Level 1: of fields the last digits are noise,
   which takes longer at higher levels, and as many bytes. */
#include "zlib_array.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

struct zlib_packer {
  z_stream stream;
};

void zlib_packer_destroy(zlib_packer *p) {
  if (!p) return;
  deflateEnd(&p->stream);
  free(p);
}

corot_status zlib_packer_create(zlib_packer **packer) {
  zlib_packer *p = calloc(1, sizeof *p);
  if (!p || deflateInit(&p->stream, 1) != Z_OK) {
    free(p);
    return corot_fail(COROT_ENOMEM, "no memory for zlib");
  }
  *packer = p;
  return COROT_OK;
}

static size_t blocks_of(size_t bytes) { return (bytes + ZLIB_BLOCK - 1) / ZLIB_BLOCK; }

/* Of streams with zlib's own sizes of windows and tables. */
size_t zlib_bound(size_t bytes) { return 24 + blocks_of(bytes) * (8 + compressBound(ZLIB_BLOCK)); }

static size_t pack_block(zlib_packer *p, const char *data, size_t bytes, char *out) {
  z_stream *s = &p->stream;
  if (deflateReset(s) != Z_OK) return 0;
  s->next_in = (unsigned char *)(uintptr_t)data, s->avail_in = (uInt)bytes;
  s->next_out = (unsigned char *)out, s->avail_out = (uInt)compressBound(ZLIB_BLOCK);
  return deflate(s, Z_FINISH) == Z_STREAM_END ? s->total_out : 0;
}

size_t zlib_pack(zlib_packer *p, const void *data, size_t bytes, char *out) {
  size_t n = blocks_of(bytes), at = 24 + 8 * n;
  const uint64_t head[3] = {n, ZLIB_BLOCK, bytes % ZLIB_BLOCK};
  memcpy(out, head, sizeof head);
  for (size_t k = 0; k < n; k++) {
    size_t left = bytes - k * ZLIB_BLOCK, take = left < ZLIB_BLOCK ? left : ZLIB_BLOCK;
    uint64_t size = pack_block(p, (const char *)data + k * ZLIB_BLOCK, take, out + at);
    if (size == 0) return 0;
    memcpy(out + 24 + 8 * k, &size, sizeof size);
    at += size;
  }
  return at;
}

uint64_t zlib_unpacked(const zlib_head *h) {
  const uint64_t most = UINT64_C(1) << 40;
  if (h->nblock == 0) return 0;
  if (h->block == 0 || h->block > most || h->nblock > most / h->block || h->last >= h->block)
    return UINT64_MAX;
  return h->last > 0 ? (h->nblock - 1) * h->block + h->last : h->nblock * h->block;
}

int zlib_unpack_block(const void *packed, size_t size, void *data, size_t bytes) {
  uLongf got = bytes;
  return uncompress(data, &got, packed, size) == Z_OK && got == bytes;
}

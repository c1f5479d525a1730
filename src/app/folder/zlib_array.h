/* Arrays as VTK has them in files with compressor="vtkZLibDataCompressor" and sizes of 64 bits:
   number of blocks, bytes of each and of a last one that is shorter (0: none is), bytes of each
   when compressed; then the blocks, each a stream of zlib. */
#ifndef COROT_APP_FOLDER_ZLIB_ARRAY_H
#define COROT_APP_FOLDER_ZLIB_ARRAY_H

#include <corot/base.h>
#include <stddef.h>
#include <stdint.h>

/* Bytes of a block. */
enum { ZLIB_BLOCK = 1 << 18 };

typedef struct zlib_packer zlib_packer;

/* All memory that packing needs is taken here. COROT_ENOMEM. */
corot_status zlib_packer_create(zlib_packer **packer);

/* Takes NULL. */
void zlib_packer_destroy(zlib_packer *packer);

/* Bytes that an array of so many may come to at the most. */
size_t zlib_bound(size_t bytes);

/* Writes the array to `out` [zlib_bound(bytes)], and returns how many bytes it came to; 0: zlib
   fails, which it has no reason for. */
size_t zlib_pack(zlib_packer *packer, const void *data, size_t bytes, char *out);

/* What an array in a file begins with. */
typedef struct zlib_head {
  uint64_t nblock, block, last;
} zlib_head;

/* Bytes of the array when unpacked; UINT64_MAX: that cannot be. */
uint64_t zlib_unpacked(const zlib_head *head);

/* A block of `size` bytes becomes `bytes`: false where it is no such block. */
int zlib_unpack_block(const void *packed, size_t size, void *data, size_t bytes);

#endif

/* Takes the XML header apart, and finds the arrays behind it. */
#include "vtu.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/folder/write_vtu.h"
#include "app/folder/zlib_array.h"

static corot_status foreign(const vtu_file *f, const char *what) {
  return corot_fail(COROT_EFORMAT,
                    "%s: %s: not a file of fields as corot writes them on this machine", f->path,
                    what);
}

static corot_status read_at(const vtu_file *f, long long at, void *to, size_t size) {
  for (size_t done = 0; done < size;) {
    ssize_t n = pread(f->fd, (char *)to + done, size - done, (off_t)(at + (long long)done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return corot_fail(COROT_EIO, "%s: cannot read: %s", f->path, strerror(errno));
    if (n == 0) return foreign(f, "it is cut short");
    done += (size_t)n;
  }
  return COROT_OK;
}

/* The value of an attribute in a tag: the text between its quotes, whole numbers only. */
static long long attribute(const char *tag, const char *name) {
  const char *end = strchr(tag, '>'), *at = strstr(tag, name);
  if (!at || !end || at > end) return -1;
  char *rest;
  long long value = strtoll(at + strlen(name), &rest, 10);
  return rest > at + strlen(name) && *rest == '"' && value >= 0 ? value : -1;
}

static corot_status read_header(vtu_file *f) {
  static const char data[] = "<AppendedData encoding=\"raw\">\n";
  const uint16_t one = 1;
  const char *order =
      *(const char *)&one == 1 ? "byte_order=\"LittleEndian\"" : "byte_order=\"BigEndian\"";
  size_t size = f->size < (long long)sizeof f->header - 1 ? (size_t)f->size : sizeof f->header - 1;
  COROT_TRY(read_at(f, 0, f->header, size));
  f->header[size] = '\0';
  char *end = strstr(f->header, data);
  if (!end) return foreign(f, "no raw data");
  char *begin = end + strlen(data);
  begin += strspn(begin, " ");
  if (*begin != '_') return foreign(f, "no raw data");
  f->data = begin + 1 - f->header;
  *end = '\0';
  if (!strstr(f->header, order) || !strstr(f->header, "header_type=\"UInt64\""))
    return foreign(f, "another byte order or type of sizes");
  f->compressed = strstr(f->header, VTU_COMPRESSOR);
  const char *piece = strstr(f->header, "<Piece ");
  long long nnode = piece ? attribute(piece, " NumberOfPoints=\"") : -1;
  long long ntet = piece ? attribute(piece, " NumberOfCells=\"") : -1;
  if (nnode <= 0 || ntet <= 0 || nnode > INT32_MAX / 4 || ntet > INT32_MAX / 4)
    return foreign(f, "no sizes");
  /* No more than the file has room for, as memory is asked for by these: three doubles a point and
     four nodes a cell, of which zlib makes a 1032nd at the least. */
  long long most = f->compressed ? 1032 * f->size : f->size;
  if (nnode > most / 24 || ntet > most / 16) return foreign(f, "it is cut short");
  f->nnode = (int)nnode;
  f->ntet = (int)ntet;
  return COROT_OK;
}

void vtu_close(vtu_file *f) {
  if (f->fd >= 0) close(f->fd);
  f->fd = -1;
}

corot_status vtu_open(const char *path, vtu_file *f) {
  *f = (vtu_file){.path = path, .fd = -1};
  COROT_TRY(file_check_regular(path));
  f->fd = open(path, O_RDONLY | O_CLOEXEC);
  struct stat about;
  if (f->fd < 0 || fstat(f->fd, &about) != 0) {
    corot_fail(COROT_EIO, "%s: %s", path, strerror(errno));
    vtu_close(f);
    return COROT_EIO;
  }
  f->size = about.st_size;
  corot_status status = read_header(f);
  if (status != COROT_OK) vtu_close(f);
  return status;
}

/* Where an array begins. */
static corot_status find(const vtu_file *f, const char *name, const char *type, long long *at) {
  char start[96];
  snprintf(start, sizeof start, "<DataArray type=\"%s\" Name=\"%s\" ", type, name);
  const char *tag = strstr(f->header, start);
  long long offset = tag ? attribute(tag, " offset=\"") : -1;
  if (offset < 0 || offset > f->size) return foreign(f, name);
  *at = f->data + offset;
  return COROT_OK;
}

/* Its size [byte], when unpacked; *head is set where it is compressed. */
static corot_status measure(const vtu_file *f, const char *name, long long at, zlib_head *head,
                            uint64_t *size) {
  if (!f->compressed) return read_at(f, at, size, sizeof *size);
  COROT_TRY(read_at(f, at, head, sizeof *head));
  *size = zlib_unpacked(head);
  return *size == UINT64_MAX ? foreign(f, name) : COROT_OK;
}

/* The blocks of an array one after another; size [nblock] of the compressed ones, packed [most]. */
static corot_status unpack(const vtu_file *f, const char *name, long long at, const zlib_head *head,
                           const uint64_t *size, size_t bytes, char *packed, uint64_t most,
                           char *values) {
  for (uint64_t k = 0; k < head->nblock; k++) {
    uint64_t left = bytes - k * head->block, n = left < head->block ? left : head->block;
    if (size[k] > most) return foreign(f, name);
    COROT_TRY(read_at(f, at, packed, size[k]));
    if (!zlib_unpack_block(packed, size[k], values + k * head->block, n)) return foreign(f, name);
    at += (long long)size[k];
  }
  return COROT_OK;
}

/* An array of `bytes` bytes that begins with this head. */
static corot_status read_packed(const vtu_file *f, const char *name, long long at,
                                const zlib_head *head, size_t bytes, void *values) {
  uint64_t n = head->nblock, block = head->block < bytes ? head->block : bytes,
           most = block + block / 1000 + 64;
  if (n > 1 && head->block < 4096) return foreign(f, name); /* memory for sizes is asked for */
  uint64_t *size = malloc((n + 1) * sizeof *size);
  char *packed = malloc(most);
  corot_status status = COROT_OK;
  if (!size || !packed) status = corot_fail(COROT_ENOMEM, "%s: out of memory", f->path);
  if (status == COROT_OK) status = read_at(f, at + 24, size, n * sizeof *size);
  if (status == COROT_OK)
    status = unpack(f, name, at + 24 + 8 * (long long)n, head, size, bytes, packed, most, values);
  free(size);
  free(packed);
  return status;
}

corot_status vtu_array(const vtu_file *f, const char *name, const char *type, size_t bytes,
                       void *values) {
  long long at = 0;
  uint64_t size;
  zlib_head head = {0};
  COROT_TRY(find(f, name, type, &at));
  COROT_TRY(measure(f, name, at, &head, &size));
  if (size != bytes) return foreign(f, name);
  if (f->compressed) return read_packed(f, name, at, &head, bytes, values);
  return read_at(f, at + 8, values, bytes);
}

corot_status vtu_order(const vtu_file *f, int *order) {
  long long at = 0;
  uint64_t size, ntet = (uint64_t)f->ntet;
  zlib_head head;
  COROT_TRY(find(f, "connectivity", "Int32", &at));
  COROT_TRY(measure(f, "connectivity", at, &head, &size));
  if (size != 4 * 4 * ntet && size != 10 * 4 * ntet) return foreign(f, "connectivity");
  *order = size == 4 * 4 * ntet ? 1 : 2;
  return COROT_OK;
}

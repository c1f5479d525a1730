/* The frame about a state: what it is of, and that it is whole. */
#include "checkpoint_file.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/text/json_text.h"
#include "core/mesh/read/reader.h"
#include "folder.h"

#define FORMAT UINT64_C(1)
#define BYTE_ORDER_OTHER UINT64_C(0x0807060504030201)

enum { MAGIC = sizeof CHECKPOINT_MARK - 1, DIGEST = HASH_SIZE - 1, BYTES_AT = MAGIC + 16 };

/* --- Writing --- */

static void put_number(pack *p, uint64_t x) { corot_pack_bytes(p, &x, sizeof x); }

void checkpoint_file_begin(pack *p, const char run[HASH_SIZE], const char *program, double t) {
  const void *text = program;
  size_t length = strlen(program);
  corot_pack_bytes(p, (char *)CHECKPOINT_MARK, MAGIC);
  put_number(p, COROT_BYTE_ORDER);
  put_number(p, FORMAT);
  put_number(p, 0); /* bytes, once they are known */
  corot_pack_bytes(p, (char *)run, DIGEST);
  corot_pack_block(p, &text, &length);
  corot_pack_double(p, &t);
}

corot_status checkpoint_file_seal(pack *p) {
  COROT_TRY(corot_pack_status(p));
  uint64_t bytes = p->bytes + DIGEST;
  char digest[HASH_SIZE];
  memcpy(p->data + BYTES_AT, &bytes, sizeof bytes);
  hash_bytes((const char *)p->data, p->bytes, digest);
  corot_pack_bytes(p, digest, DIGEST);
  return corot_pack_status(p);
}

/* --- Reading --- */

static corot_status check_frame(const char *path, const char *data, size_t size) {
  uint64_t order, format, bytes;
  char digest[HASH_SIZE];
  if (size < MAGIC || memcmp(data, CHECKPOINT_MARK, MAGIC) != 0)
    return corot_fail(COROT_EFORMAT, "%s: is not a checkpoint of corot", path);
  if (size < BYTES_AT + sizeof bytes + DIGEST)
    return corot_fail(COROT_EFORMAT, "%s: is cut short: it has %zu bytes", path, size);
  memcpy(&order, data + MAGIC, sizeof order);
  memcpy(&format, data + MAGIC + 8, sizeof format);
  memcpy(&bytes, data + BYTES_AT, sizeof bytes);
  if (order == BYTE_ORDER_OTHER)
    return corot_fail(COROT_EFORMAT, "%s: was written by a machine of another byte order", path);
  if (order != COROT_BYTE_ORDER) return corot_fail(COROT_EFORMAT, "%s: is damaged", path);
  if (format != FORMAT)
    return corot_fail(COROT_EFORMAT,
                      "%s: is of format %llu, or damaged; this program reads format %llu", path,
                      (unsigned long long)format, (unsigned long long)FORMAT);
  if (bytes != size)
    return corot_fail(COROT_EFORMAT, "%s: is %s: it has %zu bytes, and should have %llu", path,
                      size < bytes ? "cut short" : "damaged", size, (unsigned long long)bytes);
  hash_bytes(data, size - DIGEST, digest);
  if (memcmp(digest, data + size - DIGEST, DIGEST) != 0)
    return corot_fail(COROT_EFORMAT, "%s: is damaged: its checksum is another", path);
  return COROT_OK;
}

/* What follows the frame, of a file that is whole. */
static corot_status read_identity(const char *path, checkpoint_file *f) {
  pack *p = &f->state;
  const void *text = NULL;
  size_t length = 0;
  corot_pack_bytes(p, f->run, DIGEST);
  corot_pack_block(p, &text, &length);
  if (corot_pack_status(p)) return corot_fail(COROT_EFORMAT, "%s: is damaged", path);
  COROT_TRY(json_text_parse(path, text, length, &f->program));
  corot_pack_double(p, &f->t);
  return corot_pack_status(p);
}

static corot_status read_all(const char *path, checkpoint_file *f) {
  size_t size;
  COROT_TRY(file_check_regular(path));
  COROT_TRY(corot_file_load(path, &f->data, &size));
  COROT_TRY(check_frame(path, f->data, size));
  f->state = corot_pack_reader(f->data, size - DIGEST);
  f->state.at = BYTES_AT + 8;
  return read_identity(path, f);
}

corot_status checkpoint_file_read(const char *path, checkpoint_file *out) {
  checkpoint_file f = {0};
  corot_status status = read_all(path, &f);
  if (status == COROT_OK)
    *out = f;
  else
    checkpoint_file_free(&f);
  return status;
}

void checkpoint_file_free(checkpoint_file *file) {
  json_decref(file->program);
  free(file->data);
  *file = (checkpoint_file){0};
}

corot_status checkpoint_file_stands(const char *dir, bool *stands) {
  char *path = folder_path(dir, CHECKPOINT_NAME), start[MAGIC];
  if (!path) return COROT_ENOMEM;
  struct stat info;
  bool regular = lstat(path, &info) == 0 && S_ISREG(info.st_mode);
  int fd = regular ? open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC) : -1;
  *stands =
      fd >= 0 && read(fd, start, MAGIC) == MAGIC && memcmp(start, CHECKPOINT_MARK, MAGIC) == 0;
  if (fd >= 0) close(fd);
  free(path);
  return COROT_OK;
}

/* The header, then one record an output time; read back in one piece. */
#include "states.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

#include "folder.h"

static const char magic[8] = {'c', 'o', 'r', 'o', 't', '-', 's', 't'};
enum { VERSION = 1, ORDER = 0x01020304 };

typedef struct header {
  char magic[8];
  uint32_t version, order;
  int64_t n;
} header;

/* Bytes of the places with what fills them up to whole doubles, and of a record. */
static size_t place_bytes(size_t n) { return (n + n % 2) * sizeof(int32_t); }
static size_t record_bytes(size_t n) { return (1 + 2 * n) * sizeof(double); }

/* --- Writing --- */

struct state_writer {
  int fd, n;
  char *path;
  double *record; /* [1 + 2 n] */
  growth whole;   /* the header and the whole records, without a sum */
};

corot_status states_close(state_writer *file) {
  if (!file) return COROT_OK;
  corot_status status = file_close(file->fd, file->path);
  free(file->path);
  free(file->record);
  free(file);
  return status;
}

static corot_status write_header(state_writer *file, const corot_model *model) {
  size_t n = (size_t)file->n, size = sizeof(header) + place_bytes(n);
  char *text = calloc(1, size);
  if (!text) return corot_fail(COROT_ENOMEM, "%s: out of memory", file->path);
  header head = {.version = VERSION, .order = ORDER, .n = file->n};
  memcpy(head.magic, magic, sizeof magic);
  memcpy(text, &head, sizeof head);

  int32_t *place = (int32_t *)(text + sizeof head);
  const int(*dof)[3] = corot_model_dof(model);
  for (int i = 0; i < corot_model_mesh(model)->nnode; i++)
    for (int c = 0; c < 3; c++)
      if (dof[i][c] >= 0) place[dof[i][c]] = 3 * i + c;

  corot_status status = file_write(file->fd, file->path, text, size);
  free(text);
  file->whole.size = (long)size;
  return status;
}

/* Without its file. */
static corot_status prepare(state_writer *file, const char *dir, const corot_model *model) {
  file->n = corot_model_ndof(model);
  file->path = folder_path(dir, "states.bin");
  if (!file->path) return COROT_ENOMEM;
  file->record = malloc(record_bytes((size_t)file->n));
  if (!file->record) return corot_fail(COROT_ENOMEM, "%s: out of memory", file->path);
  file->whole = growth_begin();
  return COROT_OK;
}

/* On the file of a checkpoint, or from the beginning (NULL). */
static corot_status begin(const char *dir, const corot_model *model, pack *p, state_writer **out) {
  state_writer *file = calloc(1, sizeof *file);
  if (!file) return corot_fail(COROT_ENOMEM, "%s/states.bin: out of memory", dir);
  file->fd = -1;
  corot_status status = prepare(file, dir, model);
  if (status == COROT_OK && p) {
    growth_exchange(p, &file->whole);
    status = corot_pack_status(p);
    if (status == COROT_OK) status = growth_reopen(file->path, &file->whole, &file->fd);
  } else if (status == COROT_OK) {
    status = file_create(file->path, &file->fd);
    if (status == COROT_OK) status = write_header(file, model);
  }
  if (status != COROT_OK) {
    states_close(file);
    return status;
  }
  *out = file;
  return COROT_OK;
}

corot_status states_create(const char *dir, const corot_model *model, state_writer **out) {
  return begin(dir, model, NULL, out);
}

corot_status states_resume(const char *dir, const corot_model *model, pack *p, state_writer **out) {
  return begin(dir, model, p, out);
}

corot_status states_pack(state_writer *file, pack *p) {
  growth_exchange(p, &file->whole);
  return corot_pack_status(p);
}

corot_status states_cut(state_writer *file) {
  return growth_cut(file->fd, file->path, &file->whole);
}

corot_status states_synchronise(state_writer *file) {
  return file_synchronise(file->fd, file->path);
}

corot_status states_add(state_writer *file, double t, const double *u, const double *v) {
  size_t n = (size_t)file->n, size = record_bytes(n);
  file->record[0] = t;
  memcpy(file->record + 1, u, n * sizeof *u);
  memcpy(file->record + 1 + n, v, n * sizeof *v);
  corot_status status = file_write(file->fd, file->path, file->record, size);
  if (status == COROT_OK)
    file->whole.size += (long)size;
  else if (ftruncate(file->fd, file->whole.size) == 0)
    lseek(file->fd, file->whole.size, SEEK_SET);
  return status;
}

/* --- Reading --- */

static corot_status read_bytes(int fd, const char *path, void *data, size_t size) {
  char *rest = data;
  while (size > 0) {
    ssize_t got = read(fd, rest, size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return corot_fail(COROT_EIO, "%s: cannot read: %s", path, strerror(errno));
    if (got == 0) return corot_fail(COROT_EFORMAT, "%s: cut short", path);
    rest += got;
    size -= (size_t)got;
  }
  return COROT_OK;
}

static corot_status check_header(const header *head, off_t size, const char *path) {
  if (memcmp(head->magic, magic, sizeof magic) != 0)
    return corot_fail(COROT_EFORMAT, "%s: not a file of states", path);
  if (head->order != ORDER)
    return corot_fail(COROT_EFORMAT, "%s: written by a machine of another byte order", path);
  if (head->version != VERSION)
    return corot_fail(COROT_EFORMAT, "%s: version %u; this program reads %d", path,
                      (unsigned)head->version, VERSION);
  if (head->n < 0 || head->n > INT_MAX ||
      (uint64_t)size < sizeof *head + place_bytes((size_t)head->n))
    return corot_fail(COROT_EFORMAT, "%s: %lld degrees of freedom in %lld bytes", path,
                      (long long)head->n, (long long)size);
  return COROT_OK;
}

static corot_status check_places(const trajectory *s, const char *path) {
  for (int i = 0; i < s->n; i++)
    if (s->place[i] <= (i > 0 ? s->place[i - 1] : -1))
      return corot_fail(COROT_EFORMAT, "%s: degree of freedom %d is at place %d, out of order",
                        path, i, s->place[i]);
  return COROT_OK;
}

static corot_status check_records(const trajectory *s, const char *path) {
  size_t length = 1 + 2 * (size_t)s->n;
  for (int k = 0; k < s->count; k++) {
    const double *record = s->record + (size_t)k * length;
    for (size_t i = 0; i < length; i++)
      if (!isfinite(record[i]))
        return corot_fail(COROT_EFORMAT, "%s: record %d: number %zu is %g", path, k, i, record[i]);
    if (k > 0 && !(record[0] > states_t(s, k - 1)))
      return corot_fail(COROT_EFORMAT, "%s: record %d: t = %g s follows %g s", path, k, record[0],
                        states_t(s, k - 1));
  }
  return COROT_OK;
}

static corot_status read_all(int fd, const char *path, trajectory *s) {
  struct stat info;
  header head;
  if (fstat(fd, &info) != 0)
    return corot_fail(COROT_EIO, "%s: cannot read: %s", path, strerror(errno));
  COROT_TRY(read_bytes(fd, path, &head, sizeof head));
  COROT_TRY(check_header(&head, info.st_size, path));

  size_t n = (size_t)head.n, places = place_bytes(n);
  size_t count = ((size_t)info.st_size - sizeof head - places) / record_bytes(n);
  if (count > INT_MAX) return corot_fail(COROT_EFORMAT, "%s: %zu records", path, count);
  s->n = (int)n;
  s->count = (int)count;
  s->place = malloc(places + 1);
  s->record = malloc(count * record_bytes(n) + 1);
  if (!s->place || !s->record) return corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  COROT_TRY(read_bytes(fd, path, s->place, places));
  COROT_TRY(read_bytes(fd, path, s->record, count * record_bytes(n)));
  COROT_TRY(check_places(s, path));
  return check_records(s, path);
}

corot_status states_read(const char *dir, trajectory *out) {
  char *path = folder_path(dir, "states.bin");
  if (!path) return COROT_ENOMEM;
  trajectory s = {0};
  int fd = open(path, O_RDONLY | O_CLOEXEC);
  corot_status status = fd < 0
                            ? corot_fail(COROT_EIO, "%s: cannot open it: %s", path, strerror(errno))
                            : read_all(fd, path, &s);
  if (fd >= 0) close(fd);
  free(path);
  if (status == COROT_OK)
    *out = s;
  else
    states_free(&s);
  return status;
}

void states_free(trajectory *s) {
  free(s->place);
  free(s->record);
  *s = (trajectory){0};
}

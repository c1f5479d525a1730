/* Looks what has become of a run, and books failures and timings. */
#include "store.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/command/cli.h"
#include "app/folder/folder.h"
#include "app/folder/folder_files.h"
#include "app/run/stop.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "report/read/lookup.h"
#include "study/plan/json_file.h"

char *store_path(const char *dir, const study_run *run, const char *name) {
  size_t size = strlen(dir) + strlen(run->id) + strlen(name) + sizeof "/runs//";
  char *path = malloc(size);
  if (!path) {
    no_memory();
    return NULL;
  }
  snprintf(path, size, "%s/runs/%s%s%s", dir, run->id, *name ? "/" : "", name);
  return path;
}

/* A file of a run, or nothing if it is missing, damaged or about another run. */
static corot_status read_own(const char *dir, const study_run *run, const char *name,
                             const char *hash_path, json_t **out) {
  char *path = store_path(dir, run, name);
  if (!path) return COROT_ENOMEM;
  json_t *json = NULL;
  bool there;
  corot_status status = folder_look(path, &there);
  if (status == COROT_OK && there) status = json_file_read(path, &json);
  free(path);
  if (status == COROT_ENOMEM || status == COROT_EIO) return status;
  const json_t *hash = lookup(json, hash_path);
  if (!json_is_string(hash) || strcmp(json_string_value(hash), run->hash) != 0) {
    json_decref(json);
    json = NULL;
  }
  *out = json;
  return COROT_OK;
}

/* --- Runs --- */

/* Whether the same would happen again. */
static bool is_lasting(const json_t *said) {
  return json_is_false(json_object_get(json_object_get(said, "failure"), "retry"));
}

static corot_status keep_reason(const json_t *json, run_record *record) {
  const char *reason = json_string_value(json_object_get(json, "reason"));
  if (!reason) reason = "no reason is given";
  record->reason = malloc(strlen(reason) + 1);
  if (!record->reason) return no_memory();
  strcpy(record->reason, reason);
  record->exit_code = (int)json_integer_value(json_object_get(json, "exit_code"));
  record->timed_out = strcmp(lookup_text(json, "failure.kind"), "timeout") == 0;
  if (is_lasting(json)) record->state = RUN_FAILED;
  return COROT_OK;
}

/* A result is worth as much as the files that it lists: where one is lost, the run is. */
static corot_status look_at_files(const char *dir, const study_run *run, json_t *result,
                                  bool contents, run_record *record) {
  char *path = store_path(dir, run, "");
  if (!path) return COROT_ENOMEM;
  corot_status status = contents ? folder_verify(path, result) : folder_check(path, result);
  free(path);
  if (status == COROT_OK) {
    record->state = RUN_DONE;
    record->result = json_incref(result);
  } else if (status == COROT_EFORMAT) {
    record->damaged = true;
    record->reason = strdup(corot_error());
    status = record->reason ? COROT_OK : no_memory();
  }
  return status;
}

static corot_status look(const char *dir, const study_run *run, bool contents, run_record *record) {
  run_record r = {.state = RUN_MISSING};
  json_t *result = NULL, *failure = NULL;
  COROT_TRY(read_own(dir, run, "result.json", "hashes.run", &result));
  const char *status = json_string_value(json_object_get(result, "status"));
  corot_status looked = COROT_OK;
  if (status && strcmp(status, "ok") == 0) {
    looked = look_at_files(dir, run, result, contents, &r);
  } else if (is_lasting(result)) {
    looked = keep_reason(result, &r);
  } else {
    looked = read_own(dir, run, "failure.json", "hash", &failure);
    if (looked == COROT_OK && (failure || status))
      looked = keep_reason(failure ? failure : result, &r);
  }
  json_decref(result);
  json_decref(failure);
  if (looked == COROT_OK) *record = r;
  return looked;
}

corot_status store_look(const char *dir, const study_run *run, run_record *record) {
  return look(dir, run, false, record);
}

corot_status store_verify(const char *dir, const study_run *run, run_record *record) {
  return look(dir, run, true, record);
}

void run_record_free(run_record *record) {
  free(record->reason);
  json_decref(record->result);
  *record = (run_record){0};
}

static corot_status remove_own(const char *dir, const study_run *run, const char *name) {
  char *path = store_path(dir, run, name);
  if (!path) return COROT_ENOMEM;
  corot_status status = COROT_OK;
  if (unlink(path) != 0 && errno != ENOENT)
    status = corot_fail(COROT_EIO, "%s: cannot remove it: %s", path, strerror(errno));
  free(path);
  return status;
}

corot_status store_clear(const char *dir, const study_run *run) {
  char *path = store_path(dir, run, "");
  if (!path) return COROT_ENOMEM;
  corot_status status = folder_make(path);
  free(path);
  COROT_TRY(status);
  COROT_TRY(remove_own(dir, run, "result.json"));
  return remove_own(dir, run, "failure.json");
}

bool store_is_timeout(int ended) {
  return ended == -SIGALRM || ended == 128 + SIGALRM || ended == -SIGXCPU || ended == 128 + SIGXCPU;
}

static bool is_request(int number) {
  for (int i = 0; i < STOP_SIGNALS; i++)
    if (stop_signals[i] == number) return true;
  return number == SIGKILL; /* by the system, for want of memory, or by hand */
}

run_failure store_failure(int ended) {
  if (store_is_timeout(ended)) return (run_failure){"timeout", false};
  if (is_request(-ended) || ended > 127) return (run_failure){"interrupted", true};
  if (ended < 0) return (run_failure){"crash", true}; /* mostly for want of memory */
  if (ended == EXIT_SYSTEM || ended == 127) return (run_failure){"io", true};
  if (ended == EXIT_CHECK) return (run_failure){"crash", true}; /* OpenMP's, for want of memory */
  if (ended == EXIT_INTEGRATOR) return (run_failure){"integrator", false};
  return (run_failure){"scenario", ended == 0}; /* 0: it was changed meanwhile */
}

/* What a run that did not get as far as its hash said itself. */
static bool says_memory(const char *dir, const study_run *run) {
  char *path = store_path(dir, run, "result.json");
  json_t *result = NULL;
  corot_status status = path ? json_file_read(path, &result) : COROT_ENOMEM;
  const json_t *failure = json_object_get(result, "failure");
  const char *kind = json_string_value(json_object_get(failure, "kind"));
  bool memory = status == COROT_OK && kind && strcmp(kind, "memory") == 0;
  json_decref(result);
  free(path);
  return memory;
}

corot_status store_fail(const char *dir, const study_run *run, int ended, const char *reason) {
  run_failure why = store_failure(ended);
  if (ended == EXIT_SYSTEM && says_memory(dir, run)) why.kind = "memory";
  char *path = store_path(dir, run, "");
  json_t *failure =
      json_pack("{s:s, s:o, s:o, s:i}", "hash", run->hash, "reason", json_text_string(reason),
                "failure", run_failure_json(why), ended < 0 ? "signal" : "exit_code", abs(ended));
  corot_status status =
      path && failure ? json_file_write(path, "failure.json", failure) : no_memory();
  json_decref(failure);
  free(path);
  return status;
}

corot_status store_check(const char *dir, store_lock lock) {
  struct stat info;
  int fd = lock.part >= 0 ? lock.part : lock.whole;
  if (fd < 0 || fstat(fd, &info) != 0 || info.st_nlink > 0) return COROT_OK;
  return corot_fail(COROT_EIO,
                    "%s: has been removed while it was written; the same command does all of it "
                    "again",
                    dir);
}

/* --- Timings --- */

static bool grow(void **array, int n, size_t size) {
  void *more = realloc(*array, (size_t)n * size);
  if (more) *array = more;
  return more != NULL;
}

static corot_status timings_grow(timings *t, double cpu, double wall, json_t *provenance) {
  int n = t->n + 1;
  if (!grow((void **)&t->cpu, n, sizeof *t->cpu) || !grow((void **)&t->wall, n, sizeof *t->wall) ||
      !grow((void **)&t->provenance, n, sizeof(json_t *)))
    return no_memory();
  t->cpu[t->n] = cpu;
  t->wall[t->n] = wall;
  t->provenance[t->n++] = json_incref(provenance);
  return COROT_OK;
}

corot_status timings_read(const char *dir, const study_run *run, timings *out) {
  json_t *json = NULL;
  COROT_TRY(read_own(dir, run, "timings.json", "hash", &json));
  const json_t *runs = json_object_get(json, "runs");
  timings t = {0};
  corot_status status = COROT_OK;
  for (size_t i = 0; i < json_array_size(runs) && status == COROT_OK; i++) {
    const json_t *entry = json_array_get(runs, i);
    status = timings_grow(&t, json_number_value(json_object_get(entry, "cpu")),
                          json_number_value(json_object_get(entry, "wall")),
                          json_object_get(entry, "provenance"));
  }
  json_decref(json);
  if (status == COROT_OK)
    *out = t;
  else
    timings_free(&t);
  return status;
}

corot_status timings_add(const char *dir, const study_run *run, timings *t, double cpu, double wall,
                         json_t *provenance) {
  COROT_TRY(timings_grow(t, cpu, wall, provenance));
  json_t *list = json_array();
  for (int i = 0; i < t->n; i++)
    list = json_text_push(list, json_pack("{s:f, s:f, s:O?}", "cpu", t->cpu[i], "wall", t->wall[i],
                                          "provenance", t->provenance[i]));
  json_t *json = json_pack("{s:s, s:o}", "hash", run->hash, "runs", list);
  char *path = store_path(dir, run, "");
  corot_status status = json && path ? json_file_write(path, "timings.json", json) : no_memory();
  json_decref(json);
  free(path);
  return status;
}

void timings_free(timings *t) {
  for (int i = 0; i < t->n; i++) json_decref(t->provenance[i]);
  free(t->provenance);
  free(t->cpu);
  free(t->wall);
  *t = (timings){0};
}

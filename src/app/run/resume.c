/* A result first, for it is what a run is for; then a checkpoint. */
#include "resume.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/folder/folder_files.h"
#include "app/folder/folder_owner.h"
#include "app/folder/provenance.h"
#include "app/text/json_text.h"
#include "app/text/say.h"

/* --- A result --- */

static const char *hash_of(const json_t *result) {
  const char *run = json_string_value(json_object_get(json_object_get(result, "hashes"), "run"));
  return run ? run : "";
}

/* Its files are there, too. */
static bool is_finished(const char *dir, const json_t *result, const char run[HASH_SIZE]) {
  return folder_is_over(result) && strcmp(hash_of(result), run) == 0 &&
         folder_check(dir, result) == COROT_OK;
}

/* Of a process that was killed after it had put the result in place. */
static void remove_leftover(const char *dir) {
  bool stands = false;
  char *path = folder_path(dir, CHECKPOINT_NAME);
  if (path && checkpoint_file_stands(dir, &stands) == COROT_OK && stands) unlink(path);
  free(path);
}

static corot_status look_for_result(const scenario *s, const char run[HASH_SIZE],
                                    const run_options *options, resume *out) {
  json_t *result = NULL;
  COROT_TRY(folder_result(options->dir, &result));
  corot_status status = COROT_OK;
  if (is_finished(options->dir, result, run)) {
    out->found = RESUME_FINISHED;
    remove_leftover(options->dir);
    out->exit_code = (int)json_integer_value(json_object_get(result, "exit_code"));
    if (!options->quiet) say("%s: is done already; %s\n", s->path, options->dir);
    if (options->json) status = json_text_show(result);
  }
  json_decref(result);
  return status;
}

/* --- A checkpoint --- */

/* What has to be the same for the same numbers, to the last bit, and what a state is packed by. */
static corot_status check_program(const char *path, const json_t *theirs, const json_t *ours) {
  char other[160], here[160];
  for (int i = 0; i < PROVENANCE_OF_CODE; i++) {
    if (provenance_same(theirs, ours, i)) continue;
    provenance_words(theirs, i, sizeof other, other);
    provenance_words(ours, i, sizeof here, here);
    return corot_fail(COROT_EFORMAT,
                      "%s: was written by another program, %s; this is %s: go on with that one, or "
                      "begin anew with --force",
                      path, other, here);
  }
  return COROT_OK;
}

/* Libraries round otherwise on another processor: the run goes on as well, but not to the last bit.
 */
static void tell_difference(const scenario *s, const json_t *theirs, const json_t *ours) {
  char other[160], here[160];
  for (int i = PROVENANCE_OF_CODE; i < PROVENANCE_FIELDS; i++) {
    if (provenance_same(theirs, ours, i)) continue;
    provenance_words(theirs, i, sizeof other, other);
    provenance_words(ours, i, sizeof here, here);
    say("%s: the checkpoint was written with %s, and goes on with %s: the last digits may differ "
        "from those of a run that was not cut\n",
        s->path, other, here);
    return;
  }
}

static corot_status check(const scenario *s, const char *path, const char run[HASH_SIZE],
                          const run_options *options, const checkpoint_file *file) {
  json_t *ours = NULL;
  COROT_TRY(provenance_make(&ours));
  corot_status status = check_program(path, file->program, ours);
  if (status == COROT_OK && strcmp(file->run, run) != 0)
    status = corot_fail(COROT_EFORMAT,
                        "%s: is of another scenario or mesh than %s: take that one, or another "
                        "folder, or begin anew with --force",
                        path, s->path);
  if (status == COROT_OK && !options->quiet) tell_difference(s, file->program, ours);
  json_decref(ours);
  return status;
}

static corot_status read_file(const scenario *s, const char *path, const char run[HASH_SIZE],
                              const run_options *options, resume *out) {
  COROT_TRY(checkpoint_file_read(path, &out->file));
  corot_status status = check(s, path, run, options, &out->file);
  if (status != COROT_OK) checkpoint_file_free(&out->file);
  return status;
}

corot_status resume_read(const scenario *s, const char run[HASH_SIZE], const run_options *options,
                         resume *out) {
  char *path = folder_path(options->dir, CHECKPOINT_NAME);
  if (!path) return COROT_ENOMEM;
  corot_status status = read_file(s, path, run, options, out);
  free(path);
  if (status == COROT_EFORMAT && options->force) {
    out->found = RESUME_NOTHING;
    if (!options->quiet) say("%s; the run begins anew\n", corot_error());
    return COROT_OK;
  }
  if (status == COROT_OK && !options->quiet)
    say("%s: goes on from t = %.6g s of %g s; %s\n", s->path, out->file.t, s->t_end, options->dir);
  return status;
}

corot_status resume_find(const scenario *s, const char run[HASH_SIZE], const run_options *options,
                         resume *out) {
  bool there = false;
  *out = (resume){.found = RESUME_NOTHING};
  COROT_TRY(look_for_result(s, run, options, out));
  if (out->found == RESUME_FINISHED) return COROT_OK;
  char *path = folder_path(options->dir, CHECKPOINT_NAME);
  corot_status status = path ? folder_look(path, &there) : COROT_ENOMEM;
  free(path);
  if (there)
    out->found = RESUME_CHECKPOINT;
  else if (status == COROT_OK && !options->quiet)
    say("%s: nothing to go on from in %s; it begins\n", s->path, options->dir);
  return status;
}

bool resume_is_over(const char *dir) {
  json_t *result = NULL;
  bool over = folder_result(dir, &result) == COROT_OK && folder_is_over(result);
  json_decref(result);
  return over;
}

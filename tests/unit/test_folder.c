/* Files put in place as a whole, where the disk refuses at the last moment. */
#include "check.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "temporary.h"

static int until_failure; /* calls of fsync that succeed; -1: all do */

int fsync(int fd) {
  (void)fd;
  if (until_failure < 0 || until_failure-- > 0) return 0;
  errno = EIO;
  return -1;
}

/* Neither the file nor its temporary one is left to be taken for a success. */
static void a_failed_fsync_leaves_no_file(void **state) {
  (void)state;
  char *dir = temporary_folder(), *path = folder_path(dir, "result.json");
  char *temporary = folder_path(dir, "result.json.tmp");
  for (int fail = 0; fail < 2; fail++) {
    until_failure = fail; /* the file, the folder */
    assert_fails(file_replace_durably(path, "ok", 2), COROT_EIO, "cannot write to the disk");
    assert_int_equal(access(path, F_OK), -1);
    assert_int_equal(access(temporary, F_OK), -1);
  }
  until_failure = -1;
  assert_ok(file_replace_durably(path, "ok", 2));
  assert_int_equal(access(path, F_OK), 0);
  free(path), free(temporary);
  remove_folder(dir);
}

typedef enum thing { A_FOLDER, A_PIPE, A_LINK, A_DANGLING_LINK, A_DEVICE, THINGS } thing;

static void place(const char *dir, thing what, const char *path) {
  switch (what) {
    case A_FOLDER:
      assert_int_equal(mkdir(path, 0777), 0);
      break;
    case A_PIPE:
      assert_int_equal(mkfifo(path, 0666), 0);
      break;
    case A_LINK:
      assert_int_equal(symlink("theirs", path), 0);
      break;
    case A_DANGLING_LINK:
      assert_int_equal(symlink("nowhere", path), 0);
      break;
    default:
      assert_int_equal(symlink("/dev/null", path), 0);
  }
  char *theirs = folder_path(dir, "theirs");
  FILE *file = fopen(theirs, "w");
  assert_true(file && fputs("precious", file) != EOF && fclose(file) == 0);
  free(theirs);
}

static void expect_untouched(const char *dir, const char *path, const struct stat *before) {
  char *theirs = folder_path(dir, "theirs"), *nowhere = folder_path(dir, "nowhere");
  struct stat now;
  assert_int_equal(lstat(path, &now), 0);
  assert_int_equal(now.st_ino, before->st_ino);
  assert_int_equal(now.st_mode, before->st_mode);
  assert_int_equal(stat(theirs, &now), 0);
  assert_int_equal(now.st_size, 8);
  assert_int_equal(access(nowhere, F_OK), -1);
  free(theirs), free(nowhere);
}

/* Neither where a file is to be put, nor where its temporary one is, nor where a table grows. */
static void what_is_not_a_regular_file_stays(void **state) {
  (void)state;
  for (thing what = 0; what < THINGS; what++)
    for (int place_of = 0; place_of < 3; place_of++) {
      char *dir = temporary_folder(), *path = folder_path(dir, "result.json");
      char *temporary = folder_path(dir, "result.json.tmp");
      char *at = place_of == 1 ? temporary : path;
      struct stat before;
      int fd = -1;
      place(dir, what, at);
      assert_int_equal(lstat(at, &before), 0);
      if (place_of == 2 && (what == A_DEVICE || what == A_PIPE)) { /* which harms nothing */
        int reader = open(at, O_RDONLY | O_NONBLOCK);
        assert_ok(file_create(at, &fd));
        close(reader);
      } else {
        assert_fails(place_of < 2 ? file_replace_durably(path, "ok", 2) : file_create(at, &fd),
                     COROT_EIO, "is not a regular file");
      }
      if (what != A_DEVICE || place_of != 1) expect_untouched(dir, at, &before);
      if (fd >= 0) close(fd);
      free(path), free(temporary);
      remove_folder(dir);
    }
}

/* A temporary file that has another name is not the one that is written to. */
static void a_hard_link_is_no_way_out(void **state) {
  (void)state;
  char *dir = temporary_folder(), *path = folder_path(dir, "result.json");
  char *temporary = folder_path(dir, "result.json.tmp"), *theirs = folder_path(dir, "theirs");
  struct stat info;
  place(dir, A_DANGLING_LINK, path);
  assert_int_equal(unlink(path), 0);
  assert_int_equal(link(theirs, temporary), 0);
  assert_ok(file_replace_durably(path, "ok", 2));
  assert_int_equal(stat(theirs, &info), 0);
  assert_int_equal(info.st_size, 8);
  free(path), free(temporary), free(theirs);
  remove_folder(dir);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_failed_fsync_leaves_no_file),
      cmocka_unit_test(what_is_not_a_regular_file_stays),
      cmocka_unit_test(a_hard_link_is_no_way_out),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Files put in place as a whole, where the disk refuses at the last moment. */
#include "check.h"

#include <app/folder.h>
#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

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

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_failed_fsync_leaves_no_file)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}

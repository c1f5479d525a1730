/* corot-bench peers: the script of that name, which runs corot and other programs. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "bench.h"

int command_peers(int argc, char **argv) {
  char script[] = PEERS_SCRIPT;
  char **given = calloc((size_t)argc + 1, sizeof *given);
  if (!given) return failure(corot_fail(COROT_ENOMEM, "out of memory"));
  setenv("COROT", COROT_PROGRAM, 0);
  memcpy(given, argv, (size_t)argc * sizeof *given);
  given[0] = script;
  execv(script, given);
  corot_status status = corot_fail(COROT_EIO, "%s: %s", script, strerror(errno));
  free(given);
  return failure(status);
}

/* The command line: one function a command, and what they share. */
#ifndef COROT_APP_COMMAND_CLI_H
#define COROT_APP_COMMAND_CLI_H

#include <corot/mesh.h>
#include <getopt.h>
#include <stdbool.h>

#include "app/run/exit_code.h"

/* Each gets the arguments from its own name on, prints data on stdout and messages on stderr, and
   returns the exit code. */
int command_run(int argc, char **argv);
int command_static(int argc, char **argv);
int command_modes(int argc, char **argv);
int command_check(int argc, char **argv);
int command_schema(int argc, char **argv);
int command_tune(int argc, char **argv);
int command_mesh(int argc, char **argv);
int command_new(int argc, char **argv);
int command_mesh_box(int argc, char **argv);
int command_mesh_info(int argc, char **argv);
int command_mesh_refine(int argc, char **argv);
int command_mesh_repair(int argc, char **argv);
int command_mesh_convert(int argc, char **argv);

typedef struct command {
  const char *name;
  int (*run)(int argc, char **argv);
} command;

/* Runs the command named by argv[1], out of those in `table`, which an entry without a name ends.
   `program` is what stands before it ("corot", "corot mesh"). */
int dispatch(const char *program, const char *help, const command *table, int argc, char **argv);

/* "corot COMMAND: ..." and where to find help, on stderr. Returns EXIT_USAGE. */
int usage_error(const char *program, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* What getopt_long meant by '?' or ':'. */
int option_error(const char *program, int answer, char **argv, const struct option *known);

/* corot_error() on stderr, and the exit code that belongs to the status. */
int failure(corot_status status);

/* What reading a scenario, a study or a mesh comes to: a file that is not there, or is a folder, is
   a bad one (COROT_EFORMAT); one that the system would not read stays COROT_EIO. */
corot_status read_failure(corot_status status, const char *path);

/* A mesh file, mended; what was mended is said on stderr, a warning a line. */
corot_status read_mended(const char *path, const corot_mending *mending, corot_mesh **mesh);

/* A unit of length; EXIT_OK, or the exit code of a usage error. */
int parse_unit(const char *program, const char *text, double *metres);

/* Three numbers separated by commas. */
bool parse_three(const char *text, double number[3]);

/* A number > 0, below 1e9. */
bool parse_positive(const char *text, double *number);

/* A whole number from 1 to `most`. */
bool parse_count(const char *text, int most, int *number);

#endif

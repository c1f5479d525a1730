/* The standard streams, for libraries that were compiled for programs and take them for variables
   of their own: see CMakeLists.txt. */
#include <stdio.h>

extern FILE *corot_fmu_stdin, *corot_fmu_stdout, *corot_fmu_stderr;
FILE *corot_fmu_stdin, *corot_fmu_stdout, *corot_fmu_stderr;

__attribute__((constructor)) static void find_streams(void) {
  corot_fmu_stdin = stdin;
  corot_fmu_stdout = stdout;
  corot_fmu_stderr = stderr;
}

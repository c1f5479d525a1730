/* What the archives that an FMU is linked of take for granted, and the C library has not, or has in
   another way: see CMakeLists.txt. */
#include <stdio.h>
#include <time.h>

/* The standard streams, for libraries that were compiled for programs and take them for variables
   of their own. */
extern FILE *corot_fmu_stdin, *corot_fmu_stdout, *corot_fmu_stderr;
FILE *corot_fmu_stdin, *corot_fmu_stdout, *corot_fmu_stderr;

__attribute__((constructor)) static void find_streams(void) {
  corot_fmu_stdin = stdin;
  corot_fmu_stdout = stdout;
  corot_fmu_stderr = stderr;
}

/* The clock of OpenMP, by which SuiteSparse 7 would measure times; nobody asks it to. */
double omp_get_wtime(void);
double omp_get_wtime(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

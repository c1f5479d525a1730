/* Decks in a folder of their own, which is removed; ccx in a process of its own. */
#include "calculix.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* Runs ccx with one argument or two, silently. Its exit code; -1: it could not be run. */
static int call(const char *const argv[]) {
  posix_spawn_file_actions_t quiet;
  if (posix_spawn_file_actions_init(&quiet) != 0) return -1;
  pid_t child;
  int code = -1;
  bool started = posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", O_WRONLY, 0) == 0 &&
                 posix_spawnp(&child, argv[0], &quiet, NULL, (char **)argv, environ) == 0;
  posix_spawn_file_actions_destroy(&quiet);
  if (started)
    while (waitpid(child, &code, 0) < 0)
      if (errno != EINTR) return -1;
  return started && WIFEXITED(code) ? WEXITSTATUS(code) : -1;
}

bool calculix_found(void) {
  const char *argv[] = {"ccx", "-v", NULL};
  int code = call(argv);
  return code >= 0 && code != 127;
}

static void write_loads(const calculix_body *b, FILE *f) {
  fprintf(f, "*CLOAD, AMPLITUDE=RISE\n");
  for (int k = 0; k < b->nnode; k++)
    for (int c = 0; c < 3; c++)
      if (!b->held[k] && b->force[k][c] != 0)
        fprintf(f, "%d, %d, %.13e\n", k + 1, c + 1, b->force[k][c]);
}

static void write_deck(const calculix_body *b, double step, FILE *f) {
  const double lambda = 1e5, mu = 1e4;
  fprintf(f, "*NODE, NSET=ALL\n");
  for (int k = 0; k < b->nnode; k++)
    fprintf(f, "%d, %.13e, %.13e, %.13e\n", k + 1, b->x[k][0], b->x[k][1], b->x[k][2]);
  fprintf(f, "*ELEMENT, TYPE=%s, ELSET=BAR\n", b->type);
  for (int e = 0; e < b->nelement; e++) {
    fprintf(f, "%d", e + 1);
    for (int i = 0; i < b->size; i++) fprintf(f, ", %d", b->node[b->size * e + i] + 1);
    fprintf(f, "\n");
  }
  fprintf(f, "*NSET, NSET=CORNER\n%d\n*BOUNDARY\n", b->probe + 1);
  for (int k = 0; k < b->nnode; k++)
    if (b->held[k]) fprintf(f, "%d, 1, 3\n", k + 1);
  fprintf(f, "*MATERIAL, NAME=SOFT\n*ELASTIC\n%.13e, %.13e\n*DENSITY\n1000.\n",
          mu * (3 * lambda + 2 * mu) / (lambda + mu), lambda / 2 / (lambda + mu));
  fprintf(f,
          "*SOLID SECTION, ELSET=BAR, MATERIAL=SOFT\n"
          "*AMPLITUDE, NAME=RISE\n0., 0., 10., 1., 1000., 1.\n"
          "*STEP, NLGEOM, INC=1000000\n");
  fprintf(f, "*DYNAMIC\n%g, 40., 1e-6, %g\n", step, step);
  write_loads(b, f);
  fprintf(f, "*NODE PRINT, NSET=CORNER\nU\n*END STEP\n");
}

/* Blocks of a line that ends in the time, and one of the node and its displacement. */
static int read_table(FILE *f, int most, double (*out)[2]) {
  char line[256];
  double t = -1;
  int n = 0, node;
  while (n < most && fgets(line, sizeof line, f)) {
    const char *time = strstr(line, "and time");
    if (time) {
      t = strtod(time + strlen("and time"), NULL);
    } else if (t >= 0 && sscanf(line, "%d %lf", &node, &out[n][1]) == 2) {
      out[n++][0] = t;
      t = -1;
    }
  }
  return n;
}

static double children_cpu(void) {
  struct rusage usage;
  getrusage(RUSAGE_CHILDREN, &usage);
  return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

/* In the folder where the process is. */
static corot_status run_here(const calculix_body *body, double step, int most, double (*out)[2],
                             int *count, double *cpu) {
  FILE *f = fopen("bar.inp", "w");
  if (!f) return corot_fail(COROT_EIO, "bar.inp: %s", strerror(errno));
  write_deck(body, step, f);
  if (fclose(f) != 0) return corot_fail(COROT_EIO, "bar.inp: %s", strerror(errno));
  setenv("OMP_NUM_THREADS", "1", 1);
  const char *argv[] = {"ccx", "-i", "bar", NULL};
  double before = children_cpu();
  int code = call(argv);
  *cpu = children_cpu() - before;
  f = fopen("bar.dat", "r");
  int n = f ? read_table(f, most, out) : 0;
  if (f) fclose(f);
  if (code != 0 || n == 0 || out[n - 1][0] < 40 * (1 - 1e-6))
    return corot_fail(COROT_EINTEGRATE, "ccx: exit code %d after %g s of motion", code,
                      n ? out[n - 1][0] : 0.0);
  *count = n;
  return COROT_OK;
}

/* What ccx leaves behind. */
static void clear_here(void) {
  static const char *const files[] = {"bar.inp", "bar.dat", "bar.frd",    "bar.sta",
                                      "bar.cvg", "bar.12d", "spooles.out"};
  for (size_t k = 0; k < sizeof files / sizeof *files; k++) unlink(files[k]);
}

corot_status calculix_run(const calculix_body *body, double step, int most, double (*out)[2],
                          int *count, double *cpu) {
  const char *base = getenv("TMPDIR");
  char folder[512], back[4096];
  snprintf(folder, sizeof folder, "%s/corot-bench-XXXXXX", base ? base : "/tmp");
  if (!getcwd(back, sizeof back) || !mkdtemp(folder) || chdir(folder) != 0)
    return corot_fail(COROT_EIO, "%s: %s", folder, strerror(errno));
  corot_status status = run_here(body, step, most, out, count, cpu);
  clear_here();
  if (chdir(back) != 0) status = corot_fail(COROT_EIO, "%s: %s", back, strerror(errno));
  rmdir(folder);
  return status;
}

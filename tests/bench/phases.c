/* corot-bench phases: wall time and memory of what a run consists of, from the file to the fields.
 */
#include <corot/solve.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/folder/folder.h"
#include "app/folder/write_vtu.h"
#include "app/run/run_clock.h"
#include "bench.h"
#include "core/mesh/mesh.h"
#include "cost.h"
#include "machine.h"
#include "report.h"
#include "resident.h"
#include "solid.h"

static const char help[] =
    "usage: corot-bench phases [--json] [--tets N]... [--order N] [--solver NAME] [--step S]\n"
    "\n"
    "What a run consists of, once each, on a box: wall time, CPU time of the process, and what\n"
    "memory, arithmetic or the file allow, with the ratio of the last two; and memory beside what\n"
    "has to be there when the phase is over.\n"
    "\n"
    "      --json        one JSON object a line\n"
    "      --tets N      size of the box, rounded to whole cells; may be given again for more\n"
    "                    (default: 10000, 100000, 1000000; of order 2: 100000)\n"
    "      --order N     of the tets: 1, four nodes; 2, ten nodes (default: 1)\n"
    "      --solver NAME linear solver (default: auto)\n"
    "      --step S      g of the matrix M + g D + g^2 K, in seconds (default: 0.01)\n"
    "\n"
    "read      the mesh out of a file of gmsh 2.2, checks included; limit: read(2) of the file\n"
    "checks    the mesh once more out of arrays; limit: one sweep over them\n"
    "model     supports, masses, patterns; limit: one sweep over mesh and model\n"
    "state     scratch of the evaluations; limit: one sweep over it\n"
    "analysis  the pencil: choice of the solver, orderings, room for the matrices\n"
    "force     the residual with exact frames, damped (limits as corot-bench kernels has them)\n"
    "tangent   K and D with the variation of the frames\n"
    "combine   M + g D + g^2 K\n"
    "factor    the first factor, or preconditioner\n"
    "solve     one right-hand side\n"
    "output    fields of one moment; limit: write(2) of as many bytes\n"
    "\n"
    "example: corot-bench phases --tets 100000\n";

static const char program[] = "corot-bench phases";

enum { MOST_SIZES = 16 };

typedef struct arguments {
  bool json;
  int order, nsize, ntet[MOST_SIZES];
  corot_linear_def linear;
  double g;
} arguments;

/* A run as far as it has come. */
typedef struct body {
  const arguments *a;
  char folder[64];
  char *file; /* of the mesh */
  corot_mesh *mesh;
  specimen s;
  corot_pencil *pencil;
  vtu *fields;
  double base;      /* bytes in use at the beginning */
  double bandwidth; /* of the memory [B/s] */
  double steps;     /* of the polar iteration */
} body;

/* At least: seconds, and bytes that there have to be afterwards. */
typedef struct limit {
  double seconds, bytes;
} limit;

/* --- The phases --- */

static corot_status read_mesh(body *b) { return corot_mesh_read(b->file, &b->mesh); }

static corot_status check_mesh(body *b) {
  const corot_mesh *m = b->mesh;
  corot_mesh *copy = NULL;
  int(*ten)[10] = m->mid ? malloc((size_t)m->ntet * sizeof *ten) : NULL;
  if (m->mid && !ten) return corot_fail(COROT_ENOMEM, "no memory for %d tets", m->ntet);
  for (int e = 0; ten && e < m->ntet; e++) {
    memcpy(ten[e], m->tet[e], sizeof *m->tet);
    memcpy(ten[e] + 4, m->mid[e], sizeof *m->mid);
  }
  const double(*x)[3] = (const double(*)[3])m->x;
  corot_status status =
      ten ? corot_mesh_create_order_2(m->nnode, x, m->ntet, (const int(*)[10])ten, &copy)
          : corot_mesh_create(m->nnode, x, m->ntet, (const int(*)[4])m->tet, &copy);
  corot_mesh_destroy(copy);
  free(ten);
  return status;
}

static corot_status make_model(body *b) { return solid_define(b->mesh, "polar", true, &b->s); }

static corot_status make_state(body *b) { return solid_begin(&b->s); }

static corot_status make_pencil(body *b) {
  COROT_TRY(corot_pencil_create(b->s.model, b->s.state, &b->a->linear, &b->pencil));
  corot_pencil_use(b->pencil, COROT_TANGENT_EXACT);
  return COROT_OK;
}

static corot_status find_force(body *b) {
  return corot_residual(b->s.model, b->s.state, 0, b->s.u, b->s.v, b->s.r);
}

static corot_status find_tangent(body *b) {
  return corot_pencil_assemble(b->pencil, 0, b->s.u, b->s.v);
}

static corot_status combine(body *b) {
  corot_pencil_combine(b->pencil, 1, b->a->g, b->a->g * b->a->g);
  return COROT_OK;
}

static corot_status factor(body *b) { return corot_pencil_factor(b->pencil); }

static corot_status solve(body *b) { return corot_pencil_solve(b->pencil, b->s.r, b->s.du); }

static corot_status write_fields(body *b) {
  int *material = calloc((size_t)b->mesh->ntet, sizeof *material);
  if (!material) return corot_fail(COROT_ENOMEM, "no memory for %d tets", b->mesh->ntet);
  corot_status status = vtu_create(b->folder, b->mesh, material, VTU_RAW, &b->fields);
  free(material);
  COROT_TRY(status);
  vtu_fields to = vtu_arrays(b->fields);
  corot_element_fields fields = {.frame = to.frame,
                                 .strain = to.strain,
                                 .von_mises = to.von_mises,
                                 .det = to.det,
                                 .frame_at = to.frame_at,
                                 .strain_at = to.strain_at,
                                 .von_mises_at = to.von_mises_at,
                                 .det_at = to.det_at};
  COROT_TRY(corot_elements(b->s.model, b->s.state, 0, b->s.u, &fields));
  corot_nodal(b->s.model, 0, b->s.u, b->s.v, to.displacement, to.velocity);
  return vtu_write(b->fields, 0);
}

/* --- Their limits --- */

static limit at_least(const body *b, cost c, double bytes) {
  return (limit){fmax(c.bytes / b->bandwidth, c.flops / machine_peak()), bytes};
}

static limit sweep(const body *b, double bytes, double held) {
  return at_least(b, (cost){.bytes = bytes}, held);
}

/* Seconds for all of a file by read(2), or for so many bytes by write(2). */
static double plain_transfer(const char *path, double bytes, bool writes) {
  enum { PIECE = 1 << 20 };
  char *piece = calloc(1, PIECE);
  double start = wall_clock();
  int fd = open(path, writes ? O_WRONLY | O_CREAT | O_TRUNC : O_RDONLY, 0600);
  ssize_t n = PIECE;
  for (; piece && fd >= 0 && n > 0 && bytes > 0; bytes -= (double)n)
    n = writes ? write(fd, piece, (size_t)fmin(PIECE, bytes)) : read(fd, piece, PIECE);
  if (fd >= 0) close(fd);
  free(piece);
  return wall_clock() - start;
}

static limit of_read(const body *b) {
  return (limit){plain_transfer(b->file, INFINITY, false), (double)corot_mesh_bytes(b->mesh)};
}

static limit of_checks(const body *b) { return sweep(b, (double)corot_mesh_bytes(b->mesh), 0); }

static limit of_model(const body *b) {
  double bytes = (double)corot_model_bytes(b->s.model);
  return sweep(b, (double)corot_mesh_bytes(b->mesh) + bytes, bytes);
}

/* The vectors of this command among it. */
static limit of_state(const body *b) {
  double bytes = (double)corot_state_bytes(b->s.state) + 7.0 * b->s.n * sizeof(double);
  return sweep(b, bytes, bytes);
}

/* K and D, and a triangle of their sum: its value, row and place in them. */
static limit of_analysis(const body *b) {
  const corot_csc *csc = corot_pencil_view(b->pencil).csc;
  double bytes = 2.0 * 72 * (double)corot_model_nblock(b->s.model) + 16.0 * csc->nnz;
  return sweep(b, bytes, bytes);
}

static limit of_force(const body *b) { return at_least(b, cost_force(&b->s, false, b->steps), 0); }

static limit of_tangent(const body *b) {
  return at_least(b, cost_jacobian(&b->s, true, b->steps), 0);
}

static limit of_combine(const body *b) {
  return at_least(b, cost_combine(&b->s, corot_pencil_view(b->pencil).csc), 0);
}

static bool is_iterative(const body *b) {
  return corot_pencil_statistics(b->pencil).niteration > 0 ||
         strncmp(corot_pencil_solver(b->pencil), "pcg", 3) == 0;
}

/* Of a direct solver it takes an ordering to know. */
static solver_cost solver_limit(const body *b) {
  const corot_csc *csc = corot_pencil_view(b->pencil).csc;
  solver_cost c = {0};
  if (is_iterative(b)) {
    const corot_csc full = {.n = csc->n, .nnz = 2 * csc->nnz - csc->n};
    return cost_pcg(&full, (double)corot_pencil_statistics(b->pencil).niteration);
  }
  corot_csc *full = NULL;
  if (corot_csc_create(b->s.model, COROT_FULL, &full) == COROT_OK) cost_direct(full, true, &c);
  corot_csc_destroy(full);
  return c;
}

static limit of_factor(const body *b) {
  solver_cost c = solver_limit(b);
  return at_least(b, c.factor, c.solve.data);
}

static limit of_solve(const body *b) { return at_least(b, solver_limit(b).solve, 0); }

static limit of_output(const body *b) {
  char path[96];
  snprintf(path, sizeof path, "%s/plain", b->folder);
  double bytes = (double)vtu_bytes(b->mesh);
  return (limit){plain_transfer(path, bytes, true), bytes};
}

/* --- All of them --- */

static const struct phase {
  const char *name;
  corot_status (*work)(body *b);
  limit (*least)(const body *b);
} phases[] = {
    {"read", read_mesh, of_read},           {"checks", check_mesh, of_checks},
    {"model", make_model, of_model},        {"state", make_state, of_state},
    {"analysis", make_pencil, of_analysis}, {"force", find_force, of_force},
    {"tangent", find_tangent, of_tangent},  {"combine", combine, of_combine},
    {"factor", factor, of_factor},          {"solve", solve, of_solve},
    {"output", write_fields, of_output},
};

typedef struct result {
  const char *name;
  double wall, cpu;  /* [s] */
  double held, most; /* bytes that it has added, and the most there were */
  limit least;
} result;

static void print_heading(const body *b, int ntet) {
  if (!b->a->json)
    printf("\n%d tets of order %d\n%-9s %9s %9s %9s %8s %9s %9s %9s\n", ntet, b->a->order, "phase",
           "wall, s", "CPU, s", "at least", "ratio", "B/tet", "at least", "most, MB");
}

static void print(const body *b, const result *r) {
  int ntet = b->mesh->ntet;
  if (b->a->json)
    report_object(json_pack("{s:s, s:s, s:i, s:i, s:f, s:f, s:f, s:f, s:f, s:f}", "bench", "phases",
                            "phase", r->name, "tets", ntet, "order", b->a->order, "wall_s", r->wall,
                            "cpu_s", r->cpu, "floor_s", r->least.seconds, "bytes_per_tet",
                            r->held / ntet, "least_bytes_per_tet", r->least.bytes / ntet,
                            "most_bytes", r->most));
  else
    printf("%-9s %9.3g %9.3g %9.3g %8.1f %9.0f %9.0f %9.0f\n", r->name, r->wall, r->cpu,
           r->least.seconds, r->cpu / r->least.seconds, r->held / ntet, r->least.bytes / ntet,
           r->most / 1e6);
  fflush(stdout);
}

static corot_status run_phase(body *b, const struct phase *p) {
  result r = {.name = p->name};
  resident_begin();
  double before = resident_now(), wall, cpu;
  wall = wall_clock(), cpu = cpu_clock();
  COROT_TRY(p->work(b));
  r.wall = wall_clock() - wall, r.cpu = cpu_clock() - cpu;
  r.most = resident_most() - b->base;
  resident_begin();
  r.held = resident_now() - before;
  if (p->work == make_state) b->steps = cost_polar_steps(&b->s);
  r.least = p->least(b);
  print(b, &r);
  return COROT_OK;
}

static corot_status write_file(body *b, int ntet) {
  corot_mesh *mesh;
  COROT_TRY(solid_mesh(ntet, b->a->order, &mesh));
  corot_status status = corot_mesh_group_plane(mesh, "base", 2, 0, 0);
  print_heading(b, mesh->ntet);
  if (!status) status = corot_mesh_write(mesh, b->file);
  corot_mesh_destroy(mesh);
  return status;
}

static corot_status run_phases(body *b, int ntet) {
  COROT_TRY(write_file(b, ntet));
  b->bandwidth = machine_bandwidth(200 << 20);
  resident_begin();
  b->base = resident_now();
  for (size_t k = 0; k < sizeof phases / sizeof *phases; k++) COROT_TRY(run_phase(b, &phases[k]));
  if (b->a->json) return COROT_OK;
  printf("solved by %s", corot_pencil_solver(b->pencil));
  if (is_iterative(b)) printf(", %ld iterations", corot_pencil_statistics(b->pencil).niteration);
  printf("\n");
  return COROT_OK;
}

static void clear(body *b) {
  static const char *const left[] = {"mesh.msh", "plain", "fields.pvd", "fields"};
  char path[128];
  vtu_destroy(b->fields);
  corot_pencil_destroy(b->pencil);
  solid_clear(&b->s);
  corot_mesh_destroy(b->mesh);
  free(b->file);
  snprintf(path, sizeof path, "%s/fields", b->folder);
  folder_remove_frames(path, 0);
  for (size_t k = 0; k < sizeof left / sizeof *left; k++) {
    snprintf(path, sizeof path, "%s/%s", b->folder, left[k]);
    remove(path);
  }
  rmdir(b->folder);
}

static corot_status measure(const arguments *a, int ntet) {
  body b = {.a = a};
  const char *where = getenv("TMPDIR");
  snprintf(b.folder, sizeof b.folder, "%.40s/corot-bench-XXXXXX", where && *where ? where : "/tmp");
  if (!mkdtemp(b.folder)) return corot_fail(COROT_EIO, "%s: %s", b.folder, strerror(errno));
  b.file = folder_path(b.folder, "mesh.msh");
  corot_status status = b.file ? run_phases(&b, ntet) : COROT_ENOMEM;
  clear(&b);
  return status;
}

static corot_status all(arguments *a) {
  static const int sizes[] = {10000, 100000, 1000000};
  if (a->nsize == 0 && a->order == 2)
    a->ntet[a->nsize++] = 100000;
  else if (a->nsize == 0)
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) a->ntet[a->nsize++] = sizes[k];
  if (a->json)
    report_machine(true);
  else
    printf("%s; one call of each\n", machine_cpu());
  for (int k = 0; k < a->nsize; k++) COROT_TRY(measure(a, a->ntet[k]));
  return COROT_OK;
}

static int take(arguments *a, int answer, char **argv, const struct option *known) {
  switch (answer) {
    case 'j':
      a->json = true;
      return EXIT_OK;
    case 't':
      if (a->nsize == MOST_SIZES) return usage_error(program, "--tets: at most %d", MOST_SIZES);
      if (parse_count(optarg, 100 * 1000 * 1000, &a->ntet[a->nsize++])) return EXIT_OK;
      return usage_error(program, "--tets %s: expected a whole number > 0", optarg);
    case 'o':
      if (parse_count(optarg, 2, &a->order)) return EXIT_OK;
      return usage_error(program, "--order: 1 or 2");
    case 's':
      a->linear.solver = optarg;
      return EXIT_OK;
    case 'g':
      if (parse_positive(optarg, &a->g)) return EXIT_OK;
      return usage_error(program, "--step %s: expected a number > 0", optarg);
    default:
      return option_error(program, answer, argv, known);
  }
}

int command_phases(int argc, char **argv) {
  static const struct option known[] = {{"json", no_argument, NULL, 'j'},
                                        {"tets", required_argument, NULL, 't'},
                                        {"order", required_argument, NULL, 'o'},
                                        {"solver", required_argument, NULL, 's'},
                                        {"step", required_argument, NULL, 'g'},
                                        {"help", no_argument, NULL, 'h'},
                                        {0}};
  arguments a = {.order = 1, .linear = corot_linear_defaults(), .g = 0.01};
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", known, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    int code = take(&a, answer, argv, known);
    if (code != EXIT_OK) return code;
  }
  if (optind < argc) return usage_error(program, "unexpected: %s", argv[optind]);
  corot_status status = all(&a);
  return status ? failure(status) : EXIT_OK;
}

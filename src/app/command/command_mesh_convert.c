/* `corot mesh repair` and `corot mesh convert`: from file to file, mended. */
#include <corot/mesh.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/scenario/warnings.h"
#include "app/scenario/words.h"
#include "app/text/say.h"
#include "cli.h"

typedef struct arguments {
  const char *program;
  const char *from, *to;
  const char *format; /* NULL: by the suffix of `to` */
  corot_mending mending;
} arguments;

/* Says what a report has, and is rid of it. */
static corot_status say_report(corot_mesh_report *report) {
  warnings w = {0};
  corot_status status = warnings_of_report(report, &w);
  warnings_print(&w, 0, "warning: ", stderr);
  warnings_free(&w);
  corot_mesh_report_destroy(report);
  return status;
}

corot_status read_mended(const char *path, const corot_mending *mending, corot_mesh **mesh) {
  corot_mesh_report *report;
  corot_mesh *m;
  COROT_TRY(corot_mesh_read_mended(path, mending, &m, &report));
  corot_status status = say_report(report);
  if (status)
    corot_mesh_destroy(m);
  else
    *mesh = m;
  return status;
}

/* Whether both names are of one file, which is there. */
static bool is_same_file(const char *a, const char *b) {
  struct stat p, q;
  return stat(a, &p) == 0 && stat(b, &q) == 0 && p.st_dev == q.st_dev && p.st_ino == q.st_ino;
}

/* A TetGen mesh is read from, and written to, several files that differ in the suffix. */
static bool is_same_mesh(const char *from, const char *to) {
  const char *dot_from = strrchr(from, '.'), *dot_to = strrchr(to, '.');
  if (is_same_file(from, to) || strcmp(from, to) == 0) return true;
  if (!dot_from || !dot_to) return false;
  bool tetgen = !strcmp(dot_from, ".node") || !strcmp(dot_from, ".ele");
  size_t n = (size_t)(dot_from - from);
  return tetgen && (!strcmp(dot_to, ".node") || !strcmp(dot_to, ".ele")) &&
         n == (size_t)(dot_to - to) && strncmp(from, to, n) == 0;
}

static int convert(const arguments *a) {
  corot_mesh *mesh = NULL;
  corot_mesh_report *report = NULL;
  if (is_same_mesh(a->from, a->to))
    return usage_error(a->program, "%s is the input: write to another file", a->to);
  if (!corot_mesh_format(a->format, a->to)) return usage_error(a->program, "%s", corot_error());
  corot_status status = read_mended(a->from, &a->mending, &mesh);
  if (status != COROT_OK) return failure(read_failure(status, a->from));
  status = corot_mesh_write_as(mesh, a->to, a->format, &report);
  if (status == COROT_OK) status = say_report(report);
  if (status == COROT_OK)
    say("%s: %d nodes, %d tets, %d group%s\n", a->to, mesh->nnode, mesh->ntet, mesh->ngroup,
        mesh->ngroup == 1 ? "" : "s");
  corot_mesh_destroy(mesh);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

static const char repair_help[] =
    "usage: corot mesh repair FILE [--cut] [--merge TOL] [--unit UNIT] [--to FORMAT] -o OUT\n"
    "\n"
    "Reads a mesh of any format that corot reads, mends what is only written down wrongly, and "
    "writes\n"
    "it to another file: nodes in no tet are left out, left-handed tets turned round, tets that "
    "are\n"
    "there twice left out. What was mended is said on stderr. What cannot be mended is refused "
    "with\n"
    "all faults, by their numbers in the file (up to ten, and how many more), and nothing is "
    "written:\n"
    "flat tets, coordinates that are no numbers, nodes that do not exist, three tets at a face.\n"
    "\n"
    "      --merge TOL      nodes no further apart than TOL [m] become one\n"
    "      --cut            hexahedra, prisms and pyramids of first order are cut into tets that "
    "match\n"
    "                       across faces\n"
    "      --unit UNIT      that FILE is in, m, km, cm, mm, um, nm, in or ft; OUT is in metres\n"
    "      --to FORMAT      of OUT, as of corot mesh convert; default: by its suffix\n"
    "  -o, --output OUT     the file to write; never FILE itself\n"
    "\n"
    "example: corot mesh repair part.msh --merge 1e-9 -o mended.msh\n";

static const char convert_help[] =
    "usage: corot mesh convert FROM TO [--to FORMAT] [--cut] [--merge TOL] [--unit UNIT]\n"
    "\n"
    "Reads a mesh of any format that corot reads, mended as by corot mesh repair, and writes it "
    "in\n"
    "another one, with all its groups. Without --unit coordinates keep every bit.\n"
    "\n"
    "      --to FORMAT      gmsh (4.1, .msh), gmsh-2.2, vtu (.vtu), vtk (legacy, .vtk), tetgen\n"
    "                       (.node or .ele, with .face), medit (.mesh), abaqus (.inp); default: "
    "by\n"
    "                       the suffix of TO. tetgen and medit have one number for each tet and "
    "face:\n"
    "                       names become numbers, and what does not fit is said on stderr\n"
    "      --cut            hexahedra, prisms and pyramids of first order are cut into tets\n"
    "      --merge TOL      nodes no further apart than TOL [m] become one\n"
    "      --unit UNIT      that FROM is in, m, km, cm, mm, um, nm, in or ft; TO is in metres\n"
    "\n"
    "example: corot mesh convert part.inp part.msh\n";

static const struct option options[] = {
    {"to", required_argument, NULL, 't'},
    {"cut", no_argument, NULL, 'c'},
    {"merge", required_argument, NULL, 'm'},
    {"output", required_argument, NULL, 'o'},
    {"unit", required_argument, NULL, 'u'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

int parse_unit(const char *program, const char *text, double *metres) {
  int unit = words_find(words_length, text);
  if (unit < 0)
    return usage_error(program, "--unit %s: expected m, km, cm, mm, um, nm, in or ft", text);
  *metres = length_in_metres(unit);
  return EXIT_OK;
}

/* Takes one option of the line; EXIT_OK: go on. */
static int take_option(arguments *a, int answer, char **argv) {
  switch (answer) {
    case 't':
      a->format = optarg;
      return EXIT_OK;
    case 'c':
      a->mending.cut = 1;
      return EXIT_OK;
    case 'm':
      if (parse_positive(optarg, &a->mending.merge)) return EXIT_OK;
      return usage_error(a->program, "--merge %s: expected a length > 0", optarg);
    case 'u':
      return parse_unit(a->program, optarg, &a->mending.scale);
    case 'o':
      a->to = optarg;
      return EXIT_OK;
    default:
      return option_error(a->program, answer, argv, options);
  }
}

int command_mesh_repair(int argc, char **argv) {
  arguments a = {.program = "corot mesh repair"};
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":o:h", options, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(repair_help, stdout);
      return EXIT_OK;
    }
    int code = take_option(&a, answer, argv);
    if (code != EXIT_OK) return code;
  }
  if (argc - optind != 1)
    return usage_error(a.program, "expected one mesh file, found %d", argc - optind);
  if (!a.to) return usage_error(a.program, "-o FILE is missing");
  a.from = argv[optind];
  return convert(&a);
}

int command_mesh_convert(int argc, char **argv) {
  arguments a = {.program = "corot mesh convert"};
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", options, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(convert_help, stdout);
      return EXIT_OK;
    }
    int code = take_option(&a, answer, argv);
    if (code != EXIT_OK) return code;
  }
  if (a.to) return usage_error(a.program, "the file to write stands behind the one to read");
  if (argc - optind != 2)
    return usage_error(a.program, "expected two mesh files, FROM and TO, found %d", argc - optind);
  a.from = argv[optind];
  a.to = argv[optind + 1];
  return convert(&a);
}

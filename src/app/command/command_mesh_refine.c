/* `corot mesh refine`: refinement from file to file. */
#include <corot/mesh.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/marks_file.h"
#include "app/scenario/refine.h"
#include "app/scenario/words.h"
#include "app/text/say.h"
#include "cli.h"

static const char program[] = "corot mesh refine";

static const char help[] =
    "usage: corot mesh refine FILE [--levels N] [--diagonal NAME] [--marks FILE]\n"
    "                         [--near X,Y,Z [--times N]] [--order N] -o FILE.msh\n"
    "\n"
    "Cuts every tet into eight, N times, then those that are marked, and writes gmsh 2.2 ASCII "
    "with all groups. Nodes keep\n"
    "their numbers; the middles of the edges follow. Curved ten-node tets stay curved. Size and "
    "shape before and after are printed\n"
    "to stderr; see also corot mesh info.\n"
    "\n"
    "      --levels N       how often; default: 1, with --marks or --near 0\n"
    "      --diagonal NAME  shortest: better shapes on the average; consistent: at most three "
    "shapes\n"
    "                       of tets come from each, however often it is cut (Bey 1995); default:\n"
    "                       shortest\n"
    "      --marks FILE     cut some tets, each into at least eight by halves, and neighbours as "
    "far "
    "as\n"
    "                       faces have to match; a line of FILE is a pass, the numbers, from 0, of "
    "the\n"
    "                       tets to cut in the mesh that the lines before it have made; # begins "
    "a\n"
    "                       comment. As mesh.marks of a scenario\n"
    "      --near X,Y,Z     cut the tet at this point, and all that share a corner with it, alike\n"
    "      --times N        and so again at the same point; default: 1\n"
    "      --order N        of the result: 1, four-node tets, or 2, ten-node tets; default: as "
    "FILE.\n"
    "                       2 adds the middles of straight edges, 1 drops the nodes on edges\n"
    "  -o, --output FILE    the file to write\n"
    "\n"
    "example: corot mesh refine bar.msh --levels 2 -o fine.msh\n";

static const struct option options[] = {
    {"levels", required_argument, NULL, 'l'},
    {"diagonal", required_argument, NULL, 'd'},
    {"marks", required_argument, NULL, 'm'},
    {"near", required_argument, NULL, 'n'},
    {"times", required_argument, NULL, 't'},
    {"order", required_argument, NULL, 'r'},
    {"output", required_argument, NULL, 'o'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

typedef struct arguments {
  const char *from, *to;
  const char *marks; /* NULL: none */
  int nlevel;        /* -1: not said */
  int order;         /* 0: as it is */
  int times;         /* 0: not said */
  bool near;
  double point[3];
  corot_diagonal diagonal;
} arguments;

/* Takes one option of the line; EXIT_OK: go on. */
static int take_option(arguments *a, int answer, char **argv) {
  char *end;
  long n;
  int word;
  switch (answer) {
    case 'l':
      n = strtol(optarg, &end, 10);
      if (end == optarg || *end || n < 0 || n > 100)
        return usage_error(program, "--levels %s: expected a whole number >= 0", optarg);
      a->nlevel = (int)n;
      return EXIT_OK;
    case 'd':
      word = words_find(words_diagonal, optarg);
      if (word < 0)
        return usage_error(program, "--diagonal %s: expected consistent or shortest", optarg);
      a->diagonal = (corot_diagonal)word;
      return EXIT_OK;
    case 'm':
      a->marks = optarg;
      return EXIT_OK;
    case 'n':
      a->near = parse_three(optarg, a->point);
      return a->near ? EXIT_OK : usage_error(program, "--near %s: expected X,Y,Z", optarg);
    case 't':
      if (!parse_count(optarg, 100, &a->times))
        return usage_error(program, "--times %s: expected a whole number, 1 to 100", optarg);
      return EXIT_OK;
    case 'r':
      if (!parse_count(optarg, 2, &a->order))
        return usage_error(program, "--order %s: expected 1 or 2", optarg);
      return EXIT_OK;
    case 'o':
      a->to = optarg;
      return EXIT_OK;
    default:
      return option_error(program, answer, argv, options);
  }
}

static void report(const char *file, const corot_mesh *mesh) {
  corot_mesh_quality q = corot_mesh_measure(mesh);
  say("%s: %d nodes, %d tets; shape mean %.3f, worst %.3f\n", file, mesh->nnode, mesh->ntet,
      q.shape_mean, q.shape_min);
}

/* Octasections, then local refinement. */
static corot_status cut(const arguments *a, corot_mesh **mesh) {
  int nlevel = a->nlevel >= 0 ? a->nlevel : !a->marks && !a->near;
  COROT_TRY(refine_mesh(nlevel, a->diagonal, mesh, NULL));
  if (a->marks) COROT_TRY(read_failure(marks_file_apply(a->marks, mesh), a->marks));
  return a->near ? refine_near(a->point, a->times ? a->times : 1, mesh) : COROT_OK;
}

static int refine(const arguments *a) {
  corot_mesh *mesh = NULL;
  corot_status status = read_mended(a->from, NULL, &mesh);
  if (status != COROT_OK) return failure(read_failure(status, a->from));
  report(a->from, mesh);
  if (a->order == 1) status = change_order(1, &mesh, NULL);
  if (status == COROT_OK) status = cut(a, &mesh);
  if (status == COROT_OK && a->order == 2) status = change_order(2, &mesh, NULL);
  if (status == COROT_EINVAL) corot_fail(status, "%s: %s", a->from, corot_error());
  if (status == COROT_OK) status = corot_mesh_write(mesh, a->to);
  if (status == COROT_OK) report(a->to, mesh);
  corot_mesh_destroy(mesh);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

int command_mesh_refine(int argc, char **argv) {
  arguments a = {.nlevel = -1, .diagonal = COROT_DIAGONAL_SHORTEST};
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":o:h", options, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(help, stdout);
      return EXIT_OK;
    }
    int code = take_option(&a, answer, argv);
    if (code != EXIT_OK) return code;
  }
  if (argc - optind != 1)
    return usage_error(program, "expected one mesh file, found %d", argc - optind);
  if (a.times && !a.near) return usage_error(program, "--times is for --near");
  if (!a.to) return usage_error(program, "-o FILE is missing");
  a.from = argv[optind];
  return refine(&a);
}

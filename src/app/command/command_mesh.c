/* `corot mesh`, and `corot mesh box`. */
#include <corot/mesh.h>
#include <stdio.h>
#include <string.h>

#include "app/scenario/refine.h"
#include "app/scenario/words.h"
#include "app/text/say.h"
#include "cli.h"

static const char help[] =
    "usage: corot mesh box ...\n"
    "       corot mesh info FILE\n"
    "       corot mesh refine FILE ...\n"
    "       corot mesh repair FILE ...\n"
    "       corot mesh convert FROM TO ...\n"
    "\n"
    "example: corot mesh box --size 0.1,0.1,0.6 --cells 2,2,12 -o bar.msh\n";

int command_mesh(int argc, char **argv) {
  static const command table[] = {
      {"box", command_mesh_box},         {"info", command_mesh_info},
      {"refine", command_mesh_refine},   {"repair", command_mesh_repair},
      {"convert", command_mesh_convert}, {0}};
  return dispatch("corot mesh", help, table, argc, argv);
}

/* --- mesh box --- */

static const char box_help[] =
    "usage: corot mesh box --size X,Y,Z --cells I,J,K [--origin X,Y,Z] [--split NAME]\n"
    "                       [--order N] -o FILE.msh\n"
    "\n"
    "Writes a box of I*J*K cells, six tets each, as gmsh 2.2 ASCII. Its sides are groups xmin "
    "xmax\n"
    "ymin ymax zmin zmax.\n"
    "\n"
    "      --size X,Y,Z     lengths of the edges [m]\n"
    "      --cells I,J,K    cells along each axis\n"
    "      --origin X,Y,Z   the corner with the smallest coordinates [m]; default: 0,0,0\n"
    "      --split NAME     symmetric: cells are mirrored from one to the next, and the middle one "
    "of\n"
    "                       an odd number is cut in halves, so that nothing drifts sideways;\n"
    "                       alternating: mirrored only, which drifts a little where a number is "
    "odd;\n"
    "                       kuhn: all cells the same, which drifts by up to a third of the\n"
    "                       deflection; default: symmetric\n"
    "      --order N        1: four-node tets; 2: ten-node tets; default: 1\n"
    "  -o, --output FILE    the file to write\n"
    "\n"
    "example: corot mesh box --size 0.1,0.1,0.6 --cells 2,2,12 -o bar.msh\n";

static const struct option box_options[] = {
    {"size", required_argument, NULL, 's'},   {"cells", required_argument, NULL, 'c'},
    {"origin", required_argument, NULL, 'g'}, {"split", required_argument, NULL, 'p'},
    {"order", required_argument, NULL, 'r'},  {"output", required_argument, NULL, 'o'},
    {"help", no_argument, NULL, 'h'},         {0},
};

typedef struct box_arguments {
  corot_box box;
  const char *file;
  bool size, cells; /* given */
  int order;
} box_arguments;

/* Takes one option of the line; EXIT_OK: go on. */
static int box_option(box_arguments *a, int answer, char **argv) {
  static const char program[] = "corot mesh box";
  double cells[3];
  int word;
  switch (answer) {
    case 's':
      a->size = parse_three(optarg, a->box.size);
      return a->size ? EXIT_OK : usage_error(program, "--size %s: expected X,Y,Z", optarg);
    case 'c':
      a->cells = parse_three(optarg, cells);
      for (int i = 0; i < 3 && a->cells; i++) {
        a->cells = cells[i] >= 1 && cells[i] <= 1e9 && cells[i] == (int)cells[i];
        if (a->cells) a->box.cells[i] = (int)cells[i];
      }
      if (a->cells) return EXIT_OK;
      return usage_error(program, "--cells %s: expected three whole numbers I,J,K > 0", optarg);
    case 'g':
      if (parse_three(optarg, a->box.origin)) return EXIT_OK;
      return usage_error(program, "--origin %s: expected X,Y,Z", optarg);
    case 'p':
      word = words_find(words_box_split, optarg);
      if (word >= 0) a->box.split = (corot_box_split)word;
      if (word >= 0) return EXIT_OK;
      return usage_error(program, "--split %s: expected symmetric, alternating or kuhn", optarg);
    case 'r':
      if (parse_count(optarg, 2, &a->order)) return EXIT_OK;
      return usage_error(program, "--order %s: expected 1 or 2", optarg);
    case 'o':
      a->file = optarg;
      return EXIT_OK;
    default:
      return option_error(program, answer, argv, box_options);
  }
}

static int write_box(const box_arguments *a) {
  corot_mesh *mesh = NULL;
  corot_status status = corot_mesh_box(&a->box, &mesh);
  if (status == COROT_EINVAL) return usage_error("corot mesh box", "%s", corot_error());
  if (status == COROT_OK) status = change_order(a->order, &mesh, NULL);
  if (status == COROT_OK) status = corot_mesh_write(mesh, a->file);
  if (status == COROT_OK) say("%s: %d nodes, %d tets\n", a->file, mesh->nnode, mesh->ntet);
  corot_mesh_destroy(mesh);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

int command_mesh_box(int argc, char **argv) {
  box_arguments a = {.box = corot_box_defaults(), .order = 1};
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":o:h", box_options, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(box_help, stdout);
      return EXIT_OK;
    }
    int code = box_option(&a, answer, argv);
    if (code != EXIT_OK) return code;
  }
  if (optind < argc) return usage_error("corot mesh box", "unexpected: %s", argv[optind]);
  if (!a.size || !a.cells || !a.file)
    return usage_error("corot mesh box", "%s is missing",
                       !a.size    ? "--size"
                       : !a.cells ? "--cells"
                                  : "-o FILE");
  return write_box(&a);
}

/* `corot mesh info`. */
#include <corot/mesh.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/folder/folder.h"
#include "app/text/json_text.h"
#include "app/text/say.h"
#include "app/text/text_stream.h"
#include "cli.h"
#include "mesh_facts.h"
#include "mesh_picture.h"

static const char info_help[] =
    "usage: corot mesh info FILE [--cut] [--unit UNIT] [--svg FILE] [--html FILE] [--json]\n"
    "\n"
    "Size, shape, parts and groups of a mesh, as a scenario would have it, and what of the file "
    "is\n"
    "mended for it: nodes in no tet are left out, left-handed tets turned round. Read are gmsh 1, "
    "2.2,\n"
    "4.0 and 4.1 (.msh), TetGen (.node, .ele, .face), MEDIT (.mesh, .meshb), Abaqus and CalculiX\n"
    "(.inp), FEBio (.feb), VTK (.vtk, .vtu), Netgen (.vol), MFEM (.mesh), VegaFEM (.veg).\n"
    "\n"
    "      --cut            hexahedra, prisms and pyramids of first order are cut into tets\n"
    "      --unit UNIT      that FILE is in: m, km, cm, mm, um, nm, in or ft; default: m\n"
    "      --svg FILE       a picture of the surface from two sides, groups in colours; of "
    "ten-node\n"
    "                       tets the corners\n"
    "      --html FILE      a page of the picture and the facts\n"
    "      --json           the facts as JSON\n"
    "\n"
    "Shape is 3 inradius / circumradius of a tet, the radius ratio (Liu and Joe 1994). Tets "
    "through "
    "the\n"
    "thickness are counted on straight ways, from the middle of each triangle of the surface "
    "inward\n"
    "to the other side; a tet counts with the part of its extent along the way that is passed.\n"
    "\n"
    "example: corot mesh info bar.msh --html bar.html\n";

static const struct option info_options[] = {
    {"cut", no_argument, NULL, 'c'},
    {"unit", required_argument, NULL, 'u'},
    {"svg", required_argument, NULL, 's'},
    {"html", required_argument, NULL, 'w'},
    {"json", no_argument, NULL, 'j'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

typedef struct info_arguments {
  const char *path, *svg, *html;
  bool json;
  corot_mending mending;
} info_arguments;

/* Takes one option of the line; EXIT_OK: go on. */
static int take_option(info_arguments *a, int answer, char **argv) {
  switch (answer) {
    case 'c':
      a->mending.cut = 1;
      return EXIT_OK;
    case 'u':
      return parse_unit("corot mesh info", optarg, &a->mending.scale);
    case 's':
      a->svg = optarg;
      return EXIT_OK;
    case 'w':
      a->html = optarg;
      return EXIT_OK;
    case 'j':
      a->json = true;
      return EXIT_OK;
    default:
      return option_error("corot mesh info", answer, argv, info_options);
  }
}

/* Puts what `write` prints into a file, as a whole; nothing if there is no path. */
static corot_status save(const char *path, corot_status (*write)(const void *, FILE *),
                         const mesh_facts *f) {
  char *text = NULL;
  size_t size = 0;
  if (!path) return COROT_OK;
  FILE *out = text_open(&text, &size);
  corot_status status = out ? write(f, out) : COROT_OK;
  int failed = text_close(out);
  if (status == COROT_OK && failed) status = corot_fail(COROT_ENOMEM, "%s: out of memory", path);
  if (status == COROT_OK) status = file_replace_durably(path, text, size);
  free(text);
  return status;
}

static corot_status tell(const info_arguments *a, const mesh_facts *f) {
  COROT_TRY(save(a->svg, mesh_picture_svg, f));
  COROT_TRY(save(a->html, mesh_picture_html, f));
  if (!a->json) return show_all(mesh_facts_print, f);
  json_t *info = mesh_facts_json(f);
  corot_status status = json_text_show(info);
  json_decref(info);
  return status;
}

static int info(const info_arguments *a) {
  corot_mesh *mesh = NULL;
  corot_mesh_report *report = NULL;
  mesh_facts f = {0};
  corot_status status = corot_mesh_read_mended(a->path, &a->mending, &mesh, &report);
  if (status != COROT_OK) return failure(read_failure(status, a->path));
  status = warnings_of_report(report, &f.warnings);
  corot_mesh_report_destroy(report);
  if (status == COROT_OK) status = mesh_facts_find(a->path, mesh, &f);
  if (status == COROT_OK) status = tell(a, &f);
  int code = status == COROT_OK ? EXIT_OK : failure(status);
  mesh_facts_free(&f);
  corot_mesh_destroy(mesh);
  return code;
}

int command_mesh_info(int argc, char **argv) {
  info_arguments a = {0};
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", info_options, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(info_help, stdout);
      return EXIT_OK;
    }
    int code = take_option(&a, answer, argv);
    if (code != EXIT_OK) return code;
  }
  if (argc - optind != 1)
    return usage_error("corot mesh info", "expected one mesh file, found %d", argc - optind);
  a.path = argv[optind];
  return info(&a);
}

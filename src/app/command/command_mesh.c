/* `corot mesh box` and `corot mesh info`. */
#include <corot/mesh.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scenario/facts.h"
#include "app/scenario/refine.h"
#include "app/scenario/warnings.h"
#include "app/scenario/words.h"
#include "app/text/json_text.h"
#include "app/text/say.h"
#include "cli.h"
#include "solve/statics/rigid.h"

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

/* --- mesh info --- */

static const char info_help[] =
    "usage: corot mesh info FILE [--cut] [--json]\n"
    "\n"
    "Size, shape, parts and groups of a mesh, as a scenario would have it, and what of the file "
    "is\n"
    "mended for it: nodes in no tet are left out, left-handed tets turned round. Read are gmsh 1, "
    "2.2,\n"
    "4.0 and 4.1 (.msh), TetGen (.node, .ele, .face), MEDIT (.mesh, .meshb), Abaqus and CalculiX\n"
    "(.inp), FEBio (.feb), VTK (.vtk, .vtu), Netgen (.vol), MFEM (.mesh), VegaFEM (.veg).\n"
    "\n"
    "      --cut            hexahedra, prisms and pyramids of first order are cut into tets\n"
    "      --json           the same as JSON\n"
    "\n"
    "example: corot mesh info bar.msh\n";

static const struct option info_options[] = {
    {"cut", no_argument, NULL, 'c'},
    {"json", no_argument, NULL, 'j'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

/* What is known of a mesh beside its shape. */
typedef struct mesh_facts {
  int ncorner; /* nodes that are corners of tets; the others are on edges */
  int npart;
  corot_part *part; /* [npart] */
  warnings warnings;
} mesh_facts;

static corot_status count_corners(const corot_mesh *mesh, int *ncorner) {
  char *corner = calloc((size_t)mesh->nnode, 1);
  if (!corner) return corot_fail(COROT_ENOMEM, "no memory for %d nodes", mesh->nnode);
  for (int e = 0; e < mesh->ntet; e++)
    for (int k = 0; k < 4; k++) corner[mesh->tet[e][k]] = 1;
  *ncorner = 0;
  for (int i = 0; i < mesh->nnode; i++) *ncorner += corner[i];
  free(corner);
  return COROT_OK;
}

static corot_status find_mesh_facts(const corot_mesh *mesh, mesh_facts *f) {
  COROT_TRY(count_corners(mesh, &f->ncorner));
  COROT_TRY(corot_mesh_parts(mesh, &f->npart, &f->part));
  return warnings_of_mesh(mesh, &f->warnings);
}

static void print_info(const char *path, const corot_mesh *mesh, const mesh_facts *f) {
  corot_mesh_quality q = corot_mesh_measure(mesh);
  show("file      %s\n", path);
  if (mesh->mid)
    show("nodes     %d: %d corners and %d on edges\n", mesh->nnode, f->ncorner,
         mesh->nnode - f->ncorner);
  else
    show("nodes     %d\n", mesh->nnode);
  show("tets      %d\n", mesh->ntet);
  show("order     %d\n", corot_mesh_order(mesh));
  show("parts     %d\n", f->npart);
  show("box       [%g, %g] x [%g, %g] x [%g, %g] m\n", q.min[0], q.max[0], q.min[1], q.max[1],
       q.min[2], q.max[2]);
  show("volume    %.6g m^3; of a tet %.3g to %.3g\n", q.volume, q.volume_min, q.volume_max);
  show("edges     %.4g to %.4g m\n", q.edge_min, q.edge_max);
  show("dihedral  %.1f to %.1f degrees\n", q.dihedral_min, q.dihedral_max);
  show("shape     mean %.3f, worst %.3f (tet %d); 3 inradius / circumradius, 1 is regular\n",
       q.shape_mean, q.shape_min, q.shape_worst);
  for (int i = 0; i < mesh->ngroup; i++) {
    const corot_group *g = &mesh->group[i];
    show("group     %s: %d nodes, %d triangles, %d tets\n", g->name, g->nnode, g->ntri, g->ntet);
  }
  warnings_print(&f->warnings, 0, "warning   ", stdout);
}

static json_t *parts_json(const mesh_facts *f) {
  json_t *list = json_array();
  for (int k = 0; list && k < f->npart; k++)
    if (json_array_append_new(
            list, json_pack("{s:i, s:i}", "first", f->part[k].first, "nodes", f->part[k].nnode))) {
      json_decref(list);
      list = NULL;
    }
  return list;
}

static json_t *info_json(const char *path, const corot_mesh *mesh, const mesh_facts *f) {
  corot_mesh_quality q = corot_mesh_measure(mesh);
  json_t *j = json_object();
  j = json_text_with(j, "file", json_text_string(path));
  j = json_text_with(j, "nodes", json_integer(mesh->nnode));
  j = json_text_with(j, "corners", json_integer(f->ncorner));
  j = json_text_with(j, "tets", json_integer(mesh->ntet));
  j = json_text_with(j, "order", json_integer(corot_mesh_order(mesh)));
  j = json_text_with(j, "parts", parts_json(f));
  j = json_text_with(j, "min", json_pack("[f, f, f]", q.min[0], q.min[1], q.min[2]));
  j = json_text_with(j, "max", json_pack("[f, f, f]", q.max[0], q.max[1], q.max[2]));
  j = json_text_with(j, "volume", json_real(q.volume));
  j = json_text_with(j, "tet_volume", json_pack("[f, f]", q.volume_min, q.volume_max));
  j = json_text_with(j, "edge", json_pack("[f, f]", q.edge_min, q.edge_max));
  j = json_text_with(j, "dihedral_degrees", json_pack("[f, f]", q.dihedral_min, q.dihedral_max));
  j = json_text_with(j, "shape",
                     json_pack("{s:f, s:f, s:i}", "mean", q.shape_mean, "min", q.shape_min, "worst",
                               q.shape_worst));
  j = json_text_with(j, "groups", facts_groups(mesh));
  return json_text_with(j, "warnings", warnings_json(&f->warnings));
}

static int print_info_json(const char *path, const corot_mesh *mesh, const mesh_facts *f) {
  json_t *info = info_json(path, mesh, f);
  corot_status status = json_text_show(info);
  json_decref(info);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

int command_mesh_info(int argc, char **argv) {
  bool json = false, cut = false;
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", info_options, NULL)) != -1;) {
    if (answer == 'h') {
      fputs(info_help, stdout);
      return EXIT_OK;
    }
    if (answer != 'j' && answer != 'c')
      return option_error("corot mesh info", answer, argv, info_options);
    json = json || answer == 'j';
    cut = cut || answer == 'c';
  }
  /* one file */
  if (argc - optind != 1)
    return usage_error("corot mesh info", "expected one mesh file, found %d", argc - optind);
  const char *path = argv[optind];
  corot_mesh *mesh = NULL;
  corot_mesh_report *report = NULL;
  const corot_mending mending = {.cut = cut};
  corot_status status = corot_mesh_read_mended(path, &mending, &mesh, &report);
  if (status != COROT_OK) return failure(read_failure(status, path));
  /* what is known of it */
  mesh_facts f = {0};
  int code = EXIT_OK;
  status = warnings_of_report(report, &f.warnings);
  corot_mesh_report_destroy(report);
  if (status == COROT_OK) status = find_mesh_facts(mesh, &f);
  if (status != COROT_OK)
    code = failure(status);
  else if (json)
    code = print_info_json(path, mesh, &f);
  else
    print_info(path, mesh, &f);
  warnings_free(&f.warnings);
  free(f.part);
  corot_mesh_destroy(mesh);
  return code;
}

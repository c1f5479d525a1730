/* corot-bench memory: bytes of model and state. */
#include "bench.h"
#include "core/element/strain.h"
#include "report.h"

static const char help[] =
    "usage: corot-bench memory [--json] [--tets N] [--order N]\n"
    "\n"
    "Bytes per tet that a model and a state of each strain measure hold.\n"
    "\n"
    "      --json     one JSON object a line\n"
    "      --tets N   size of the box, rounded to whole cells (default: 18432)\n"
    "      --order N  of the tets: 1, four nodes; 2, ten nodes (default: 1)\n"
    "\n"
    "example: corot-bench memory\n";

static void print(bool json, const char *strain, const specimen *s) {
  double model = (double)corot_model_bytes(s->model) / s->ntet;
  double state = (double)corot_state_bytes(s->state) / s->ntet;
  if (json)
    report_object(json_pack("{s:s, s:s, s:i, s:f, s:f, s:f}", "bench", "memory", "strain", strain,
                            "tets", s->ntet, "model_bytes_per_tet", model, "state_bytes_per_tet",
                            state, "bytes_per_tet", model + state));
  else
    printf("%-8s %9.0f %9.0f %9.0f\n", strain, model, state, model + state);
}

static corot_status all(bool json, int order, int ntet) {
  corot_mesh *mesh;
  COROT_TRY(solid_mesh(ntet, order, &mesh));
  if (!json)
    printf("%d tets; bytes per tet\n%-8s %9s %9s %9s\n", mesh->ntet, "strain", "model", "state",
           "both");
  corot_status status = COROT_OK;
  for (int k = 0; k < NSTRAIN && !status; k++) {
    specimen s = {0};
    status = solid_create(mesh, strain_measures[k].name, true, &s);
    if (!status) print(json, strain_measures[k].name, &s);
    solid_clear(&s);
  }
  corot_mesh_destroy(mesh);
  return status;
}

int command_memory(int argc, char **argv) {
  static const char program[] = "corot-bench memory";
  static const struct option known[] = {{"json", no_argument, NULL, 'j'},
                                        {"tets", required_argument, NULL, 't'},
                                        {"order", required_argument, NULL, 'o'},
                                        {"help", no_argument, NULL, 'h'},
                                        {0}};
  bool json = false;
  int ntet = 18432, order = 1;
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":h", known, NULL)) != -1;) switch (answer) {
      case 'j':
        json = true;
        break;
      case 't':
        if (!parse_count(optarg, 100 * 1000 * 1000, &ntet))
          return usage_error(program, "--tets %s: expected a whole number > 0", optarg);
        break;
      case 'o':
        if (!parse_count(optarg, 2, &order)) return usage_error(program, "--order: 1 or 2");
        break;
      case 'h':
        fputs(help, stdout);
        return EXIT_OK;
      default:
        return option_error(program, answer, argv, known);
    }
  if (optind < argc) return usage_error(program, "unexpected: %s", argv[optind]);
  corot_status status = all(json, order, ntet);
  return status ? failure(status) : EXIT_OK;
}

/* `corot export-fmu`: options, then export_fmu(). */
#include "command_fmu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/command/cli.h"
#include "app/scenario/words.h"
#include "app/text/json_text.h"
#include "app/text/no_memory.h"
#include "app/text/say.h"
#include "fmi/describe/export_fmu.h"

static const char program[] = "corot export-fmu";

static const char help[] =
    "usage: corot export-fmu MODEL.yaml [-o FILE.fmu] [--interface NAME] [--set KEY=VALUE]...\n"
    "                        [--quiet] [--json]\n"
    "\n"
    "Makes a functional mock-up unit of FMI 3.0 out of a scenario, for programs that couple "
    "models.\n"
    "It brings all with it: the resolved scenario, its mesh and tables, and a shared object that "
    "needs\n"
    "the C library and libm alone. Its variables:\n"
    "\n"
    "  inputs      those of the scenario, by name, with their values at t = 0 to begin with\n"
    "  outputs     the columns of its probes, as in probes.csv\n"
    "  parameters  the materials' numbers, by the keys that --set has, as material.mu\n"
    "  states      body.u and body.v, of all degrees of freedom (Model Exchange)\n"
    "\n"
    "Co-Simulation has corot's own integrator inside: the one of the scenario, with KLU. Without\n"
    "inputs the outputs are, bit for bit, those of corot run --set linear_solver=klu at its "
    "output\n"
    "times. Model Exchange hands the equation of motion to the importer's integrator, with "
    "directional\n"
    "derivatives; it wants exact frames. States can be saved, restored and serialised.\n"
    "\n"
    "  -o, --output FILE    the FMU; default: MODEL.fmu in this folder. One that is there is "
    "replaced\n"
    "      --interface NAME co-simulation, model-exchange, both; auto, the default: Co-Simulation "
    "and,\n"
    "                       where it is possible, Model Exchange\n"
    "      --set KEY=VALUE  overrides a key of the scenario; any number of times\n"
    "  -q, --quiet          nothing on stderr but errors\n"
    "      --json           what the FMU has, on stdout\n"
    "\n"
    "example: corot export-fmu bar.yaml -o bar.fmu --set integrator.rtol=1e-6\n";

static const struct option options[] = {
    {"output", required_argument, NULL, 'o'},
    {"interface", required_argument, NULL, 'i'},
    {"set", required_argument, NULL, 's'},
    {"quiet", no_argument, NULL, 'q'},
    {"json", no_argument, NULL, 'j'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

static const char *const interfaces[] = {[EXPORT_AUTO] = "auto",
                                         [EXPORT_SIMULATION] = "co-simulation",
                                         [EXPORT_EXCHANGE] = "model-exchange",
                                         [EXPORT_BOTH] = "both",
                                         NULL};

typedef struct arguments {
  const char *from, *to;
  export_interface interface;
  bool quiet, json;
  int noverride;
  char **override;
} arguments;

/* --- The shared object --- */

/* DIR/PATH, if that can be read; else NULL. The caller's. */
static char *readable(const char *dir, const char *path) {
  size_t size = strlen(dir) + strlen(path) + 2;
  char *made = malloc(size);
  if (made) snprintf(made, size, "%s/%s", dir, path);
  if (made && access(made, R_OK) == 0) return made;
  free(made);
  return NULL;
}

/* Beside the program, as it is built, or where it is installed to. The caller's. */
static corot_status find_object(char **object) {
  char dir[4096];
  ssize_t n = readlink("/proc/self/exe", dir, sizeof dir - 1);
  dir[n > 0 ? n : 0] = '\0';
  char *slash = strrchr(dir, '/');
  if (slash) *slash = '\0';
  *object = readable(dir, "corot_fmu.so");
  if (!*object) *object = readable(dir, COROT_FMU_DIR "/corot_fmu.so");
  if (*object) return COROT_OK;
  return corot_fail(COROT_EIO,
                    "%s/%s/corot_fmu.so is not there: this corot was built without the archives "
                    "(libNAME.a) that an FMU is linked of, or without COROT_FMU",
                    dir, COROT_FMU_DIR);
}

/* --- What is said --- */

static json_t *facts_json(const export_def *def, const export_facts *f) {
  json_t *list = json_array();
  if (f->simulation) list = json_text_push(list, json_text_string("CoSimulation"));
  if (f->exchange) list = json_text_push(list, json_text_string("ModelExchange"));
  json_t *j = json_object();
  j = json_text_with(j, "fmu", json_text_string(def->to));
  j = json_text_with(j, "model_identifier", json_text_string(f->identifier));
  j = json_text_with(j, "instantiation_token", json_text_string(f->token));
  j = json_text_with(j, "platform", json_text_string(f->platform));
  j = json_text_with(j, "interfaces", list);
  j = json_text_with(j, "no_model_exchange",
                     *f->no_exchange ? json_text_string(f->no_exchange) : json_null());
  j = json_text_with(j, "parameters", json_integer(f->nparameter));
  j = json_text_with(j, "inputs", json_integer(f->ninput));
  j = json_text_with(j, "outputs", json_integer(f->noutput));
  j = json_text_with(j, "continuous_states", json_integer(f->nstate));
  return json_text_with(j, "resources", json_integer(f->nfile));
}

static const char *plural(int n) { return n == 1 ? "" : "s"; }

static void tell(const export_def *def, const export_facts *f) {
  if (*f->no_exchange) say("%s: without Model Exchange: %s\n", def->scenario->path, f->no_exchange);
  say("%s: %s%s%s; %d input%s, %d output%s, %d parameters; %s\n", def->scenario->path,
      f->simulation ? "Co-Simulation" : "", f->simulation && f->exchange ? " and " : "",
      f->exchange ? "Model Exchange" : "", f->ninput, plural(f->ninput), f->noutput,
      plural(f->noutput), f->nparameter, def->to);
}

/* --- The command --- */

/* MODEL.fmu of FOLDER/MODEL.yaml; the caller's. NULL: no memory. */
static char *default_name(const char *path) {
  const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
  const char *dot = strrchr(base, '.');
  size_t length = dot && dot != base ? (size_t)(dot - base) : strlen(base);
  char *name = malloc(length + 8);
  if (name) sprintf(name, "%.*s.fmu", (int)length, base);
  return name;
}

static corot_status export_scenario(const arguments *a, const scenario *s, const char *to) {
  char *object;
  export_facts facts;
  COROT_TRY(find_object(&object));
  const export_def def = {s, a->interface, object, to};
  corot_status status = export_fmu(&def, &facts);
  free(object);
  COROT_TRY(status);
  if (!a->quiet) tell(&def, &facts);
  if (!a->json) return COROT_OK;
  json_t *value = facts_json(&def, &facts);
  status = json_text_show(value);
  json_decref(value);
  return status;
}

static int run(const arguments *a) {
  scenario *s = NULL;
  char *name = a->to ? NULL : default_name(a->from);
  corot_status status = a->to || name ? COROT_OK : no_memory();
  if (status == COROT_OK)
    status = read_failure(scenario_read(a->from, a->noverride, a->override, &s), a->from);
  if (status == COROT_OK) status = export_scenario(a, s, a->to ? a->to : name);
  scenario_destroy(s);
  free(name);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

/* Takes one option of the line; -1: go on. */
static int take_option(arguments *a, int answer, char **argv) {
  int word;
  switch (answer) {
    case 'o':
      a->to = optarg;
      return *a->to ? -1 : usage_error(program, "--output: the name is empty");
    case 'i':
      word = words_find(interfaces, optarg);
      if (word < 0)
        return usage_error(program,
                           "--interface %s: expected auto, co-simulation, model-exchange or both",
                           optarg);
      a->interface = (export_interface)word;
      return -1;
    case 's':
      a->override[a->noverride++] = optarg;
      return -1;
    case 'q':
      a->quiet = true;
      return -1;
    case 'j':
      a->json = true;
      return -1;
    case 'h':
      fputs(help, stdout);
      return EXIT_OK;
    default:
      return option_error(program, answer, argv, options);
  }
}

int command_export_fmu(int argc, char **argv) {
  arguments a = {.override = calloc((size_t)argc, sizeof *a.override)};
  if (!a.override) return failure(no_memory());
  int code = -1;
  opterr = 0;
  for (int answer; code < 0 && (answer = getopt_long(argc, argv, ":o:qh", options, NULL)) != -1;)
    code = take_option(&a, answer, argv);
  if (code < 0 && argc - optind != 1)
    code = usage_error(program, "expected one scenario, found %d", argc - optind);
  if (code < 0) {
    a.from = argv[optind];
    code = run(&a);
  }
  free(a.override);
  return code;
}

/* Lays the resources out, opens them as an instance would, and packs all. */
#include "export_fmu.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/text/no_memory.h"
#include "archive.h"
#include "description.h"
#include "resources.h"

#if defined(__x86_64__)
#define MACHINE "x86_64"
#elif defined(__aarch64__)
#define MACHINE "aarch64"
#elif defined(__riscv) && __riscv_xlen == 64
#define MACHINE "riscv64"
#else
#define MACHINE "unknown"
#endif

/* As the standard calls the folder of a shared object. */
static const char platform[] = MACHINE "-linux";

static const char licenses[] =
    "The shared object in binaries was linked from\n"
    "\n"
    "  corot                   BSD-3-Clause\n"
    "  SUNDIALS                BSD-3-Clause\n"
    "  KLU, BTF (SuiteSparse)  LGPL-2.1-or-later\n"
    "  AMD, COLAMD             BSD-3-Clause\n"
    "  libfyaml, jansson       MIT\n"
    "  libmd                   BSD-3-Clause, BSD-2-Clause, ISC, public domain\n"
    "  zlib                    Zlib\n"
    "\n"
    "Whoever hands it on gives along their notices, and for KLU and BTF either their source with "
    "the\n"
    "objects of the rest, or the offer of both: corot is built, and the FMU exported again, from\n"
    "its source with any version of these libraries. In Debian the notices are in\n"
    "/usr/share/doc/PACKAGE/copyright of libsundials-dev, libsuitesparse-dev, libfyaml-dev,\n"
    "libjansson-dev, libmd-dev and zlib1g-dev.\n";

/* --- Names --- */

/* The file's name without folder and suffix, as a name of C. */
static void name_model(const char *path, size_t size, char *name, char *identifier) {
  const char *slash = strrchr(path, '/'), *base = slash ? slash + 1 : path;
  snprintf(name, size, "%s", base);
  char *dot = strrchr(name, '.');
  if (dot && dot != name) *dot = '\0';
  snprintf(identifier, size, "%s%.120s", isdigit((unsigned char)*name) ? "model_" : "", name);
  for (char *c = identifier; *c; c++)
    if (!isalnum((unsigned char)*c) && *c != '_') *c = '_';
}

/* --- Parts of the archive --- */

static corot_status add_description(const description *d, archive *a) {
  char *text = NULL;
  size_t size;
  FILE *out = open_memstream(&text, &size);
  if (!out) return no_memory();
  description_write(d, out);
  bool failed = ferror(out);
  failed |= fclose(out) != 0 || !text; /* which is NULL where the last byte has found no room */
  corot_status status = failed ? no_memory() : archive_add(a, "modelDescription.xml", text, size);
  free(text);
  return status;
}

static corot_status add_object(const export_def *def, const char *identifier, archive *a) {
  char name[256];
  snprintf(name, sizeof name, "binaries/%s/%s.so", platform, identifier);
  return archive_add_file(a, name, def->object);
}

static corot_status add_resources(const resources *r, archive *a) {
  COROT_TRY(archive_add(a, "resources/scenario.json", r->scenario, strlen(r->scenario)));
  for (int i = 0; i < r->n; i++) {
    size_t size = strlen(r->file[i].name) + 16;
    char *name = malloc(size);
    if (!name) return no_memory();
    snprintf(name, size, "resources/%s", r->file[i].name);
    const resource *f = &r->file[i];
    corot_status status =
        f->data ? archive_add(a, name, f->data, f->size) : archive_add_file(a, name, f->path);
    free(name);
    COROT_TRY(status);
  }
  return COROT_OK;
}

static corot_status add_all(const export_def *def, const description *d, const resources *r,
                            archive *a) {
  COROT_TRY(add_description(d, a));
  COROT_TRY(add_object(def, d->identifier, a));
  COROT_TRY(add_resources(r, a));
  return archive_add(a, "documentation/licenses/license.txt", licenses, strlen(licenses));
}

static corot_status pack_all(const export_def *def, const description *d, const resources *r) {
  archive *a = NULL;
  COROT_TRY(archive_open(def->to, &a));
  corot_status status = add_all(def, d, r, a);
  if (status == COROT_OK) return archive_close(a);
  archive_abandon(a);
  return status;
}

/* --- What it has --- */

static corot_status choose(const export_def *def, const body *b, export_facts *facts) {
  const char *reason = body_no_exchange(b);
  facts->exchange = def->interface != EXPORT_SIMULATION && !reason;
  facts->simulation = def->interface != EXPORT_EXCHANGE;
  if (!reason || def->interface == EXPORT_SIMULATION) return COROT_OK;
  snprintf(facts->no_exchange, sizeof facts->no_exchange, "%s", reason);
  if (def->interface == EXPORT_AUTO) return COROT_OK;
  return corot_fail(COROT_EFORMAT,
                    "%s: Model Exchange is not possible: %s; Co-Simulation is: --interface "
                    "co-simulation",
                    def->scenario->path, reason);
}

static void count(const body *b, const variables *v, const resources *r, export_facts *facts) {
  memcpy(facts->token, b->hashes.run, sizeof facts->token);
  facts->platform = platform;
  facts->nparameter = v->nparameter;
  facts->ninput = v->ninput;
  facts->noutput = v->noutput;
  facts->nstate = facts->exchange ? 2 * corot_model_ndof(b->model) : 0;
  facts->nfile = r->n + 1;
}

/* Opens the folder that has been laid out. */
static corot_status open_resources(const char *dir, body *b) {
  size_t size = strlen(dir) + 32;
  char *path = malloc(size);
  if (!path) return no_memory();
  snprintf(path, size, "%s/scenario.json", dir);
  corot_status status = body_open(path, b);
  free(path);
  return status;
}

/* The body as an instance will have it: from resources that lie in a folder beside the FMU for that
   while. */
static corot_status try_resources(const char *to, const resources *r, body *b) {
  size_t size = strlen(to) + 8;
  char *dir = malloc(size);
  if (!dir) return no_memory();
  snprintf(dir, size, "%s.files", to);
  corot_status status = resources_lay_out(r, dir);
  if (status == COROT_OK) status = open_resources(dir, b);
  bool opened = status == COROT_OK;
  if (opened)
    status = resources_take_away(r, dir);
  else
    resources_abandon(r, dir);
  if (status && opened) body_close(b);
  free(dir);
  return status;
}

static corot_status describe(const export_def *def, const body *b, const resources *r,
                             export_facts *facts) {
  char name[128];
  variables v;
  name_model(def->scenario->path, sizeof name, name, facts->identifier);
  COROT_TRY(choose(def, b, facts));
  COROT_TRY(variables_create(b, &v));
  const description d = {b, &v, name, facts->identifier, facts->exchange, facts->simulation};
  corot_status status = pack_all(def, &d, r);
  count(b, &v, r, facts);
  variables_clear(&v);
  return status;
}

corot_status export_fmu(const export_def *def, export_facts *facts) {
  resources r;
  body b;
  *facts = (export_facts){0};
  COROT_TRY(resources_find(def->scenario, &r));
  corot_status status = try_resources(def->to, &r, &b);
  if (status == COROT_OK) {
    status = describe(def, &b, &r, facts);
    body_close(&b);
  }
  resources_clear(&r);
  return status;
}

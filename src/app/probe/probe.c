/* The columns of a scenario's probes, and what they are at a moment. */
#include "probe.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const displacement_words[3] = {"ux", "uy", "uz"};

/* A probe on its part of the mesh. */
typedef struct probe {
  const char *name;
  int node;
} probe;

struct probes {
  int n, ncolumn;
  probe *probe;      /* [n] */
  char **column;     /* [ncolumn] names, with the component */
  const char **unit; /* [ncolumn] */
};

void probes_destroy(probes *p) {
  if (!p) return;
  for (int i = 0; i < p->ncolumn; i++) free(p->column[i]);
  free(p->column);
  free(p->unit);
  free(p->probe);
  free(p);
}

static corot_status out_of_memory(void) {
  return corot_fail(COROT_ENOMEM, "the probes: out of memory");
}

static corot_status add_column(probes *p, const char *of, const char *component, const char *unit) {
  size_t size = strlen(of) + strlen(component) + 2;
  char *name = malloc(size);
  if (!name) return out_of_memory();
  snprintf(name, size, "%s.%s", of, component);
  p->unit[p->ncolumn] = unit;
  p->column[p->ncolumn++] = name;
  return COROT_OK;
}

static corot_status find_node(const probe_def *def, const corot_mesh *mesh, int *node) {
  *node = def->node >= 0 ? def->node : corot_mesh_nearest(mesh, def->point);
  if (*node < mesh->nnode) return COROT_OK;
  return corot_fail(COROT_EINVAL, "probe %s: node %d; the mesh's nodes are 0 to %d", def->name,
                    def->node, mesh->nnode - 1);
}

static corot_status make(probes *p, const scenario *s, const corot_mesh *mesh) {
  p->probe = calloc((size_t)s->nprobe + 1, sizeof *p->probe);
  p->column = calloc(3 * (size_t)s->nprobe + 1, sizeof *p->column);
  p->unit = calloc(3 * (size_t)s->nprobe + 1, sizeof *p->unit);
  if (!p->probe || !p->column || !p->unit) return out_of_memory();
  for (int i = 0; i < s->nprobe; i++) {
    p->probe[i].name = s->probe[i].name;
    COROT_TRY(find_node(&s->probe[i], mesh, &p->probe[i].node));
    p->n++;
    for (int c = 0; c < 3; c++)
      COROT_TRY(add_column(p, p->probe[i].name, displacement_words[c], "m"));
  }
  return COROT_OK;
}

corot_status probes_create(const scenario *s, const corot_model *model, probes **out) {
  probes *p = calloc(1, sizeof *p);
  if (!p) return out_of_memory();
  corot_status status = make(p, s, corot_model_mesh(model));
  if (status == COROT_OK)
    *out = p;
  else
    probes_destroy(p);
  return status;
}

int probes_ncolumn(const probes *p) { return p->ncolumn; }
int probes_n(const probes *p) { return p->n; }

probe_facts probes_known(const probes *p, int i) {
  return (probe_facts){.name = p->probe[i].name,
                       .node = p->probe[i].node,
                       .first = 3 * i,
                       .ncolumn = 3,
                       .length = "u",
                       .moves = true};
}

const char *const *probes_columns(const probes *p) { return (const char *const *)p->column; }
const char *probes_unit(const probes *p, int i) { return p->unit[i]; }

corot_status probes_evaluate(probes *p, const probe_moment *now, double *value) {
  for (int i = 0; i < p->n; i++)
    for (int c = 0; c < 3; c++) value[3 * i + c] = now->displacement[p->probe[i].node][c];
  return COROT_OK;
}

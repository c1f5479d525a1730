/* Forces of supports, group by group. A node that two groups hold counts for both. */
#include "reactions.h"

#include <stdlib.h>
#include <string.h>

#include "app/folder/write_csv.h"
#include "app/text/json_text.h"

typedef struct support {
  const corot_group *group;
  bool held[3];
} support;

struct reactions {
  const corot_model *model;
  double t_end;
  table *table;
  int n;
  support *support;   /* [n] a group each */
  const char **name;  /* [n] */
  double (*force)[3]; /* [n] of the last row [N] */
  double (*load)[3];  /* [nnode] */
};

corot_status reactions_close(reactions *r) {
  corot_status status = table_close(r->table);
  r->table = NULL;
  return status;
}

void reactions_destroy(reactions *r) {
  if (!r) return;
  reactions_close(r);
  free(r->support);
  free(r->name);
  free(r->force);
  free(r->load);
  free(r);
}

/* The support of a group, begun if there is none yet. */
static support *support_of(reactions *r, const char *name) {
  for (int i = 0; i < r->n; i++)
    if (strcmp(r->name[i], name) == 0) return &r->support[i];
  r->name[r->n] = name;
  r->support[r->n].group = corot_mesh_find_group(corot_model_mesh(r->model), name);
  return &r->support[r->n++];
}

static void find_supports(reactions *r, const scenario *s) {
  for (int i = 0; i < s->nfix; i++) {
    support *at = support_of(r, s->fix[i].group);
    for (int c = 0; c < 3; c++) at->held[c] |= s->fix[i].component[c];
  }
  for (int i = 0; i < s->nmotion; i++) {
    support *at = support_of(r, s->motion[i].group);
    for (int c = 0; c < 3; c++) at->held[c] = true;
  }
}

static corot_status begin(reactions *r, const char *dir, const scenario *s) {
  size_t most = (size_t)s->nfix + (size_t)s->nmotion + 1;
  r->support = calloc(most, sizeof *r->support);
  r->name = calloc(most, sizeof *r->name);
  r->force = calloc(most, sizeof *r->force);
  r->load = calloc((size_t)corot_model_mesh(r->model)->nnode, sizeof *r->load);
  if (!r->support || !r->name || !r->force || !r->load)
    return corot_fail(COROT_ENOMEM, "%s/reactions.csv: out of memory", dir);
  find_supports(r, s);
  return reactions_open(dir, r->n, r->name, &r->table);
}

corot_status reactions_create(const char *dir, const scenario *s, const corot_model *model,
                              reactions **out) {
  reactions *r = calloc(1, sizeof *r);
  if (!r) return corot_fail(COROT_ENOMEM, "%s/reactions.csv: out of memory", dir);
  r->model = model;
  r->t_end = s->t_end;
  corot_status status = begin(r, dir, s);
  if (status != COROT_OK) {
    reactions_destroy(r);
    return status;
  }
  *out = r;
  return COROT_OK;
}

corot_status reactions_add(reactions *r, double factor, const double (*displacement)[3],
                           const double (*internal)[3]) {
  COROT_TRY(corot_load_force(r->model, r->t_end, factor, displacement, r->load));
  for (int k = 0; k < r->n; k++) {
    const support *s = &r->support[k];
    for (int c = 0; c < 3; c++) {
      double sum = 0;
      for (int i = 0; s->held[c] && i < s->group->nnode; i++) {
        int n = s->group->node[i];
        sum += internal[n][c] - r->load[n][c];
      }
      r->force[k][c] = sum;
    }
  }
  return reactions_row(r->table, factor * r->t_end, r->n, (const double(*)[3])r->force);
}

json_t *reactions_last(const reactions *r) {
  json_t *all = json_object();
  for (int k = 0; k < r->n; k++) {
    const double *f = r->force[k];
    json_t *list =
        json_pack("[o, o, o]", json_text_real(f[0]), json_text_real(f[1]), json_text_real(f[2]));
    all = json_text_with(all, r->name[k], list);
  }
  return all;
}

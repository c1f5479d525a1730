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
  table *table;
  int n;
  support *support;      /* [n] a group each */
  const char **name;     /* [n] */
  double (*force)[3];    /* [n] of the last row [N] */
  corot_nodal_forces at; /* [nnode] internal forces and loads */
};

static corot_status close_reactions(void *writer) {
  reactions *r = writer;
  corot_status status = table_close(r->table);
  free(r->support);
  free(r->name);
  free(r->force);
  free(r->at.internal);
  free(r->at.load);
  free(r);
  return status;
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
  for (int i = 0; i < s->model.nfix; i++) {
    support *at = support_of(r, s->model.fix[i].group);
    for (int c = 0; c < 3; c++) at->held[c] |= s->model.fix[i].component[c];
  }
  for (int i = 0; i < s->model.nmotion; i++) {
    support *at = support_of(r, s->model.motion[i].group);
    for (int c = 0; c < 3; c++) at->held[c] = true;
  }
}

static corot_status begin(reactions *r, const char *dir, const scenario *s) {
  size_t most = (size_t)s->model.nfix + (size_t)s->model.nmotion + 1;
  r->support = calloc(most, sizeof *r->support);
  r->name = calloc(most, sizeof *r->name);
  r->force = calloc(most, sizeof *r->force);
  size_t nnode = (size_t)corot_model_mesh(r->model)->nnode;
  r->at.internal = calloc(nnode, sizeof *r->at.internal);
  r->at.load = calloc(nnode, sizeof *r->at.load);
  if (!r->support || !r->name || !r->force || !r->at.internal || !r->at.load)
    return corot_fail(COROT_ENOMEM, "%s/reactions.csv: out of memory", dir);
  find_supports(r, s);
  return reactions_open(dir, r->n, r->name, &r->table);
}

static corot_status open_reactions(const writer_source *source, void **writer) {
  reactions *r = calloc(1, sizeof *r);
  if (!r) return corot_fail(COROT_ENOMEM, "%s/reactions.csv: out of memory", source->dir);
  r->model = source->model;
  corot_status status = begin(r, source->dir, source->scenario);
  if (status != COROT_OK) {
    close_reactions(r);
    return status;
  }
  *writer = r;
  return COROT_OK;
}

static corot_status write_reactions(void *writer, const moment *now) {
  reactions *r = writer;
  COROT_TRY(corot_forces(r->model, now->state, now->t, now->u, NULL, NULL, &r->at));
  for (int k = 0; k < r->n; k++) {
    const support *s = &r->support[k];
    for (int c = 0; c < 3; c++) {
      double sum = 0;
      for (int i = 0; s->held[c] && i < s->group->nnode; i++) {
        int n = s->group->node[i];
        sum += r->at.internal[n][c] - r->at.load[n][c];
      }
      r->force[k][c] = sum;
    }
  }
  return reactions_row(r->table, now->t, r->n, (const double(*)[3])r->force);
}

const writer_ops reactions_writer = {
    .file = "reactions.csv",
    .use = WRITER_OF_STATICS,
    .open = open_reactions,
    .moment = write_reactions,
    .close = close_reactions,
};

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

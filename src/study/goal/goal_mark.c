/* Marks where the estimator says: the tets that carry so much of the error that the next mesh has
   at least twice as many, if those are few. */
#include "goal_mark.h"

#include <corot/space.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/folder/folder.h"
#include "app/folder/folder_owner.h"
#include "app/folder/states.h"
#include "app/probe/probe.h"
#include "app/text/no_memory.h"
#include "app/text/text_stream.h"

/* The next mesh has about so many times the tets. */
#define GROWTH_LEAST 1.8
#define GROWTH_MOST 5.0 /* by marks alone: beyond, octasection is the same at less ado */

/* The last level as it was run. */
typedef struct solved {
  scenario *scenario;
  corot_mesh *mesh;
  corot_model *model;
  trajectory states;
} solved;

static void forget(solved *of) {
  states_free(&of->states);
  corot_model_destroy(of->model);
  corot_mesh_destroy(of->mesh);
  scenario_destroy(of->scenario);
}

static corot_status recall(const goal_search *s, solved *of) {
  const attempts *all = &s->attempts;
  const attempt *a = goal_attempt(s, s->level[s->nlevel - 1]);
  char **set = malloc((size_t)(all->nset + a->nset + 1) * sizeof *set);
  if (!set) return no_memory();
  int n = 0;
  for (int i = 0; i < all->nset; i++) set[n++] = (char *)all->set[i];
  for (int i = 0; i < a->nset; i++) set[n++] = (char *)a->set[i];
  corot_status read = scenario_read(all->scenario->path, n, set, &of->scenario);
  free(set);
  COROT_TRY(read);
  COROT_TRY(scenario_build(of->scenario, &of->mesh, NULL, &of->model));
  char *folder = attempts_folder(all, s->level[s->nlevel - 1]);
  if (!folder) return COROT_ENOMEM;
  corot_status status = states_read(folder, &of->states);
  free(folder);
  return status;
}

/* The record at the time that the quantity is of, or with the largest displacement. */
static int record_of(const goal_search *s, const trajectory *states) {
  const quantity *q = s->request->quantity;
  double t = q->operation == QUANTITY_AT ? fmin(q->to, s->until)
                                         : goal_attempt(s, s->level[s->nlevel - 1])->when;
  int best = states->count - 1;
  double least = INFINITY;
  for (int k = 0; k < states->count; k++) {
    double off = fabs(states_t(states, k) - t);
    if (isnan(t)) {
      const double *u = states_u(states, k);
      off = 0;
      for (int i = 0; i < states->n; i++) off -= u[i] * u[i];
    }
    if (off < least) least = off, best = k;
  }
  return best;
}

/* --- What it weighs by --- */

static int column_of(const probes *p, const char *name) {
  for (int i = 0; i < probes_ncolumn(p); i++)
    if (strcmp(probes_columns(p)[i], name) == 0) return i;
  return -1;
}

/* goal [ndof] of a column at a moment, if it has a derivative. */
static corot_status weigh(probes *p, const probe_moment *now, int column, double *goal,
                          bool *known) {
  double *value = calloc((size_t)probes_ncolumn(p) + 1, sizeof *value);
  if (!value) return no_memory();
  corot_status status = probes_evaluate(p, now, value);
  if (status == COROT_OK) status = probes_goal(p, now, column, goal, known);
  free(value);
  return status;
}

static corot_status weigh_at(const goal_search *s, const solved *of, const corot_space_moment *at,
                             corot_state *state, double *goal, bool *known) {
  static const ledger none;
  probes *p = NULL;
  double(*x)[3] = calloc((size_t)of->mesh->nnode, sizeof *x);
  corot_status status = x ? probes_create(of->scenario, of->model, &p) : no_memory();
  int column = status == COROT_OK ? column_of(p, s->attempts.column) : -1;
  if (status == COROT_OK && column >= 0) {
    if (at->still)
      corot_state_stand_still(state, at->load_t, at->factor);
    else
      corot_state_enter(state, at->t);
    corot_nodal(of->model, at->still ? at->load_t : at->t, at->u, NULL, x, NULL);
    const probe_moment now = {.t = at->t,
                              .state = state,
                              .u = at->u,
                              .v = at->v,
                              .displacement = (const double(*)[3])x,
                              .ledger = &none,
                              .still = at->still};
    status = weigh(p, &now, column, goal, known);
  }
  probes_destroy(p);
  free(x);
  return status;
}

/* The energy alone, where the quantity has no derivative. */
static corot_status indicate(const goal_search *s, const solved *of, const corot_space_moment *at,
                             double *indicator) {
  corot_state *state = NULL;
  double *goal = calloc((size_t)corot_model_ndof(of->model) + 1, sizeof *goal);
  bool known = false;
  corot_status status = goal ? corot_state_create(of->model, &state) : no_memory();
  if (status == COROT_OK) status = weigh_at(s, of, at, state, goal, &known);
  if (status == COROT_RETRY) status = COROT_OK, known = false;
  if (status == COROT_OK)
    status = corot_space_indicators(of->model, at, known ? goal : NULL, NULL, indicator, NULL);
  corot_state_destroy(state);
  free(goal);
  return status;
}

static corot_status find_indicators(const goal_search *s, const solved *of, double *indicator) {
  int k = record_of(s, &of->states);
  double t = states_t(&of->states, k);
  corot_space_moment at = {.t = t,
                           .u = states_u(&of->states, k),
                           .v = states_v(&of->states, k),
                           .still = s->request->still,
                           .load_t = of->scenario->t_end,
                           .factor = of->scenario->t_end > 0 ? t / of->scenario->t_end : 1};
  return indicate(s, of, &at, indicator);
}

/* --- How many --- */

typedef struct marks {
  int n, *tet; /* [n] room for all */
  double growth;
} marks;

static corot_status count(const solved *of, marks *m) {
  corot_mesh *fine = NULL;
  COROT_TRY(corot_mesh_refine_marked(of->mesh, m->n, m->tet, &fine, NULL));
  m->growth = (double)fine->ntet / of->mesh->ntet;
  corot_mesh_destroy(fine);
  return COROT_OK;
}

/* Ever more of the error, until the mesh grows enough. */
static corot_status choose(const solved *of, const double *indicator, marks *m) {
  static const double fractions[] = {0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99};
  m->growth = 1;
  for (size_t i = 0; i < sizeof fractions / sizeof *fractions && m->growth < GROWTH_LEAST; i++) {
    COROT_TRY(corot_space_mark(of->mesh->ntet, indicator, fractions[i], &m->n, m->tet));
    COROT_TRY(count(of, m));
  }
  return COROT_OK;
}

/* --- The file --- */

#define MARKS_MARK "# corot solve: tets to cut, a line for each pass"

static corot_status copy_passes(const attempts *a, int npass, FILE *out) {
  if (npass == 0) {
    fputs(MARKS_MARK "\n", out);
    return COROT_OK;
  }
  char *path = attempts_marks(a, npass), line[4096];
  FILE *in = path ? fopen(path, "r") : NULL;
  free(path);
  if (!in) return corot_fail(COROT_EIO, "%s/marks/%d.txt: cannot be read", a->options.dir, npass);
  for (size_t n; (n = fread(line, 1, sizeof line, in)) > 0;) fwrite(line, 1, n, out);
  bool failed = ferror(in);
  fclose(in);
  return failed ? corot_fail(COROT_EIO, "%s/marks: cannot be read", a->options.dir) : COROT_OK;
}

static corot_status write_marks(const goal_search *s, const marks *m) {
  const attempts *a = &s->attempts;
  char *text = NULL, *path = attempts_marks(a, s->npass + 1),
       *folder = folder_path(a->options.dir, "marks");
  size_t size = 0;
  FILE *out = path && folder ? text_open(&text, &size) : NULL;
  corot_status status = out ? folder_make(folder) : no_memory();
  if (status == COROT_OK) status = copy_passes(a, s->npass, out);
  for (int i = 0; i < m->n && status == COROT_OK; i++)
    fprintf(out, "%d%c", m->tet[i], i + 1 < m->n ? ' ' : '\n');
  if (text_close(out) != 0 && status == COROT_OK) status = no_memory();
  if (status == COROT_OK && !a->options.force) status = file_permit(path, MARKS_MARK);
  if (status == COROT_OK) status = file_replace_durably(path, text, size);
  free(text);
  free(folder);
  free(path);
  return status;
}

/* --- All of it --- */

static corot_status mark(goal_search *s, const solved *of, marks *m, goal_marking *out) {
  double *indicator = malloc((size_t)of->mesh->ntet * sizeof *indicator);
  m->tet = malloc((size_t)of->mesh->ntet * sizeof *m->tet);
  corot_status status = indicator && m->tet ? COROT_OK : no_memory();
  if (status == COROT_OK) status = find_indicators(s, of, indicator);
  /* nothing to be seen: everywhere */
  bool blind = status == COROT_RETRY || status == COROT_ESINGULAR;
  if (status == COROT_OK) status = choose(of, indicator, m);
  free(indicator);
  if (blind) return COROT_OK;
  COROT_TRY(status);
  if (s->npass == 0 && (m->growth > GROWTH_MOST || m->n == 0)) return COROT_OK;
  *out = (goal_marking){.local = true, .growth = m->growth};
  return write_marks(s, m);
}

corot_status goal_mark(goal_search *s, goal_marking *out) {
  *out = (goal_marking){.local = false, .growth = 8};
  /* what the estimator sees is a shape at a moment: it says little of waves that pass */
  if (!s->request->still && !(goal_attempt(s, s->full)->swing <= GOAL_QUIET)) return COROT_OK;
  solved of = {0};
  marks m = {0};
  corot_status status = recall(s, &of);
  if (status == COROT_OK) status = mark(s, &of, &m, out);
  free(m.tet);
  forget(&of);
  return status;
}

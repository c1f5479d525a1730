/* What is known of a run before its first step. */
#include <math.h>
#include <stdlib.h>

#include "probe_location.h"
#include "solve/statics/rigid.h"
#include "warnings.h"
#include "warnings_parts.h"

/* --- The material --- */

/* Linear tets lock where lambda is many mu. Beyond ten, a nu of 0.4545, the bar of models/bar bends
   a third less than with averaged dilatations, and at 0.495 two thirds less. Ten-node tets do so on
   coarse meshes, and far less: beyond 50, a nu of 0.4902, the bar bends 3 % less, and Cook's
   membrane of 4 cells a side a tenth less, at 0.4999 5 % and 18 %. */
static const struct {
  double most_lambda; /* over mu */
  const char *tets, *remedy;
} lock[] = {{10, "tets with a dilatation of their own", "nodal"},
            {50, "ten-node tets with a dilatation of their own at each point", "element"}};

/* The dilatation of a linear tet is its mean as well. */
static bool locks(corot_dilatation dilatation, int order) {
  return dilatation == COROT_DILATATION_LOCAL ||
         (dilatation == COROT_DILATATION_ELEMENT && order == 1);
}

static corot_status find_locking(const scenario *s, int order, warnings *w) {
  for (int i = 0; i < s->model.nmaterial && locks(s->model.dilatation, order); i++) {
    const corot_material *m = &s->model.material[i];
    if (!(m->lambda > lock[order - 1].most_lambda * m->mu)) continue;
    double ratio = m->lambda / m->mu;
    COROT_TRY(warnings_add(w, WARNING_LOCKING,
                           "material%s%.64s: nu = %.4g: %s are too stiff, the more "
                           "so the nearer nu is to 0.5; dilatation: %s is the remedy",
                           m->group ? " of " : "", m->group ? m->group : "",
                           0.5 * ratio / (ratio + 1), lock[order - 1].tets,
                           lock[order - 1].remedy));
  }
  return COROT_OK;
}

/* --- Threads --- */

static corot_status count_threads(const scenario *s, warnings *w) {
  int processors = corot_processors();
  if (s->threads <= processors) return COROT_OK;
  return warnings_add(w, WARNING_THREADS,
                      "%d threads share %d processor%s, and wait for one another: the run takes "
                      "longer than with threads: %d",
                      s->threads, processors, processors == 1 ? "" : "s", processors);
}

/* --- The parts of the body --- */

/* "2 parts that share no node: 27 nodes from node 0 on; ...", all too many left out. */
static corot_status add_parts(int npart, const corot_part *part, warnings *w) {
  enum { MOST = 5 };
  char list[MOST * 64] = "";
  int used = 0;
  if (npart < 2) return COROT_OK;
  for (int k = 0; k < npart && k < MOST; k++)
    used += snprintf(list + used, sizeof list - (size_t)used, "%s%d nodes with node %d",
                     k ? ", " : "", part[k].nnode, part[k].first);
  return warnings_add(w, WARNING_PARTS,
                      "the body is in %d parts that share no node (%s%s): they do not feel each "
                      "other; if they are to be one body, join their nodes where they touch",
                      npart, list, npart > MOST ? ", ..." : "");
}

/* Free bodies are flown on purpose, and so may several be; one that nothing holds beside one that
   is held was most likely to be joined to it. */
static corot_status add_unheld(int npart, const corot_part *part, warnings *w) {
  int nheld = 0;
  for (int k = 0; k < npart; k++) nheld += part[k].nfree < 6;
  for (int k = 0; k < npart && nheld > 0; k++) {
    if (part[k].nfree < 6) continue;
    COROT_TRY(warnings_add(w, WARNING_UNHELD,
                           "nothing holds the part of the body with node %d (%d nodes), while %s "
                           "held: it can %s; give it a support in boundary, or join it to the rest",
                           part[k].first, part[k].nnode, nheld == 1 ? "another is" : "others are",
                           part[k].can));
  }
  return COROT_OK;
}

corot_status warnings_of_report(const corot_mesh_report *report, warnings *w) {
  for (int i = 0; i < report->nremark; i++) {
    const corot_remark *r = &report->remark[i];
    warning_code code = r->what == COROT_MENDED_CUT    ? WARNING_CUT
                        : r->what == COROT_MENDED_LOST ? WARNING_LOST
                                                       : WARNING_MENDED;
    COROT_TRY(warnings_add(w, code, "%s", r->text));
  }
  return COROT_OK;
}

corot_status warnings_of_mesh(const corot_mesh *mesh, warnings *w) {
  int npart;
  corot_part *part;
  COROT_TRY(corot_mesh_parts(mesh, &npart, &part));
  corot_status status = add_parts(npart, part, w);
  free(part);
  return status;
}

static corot_status find_parts(const corot_model *model, warnings *w) {
  int npart;
  corot_part *part;
  COROT_TRY(corot_model_parts(model, &npart, &part));
  corot_status status = add_parts(npart, part, w);
  if (status == COROT_OK) status = add_unheld(npart, part, w);
  free(part);
  return status;
}

/* --- The probes --- */

static double distance(const double a[3], const double b[3]) {
  return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

static bool has_node(const corot_mesh *mesh, int e, int node) {
  for (int k = 0; k < 4; k++)
    if (mesh->tet[e][k] == node) return true;
  for (int k = 0; mesh->mid && k < 6; k++)
    if (mesh->mid[e][k] == node) return true;
  return false;
}

/* The largest distance of a node from another of its tets: in a linear mesh its longest edge; in
   one of order 2, where edges have a node in their middle, half of what separates the corners. */
static double reach_of(const corot_mesh *mesh, int node) {
  double longest = 0;
  for (int e = 0; e < mesh->ntet; e++) {
    if (!has_node(mesh, e, node)) continue;
    const int *v = mesh->tet[e];
    for (int a = 0; a < 4; a++)
      for (int b = 0; b < a; b++)
        if (mesh->mid || v[a] == node || v[b] == node)
          longest = fmax(longest, distance(mesh->x[v[a]], mesh->x[v[b]]));
  }
  return mesh->mid ? longest / 2 : longest;
}

/* Inside the body a point is at most half the longest edge from a node of a box's cell, and 0.61 of
   the edge in a regular tet: what is further off lies outside the body, or among flat tets. */
#define MOST_EDGES 0.65

static corot_status find_far_node(const probe_def *p, const corot_mesh *mesh, warnings *w) {
  int node = corot_mesh_nearest(mesh, p->point);
  double off = distance(p->point, mesh->x[node]), edge = reach_of(mesh, node);
  if (!(off > MOST_EDGES * edge)) return COROT_OK;
  return warnings_add(w, WARNING_PROBE,
                      "probe %.64s: the nearest node, %d, is %.3g m from its point, which is "
                      "%.2g of the longest edge%s there: it records that node's motion; move the "
                      "point, or name a node",
                      p->name, node, off, off / edge, mesh->mid ? " between nodes" : "");
}

static corot_status find_outside(const probe_def *p, const corot_mesh *mesh, warnings *w) {
  corot_location at;
  COROT_TRY(probe_locate(p, mesh, &at));
  if (!(at.distance > probe_rounding(mesh))) return COROT_OK;
  return warnings_add(w, WARNING_PROBE,
                      "probe %.64s: its point is %.3g m outside the body: it records the nearest "
                      "point of the surface, (%.6g, %.6g, %.6g); move the point, or name a node",
                      p->name, at.distance, at.x[0], at.x[1], at.x[2]);
}

static corot_status find_probes(const scenario *s, const corot_mesh *mesh, warnings *w) {
  for (int i = 0; i < s->nprobe; i++) {
    const probe_def *p = &s->probe[i];
    if (!probe_is_local(p) || p->node >= 0) continue;
    COROT_TRY(p->nearest ? find_far_node(p, mesh, w) : find_outside(p, mesh, w));
  }
  return COROT_OK;
}

/* --- The tolerances --- */

/* A displacement of this part of the length is taken for the run's until it is known. */
#define EXPECTED_DISPLACEMENT 0.1

double warnings_atol(const scenario *s, const corot_model *model) {
  const corot_integrator_def *d = &s->integrator;
  if (d->step > 0) return 0;
  if (d->atol_displacement > 0) return d->atol_displacement;
  return 0.01 * d->rtol * corot_model_length(model);
}

corot_status warnings_find_rtol(const scenario *s, const corot_model *model, double displacement,
                                warnings *w) {
  const corot_integrator_def *d = &s->integrator;
  double length = corot_model_length(model);
  if (d->step > 0) {
    if (d->newton_tolerance >= LEAST_TOLERANCE) return COROT_OK;
    return warnings_add(w, WARNING_RTOL,
                        "integrator.newton.tolerance = %g of the length is below what double "
                        "precision can tell of a correction, some %.0e; make it larger",
                        d->newton_tolerance, LEAST_TOLERANCE);
  }
  double tolerance = d->rtol * displacement + warnings_atol(s, model);
  double least = LEAST_TOLERANCE * (length + displacement);
  if (tolerance >= least) return COROT_OK;
  return warnings_add(w, WARNING_RTOL,
                      "integrator.rtol = %g asks for steps that are right to %.1e m, but rounding "
                      "moves a body of %.3g m by some %.0e m in each: more steps do not make the "
                      "answer better; make rtol %.1e or larger",
                      d->rtol, tolerance, length, least,
                      2 * least / (displacement + 0.01 * length));
}

/* --- All of it --- */

corot_status warnings_before(const scenario *s, const corot_model *model, bool statics,
                             warnings *w) {
  COROT_TRY(count_threads(s, w));
  COROT_TRY(find_locking(s, corot_mesh_order(corot_model_mesh(model)), w));
  COROT_TRY(find_parts(model, w));
  COROT_TRY(find_probes(s, corot_model_mesh(model), w));
  if (!statics) COROT_TRY(warnings_find_integrator(s, model, w));
  return warnings_find_rtol(s, model, EXPECTED_DISPLACEMENT * corot_model_length(model), w);
}

/* Probes: what a scenario asks to be recorded of the motion, as columns of numbers. They are
   evaluated at the end of every step, and at every output time. */
#ifndef COROT_APP_PROBE_PROBE_H
#define COROT_APP_PROBE_PROBE_H

#include <jansson.h>

#include "core/base/pack.h"
#include "probe_moment.h"

typedef struct probes probes;

/* The scenario and the model must outlive them. COROT_EINVAL: a probe does not fit the mesh.
   COROT_ENOMEM. */
corot_status probes_create(const scenario *s, const corot_model *model, probes **out);

/* Takes NULL. */
void probes_destroy(probes *p);

/* Columns, in the order of the scenario: "corner.ux", "corner.uy", ... Names [ncolumn] and units
   live as long as the probes; a unit is "" for a pure number. */
int probes_ncolumn(const probes *p);
const char *const *probes_columns(const probes *p);
const char *probes_unit(const probes *p, int i);

/* What is known of one probe, i = 0 to probes_n - 1. */
typedef struct probe_facts {
  const char *name;
  int first, ncolumn; /* its columns */
  const char *length; /* of a vector, what its length is called, as "u"; else NULL */
  bool moves;         /* its columns are a displacement */
} probe_facts;

int probes_n(const probes *p);
probe_facts probes_known(const probes *p, int i);

/* Of column c of probe i when it was last evaluated; not known where it is no extreme. */
probe_where probes_where(const probes *p, int i, int c);

/* Writes or reads what probes_where() says. */
void probes_exchange(pack *p, probes *all);
void probe_where_exchange(pack *p, probe_where *where);

/* {"node" or "tet", "x"}; NULL: no memory. */
json_t *probe_where_json(const probe_where *where);

/* {NAME: {...}, ...} of the values [ncolumn] and velocities [nnode] of a moment. Of a displacement
   at a point or node: "node" (null: between nodes, then "tet" and "x"), "u", "v"; of others "of",
   "take", "group" where they are said, "value": {COMPONENT: number}, and "at": {COMPONENT:
   probe_where_json} of an extreme of the last evaluation. The caller's; NULL: no memory. */
json_t *probes_json(const probes *p, const double *value, const double (*velocity)[3]);

/* rate [ncolumn]: the columns' derivatives by time, of displacements at a point or node, from the
   velocity of all nodes [nnode]; NaN of all others. */
void probes_rates(const probes *p, const double (*velocity)[3], double *rate);

/* value [ncolumn] of a moment. COROT_RETRY: a tet is inverted, of whose stress or force a probe is.
 */
corot_status probes_evaluate(probes *p, const probe_moment *now, double *value);

/* goal [ndof] = the derivative of column i by the displacement of what is free, at the moment that
   was evaluated last: what corot_space_indicators weighs by. *known: there is one. Of a
   displacement, its component or length, at a point, over a group or the body, by any take (an
   extreme is that of the node where it was); velocities and accelerations have the weights of the
   displacement in their direction. Of what tets have, as a stress, at a point or a node, and of its
   extremes: by differences over the nodes of the tets there, which leaves out those by which an
   averaged dilatation reaches further. Of means and sums over many tets, of forces, energies and
   momenta it is not known, and goal zero: there the energy is as good a guide. COROT_RETRY as
   above; COROT_ENOMEM. */
corot_status probes_goal(probes *p, const probe_moment *now, int i, double *goal, bool *known);

#endif

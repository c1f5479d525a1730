/* Where a probe of a point or a node is. */
#ifndef COROT_APP_SCENARIO_PROBE_LOCATION_H
#define COROT_APP_SCENARIO_PROBE_LOCATION_H

#include "scenario.h"

/* Of neither a group nor the whole body. */
static inline bool probe_is_local(const probe_def *p) { return !p->group && !p->body; }

/* Whether it is a displacement at a point or a node: what a probe is that says nothing else. */
static inline bool probe_is_plain(const probe_def *p) {
  return probe_is_local(p) && p->of == PROBE_DISPLACEMENT && p->component == 0;
}

/* Of a local probe. `distance` is that from the point, which may be outside, or have been moved to
   a node. COROT_EINVAL: there is no such node. COROT_ENOMEM. */
corot_status probe_locate(const probe_def *p, const corot_mesh *mesh, corot_location *location);

/* A distance that is no more than rounding in how a point was typed [m]. */
double probe_rounding(const corot_mesh *mesh);

#endif

/* From a probe's point or node to its place in the mesh. */
#include "probe_location.h"

#include <math.h>

#include "core/mesh/mesh.h"

static corot_location locate_nearest(const probe_def *p, const corot_mesh *mesh) {
  corot_location at = corot_mesh_locate_node(mesh, corot_mesh_nearest(mesh, p->point));
  double square = 0;
  for (int c = 0; c < 3; c++) square += (at.x[c] - p->point[c]) * (at.x[c] - p->point[c]);
  at.distance = sqrt(square);
  return at;
}

corot_status probe_locate(const probe_def *p, const corot_mesh *mesh, corot_location *location) {
  if (p->node >= mesh->nnode)
    return corot_fail(COROT_EINVAL, "probe %s: node %d; the mesh's nodes are 0 to %d", p->name,
                      p->node, mesh->nnode - 1);
  if (p->node < 0 && !p->nearest) return corot_mesh_locate(mesh, p->point, location);
  *location = p->node < 0 ? locate_nearest(p, mesh) : corot_mesh_locate_node(mesh, p->node);
  return COROT_OK;
}

double probe_rounding(const corot_mesh *mesh) {
  double min[3], max[3];
  corot_mesh_bounds(mesh, min, max);
  return 1e-6 * hypot(hypot(max[0] - min[0], max[1] - min[1]), max[2] - min[2]);
}

/* What a definition must be like, whatever the mesh: the rules that creation refuses by, each once,
   with a fault (core/base/fault.h). Whoever reads definitions from files looks by them before there
   is a mesh. */
#ifndef COROT_CORE_MODEL_DEFINITION_H
#define COROT_CORE_MODEL_DEFINITION_H

#include <corot/model.h>

/* What the coefficients of a material must be, OF(FIELD, RANGE) each: for the core, which refuses
   others, and for whoever documents the files that they come from. */
#define COROT_MATERIAL_RANGES(OF)  \
  OF(mu, POSITIVE)                 \
  OF(density, POSITIVE)            \
  OF(damping_lambda, NOT_NEGATIVE) \
  OF(damping_mu, NOT_NEGATIVE)     \
  OF(damping_mass, NOT_NEGATIVE)

/* All of the definition but its mesh and the refinement of its hierarchy, in whose place stands
   `nlevel`, the levels under the finest one. COROT_EINVAL. */
corot_status corot_definition_check(const corot_model_def *def, int nlevel);

/* Its parts: entry k of a list, and how it goes with the entries before it. */
corot_status corot_material_check(const corot_model_def *def, int k);
corot_status corot_motion_check(const corot_model_def *def, int k);
corot_status corot_load_check(const corot_model_def *def, int k);

/* The group that entry `index` of the list `entry` names; _nodes: which must have some.
   COROT_EINVAL with a fault in the entry's field "group". */
corot_status corot_definition_group(const corot_mesh *mesh, const char *entry, int index,
                                    const char *name, const corot_group **group);
corot_status corot_definition_nodes(const corot_mesh *mesh, const char *entry, int index,
                                    const char *name, const corot_group **group);

#endif

/* The error of the meshes of a study that varies mesh.refine. */
#ifndef COROT_STUDY_MEASURE_COLLECT_SPACE_H
#define COROT_STUDY_MEASURE_COLLECT_SPACE_H

#include "collect_measure.h"
#include "collect_rows.h"

/* What references of neighbouring mesh.refine say of the meshes: a list, the caller's. */
corot_status collect_space(measuring *g, const table_reference *reference, json_t **out);

#endif

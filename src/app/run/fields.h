/* The fields of a run (write_vtu.h) as a writer, and with them the groups that supports and loads
   act on (write_groups.h). */
#ifndef COROT_APP_RUN_FIELDS_H
#define COROT_APP_RUN_FIELDS_H

#include "writer.h"

extern const writer_ops fields_writer;

/* material [ntet]: the entry of the scenario's list that fills each tet. */
void fields_number_materials(const corot_model_def *def, const corot_mesh *mesh, int *material);

#endif

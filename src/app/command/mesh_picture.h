/* A mesh as a picture: its surface from two opposite sides, groups in colours. */
#ifndef COROT_APP_COMMAND_MESH_PICTURE_H
#define COROT_APP_COMMAND_MESH_PICTURE_H

#include "mesh_facts.h"

/* SVG, and a page of HTML that has it and the facts in it. `what` is a mesh_facts; errors of the
   stream are left in it. COROT_ENOMEM. */
corot_status mesh_picture_svg(const void *what, FILE *out);
corot_status mesh_picture_html(const void *what, FILE *out);

#endif

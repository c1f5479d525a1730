/* Tets to be cut, in a text file. Each line is a pass: the numbers, from 0, of the tets to be cut
   in the mesh that the passes before it have made, with blanks between them. # begins a comment;
   lines without a number are no passes. */
#ifndef COROT_APP_SCENARIO_MARKS_FILE_H
#define COROT_APP_SCENARIO_MARKS_FILE_H

#include <corot/mesh.h>

/* Replaces the mesh by what it becomes when all passes are carried out by corot_mesh_refine_marked.
   COROT_EIO: there is no such file. COROT_EFORMAT: a message with the file's line and column. */
corot_status marks_file_apply(const char *path, corot_mesh **mesh);

#endif

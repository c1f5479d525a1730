/* groups.json: the nodes and faces of the groups that supports and loads name, for whoever draws
   them on the body:

     {"NAME": {"nodes": [n, ...], "faces": [[a, b, c], ...]}, ...}

   by the numbers of the mesh that the fields stand on; faces of the boundary wind outward. What is
   done to a group is said by the scenario in result.json. */
#ifndef COROT_APP_FOLDER_WRITE_GROUPS_H
#define COROT_APP_FOLDER_WRITE_GROUPS_H

#include <corot/mesh.h>
#include <jansson.h>

/* Writes DIR/groups.json. `resolved` is the scenario with all its groups in the mesh. */
corot_status groups_write(const char *dir, const json_t *resolved, const corot_mesh *mesh);

#endif

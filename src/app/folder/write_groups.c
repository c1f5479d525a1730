/* The groups that supports and loads act on, as a file of a run's folder. */
#include "write_groups.h"

#include <stdlib.h>
#include <string.h>

#include "app/text/json_text.h"
#include "folder.h"

static json_t *nodes_of(const corot_group *g) {
  json_t *list = json_array();
  for (int i = 0; list && i < g->nnode; i++) {
    if (json_array_append_new(list, json_integer(g->node[i])) == 0) continue;
    json_decref(list);
    list = NULL;
  }
  return list;
}

static json_t *faces_of(const corot_group *g) {
  json_t *list = json_array();
  for (int i = 0; list && i < g->ntri; i++) {
    const int *n = g->tri[i];
    if (json_array_append_new(list, json_pack("[i, i, i]", n[0], n[1], n[2])) == 0) continue;
    json_decref(list);
    list = NULL;
  }
  return list;
}

/* Adds the groups that the maps of a list name, and hands `groups` on; NULL: no memory. */
static json_t *add_groups(json_t *groups, const json_t *list, const corot_mesh *mesh) {
  for (size_t i = 0; groups && i < json_array_size(list); i++) {
    const char *name = json_string_value(json_object_get(json_array_get(list, i), "group"));
    const corot_group *g = name ? corot_mesh_find_group(mesh, name) : NULL;
    if (!g || json_object_get(groups, name)) continue;
    json_t *entry = json_text_with(json_object(), "nodes", nodes_of(g));
    groups = json_text_with(groups, name, json_text_with(entry, "faces", faces_of(g)));
  }
  return groups;
}

corot_status groups_write(const char *dir, const json_t *resolved, const corot_mesh *mesh) {
  json_t *groups = add_groups(json_object(), json_object_get(resolved, "boundary"), mesh);
  groups = add_groups(groups, json_object_get(resolved, "loads"), mesh);
  char *path = folder_path(dir, "groups.json");
  char *text = groups ? json_text_dump_plain(groups, JSON_COMPACT) : NULL;
  corot_status status = text && path
                            ? file_replace_durably(path, text, strlen(text))
                            : corot_fail(COROT_ENOMEM, "%s/groups.json: out of memory", dir);
  json_decref(groups);
  free(text);
  free(path);
  return status;
}

/* Finds the key of a scenario that an entry and a field of a definition come from. */
#include "scenario_fault.h"

#include "app/text/suggest.h"
#include "core/base/fault.h"
#include "curve_file.h"
#include "scenario_parts.h"

/* --- Groups --- */

/* Of two names that were meant, the nearer to what is typed; `near` may be NULL. */
static const char *nearer(const char *typed, const char *near, const char *name) {
  int distance = suggest_distance(typed, name), most = near ? suggest_distance(typed, near) : 4;
  return distance < most && 2 * distance <= (int)strlen(name) ? name : near;
}

static void list_names(const corot_mesh *mesh, size_t size, char *list) {
  size_t used = 0;
  for (int i = 0; i < mesh->ngroup; i++) {
    const char *name = mesh->group[i].name;
    bool fits = used + strlen(name) + sizeof ", , ..." < size;
    used += (size_t)snprintf(list + used, size - used, "%s%s", i ? ", " : "", fits ? name : "...");
    if (!fits) return;
  }
}

static corot_status refuse_name(const config_node *node, const corot_mesh *mesh, const char *near) {
  char list[256] = "none";
  for (int i = 0; i < mesh->ngroup; i++) near = nearer(node->text, near, mesh->group[i].name);
  list_names(mesh, sizeof list, list);
  if (near) return config_fail(node, "no group %.64s; did you mean %s?", node->text, near);
  return config_fail(node, "no group %.64s; there are: %s", node->text, list);
}

corot_status scenario_unknown_group(const config_node *node, const corot_mesh *mesh) {
  return refuse_name(node, mesh, NULL);
}

corot_status scenario_unknown_other(const scenario *s, const config_node *node,
                                    const corot_mesh *mesh) {
  const char *near = NULL;
  for (int i = 0; i < s->ngroup; i++) near = nearer(node->text, near, s->group[i].name);
  return refuse_name(node, mesh, near);
}

/* --- Places --- */

/* Fields that have another name in a scenario; of several keys the first that is there. */
static const struct {
  const char *field, *key;
  bool whole; /* the message points at the key: all of its value is meant */
} keys[] = {
    {.field = "damping_lambda", .key = "damping.lambda"},
    {.field = "damping_mu", .key = "damping.mu"},
    {.field = "damping_mass", .key = "damping.mass"},
    {.field = "amplitude", .key = "amplitude.smooth"},
    {.field = "amplitude.time", .key = "amplitude.smooth"},
    {.field = "amplitude.time", .key = "amplitude"},
    {.field = "amplitude.time", .key = "values"},
    {.field = "amplitude.frequency", .key = "amplitude.sine.frequency"},
    {.field = "amplitude.phase", .key = "amplitude.sine.phase"},
    {.field = "conservative", .key = "force"},
    {.field = "dilatation", .key = "dilatation.name"},
    {.field = "dilatation_local", .key = "dilatation.local"},
    {.field = "kind", .key = "pressure"},
    {.field = "value", .key = "traction"},
    {.field = "value", .key = "gravity"},
    {.field = "value", .key = "force"},
    {.field = "value", .key = "pressure"},
    {.field = "", .key = "rotate"},
    {.field = "", .key = "translate"},
    {.field = "", .key = "move"},
    {.field = "fix", .key = "boundary", .whole = true},
    {.field = "material", .key = "material", .whole = true},
};

/* The maps of a condition whose keys are a motion's fields. */
static const char *const inside[] = {"", "rotate.", "translate.", "move.rotate.", "move."};

static config_node *find_key(config_node *entry, const char *key) {
  config_node *found = NULL;
  for (size_t i = 0; !found && i < sizeof inside / sizeof *inside; i++) {
    char path[64];
    snprintf(path, sizeof path, "%s%s", inside[i], key);
    found = config_find(entry, path);
  }
  return found;
}

/* Entry `index` of those in `list`: of boundary, of the maps that fix or of those that do not. */
static config_node *find_entry(config_node *list, int index, const char *entry) {
  bool fix = strcmp(entry, "fix") == 0, motion = strcmp(entry, "motion") == 0;
  bool named = strcmp(entry, "input") == 0;
  config_node *c = list->kind == CONFIG_LIST || named ? list->child : NULL;
  for (; c; c = c->next) {
    bool fixes = config_find(c, "fix") != NULL;
    if ((fix && !fixes) || (motion && fixes)) continue;
    if (index-- == 0) return c;
  }
  return list; /* of a material that stands alone */
}

static config_node *entry_of(const scenario *s, const char *entry, int index) {
  static const struct {
    const char *entry, *key;
  } lists[] = {{"material", "material"}, {"fix", "boundary"}, {"motion", "boundary"},
               {"load", "loads"},        {"input", "inputs"}, {"hierarchy", "hierarchy"}};
  config_node *root = s->source->root;
  for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
    if (strcmp(lists[i].entry, entry) == 0)
      return find_entry(config_find(root, lists[i].key), index, entry);
  return root;
}

/* The node of a field, or the entry if it is not there; *whole as in the table. */
static config_node *field_of(config_node *entry, const char *field, bool *whole) {
  config_node *found = NULL;
  for (size_t i = 0; !found && i < sizeof keys / sizeof *keys; i++) {
    if (strcmp(keys[i].field, field) != 0) continue;
    found = find_key(entry, keys[i].key);
    *whole = keys[i].whole;
  }
  if (!found && *field) found = find_key(entry, field);
  return found ? found : entry;
}

/* --- Messages --- */

/* At a point of an amplitude: in the list, or in the file that stands for it. */
static corot_status fail_at_point(const scenario *s, config_node *points, int point,
                                  const char *reason) {
  const config_node *file = config_find(points, "file"), *c = points->child;
  if (file) return curve_file_fail(s->source, file, s->path, point, reason);
  while (point-- > 0) c = c->next;
  return config_fail(c->child, "%s", reason);
}

corot_status scenario_told(const scenario *s, const corot_mesh *mesh, corot_status status) {
  corot_fault f = corot_fault_last();
  char reason[700], other[96] = "";
  bool whole = false;
  if (status == COROT_OK || status == COROT_ENOMEM) return status;
  if (!f.entry) return config_fail_key(entry_of(s, "material", -1), "%s", corot_error());

  /* the reason alone, and what it does not go with in the scenario's words */
  if (f.other) {
    char path[64];
    config_path(entry_of(s, f.other, f.other_index), sizeof path, path);
    snprintf(other, sizeof other, "; see %s", path);
  }
  snprintf(reason, sizeof reason, "%.*s%s", f.length < 600 ? f.length : 600, f.reason, other);

  /* where it stands */
  config_node *node = field_of(entry_of(s, f.entry, f.index), f.field, &whole);
  if (strcmp(f.field, "amplitude.time") == 0) return fail_at_point(s, node, f.point, reason);
  bool group = mesh && strcmp(f.field, "group") == 0 && node->kind == CONFIG_SCALAR;
  if (group && !corot_mesh_find_group(mesh, node->text)) return scenario_unknown_group(node, mesh);
  return whole ? config_fail_key(node, "%s", reason) : config_fail(node, "%s", reason);
}

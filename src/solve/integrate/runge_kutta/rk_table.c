/* Butcher tables by name or order. */
#include <stdio.h>
#include <string.h>

#include "runge_kutta.h"

static const rk_table *named(const rk_table *tables, const char *name) {
  for (; tables->name; tables++)
    if (strcmp(tables->name, name) == 0) return tables;
  return NULL;
}

int corot_rk_order(const char *name, const rk_table *tables) {
  const rk_table *table = named(tables, name);
  return table ? table->order : 0;
}

const rk_table *corot_rk_find(const corot_integrator_def *def, const rk_table *mine) {
  if (def->table) {
    mine = named(mine, def->table);
    return mine && (def->order == 0 || def->order == mine->order) ? mine : NULL;
  }
  for (; mine->name; mine++)
    if (mine->order == def->order) return mine;
  return NULL;
}

/* Appends what fits. */
static void append(char *text, size_t size, const char *what) {
  size_t length = strlen(text);
  snprintf(text + length, size - length, "%s%s", length ? ", " : "", what);
}

static void list(const rk_table *tables, bool names, char *text, size_t size) {
  text[0] = 0;
  for (int last = 0; tables->name; last = tables->order, tables++) {
    char order[16];
    snprintf(order, sizeof order, "%d", tables->order);
    if (names || tables->order != last) append(text, size, names ? tables->name : order);
  }
}

corot_status corot_rk_refuse(const corot_integrator *self, const rk_table *mine,
                             const rk_table *others, const char *others_are) {
  const corot_integrator_def *d = &self->def;
  const char *method = self->ops->kind.name;
  char there_are[900];
  if (!d->table) {
    list(mine, false, there_are, sizeof there_are);
    return corot_fail(COROT_EINVAL, "%s: no table of order %d: there are orders %s (0: choose)",
                      method, d->order, there_are);
  }
  const rk_table *table = named(mine, d->table);
  if (table)
    return corot_fail(COROT_EINVAL, "%s: table %s is of order %d, not %d", method, d->table,
                      table->order, d->order);
  if (named(others, d->table))
    return corot_fail(COROT_EINVAL, "%s: table %s is %s", method, d->table, others_are);
  list(mine, true, there_are, sizeof there_are);
  return corot_fail(COROT_EINVAL, "%s: no table '%s': %s", method, d->table, there_are);
}

/* Takes a unit apart, symbol by symbol. */
#include "units.h"

#include <stdlib.h>
#include <string.h>

const char *const unit_bases[UNIT_BASES] = {"kg", "m", "s", "rad"};

static const struct {
  const char *symbol;
  int power[UNIT_BASES];
} symbols[] = {
    {"1", {0}},
    {"kg", {[UNIT_KG] = 1}},
    {"m", {[UNIT_M] = 1}},
    {"s", {[UNIT_S] = 1}},
    {"rad", {[UNIT_RAD] = 1}},
    {"N", {[UNIT_KG] = 1, [UNIT_M] = 1, [UNIT_S] = -2}},
    {"Pa", {[UNIT_KG] = 1, [UNIT_M] = -1, [UNIT_S] = -2}},
    {"J", {[UNIT_KG] = 1, [UNIT_M] = 2, [UNIT_S] = -2}},
};

/* The symbol of that length, or NULL. */
static const int *find(const char *text, size_t length) {
  for (size_t i = 0; i < sizeof symbols / sizeof *symbols; i++)
    if (strlen(symbols[i].symbol) == length && strncmp(symbols[i].symbol, text, length) == 0)
      return symbols[i].power;
  return NULL;
}

bool unit_powers(const char *unit, int power[UNIT_BASES]) {
  int sign = 1;
  memset(power, 0, UNIT_BASES * sizeof *power);
  while (*unit) {
    size_t length = strcspn(unit, " /^");
    const int *of = find(unit, length);
    if (!of) return false;
    char *end = (char *)unit + length;
    long times = *end == '^' ? strtol(end + 1, &end, 10) : 1;
    for (int k = 0; k < UNIT_BASES; k++) power[k] += sign * (int)times * of[k];
    if (*end && *end != ' ' && *end != '/') return false;
    if (*end == '/') sign = -1;
    unit = *end ? end + 1 : end;
  }
  return true;
}

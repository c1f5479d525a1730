/* One table for who cleans a folder, who vouches for it, and who asks whose it is. */
#include "inventory.h"

#include <stdlib.h>
#include <string.h>

const inventory_file inventory[INVENTORY_SIZE] = {
    /* name                writer       cleaned listed */
    {"result.json", "run", true, false},      {"result.json.tmp", "run", false, false},
    {CHECKPOINT_NAME, "run", true, false},    {CHECKPOINT_NAME ".tmp", "run", false, false},
    {"probes.csv", "run", true, true},        {"energy.csv", "run", true, true},
    {"steps.csv", "run", true, true},         {"history.csv", "run", true, true},
    {"compare.csv", "run", true, true},       {"reactions.csv", "static", true, true},
    {"modes.csv", "modes", true, true},       {"groups.json", "run", true, true},
    {"groups.json.tmp", "run", false, false}, {"states.bin", "run", true, true},
    {"fields.pvd", "run", true, true},        {INVENTORY_FIELDS "/frame.tmp", "run", false, false},
    {"report.html", "report", true, false},
};

bool inventory_is_frame(const char *name) {
  if (strncmp(name, "fields_", 7) != 0) return false;
  size_t digits = strspn(name + 7, "0123456789");
  return digits > 0 && strcmp(name + 7 + digits, ".vtu") == 0;
}

long inventory_frame(const char *name) { return strtol(name + 7, NULL, 10); }

/* `corot plot`, which draws tables, of a study that has none yet. */
#include <corot/base.h>
#include <stdbool.h>

#include "app/command/cli.h"
#include "command_folder.h"
#include "command_study.h"
#include "report/command/commands.h"
#include "report/command/report.h"

/* Whether a folder is that of a study that has been cut off, or still runs, and so has no table. */
static bool lacks_table(const char *dir) {
  bool planned = false, table = true;
  return report_has(dir, "study.json", &planned) == COROT_OK && planned &&
         report_has(dir, "table.json", &table) == COROT_OK && !table;
}

int command_study_plot(int argc, char **argv) {
  for (int i = 1; i < argc; i++) {
    int ndamaged;
    if (argv[i][0] == '-' || !lacks_table(argv[i])) continue;
    corot_status status = study_collect(argv[i], &ndamaged);
    if (status != COROT_OK) return failure(status);
  }
  return command_plot(argc, argv);
}

/* `corot report`: the page of a folder. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/command/cli.h"
#include "app/folder/folder.h"
#include "app/folder/folder_owner.h"
#include "app/text/say.h"
#include "commands.h"
#include "report.h"

static const char help[] =
    "usage: corot report DIR [-o FILE.html] [--force]\n"
    "\n"
    "Writes one HTML file that shows the run, the study, the error budget or the answer of\n"
    "corot solve in DIR: a summary, charts that can be zoomed into, and, of a run with fields, "
    "the\n"
    "moving body to turn and play. Any browser opens it, from the disk and without a network. Its "
    "name\n"
    "goes to stdout.\n"
    "\n"
    "  -o, --output FILE    default: DIR/report.html\n"
    "      --force          replaces a file that corot has not written, too\n"
    "\n"
    "example: corot report out/bar\n";

static const struct option options[] = {
    {"output", required_argument, NULL, 'o'},
    {"force", no_argument, NULL, 'f'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

int command_report(int argc, char **argv) {
  const char *output = NULL;
  bool force = false;
  opterr = 0;
  for (int answer; (answer = getopt_long(argc, argv, ":o:h", options, NULL)) != -1;) {
    if (answer == 'h') return fputs(help, stdout), EXIT_OK;
    if (answer == 'f') {
      force = true;
      continue;
    }
    if (answer != 'o') return option_error("corot report", answer, argv, options);
    output = optarg;
  }
  if (argc - optind != 1)
    return usage_error("corot report", "expected one folder, found %d", argc - optind);
  if (output && !*output) return usage_error("corot report", "--output: the name is empty");
  /* the page, beside the results unless another place is named */
  char *path = output ? NULL : folder_path(argv[optind], "report.html");
  if (!output && !path) return failure(COROT_ENOMEM);
  if (!output) output = path;
  corot_status status = force ? COROT_OK : file_permit(output, FOLDER_PAGE_MARK);
  if (status == COROT_OK) status = report_write(argv[optind], output);
  if (status == COROT_OK) show("%s\n", output);
  free(path);
  return status == COROT_OK ? EXIT_OK : failure(status);
}

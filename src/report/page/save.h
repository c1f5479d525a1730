/* Files that appear as a whole. */
#ifndef COROT_REPORT_PAGE_SAVE_H
#define COROT_REPORT_PAGE_SAVE_H

#include <corot/base.h>
#include <stdio.h>

/* What writes the text; errors of the stream are left in it. */
typedef corot_status save_writer(const void *what, FILE *out);

/* Puts what `write` makes of `what` in place at `path`, by way of PATH.tmp; nothing where
   `write` fails. */
corot_status save_text(const char *path, save_writer *write, const void *what);

#endif

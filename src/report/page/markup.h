/* Text for SVG and HTML, by way of app/text/escape.h. */
#ifndef COROT_REPORT_PAGE_MARKUP_H
#define COROT_REPORT_PAGE_MARKUP_H

#include <stdio.h>

/* Writes text that may stand between tags and in attributes: & < > " ' are escaped; control
   characters and bytes that are not UTF-8 become '?'. NULL writes nothing. Errors are left in the
   stream. */
void markup_text(FILE *out, const char *text);

/* The same of at most `most` characters, of which the last is then an ellipsis. */
void markup_text_cut(FILE *out, const char *text, int most);

/* Characters, not bytes. */
int markup_length(const char *text);

#endif

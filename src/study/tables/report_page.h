/* The page to look at, once a study or a budget is there. */
#ifndef COROT_STUDY_TABLES_REPORT_PAGE_H
#define COROT_STUDY_TABLES_REPORT_PAGE_H

#include <corot/base.h>
#include <stdbool.h>

/* Makes DIR/report.html and, unless `quiet`, tells its name on stderr. */
corot_status study_page(const char *dir, bool quiet);

#endif

/* The report of a run. */
#ifndef COROT_REPORT_RUN_REPORT_RUN_H
#define COROT_REPORT_RUN_REPORT_RUN_H

#include <corot/base.h>

corot_status report_run(const char *dir, const char *path);

#endif

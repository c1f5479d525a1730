/* The report of a study. */
#ifndef COROT_REPORT_STUDY_REPORT_STUDY_H
#define COROT_REPORT_STUDY_REPORT_STUDY_H

#include <corot/base.h>

corot_status report_study(const char *dir, const char *path);

#endif

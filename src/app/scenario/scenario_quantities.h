/* What is wrong with a quantity of a scenario, told with its place. */
#ifndef COROT_APP_SCENARIO_SCENARIO_QUANTITIES_H
#define COROT_APP_SCENARIO_SCENARIO_QUANTITIES_H

#include "scenario.h"

/* COROT_EFORMAT: corot_error() is the reason, and stands at place `at` of its text. */
corot_status scenario_quantity_fail(const quantity_def *q, size_t at);

#endif

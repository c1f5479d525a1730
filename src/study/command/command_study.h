/* The commands `corot study`, `corot budget`, `corot find-limit` and `corot solve`. */
#ifndef COROT_STUDY_COMMAND_COMMAND_STUDY_H
#define COROT_STUDY_COMMAND_COMMAND_STUDY_H

int command_study(int argc, char **argv);

/* corot plot, of a study that may have no table yet. */
int command_study_plot(int argc, char **argv);
int command_budget(int argc, char **argv);
int command_find_limit(int argc, char **argv);
int command_solve(int argc, char **argv);

#endif

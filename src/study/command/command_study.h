/* The commands `corot study`, `corot budget` and `corot find-limit`. */
#ifndef COROT_STUDY_COMMAND_COMMAND_STUDY_H
#define COROT_STUDY_COMMAND_COMMAND_STUDY_H

int command_study(int argc, char **argv);

/* corot plot, of a study that may have no table yet. */
int command_study_plot(int argc, char **argv);
int command_budget(int argc, char **argv);
int command_find_limit(int argc, char **argv);

#endif

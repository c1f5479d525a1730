/* The command `corot study`. */
#ifndef COROT_STUDY_COMMAND_STUDY_H
#define COROT_STUDY_COMMAND_STUDY_H

int command_study(int argc, char **argv);

#endif

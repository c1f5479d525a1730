/* The commands about a study's folder: what `corot study` knows beside running one. */
#ifndef COROT_STUDY_COMMAND_COMMAND_FOLDER_H
#define COROT_STUDY_COMMAND_COMMAND_FOLDER_H

#include <corot/base.h>

int command_study_status(int argc, char **argv);
int command_study_collect(int argc, char **argv);
int command_study_table(int argc, char **argv);
int command_study_csv(int argc, char **argv);
int command_study_export(int argc, char **argv);
int command_study_schema(int argc, char **argv);

/* The tables of a folder anew, by its own study.json, of the runs there are now; as write_tables.h
   says, with its remarks on stderr. */
corot_status study_collect(const char *dir, int *ndamaged);

#endif

/* The commands that draw what runs and studies found. See cli.h. */
#ifndef COROT_REPORT_COMMAND_COMMANDS_H
#define COROT_REPORT_COMMAND_COMMANDS_H

int command_plot(int argc, char **argv);
int command_report(int argc, char **argv);

#endif

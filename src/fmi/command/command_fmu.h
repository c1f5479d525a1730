/* The command of this storey. */
#ifndef COROT_FMI_COMMAND_COMMAND_FMU_H
#define COROT_FMI_COMMAND_COMMAND_FMU_H

int command_export_fmu(int argc, char **argv);

#endif

/* Exit codes of the program. */
#ifndef COROT_APP_RUN_EXIT_CODE_H
#define COROT_APP_RUN_EXIT_CODE_H

enum {
  EXIT_OK = 0,
  EXIT_CHECK = 1,      /* finished, but a check failed */
  EXIT_USAGE = 2,      /* the command line makes no sense */
  EXIT_SCENARIO = 3,   /* bad scenario or mesh, or there is none */
  EXIT_INTEGRATOR = 4, /* the integrator gave up */
  EXIT_SYSTEM = 5,     /* the system refused memory, reading or writing */
  EXIT_SIGNAL = 128,   /* and the number of the signal that ended a run */
};

#endif

/* What signals are to do when the program begins, whatever libraries make of them as they are
   loaded. */
#ifndef COROT_MAIN_FIRST_SIGNALS_H
#define COROT_MAIN_FIRST_SIGNALS_H

/* Puts SIGHUP and the signals of faults back to what they were before any library began. Call this
   first in main. In a build with sanitizers, whose handlers these may be, nothing happens. */
void first_signals_restore(void);

#endif

/* What the program says when a fault inside it, or inside a library, ends it. */
#ifndef COROT_MAIN_CRASH_H
#define COROT_MAIN_CRASH_H

/* From now on SIGSEGV, SIGBUS, SIGFPE, SIGILL and SIGABRT are told in one line on standard error,
   with the library the fault is in; then whoever handled the signal before has it, so that the exit
   status and the core dump are those of a program without this. Call this once, from main, while
   there is one thread. A library that is loaded later is not known by name. In a build with
   sanitizers, which say more, nothing happens. */
void crash_watch(void);

#endif

/* A process that stands for the program before it has looked at its arguments, and copies itself
   for each run. Loading the program with its libraries takes longer than a short run does: so it is
   done once.

   Copies are children of the process that asked for them, which waits for them and kills them as it
   does with any others; their memory is that of a process that has just begun. Linux only;
   elsewhere there is no template. */
#ifndef COROT_STUDY_EXECUTE_TEMPLATE_H
#define COROT_STUDY_EXECUTE_TEMPLATE_H

#include <signal.h>
#include <stdbool.h>
#include <sys/types.h>

/* Call this at the start of main(). In a template it returns in its copies only, with the arguments
   of each; elsewhere at once, and templates of this program can be started from then on. */
void template_serve(int *argc, char ***argv);

/* What a new process has to do before it is a run: it dies with `parent`, reads nothing, prints to
   the file `messages`, and gets SIGALRM after `timeout` seconds (0: never) and every few seconds
   from then on. */
void template_become(pid_t parent, const char *messages, double timeout);

/* Starts the template, unless there is one; false: there can be none. Block signals meanwhile; it
   has those of `mask` blocked. heed() is called in it first. */
bool template_start(void (*heed)(void), const sigset_t *mask);

/* A copy with those arguments. -1: none was made, and there is no template any more. */
pid_t template_copy(const char *const *argv, const char *messages, double timeout);

/* Ends the template, if there is one. Its copies go on. */
void template_stop(void);

#endif

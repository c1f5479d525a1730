/* Threads that work on one evaluation together. Who shares a loop out cuts it into parts, none of
   which needs another: they may run at the same time, or one after the other in any order, and what
   comes out is the same to the last bit.

   Why not OpenMP: GCC's ends the process where a thread cannot be started, a copy of the process
   made by fork() waits for ever in it, and ThreadSanitizer does not see its barriers. */
#ifndef COROT_CORE_BASE_TEAM_H
#define COROT_CORE_BASE_TEAM_H

#include <corot/base.h>
#include <stddef.h>

#include "sisters.h"

enum { TEAM_MOST = 256 }; /* threads; as COROT_MOST_THREADS */

typedef struct team team;

/* Does part `part` of some work. */
typedef void team_part(void *work, int part);

/* Of a host: does all parts of some work from 0 to nparts - 1; see corot_state_parallel. */
typedef void team_host(void *host, int nparts, team_part *part, void *work);

/* A team of n threads, 1 <= n <= TEAM_MOST: n - 1 of its own, and whoever calls team_run.
   COROT_ENOMEM: a thread could not be started. */
corot_status corot_team_create(int n, team **t);

/* The same where a host has the parts done. */
corot_status corot_team_of_host(int n, team_host *run, void *host, team **t);

/* Takes NULL. */
void corot_team_destroy(team *t);

/* Among how many the work is shared; 1 of NULL. */
COROT_SISTERS int corot_team_size(const team *t);

/* All parts from 0 to nparts - 1; returns when they are done. A team works for one caller at a
   time. NULL, and what a copy made by fork() has of a team: one part after the other. */
COROT_SISTERS void corot_team_run(team *t, int nparts, team_part *part, void *work);

/* A part of a loop. */
typedef void team_loop(void *work, int from, int end);

/* A loop from 0 to count, in as many parts as the team has threads; each must write elsewhere. */
COROT_SISTERS void corot_team_loop(team *t, int count, team_loop *loop, void *work);

/* Where part k of n begins in a loop from 0 to count; part n begins at the end. */
static inline int team_share(int count, int n, int k) { return (int)((long long)count * k / n); }

#endif

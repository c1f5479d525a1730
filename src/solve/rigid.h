/* Rigid motions that nothing holds. */
#ifndef COROT_SOLVE_RIGID_H
#define COROT_SOLVE_RIGID_H

#include <corot/model.h>

/* COROT_ESINGULAR if the body, or a part of it that shares no node with the rest, has a rigid
   motion that no support hinders, however small; the message names it. */
corot_status corot_rigid_check(const corot_model *model);

#endif

/* The words of a scenario for what the library numbers. Each list is indexed by the enumerators and
   ends with NULL. */
#ifndef COROT_APP_SCENARIO_WORDS_H
#define COROT_APP_SCENARIO_WORDS_H

extern const char *const words_box_split[];      /* corot_box_split */
extern const char *const words_length[];         /* units of length */
extern const char *const words_diagonal[];       /* corot_diagonal */
extern const char *const words_viscosity[];      /* corot_viscosity */
extern const char *const words_mass[];           /* corot_mass */
extern const char *const words_dilatation[];     /* corot_dilatation */
extern const char *const words_coupling[];       /* corot_coupling */
extern const char *const words_load[];           /* corot_load_kind: the keys of loads */
extern const char *const words_solution[];       /* corot_solution */
extern const char *const words_tangent[];        /* corot_tangent, but for auto */
extern const char *const words_frame_history[];  /* corot_history */
extern const char *const words_statics_frames[]; /* corot_frames, as statics know them */

/* The number of a word in such a list; -1: it is not there. */
int words_find(const char *const *words, const char *word);

/* One of words_length [m]. */
double length_in_metres(int unit);

#endif

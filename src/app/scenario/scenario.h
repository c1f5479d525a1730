/* A scenario: what a YAML or JSON file says about one run, with every default filled in. */
#ifndef COROT_APP_SCENARIO_SCENARIO_H
#define COROT_APP_SCENARIO_SCENARIO_H

#include <corot/integrate.h>
#include <corot/statics.h>
#include <jansson.h>
#include <stdbool.h>
#include <stdio.h>

#include "app/quantity/quantity.h"
#include "probe_quantity.h"
#include "scenario_keys.h"

typedef enum group_kind {
  GROUP_PLANE,
  GROUP_BOX,
  GROUP_NODES,
  GROUP_SPHERE,
  GROUP_CYLINDER,
  GROUP_HALF_SPACE,
  GROUP_NORMAL,
  GROUP_NEAR,
  GROUP_COMBINED,
} group_kind;

typedef struct group_def {
  const char *name;
  group_kind kind;
  int axis; /* plane */
  double at;
  double min[3], max[3];     /* box; the ends of a cylinder */
  double point[3], along[3]; /* sphere, half-space; normal */
  double size;               /* radius, angle or distance */
  corot_set_operation operation;
  int nother; /* groups that it is made of */
  const char *const *other;
  int nnode; /* nodes */
  const int *node;
  const struct config_node *entry; /* of the scenario: the name is its key */
} group_def;

/* All zero but the name: the displacement of node 0. */
typedef struct probe_def {
  const char *name;
  int node;          /* -1: of something else */
  double point[3];   /* unless there is a node, a group, or it is of the body */
  bool nearest;      /* of the node nearest to the point */
  const char *group; /* NULL: none */
  bool body;         /* the whole */
  probe_of of;
  probe_take take; /* that of the quantity, where none is said */
  int component;   /* into probe_components; 0: all */
  probe_part part; /* of a reaction */
  double about[3]; /* what moments are about [m] */
} probe_def;

/* A number that is asked for: see quantity.h. */
typedef struct quantity_def {
  const char *name;
  quantity quantity; /* its column is not resolved */
  const struct config_node *node;
} quantity_def;

typedef enum input_of { INPUT_LOAD, INPUT_MATERIAL } input_of;

/* A factor that comes in while a run goes on. */
typedef struct input_def {
  const char *name;
  input_of of;
  int index;              /* into model.load or model.material */
  corot_amplitude values; /* LINEAR, of at least one point; of a material they count stepwise */
  const struct config_node *node;
} input_def;

/* A velocity some nodes start with. */
typedef struct start_def {
  const char *group;  /* NULL: the whole body */
  double velocity[3]; /* [m/s] */
  double axis[3];     /* of length one; or zero, as is the rate: no spin */
  double center[3];   /* [m] */
  double rate;        /* [rad/s] */
} start_def;

/* output.space_error */
typedef enum space_error { SPACE_ERROR_AUTO, SPACE_ERROR_ON, SPACE_ERROR_OFF } space_error;

/* Everything it points to lives as long as it does. */
typedef struct scenario {
  const char *path; /* of the file, as given */
  const char *title;

  const char *mesh_file; /* resolved against the scenario's folder; NULL: a box */
  double scale;          /* of its coordinates, to be metres; 0: as 1 */
  bool cut;              /* its solids that are no tets, into tets */
  corot_box box;
  int refine;        /* times */
  const char *marks; /* file of the tets that are cut then, as mesh_file; NULL: none */
  int order;         /* of the mesh; 0: as it is */
  corot_diagonal diagonal;
  int ngroup;
  const group_def *group; /* [ngroup] those that others are made of before these */

  corot_model_def model;         /* all but the mesh, which scenario_build makes; model.hierarchy is
                                    NULL or the address of */
  corot_hierarchy_def hierarchy; /* all but the refinement */

  const char *frame_policy; /* its name */
  corot_frame_policy frames;

  double t_end;       /* [s] */
  double output_step; /* [s] */
  corot_integrator_def integrator;
  corot_statics_def statics;
  const char *start_from;    /* "rest", "equilibrium"; NULL: not said, rest */
  bool start_at_equilibrium; /* of the loads at t = 0; else undeformed */
  int nstart;
  const start_def *start; /* [nstart] a later one takes the place of an earlier on its nodes */

  int ninput;
  const input_def *input; /* [ninput] each of another load or material */

  int ncompare;
  const char *const *compare; /* measures whose forces are held against those of green */

  int nprobe;
  const probe_def *probe;
  int nquantity;
  const quantity_def *quantity; /* [nquantity] */

  bool write_fields;    /* output.fields: vtu */
  int field_every;      /* every so many output times; 0: auto (field_frames.h) */
  bool compress_fields; /* output.compression: zlib */
  bool write_history;   /* output.history: true */
  bool write_all_steps; /* output.steps: all */
  bool write_states;    /* output.states: binary */
  space_error space_error;
  int threads;             /* 0: as many as pay */
  double checkpoint_every; /* [s] on the clock */
  long checkpoint_steps;   /* 0: no checkpoints */

  corot_linear_costs costs; /* that a linear solver is chosen by, */
  bool tuned;               /* if they have been measured; else the usual ones are */

  json_t *resolved;      /* the whole scenario, defaults and overrides included */
  struct config *source; /* the file as a tree, for the places in messages; owns the memory */
} scenario;

/* Reads `path`, applies `override` [noverride] ("KEY.PATH=VALUE", in order) and fills in defaults.
   COROT_EIO: the file cannot be read. COROT_EFORMAT: the message is "FILE:LINE:COLUMN: KEY: what
   is wrong", with the line; or "--set KEY=VALUE: ..." where an override is to blame. */
corot_status scenario_read(const char *path, int noverride, char *const *override, scenario **out);

/* The same from memory; `path` stands for the file in messages and for its folder. */
corot_status scenario_read_text(const char *path, const char *text, size_t size, int noverride,
                                char *const *override, scenario **out);

/* A value for a key, "integrator.rtol", in the place of the file's. */
typedef struct setting {
  const char *key;
  const struct config_node *value;
} setting;

/* The same as scenario_read with overrides that have been read from a file themselves: messages
   name their places there. Their tree must outlive the scenario. */
corot_status scenario_read_with(const char *path, int nset, const setting *set, scenario **out);

/* v [n] = the velocity that a run starts with from the displacement u [n]. */
void scenario_start(const scenario *s, const corot_model *model, const double *u, double *v);

/* An amplitude in a few words, "sine of 5 Hz"; "" where it is one at all times. */
void scenario_describe_amplitude(const corot_amplitude *a, size_t size, char *text);

/* Takes NULL. */
void scenario_destroy(scenario *s);

/* COROT_EFORMAT at the inputs, if there are any: `what` knows nothing of them. */
corot_status scenario_refuse_inputs(const scenario *s, const char *what);

/* The mesh with its groups, its refinement if the linear solver is to know it, else NULL, and the
   model; all the caller's to destroy. Who has no use for the refinement passes NULL. COROT_EFORMAT:
   a message as above; a mesh that cannot be read is one, too. */
corot_status scenario_build(const scenario *s, corot_mesh **mesh, corot_refinement **refinement,
                            corot_model **model);

struct warnings;

/* The same, with what was mended in the mesh file as warnings: see warnings.h. */
corot_status scenario_build_warned(const scenario *s, corot_mesh **mesh,
                                   corot_refinement **refinement, corot_model **model,
                                   struct warnings *w);

/* The mesh of mesh.file or mesh.box alone, without what the scenario makes of it, and what was
   mended in the file, or NULL; both the caller's to destroy. */
corot_status scenario_read_mesh(const scenario *s, corot_mesh **mesh, corot_mesh_report **report);

#endif

#include "schema.h"

#include <stdio.h>
#include <string.h>

#define MAP SCHEMA_MAP
#define NUMBER SCHEMA_NUMBER
#define INTEGER SCHEMA_INTEGER
#define VECTOR SCHEMA_VECTOR
#define TEXT SCHEMA_TEXT
#define CHOICE SCHEMA_CHOICE
#define OPTIONAL SCHEMA_OPTIONAL
#define REQUIRED SCHEMA_REQUIRED
#define ONE_OF SCHEMA_ONE_OF
#define NOT_YET SCHEMA_NOT_YET
#define ANY SCHEMA_ANY
#define POSITIVE SCHEMA_POSITIVE
#define NOT_NEGATIVE SCHEMA_NOT_NEGATIVE

/* clang-format off */
const schema_key schema_keys[] = {
  /* path                     type             status    range         unit       default   words not_yet  doc */
  {"title",                   TEXT,            OPTIONAL, ANY,          "",        "''", 0, 0, "what the run is about"},

  {"mesh",                    MAP,             REQUIRED, ANY,          "",        0, 0, 0, "the solid: a file or a box"},
  {"mesh.file",               TEXT,            ONE_OF,   ANY,          "",        0, 0, 0, "gmsh 1, 2.2, 4.1 or TetGen file, relative to the scenario's folder"},
  {"mesh.box",                MAP,             ONE_OF,   ANY,          "",        0, 0, 0, "a box; its sides are groups xmin xmax ymin ymax zmin zmax"},
  {"mesh.box.size",           VECTOR,          REQUIRED, POSITIVE,     "m",       0, 0, 0, "lengths of the edges"},
  {"mesh.box.cells",          SCHEMA_COUNTS,   REQUIRED, POSITIVE,     "",        0, 0, 0, "cells along each axis, six tets each"},
  {"mesh.box.origin",         VECTOR,          OPTIONAL, ANY,          "m",       "[0, 0, 0]", 0, 0, "the corner with the smallest coordinates"},
  {"mesh.box.split",          CHOICE,          OPTIONAL, ANY,          "",        "kuhn", "kuhn", 0, "how a cell is cut into tets"},
  {"mesh.refine",             INTEGER,         OPTIONAL, SCHEMA_ZERO_FOR_NOW, "", "0", 0, 0, "times that each tet is cut into eight"},

  {"groups",                  SCHEMA_NAMED,    OPTIONAL, ANY,          "",        "{}", 0, 0, "sets of nodes, in addition to the mesh's own groups"},
  {"groups.NAME.plane",       MAP,             ONE_OF,   ANY,          "",        0, 0, 0, "the nodes on a plane across an axis"},
  {"groups.NAME.plane.axis",  CHOICE,          REQUIRED, ANY,          "",        0, "x|y|z", 0, "the axis the plane is normal to"},
  {"groups.NAME.plane.at",    NUMBER,          REQUIRED, ANY,          "m",       0, 0, 0, "where on the axis; within 1e-6 of the mesh's diagonal"},
  {"groups.NAME.box",         MAP,             ONE_OF,   ANY,          "",        0, 0, 0, "the nodes in a box, its sides included"},
  {"groups.NAME.box.min",     VECTOR,          REQUIRED, ANY,          "m",       0, 0, 0, "smallest coordinates"},
  {"groups.NAME.box.max",     VECTOR,          REQUIRED, ANY,          "m",       0, 0, 0, "largest coordinates"},
  {"groups.NAME.nodes",       SCHEMA_INTEGERS, ONE_OF,   NOT_NEGATIVE, "",        0, 0, 0, "numbers of nodes, the first is 0"},

  {"material",                SCHEMA_MAPS,     REQUIRED, ANY,          "",        0, 0, 0, "one material, or a list of one for each group of tets"},
  {"material.group",          TEXT,            OPTIONAL, ANY,          "",        0, 0, 0, "the tets it fills; without: all that no other entry names"},
  {"material.lambda",         NUMBER,          OPTIONAL, ANY,          "Pa",      0, 0, 0, "first Lame constant; give lambda and mu, E and nu, or mu and nu"},
  {"material.mu",             NUMBER,          OPTIONAL, POSITIVE,     "Pa",      0, 0, 0, "second Lame constant, the shear modulus"},
  {"material.E",              NUMBER,          OPTIONAL, POSITIVE,     "Pa",      0, 0, 0, "Young's modulus"},
  {"material.nu",             NUMBER,          OPTIONAL, SCHEMA_POISSON, "",      0, 0, 0, "Poisson's ratio"},
  {"material.density",        NUMBER,          REQUIRED, POSITIVE,     "kg/m^3",  0, 0, 0, "mass per rest volume"},
  {"material.damping",        MAP,             OPTIONAL, ANY,          "",        "{}", 0, 0, "viscous stress, the same law on the strain rate"},
  {"material.damping.lambda", NUMBER,          OPTIONAL, NOT_NEGATIVE, "Pa s",    "0.0", 0, 0, "first viscosity"},
  {"material.damping.mu",     NUMBER,          OPTIONAL, NOT_NEGATIVE, "Pa s",    "0.0", 0, 0, "second viscosity"},
  {"material.damping.mass",   NUMBER,          OPTIONAL, SCHEMA_ZERO_FOR_NOW, "1/s", "0.0", 0, 0, "Rayleigh coefficient of the mass"},

  {"strain",                  CHOICE,          OPTIONAL, ANY,          "",        "polar", "cauchy|green|polar|warp|hybrid", 0, "strain measure"},
  {"frames",                  MAP,             OPTIONAL, ANY,          "",        "{}", 0, 0, "the rotations of the elements, as part of the model"},
  {"frames.policy",           CHOICE,          OPTIONAL, ANY,          "",        "exact", "exact|hold", "step|extrapolate", "exact: found in every evaluation; hold: kept for an interval"},
  {"frames.interval",         NUMBER,          OPTIONAL, POSITIVE,     "s",       0, 0, 0, "time between updates; required by policy hold"},
  {"frames.max_angle",        NUMBER,          NOT_YET,  POSITIVE,     "rad",     0, 0, 0, "update where an element has turned further"},
  {"frames.history",          CHOICE,          OPTIONAL, ANY,          "",        "auto", "auto|keep|restart", 0, "the integrator's memory after an update"},

  {"boundary",                SCHEMA_LIST,     OPTIONAL, ANY,          "",        "[]", 0, 0, "prescribed motion; without: a free body"},
  {"boundary[].group",        TEXT,            REQUIRED, ANY,          "",        0, 0, 0, "the nodes it concerns"},
  {"boundary[].fix",          SCHEMA_AXES,     ONE_OF,   ANY,          "",        0, "x|y|z", 0, "displacement components held at zero"},
  {"boundary[].rotate",       MAP,             NOT_YET,  ANY,          "",        0, 0, 0, "rotation about an axis"},
  {"boundary[].translate",    MAP,             NOT_YET,  ANY,          "",        0, 0, 0, "translation"},

  {"loads",                   SCHEMA_LIST,     OPTIONAL, ANY,          "",        "[]", 0, 0, "external forces"},
  {"loads[].group",           TEXT,            OPTIONAL, ANY,          "",        0, 0, 0, "where it acts; required by traction, not for gravity"},
  {"loads[].traction",        VECTOR,          ONE_OF,   ANY,          "Pa",      0, 0, 0, "force per rest area on the group's faces, of fixed direction"},
  {"loads[].gravity",         VECTOR,          ONE_OF,   ANY,          "m/s^2",   0, 0, 0, "acceleration of the whole body"},
  {"loads[].pressure",        NUMBER,          NOT_YET,  ANY,          "Pa",      0, 0, 0, "normal force per area that follows the surface"},
  {"loads[].force",           VECTOR,          NOT_YET,  ANY,          "N",       0, 0, 0, "total force, spread over the group's nodes"},
  {"loads[].amplitude",       SCHEMA_CURVE,    OPTIONAL, ANY,          "s, 1",    0, 0, 0, "factor as [[time, value], ...], linear between, constant beyond"},

  {"time",                    MAP,             REQUIRED, ANY,          "",        0, 0, 0, "the span of the run, from t = 0"},
  {"time.end",                NUMBER,          REQUIRED, POSITIVE,     "s",       0, 0, 0, "the last time"},
  {"time.output",             NUMBER,          OPTIONAL, POSITIVE,     "s",       0, 0, 0, "time between outputs; default: end / 100"},

  {"integrator",              MAP,             OPTIONAL, ANY,          "",        "{}", 0, 0, "how the equations are integrated"},
  {"integrator.method",       CHOICE,          OPTIONAL, ANY,          "",        "cvode", "cvode", "ida|arkode|backward-euler|bdf3|newmark", "cvode: BDF with variable step and order"},
  {"integrator.step",         NUMBER,          NOT_YET,  POSITIVE,     "s",       0, 0, 0, "length of the step of a fixed-step method"},
  {"integrator.rtol",         NUMBER,          OPTIONAL, SCHEMA_FRACTION, "",     "1.0e-4", 0, 0, "relative tolerance of the local error"},
  {"integrator.atol",         MAP,             OPTIONAL, ANY,          "",        "{}", 0, 0, "absolute tolerances"},
  {"integrator.atol.displacement", NUMBER,     OPTIONAL, POSITIVE,     "m",       "auto", "auto", 0, "auto: rtol / 100 of the length of the model"},
  {"integrator.atol.velocity", NUMBER,         OPTIONAL, POSITIVE,     "m/s",     "auto", "auto", 0, "auto: of the displacement, times the model's frequency"},
  {"integrator.max_order",    INTEGER,         OPTIONAL, SCHEMA_ORDER, "",        "auto", "auto", 0, "highest order; auto: 2, more where damping or tolerance make it pay"},
  {"integrator.max_steps",    INTEGER,         OPTIONAL, POSITIVE,     "",        "none", "none", 0, "give up after so many"},
  {"integrator.first_step",   NUMBER,          OPTIONAL, POSITIVE,     "s",       "auto", "auto", 0, "length of the first step"},
  {"integrator.min_step",     NUMBER,          OPTIONAL, POSITIVE,     "s",       "none", "none", 0, "give up where a shorter step is needed"},
  {"integrator.max_step",     NUMBER,          OPTIONAL, POSITIVE,     "s",       "none", "none", 0, "take no longer step"},
  {"integrator.jacobian",     MAP,             OPTIONAL, ANY,          "",        "{}", 0, 0, "the Newton matrix: changes the cost, not the answer"},
  {"integrator.jacobian.tangent", CHOICE,      OPTIONAL, ANY,          "",        "held", "held|exact", 0, "frames in the stiffness: as if held, or with their own variation"},
  {"integrator.jacobian.reassembly", INTEGER,  OPTIONAL, POSITIVE,     "",        "20", 0, 0, "stiffness and damping anew at least every so many steps"},
  {"integrator.jacobian.refactorisation", INTEGER, OPTIONAL, POSITIVE, "",        "20", 0, 0, "factor anew at least every so many steps"},
  {"integrator.jacobian.gamma_change", NUMBER, OPTIONAL, POSITIVE,     "",        "0.3", 0, 0, "factor anew when step times leading coefficient changes by this fraction"},
  {"linear_solver",           CHOICE,          OPTIONAL, ANY,          "",        "auto", "auto|klu|cholmod", "pcg", "sparse direct solver"},

  {"probes",                  SCHEMA_NAMED,    OPTIONAL, ANY,          "",        "{}", 0, 0, "nodes whose motion is recorded; names are letters, digits, _ and -"},
  {"probes.NAME.point",       VECTOR,          ONE_OF,   ANY,          "m",       0, 0, 0, "the node nearest to it at rest"},
  {"probes.NAME.node",        INTEGER,         ONE_OF,   NOT_NEGATIVE, "",        0, 0, 0, "the node of that number, the first is 0"},

  {"output",                  MAP,             OPTIONAL, ANY,          "",        "{}", 0, 0, "what is written beside the tables"},
  {"output.fields",           CHOICE,          OPTIONAL, ANY,          "",        "vtu", "vtu|none", 0, "fields on the mesh, for ParaView"},
  {"output.every",            INTEGER,         OPTIONAL, POSITIVE,     "",        "1", 0, 0, "fields at every so many output times"},
};
/* clang-format on */

const int schema_nkey = sizeof schema_keys / sizeof *schema_keys;

const schema_key *schema_child(const char *path, const schema_key *previous) {
  size_t length = strlen(path);
  for (const schema_key *k = previous ? previous + 1 : schema_keys; k < schema_keys + schema_nkey;
       k++) {
    const char *rest = k->path;
    if (length) {
      if (strncmp(rest, path, length) != 0 || rest[length] != '.') continue;
      rest += length + 1;
    }
    if (!strchr(rest, '.')) return k;
  }
  return NULL;
}

const schema_key *schema_find(const char *path) {
  for (int i = 0; i < schema_nkey; i++)
    if (strcmp(schema_keys[i].path, path) == 0) return &schema_keys[i];
  return NULL;
}

void schema_inside(const schema_key *key, size_t size, char *path) {
  const char *suffix = key->type == SCHEMA_LIST ? "[]" : key->type == SCHEMA_NAMED ? ".NAME" : "";
  snprintf(path, size, "%s%s", key->path, suffix);
}

const char *schema_range_words(schema_range range) {
  switch (range) {
    case SCHEMA_POSITIVE:
      return "> 0";
    case SCHEMA_NOT_NEGATIVE:
      return ">= 0";
    case SCHEMA_FRACTION:
      return "> 0, < 1";
    case SCHEMA_ORDER:
      return "1 to 5";
    case SCHEMA_POISSON:
      return "> -1, < 0.5";
    case SCHEMA_ZERO_FOR_NOW:
      return "0 only";
    default:
      return "";
  }
}

/* The table of all keys of a scenario. */
#include "scenario_keys.h"

#include "core/model/definition.h"
#include "probe_quantity.h"

#define MAP SCHEMA_MAP
#define NUMBER SCHEMA_NUMBER
#define INTEGER SCHEMA_INTEGER
#define VECTOR SCHEMA_VECTOR
#define TEXT SCHEMA_TEXT
#define CHOICE SCHEMA_CHOICE
#define OPTIONAL SCHEMA_OPTIONAL
#define REQUIRED SCHEMA_REQUIRED
#define ONE_OF SCHEMA_ONE_OF
#define ANY SCHEMA_ANY
#define POSITIVE SCHEMA_POSITIVE
#define NOT_NEGATIVE SCHEMA_NOT_NEGATIVE

/* The ranges of a material's coefficients are the core's. */
#define RANGE(field, range) RANGE_OF_##field = SCHEMA_##range,
enum { COROT_MATERIAL_RANGES(RANGE) };
#define RANGE_OF(field) (schema_range) RANGE_OF_##field

/* clang-format off */
/* The keys of an amplitude given as a map, at `path`. */
#define AMPLITUDE(path) \
  {path ".sine",            MAP,             ONE_OF,   ANY,          "",        0, 0, "offset + sin(2 pi frequency t + phase), at all times"}, \
  {path ".sine.frequency",  NUMBER,       REQUIRED, POSITIVE,     "Hz",      0, 0, "periods per time"}, \
  {path ".sine.phase",      NUMBER,          OPTIONAL, ANY,          "rad",     "0.0", 0, "of the sine at t = 0"}, \
  {path ".sine.offset",     NUMBER,          OPTIONAL, ANY,          "1",       "0.0", 0, "what the sine swings about"}, \
  {path ".smooth",          SCHEMA_CURVE,    ONE_OF,   ANY,          "s, 1",    0, 0, "a cubic spline through [[time, value], ...], flat at both ends and constant beyond, or through the points of a {file: ...}; needs no stops"}, \
  {path ".smooth.file",     TEXT,            REQUIRED, ANY,          "s, 1",    0, 0, "a table as amplitude.file"}, \
  {path ".smooth.sha256",   TEXT,          OPTIONAL, ANY,          "",        0, 0, "as amplitude.sha256"}, \
  {path ".file",            TEXT,            ONE_OF,   ANY,          "s, 1",    0, 0, "a text file of two columns, time and value, separated by commas or blanks, relative to the scenario's folder; # begins a comment, a first line without numbers is a header; as a list of points"}, \
  {path ".sha256",          TEXT,            OPTIONAL, ANY,          "",        0, 0, "of the file's bytes, as the resolved scenario has it: another file is refused"}

static const schema_key keys[] = {
  /* path                     type             status    range         unit       default   words  doc */
  {"title",                   TEXT,            OPTIONAL, ANY,          "",        "''", 0, "what the run is about"},

  {"mesh",                    SCHEMA_SHORT,    REQUIRED, ANY,          "",        0, 0, "the solid: a file or a box; a text is mesh.file"},
  {"mesh.file",               TEXT,            ONE_OF,   ANY,          "",        0, 0, "gmsh 1, 2.2, 4.0, 4.1, TetGen, MEDIT, Abaqus, FEBio, VTK (.vtk, .vtu), Netgen, MFEM or VegaFEM file, relative to the scenario's folder; nodes in no tet are left out, left-handed tets turned round, tets that are there twice left out, which is told as a warning"},
  {"mesh.box",                MAP,             ONE_OF,   ANY,          "",        0, 0, "a box; its sides are groups xmin xmax ymin ymax zmin zmax"},
  {"mesh.box.size",           VECTOR,          REQUIRED, POSITIVE,     "m",       0, 0, "lengths of the edges"},
  {"mesh.box.cells",          SCHEMA_COUNTS,   REQUIRED, POSITIVE,     "",        0, 0, "cells along each axis, six tets each; see split"},
  {"mesh.box.origin",         VECTOR,          OPTIONAL, ANY,          "m",       "[0, 0, 0]", 0, "the corner with the smallest coordinates"},
  {"mesh.box.split",          CHOICE,          OPTIONAL, ANY,          "",        "symmetric", "symmetric|alternating|kuhn", "how the cells are cut into tets; symmetric: mirrored from cell to cell, and the middle one of an odd number in halves, so that nothing drifts sideways; alternating: mirrored only, which drifts a little where a number is odd; kuhn: all the same, which drifts by up to a third of the deflection"},
  {"mesh.refine",             INTEGER,         OPTIONAL, NOT_NEGATIVE, "",      "0", 0, "times that each tet is cut into eight; nodes keep their numbers, the middles of edges follow"},
  {"mesh.marks",              TEXT,            OPTIONAL, ANY,          "",        0, 0, "text file, relative to the scenario's folder, of tets that are cut after mesh.refine, each into at least eight, and neighbours as far as faces have to match: a line is a pass, the numbers, from 0, of tets of the mesh that the lines before it have made; # begins a comment, a line without numbers is none; another mesh.refine makes other tets of these numbers"},
  {"mesh.order",              INTEGER,         OPTIONAL, POSITIVE,     "",      0, 0, "1: tets of four nodes, linear displacements; 2: of ten nodes, quadratic ones, whose edges stay as curved as the file has them; default: as the file, of a box 1. 2 adds the middles of straight edges, after mesh.refine and mesh.marks, to tets of four nodes; 1 drops the nodes on edges, before mesh.refine and mesh.marks, and the numbers of the corners close up"},
  {"mesh.cut",                CHOICE,          OPTIONAL, ANY,          "",        0, "true|false", "true: hexahedra, prisms and pyramids of first order in mesh.file are cut into tets, which is told as a warning; default: false, a file that has them is refused"},
  {"mesh.unit",               CHOICE,          OPTIONAL, ANY,          "",        0, "m|km|cm|mm|um|nm|in|ft", "the unit of length that mesh.file is written in; everything else in the scenario stays in metres; default: m"},
  {"mesh.scale",              NUMBER,          OPTIONAL, POSITIVE,     "m",       0, 0, "what the coordinates of mesh.file are multiplied by to be metres, of any other unit; instead of mesh.unit"},
  {"mesh.diagonal",           CHOICE,          OPTIONAL, ANY,          "",        "shortest", "consistent|shortest", "which diagonal of the octahedron inside a tet is an edge of the eight: shortest makes better shapes on the average, consistent at most three of a tet, however often it is cut"},

  {"groups",                  SCHEMA_NAMED,    OPTIONAL, ANY,          "",        "{}", 0, "sets of nodes, faces and tets, in addition to the mesh's own groups: faces of the boundary and tets are in those of which all corners are; all but nodes choose from the mesh after mesh.refine and mesh.marks; of ten-node tets they choose corners, and a node on an edge belongs where both ends do"},
  {"groups.NAME.plane",       MAP,             ONE_OF,   ANY,          "",        0, 0, "the nodes on a plane across an axis"},
  {"groups.NAME.plane.axis",  CHOICE,          REQUIRED, ANY,          "",        0, "x|y|z", "the axis the plane is normal to"},
  {"groups.NAME.plane.at",    NUMBER,          REQUIRED, ANY,          "m",       0, 0, "where on the axis; within 1e-6 of the mesh's diagonal"},
  {"groups.NAME.box",         MAP,             ONE_OF,   ANY,          "",        0, 0, "the nodes in a box, its sides included"},
  {"groups.NAME.box.min",     VECTOR,          REQUIRED, ANY,          "m",       0, 0, "smallest coordinates"},
  {"groups.NAME.box.max",     VECTOR,          REQUIRED, ANY,          "m",       0, 0, "largest coordinates"},
  {"groups.NAME.sphere",      MAP,             ONE_OF,   ANY,          "",        0, 0, "the nodes in a sphere; of this and the next two, those on the surface, too, within 1e-6 of the mesh's diagonal"},
  {"groups.NAME.sphere.center", VECTOR,        REQUIRED, ANY,          "m",       0, 0, "its center"},
  {"groups.NAME.sphere.radius", NUMBER,        REQUIRED, POSITIVE,     "m",       0, 0, "its radius"},
  {"groups.NAME.cylinder",    MAP,             ONE_OF,   ANY,          "",        0, 0, "the nodes in a round cylinder, such as those around a bore"},
  {"groups.NAME.cylinder.from", VECTOR,        REQUIRED, ANY,          "m",       0, 0, "the center of one end"},
  {"groups.NAME.cylinder.to", VECTOR,          REQUIRED, ANY,          "m",       0, 0, "the center of the other end"},
  {"groups.NAME.cylinder.radius", NUMBER,      REQUIRED, POSITIVE,     "m",       0, 0, "its radius"},
  {"groups.NAME.half_space",  MAP,             ONE_OF,   ANY,          "",        0, 0, "the nodes on one side of a plane"},
  {"groups.NAME.half_space.point", VECTOR,     REQUIRED, ANY,          "m",       0, 0, "a point of the plane"},
  {"groups.NAME.half_space.normal", VECTOR,    REQUIRED, ANY,          "",        0, 0, "from the plane to the nodes, of any length but 0"},
  {"groups.NAME.normal",      MAP,             ONE_OF,   ANY,          "",        0, 0, "the faces of the boundary that look in a direction, with their nodes and no tets"},
  {"groups.NAME.normal.direction", VECTOR,     REQUIRED, ANY,          "",        0, 0, "of outward normals, of any length but 0"},
  {"groups.NAME.normal.angle", NUMBER,         OPTIONAL, NOT_NEGATIVE, "rad",     "0.01", 0, "by which they may differ from it, at most pi"},
  {"groups.NAME.near",        MAP,             ONE_OF,   ANY,          "",        0, 0, "the nodes near to another group's nodes, faces and tets, these nodes among them"},
  {"groups.NAME.near.group",  TEXT,            REQUIRED, ANY,          "",        0, 0, "the other group, of the mesh or of the scenario"},
  {"groups.NAME.near.distance", NUMBER,        REQUIRED, NOT_NEGATIVE, "m",       0, 0, "the largest there is to be"},
  {"groups.NAME.union",       SCHEMA_TEXTS,    ONE_OF,   ANY,          "",        0, 0, "what is in one of these groups, two or more, of the mesh or of the scenario: of nodes, of faces and of tets, each by themselves"},
  {"groups.NAME.intersection", SCHEMA_TEXTS,   ONE_OF,   ANY,          "",        0, 0, "what is in all of these groups; a box and a normal: the faces in the box that look in a direction"},
  {"groups.NAME.difference",  SCHEMA_TEXTS,    ONE_OF,   ANY,          "",        0, 0, "what is in the first of these groups and in none of the others; faces stay although all their nodes may be in the others, these do not"},
  {"groups.NAME.nodes",       SCHEMA_INTEGERS, ONE_OF,   NOT_NEGATIVE, "",        0, 0, "numbers of nodes before mesh.refine, mesh.marks and mesh.order, the first is 0; what is cut passes the group on, edges, faces and tets"},

  {"material",                SCHEMA_MAPS,     REQUIRED, ANY,          "",        0, 0, "one material, or a list of one for each group of tets"},
  {"material.group",          TEXT,            OPTIONAL, ANY,          "",        0, 0, "the tets it fills; without: all that no other entry names"},
  {"material.lambda",         NUMBER,          OPTIONAL, ANY,          "Pa",      0, 0, "first Lame constant; give lambda and mu, E and nu, or mu and nu"},
  {"material.mu",             NUMBER,          OPTIONAL, RANGE_OF(mu), "Pa",      0, 0, "second Lame constant, the shear modulus"},
  {"material.E",              NUMBER,          OPTIONAL, POSITIVE,     "Pa",      0, 0, "Young's modulus"},
  {"material.nu",             NUMBER,          OPTIONAL, SCHEMA_POISSON, "",      0, 0, "Poisson's ratio"},
  {"material.density",        NUMBER,          REQUIRED, RANGE_OF(density), "kg/m^3",  0, 0, "mass per rest volume"},
  {"material.damping",        MAP,             OPTIONAL, ANY,          "",        "{}", 0, "viscous stress, the same law on the strain rate"},
  {"material.damping.lambda", NUMBER,          OPTIONAL, RANGE_OF(damping_lambda), "Pa s",    "0.0", 0, "first viscosity"},
  {"material.damping.mu",     NUMBER,          OPTIONAL, RANGE_OF(damping_mu), "Pa s",    "0.0", 0, "second viscosity"},
  {"material.damping.mass",   NUMBER,          OPTIONAL, RANGE_OF(damping_mass), "1/s",     "0.0", 0, "Rayleigh's: a force against the velocity, this times the mass"},

  {"mass",                    CHOICE,          OPTIONAL, ANY,          "",        "auto", "auto|lumped|consistent", "lumped: at the nodes; consistent: the shape functions' own, lumped in elements at supports whose velocity may jump; auto: lumped for four-node tets and under a one-way hierarchy, else consistent for ten-node ones, which lumped twist a bar of two cells across 6 per cent too slowly"},
  {"strain",                  CHOICE,          OPTIONAL, ANY,          "",        "polar", "cauchy|green|polar|warp|hybrid", "strain measure"},
  {"hierarchy",               MAP,             OPTIONAL, ANY,          "",        0, 0, "with mesh.refine, or mesh.order: 2 as one more level: a measure of its own for the unrefined mesh, of four-node tets; strain is that of the finest level, in frames handed down"},
  {"hierarchy.coarse_strain", CHOICE,          OPTIONAL, ANY,          "",        "green", "cauchy|green|polar|warp|hybrid", "strain measure of the unrefined mesh"},
  {"hierarchy.coupling",      CHOICE,          OPTIONAL, ANY,          "",        "mean", "mean|nodes|one-way", "mean: the unrefined mesh follows the mean gradient over each of its tets; nodes: its own nodes, for small strains only; one-way: it moves for itself, and the detail follows it"},
  {"hierarchy.frame_level",   INTEGER,         OPTIONAL, NOT_NEGATIVE, "",        "0", 0, "the level whose frames are handed down to finer ones, 0 (the unrefined mesh) to mesh.refine; with mesh.order: 2 to one more, where each point of a ten-node tet has its own"},
  {"hierarchy.force",         CHOICE,          OPTIONAL, ANY,          "",        "conservative", "conservative|paper", "conservative: the gradient of the energy; paper: without the part by which the frames follow, which keeps momentum only"},
  {"dilatation",              SCHEMA_SHORT,    OPTIONAL, ANY,          "",        "local", 0, "what lambda acts on; the name alone will do"},
  {"dilatation.name",         CHOICE,          OPTIONAL, ANY,          "",        "local", "local|nodal|element", "local: each tet's own dilatation, which locks as nu nears 1/2, four-node tets soon, ten-node ones late; nodal: averages around the nodes, which do not; element: the mean over each ten-node tet, which does not either"},
  {"dilatation.local",        NUMBER,          OPTIONAL, NOT_NEGATIVE, "mu",      "1.0", 0, "nodal: so much of lambda stays with each tet's own"},
  {"viscosity",               CHOICE,          OPTIONAL, ANY,          "",        "auto", "auto|corotated|objective", "strain rate of the damping: sym(R' dF/dt), the paper's, whose forces can set a body spinning, or dS/dt of F = R S, zero in any rigid motion (polar, hybrid); auto: objective with polar and hybrid unless there is a hierarchy, else corotated"},
  {"frames",                  MAP,             OPTIONAL, ANY,          "",        "{}", 0, "the rotations of the elements, as part of the model"},
  {"frames.policy",           CHOICE,          OPTIONAL, ANY,          "",        "exact", "exact|step|hold|extrapolate", "exact: found in every evaluation; step: after every step; hold: kept between updates; extrapolate: turned on at their spin"},
  {"frames.interval",         NUMBER,          OPTIONAL, POSITIVE,     "s",       0, 0, "update at multiples of it; hold and extrapolate need this or max_angle"},
  {"frames.max_angle",        NUMBER,          OPTIONAL, POSITIVE,     "rad",     0, 0, "update after a step that leaves an element's frame off by more"},
  {"frames.history",          CHOICE,          OPTIONAL, ANY,          "",        "auto", "auto|keep|restart", "the integrator's memory after an update"},

  {"boundary",                SCHEMA_LIST,     OPTIONAL, ANY,          "",        "[]", 0, "prescribed motion; without: a free body"},
  {"boundary[].group",        TEXT,            REQUIRED, ANY,          "",        0, 0, "the nodes it concerns"},
  {"boundary[].fix",          SCHEMA_WORDS,    ONE_OF,   ANY,          "",        0, "x|y|z", "displacement components held at zero"},
  {"boundary[].rotate",       MAP,             ONE_OF,   ANY,          "",        0, 0, "turned about an axis at a constant rate, at rest before and after; holds x, y and z"},
  {"boundary[].rotate.axis",  VECTOR,          REQUIRED, ANY,          "",        0, 0, "direction of the axis, of any length but 0; right-handed"},
  {"boundary[].rotate.center", VECTOR,         OPTIONAL, ANY,          "m",       "[0, 0, 0]", 0, "a point of the axis"},
  {"boundary[].rotate.rate",  NUMBER,          REQUIRED, ANY,          "rad/s",   0, 0, "angle per time"},
  {"boundary[].rotate.from",  NUMBER,          OPTIONAL, NOT_NEGATIVE, "s",       "0.0", 0, "when it begins"},
  {"boundary[].rotate.to",    NUMBER,          OPTIONAL, POSITIVE,     "s",       "end", "end", "when it stops; end: not at all"},
  {"boundary[].translate",    MAP,             ONE_OF,   ANY,          "",        0, 0, "moved at a constant velocity, at rest before and after; holds x, y and z"},
  {"boundary[].translate.velocity", VECTOR,    REQUIRED, ANY,          "m/s",     0, 0, "displacement per time"},
  {"boundary[].translate.from", NUMBER,        OPTIONAL, NOT_NEGATIVE, "s",       "0.0", 0, "when it begins"},
  {"boundary[].translate.to", NUMBER,          OPTIONAL, POSITIVE,     "s",       "end", "end", "when it stops; end: not at all"},
  {"boundary[].move",         MAP,             ONE_OF,   ANY,          "",        0, 0, "moved or turned by an amplitude; holds x, y and z; several of one group add up"},
  {"boundary[].move.direction", VECTOR,        ONE_OF,   ANY,          "m",       0, 0, "displacement where the amplitude is 1"},
  {"boundary[].move.rotate",  MAP,             ONE_OF,   ANY,          "",        0, 0, "turned about an axis"},
  {"boundary[].move.rotate.axis", VECTOR,      REQUIRED, ANY,          "",        0, 0, "direction of the axis, of any length but 0; right-handed"},
  {"boundary[].move.rotate.center", VECTOR,    OPTIONAL, ANY,          "m",       "[0, 0, 0]", 0, "a point of the axis"},
  {"boundary[].move.rotate.angle", NUMBER,     REQUIRED, ANY,          "rad",     0, 0, "where the amplitude is 1"},
  {"boundary[].move.amplitude", SCHEMA_CURVE,  REQUIRED, ANY,          "s, 1",    0, 0, "factor in time, as of loads, without jumps; 0 at t = 0, or start: equilibrium; a sine of phase 0 sets out with a jolt, of phase -1.5707963267948966 and offset 1 without"},
  AMPLITUDE("boundary[].move.amplitude"),

  {"loads",                   SCHEMA_LIST,     OPTIONAL, ANY,          "",        "[]", 0, "external forces"},
  {"loads[].group",           TEXT,            OPTIONAL, ANY,          "",        0, 0, "where it acts; required but by gravity"},
  {"loads[].traction",        VECTOR,          ONE_OF,   ANY,          "Pa",      0, 0, "force per rest area on the group's faces, of fixed direction"},
  {"loads[].gravity",         VECTOR,          ONE_OF,   ANY,          "m/s^2",   0, 0, "acceleration of the whole body"},
  {"loads[].pressure",        NUMBER,          ONE_OF,   ANY,          "Pa",      0, 0, "force per deformed area on the group's faces, against their outward normal: it follows the surface"},
  {"loads[].force",           VECTOR,          ONE_OF,   ANY,          "N",       0, 0, "total force, spread evenly over the group's nodes, of fixed direction"},
  {"loads[].amplitude",       SCHEMA_CURVE,    OPTIONAL, ANY,          "s, 1",    0, 0, "factor as [[time, value], ...], linear between, constant beyond, two points at one time: a jump; or a map of one of sine, smooth, file"},
  AMPLITUDE("loads[].amplitude"),

  {"inputs",                  SCHEMA_NAMED,    OPTIONAL, ANY,          "",        0, 0, "what changes while the run goes on beside the amplitudes of loads and of moving supports, by name; not together with compare; at a constant step, times are those of steps"},
  {"inputs.NAME.load",        INTEGER,         ONE_OF,   NOT_NEGATIVE, "",        0, 0, "the load, counted from 0, which the values multiply beside its own amplitude: linear between, constant beyond, two points at one time a jump"},
  {"inputs.NAME.material",    INTEGER,         ONE_OF,   NOT_NEGATIVE, "",        0, 0, "the material, counted from 0, whose lambda, mu, damping.lambda and damping.mu the values multiply, each from its time to the next, the first before it, too; above 0; energy that a strained body gains so is external work"},
  {"inputs.NAME.values",      SCHEMA_CURVE,    REQUIRED, ANY,          "s, 1",    0, 0, "[[time, value], ...] or {file: ...}"},
  {"inputs.NAME.values.file", TEXT,            REQUIRED, ANY,          "s, 1",    0, 0, "a table as amplitude.file"},
  {"inputs.NAME.values.sha256", TEXT,          OPTIONAL, ANY,          "",        0, 0, "as amplitude.sha256"},

  {"time",                    MAP,             REQUIRED, ANY,          "",        0, 0, "the span of the run, from t = 0"},
  {"time.end",                NUMBER,          REQUIRED, POSITIVE,     "s",       0, 0, "the last time"},
  {"time.output",             NUMBER,          OPTIONAL, POSITIVE,     "s",       0, 0, "time between outputs; default: end / 100"},

  {"integrator",              MAP,             OPTIONAL, ANY,          "",        "{}", 0, "how the equations are integrated"},
  {"integrator.method",       CHOICE,          OPTIONAL, ANY,          "",        "cvode", "cvode|ida|arkode|erk|backward-euler|bdf2|bdf3|midpoint|newmark|hht|generalized-alpha", "cvode, ida: BDF of variable order; arkode, erk: implicit, explicit Runge-Kutta; these control the error; the others: constant step, no error control"},
  {"integrator.step",         NUMBER,          OPTIONAL, POSITIVE,     "s",       0, 0, "length of the step; required by the methods of constant step, refused by the others"},
  {"integrator.solution",     CHOICE,          OPTIONAL, ANY,          "",        "newton", "newton|linear", "constant step: Newton's method, or one linear solve a step, which suffices where frames are held and viscosity is corotated"},
  {"integrator.newton",       MAP,             OPTIONAL, ANY,          "",        "{}", 0, "constant step: Newton's method with backtracking"},
  {"integrator.newton.tolerance", NUMBER,      OPTIONAL, POSITIVE,     "",        "1.0e-9", 0, "of the last correction, in lengths of the model"},
  {"integrator.newton.iterations", INTEGER,    OPTIONAL, POSITIVE,     "",        "50", 0, "give up after so many in a step"},
  {"integrator.spectral_radius", NUMBER,       OPTIONAL, SCHEMA_UNIT,  "",        "0.8", 0, "hht (from 1/2) and generalized-alpha: of the fastest modes; 1: none is damped"},
  {"integrator.rtol",         NUMBER,          OPTIONAL, SCHEMA_FRACTION, "",     "1.0e-4", 0, "relative tolerance of the local error"},
  {"integrator.atol",         MAP,             OPTIONAL, ANY,          "",        "{}", 0, "absolute tolerances"},
  {"integrator.atol.displacement", NUMBER,     OPTIONAL, POSITIVE,     "m",       "auto", "auto", "auto: rtol / 100 of the length of the model"},
  {"integrator.atol.velocity", NUMBER,         OPTIONAL, POSITIVE,     "m/s",     "auto", "auto", "auto: of the displacement, times the model's frequency"},
  {"integrator.max_order",    INTEGER,         OPTIONAL, SCHEMA_ORDER, "",        "auto", "auto", "highest order; auto: 2, more where damping or tolerance make it pay"},
  {"integrator.order",        INTEGER,         OPTIONAL, SCHEMA_STAGE_ORDER, "",        "auto", "auto", "arkode, erk: order of the Runge-Kutta method; arkode 2 to 5, erk 2 to 8"},
  {"integrator.table",        TEXT,            OPTIONAL, ANY,          "",        0, 0, "arkode, erk: a method by SUNDIALS' name of its Butcher table (ARKODE_...), in place of order"},
  {"integrator.predictor",    INTEGER,         OPTIONAL, NOT_NEGATIVE, "",        "auto", "auto", "arkode: how a stage's first guess is made, 0 to 4, as ARKStepSetPredictorMethod numbers it"},
  {"integrator.max_steps",    INTEGER,         OPTIONAL, POSITIVE,     "",        "none", "none", "give up after so many"},
  {"integrator.first_step",   NUMBER,          OPTIONAL, POSITIVE,     "s",       "auto", "auto", "length of the first step"},
  {"integrator.min_step",     NUMBER,          OPTIONAL, POSITIVE,     "s",       "none", "none", "give up where a shorter step is needed"},
  {"integrator.max_step",     NUMBER,          OPTIONAL, POSITIVE,     "s",       "none", "none", "take no longer step"},
  {"integrator.jacobian",     MAP,             OPTIONAL, ANY,          "",        "{}", 0, "the Newton matrix: changes the cost, not the answer"},
  {"integrator.jacobian.tangent", CHOICE,      OPTIONAL, ANY,          "",        "auto", "auto|held|exact|clamped", "frames in the stiffness: as if held; with their own variation; exact, but positive semidefinite in each element"},
  {"integrator.jacobian.reassembly", INTEGER,  OPTIONAL, POSITIVE,     "",        "auto", "auto", "stiffness and damping anew at least every so many steps"},
  {"integrator.jacobian.refactorisation", INTEGER, OPTIONAL, POSITIVE, "",        "auto", "auto", "factor anew at least every so many steps; ida does so by gamma_change alone"},
  {"integrator.jacobian.gamma_change", NUMBER, OPTIONAL, POSITIVE,     "",        "auto", "auto", "factor anew when step times leading coefficient changes by this fraction"},
  {"integrator.jacobian.convergence", NUMBER,  OPTIONAL, POSITIVE,     "",        "auto", "auto", "Newton's iteration ends at this fraction of the tolerance"},
  {"linear_solver",           SCHEMA_SHORT,    OPTIONAL, ANY,          "",        "auto", 0, "how a step's linear system is solved; the name alone will do"},
  {"linear_solver.name",      CHOICE,          OPTIONAL, ANY,          "",        "auto", "auto|klu|cholmod|pcg", "klu: sparse LU; cholmod: sparse Cholesky; pcg: conjugate gradients; auto: what takes the least time by its counts of operations and the costs of corot tune, and no factor with which the run would need more than a third of the memory of the machine. What is asked for and needs more than there is is refused before it is made"},
  {"linear_solver.ordering",  CHOICE,          OPTIONAL, ANY,          "",        "auto", "auto|amd|metis", "klu, cholmod: of the mesh's nodes, against fill"},
  {"linear_solver.factor",    CHOICE,          OPTIONAL, ANY,          "",        "auto", "auto|simplicial|supernodal", "cholmod: entry by entry, or in dense blocks"},
  {"linear_solver.preconditioner", CHOICE,     OPTIONAL, ANY,          "",        "auto", "auto|block-jacobi|incomplete-cholesky|amg|hierarchical|multigrid", "pcg: what it is preconditioned with; amg: V-cycles through aggregates of nodes, on any mesh; with mesh.refine, unless mesh.marks follow, or ten-node tets also by levels, of which the corners of ten-node tets are one, the coarsest factored, or left to amg where it has more than 30 000 unknowns: their hierarchical basis, or V-cycles"},
  {"linear_solver.tolerance", NUMBER,          OPTIONAL, SCHEMA_FRACTION, "",     "1.0e-10", 0, "pcg: residual to reach, relative to the right-hand side; in statics Newton's iteration asks for less as long as it is far"},

  {"start",                   SCHEMA_STATES,   OPTIONAL, ANY,          "",        "rest", "rest|equilibrium", "where a run begins: undeformed, or in equilibrium under the loads of t = 0, at rest in both; or a map, or a list of maps, with velocities: each sets those of its nodes, a later one in place of an earlier"},
  {"start.from",              CHOICE,          OPTIONAL, ANY,          "",        0, "rest|equilibrium", "the shape to begin with; in one entry, of the whole body; without: rest"},
  {"start.group",             TEXT,            OPTIONAL, ANY,          "",        0, 0, "the nodes that get the velocity; without: the whole body"},
  {"start.velocity",          VECTOR,          OPTIONAL, ANY,          "m/s",     0, 0, "of all its nodes that no support holds; with a spin: at the spin's center"},
  {"start.spin",              MAP,             OPTIONAL, ANY,          "",        0, 0, "as a rigid body, rate axis / |axis| x (x - center), in addition to the velocity"},
  {"start.spin.axis",         VECTOR,          REQUIRED, ANY,          "",        0, 0, "direction of the axis, of any length but 0; right-handed"},
  {"start.spin.center",       VECTOR,          OPTIONAL, ANY,          "m",       "[0, 0, 0]", 0, "a point of the axis"},
  {"start.spin.rate",         NUMBER,          REQUIRED, ANY,          "rad/s",   0, 0, "angle per time"},
  {"statics",                 MAP,             OPTIONAL, ANY,          "",        "{}", 0, "how an equilibrium is found, by corot static and for start: equilibrium"},
  {"statics.frames",          CHOICE,          OPTIONAL, ANY,          "",        "exact", "exact|held", "exact: Newton's iteration; held: solved for frames that are held, found anew, and so on"},
  {"statics.tolerance",       NUMBER,          OPTIONAL, SCHEMA_FRACTION, "",     "1.0e-10", 0, "residual to reach, relative to the largest force on a node"},
  {"statics.max_iterations",  INTEGER,         OPTIONAL, POSITIVE,     "",        "20", 0, "of Newton in a load step, or updates of held frames; with strain: warp, whose stiffness leaves out how its frames vary, ten-node tets that bend far want 100 and more, or another strain"},
  {"statics.first_step",      NUMBER,          OPTIONAL, POSITIVE,     "",        "1.0", 0, "fraction of the load to begin with; halved where there is no equilibrium"},
  {"statics.min_step",        NUMBER,          OPTIONAL, POSITIVE,     "",        "1.0e-4", 0, "give up where a shorter step is needed"},
  {"statics.max_step",        NUMBER,          OPTIONAL, POSITIVE,     "",        "1.0", 0, "no longer step: short ones follow the path of the load where there are several equilibria"},

  {"compare",                 SCHEMA_WORDS,    OPTIONAL, ANY,          "",        0, "cauchy|warp|polar|hybrid", "strain measures whose forces are compared with those of green on the states of the run"},

  {"probes",                  SCHEMA_NAMED,    OPTIONAL, ANY,          "",        "{}", 0, "what is recorded at every step, in columns NAME.COMPONENT; names are letters, digits, _ and -. Of a point, a node, a group or, without these, the whole body"},
  {"probes.NAME.point",       VECTOR,          SCHEMA_AT_MOST_ONE, ANY, "m",      0, 0, "a point of the body at rest, by the shape functions of the tet that it is in; one outside stands for the nearest of the surface"},
  {"probes.NAME.node",        INTEGER,         SCHEMA_AT_MOST_ONE, NOT_NEGATIVE, "", 0, 0, "the node of that number, the first is 0; unchanged by mesh.refine, mesh.marks and mesh.order: 2"},
  {"probes.NAME.group",       TEXT,            SCHEMA_AT_MOST_ONE, ANY, "",       0, 0, "the nodes of a group; for what tets have, its tets or, where it has none, the tets at its faces"},
  {"probes.NAME.nearest",     CHOICE,          OPTIONAL, ANY,          "",        0, "true|false", "true: the node nearest to the point in its place; default: false"},
  {"probes.NAME.of",          CHOICE,          OPTIONAL, ANY,          "",        0, PROBE_WORDS, "displacement (the default; ux uy uz), velocity (vx vy vz), acceleration (ax ay az); reaction: the force of supports on the body, that is internal + viscous + inertial forces - loads on held components (fx fy fz, mx my mz); force: the loads (the same); stress: Cauchy's, in fixed axes (xx yy zz xy yz zx), principal: its eigenvalues, the largest first (p1 p2 p3), von_mises; traction: of Cauchy's stress on a group's faces, along their normals outward, as they are now, with cauchy at rest (tx ty tz); strain: of the measure, in its axes, not doubled (xx yy zz xy yz zx); frame_angle: by which frames turn [rad]; det: of F; volume: deformed; momentum (px py pz), angular_momentum (lx ly lz), elastic, kinetic and the other columns of energy.csv; momenta and kinetic are of what no support holds. One number is called value"},
  {"probes.NAME.take",        CHOICE,          OPTIONAL, ANY,          "",        0, "mean|sum|max|min", "of a group or the body: over its nodes, or over tets weighted by rest volume (faces: area), so that sum is the integral; max, min: of each column, of ten-node tets over points of integration; of a traction by the areas of now, so that sum is the force [N], max, min: of its magnitude. Default: mean; det: min; reaction, force, volume, momenta and energies are sums"},
  {"probes.NAME.component",   CHOICE,          OPTIONAL, ANY,          "",        0, PROBE_COMPONENTS, "that alone, as NAME.value: of vectors x, y, z, magnitude, of tensors xx ... zx, of principal 1, 2, 3"},
  {"probes.NAME.part",        CHOICE,          OPTIONAL, ANY,          "",        0, "total|internal|viscous|inertial|load", "of a reaction; default: total = internal + viscous + inertial - load"},
  {"probes.NAME.about",       VECTOR,          OPTIONAL, ANY,          "m",       0, 0, "the point that moments of a reaction or force, and angular momenta, are about, with arms from it to where nodes are now; default: the origin"},

  {"quantities",              SCHEMA_NAMED_TEXTS, OPTIONAL, ANY,       "",        0, 0, "numbers out of the columns of probes.csv and energy.csv, found at the resolution of the steps and written to result.json: {peak: max(corner.ux), end: corner.ux@end}; max, min, mean, integral, amplitude, period of a column, all of it or from a time to another, \"max(corner.ux, 0.5, end)\"; corner.ux@1.5 at a time [s]; when(max(..)) the time of an extreme; abs(..) around a column or a number; where braces stand around it, a text with commas wants quotes"},

  {"output",                  MAP,             OPTIONAL, ANY,          "",        "{}", 0, "what is written beside the tables"},
  {"output.fields",           CHOICE,          OPTIONAL, ANY,          "",        "vtu", "vtu|none", "fields on the mesh, for ParaView"},
  {"output.every",            INTEGER,         OPTIONAL, POSITIVE,     "",        "auto", "auto", "fields at every so many output times, and the last; auto: 1 or, where all frames of a run would take more than 100 MB together, so many that they take at most that, or the first and the last alone; corot check and corot run say so"},
  {"output.compression",      CHOICE,          OPTIONAL, ANY,          "",        "none", "none|zlib", "of the fields; zlib: as ParaView and VTK read them, bit for bit the same"},
  {"output.history",          CHOICE,          OPTIONAL, ANY,          "",        "true", "true|false", "history.csv: probes and energies at the end of every step, not at output times alone"},
  {"output.steps",            CHOICE,          OPTIONAL, ANY,          "",        0, "thin|all", "rows of steps.csv; thin, the default: each step up to 10 000, each tenth up to 100 000, each hundredth up to 1 000 000 and so on, and kinks, restarts, failures and the last one; result.json says what is there"},
  {"output.states",           CHOICE,          OPTIONAL, ANY,          "",        "none", "binary|none", "states.bin: displacement and velocity of all degrees of freedom at the output times, to the last bit"},
  {"output.space_error",      CHOICE,          OPTIONAL, ANY,          "",        "auto", "auto|true|false", "what the mesh of four-node tets leaves out of the displacement, in result.json and, above 5 %, as a warning; auto: where it takes at most a tenth of the run, or next to no time, some 0.05 s"},

  {"threads",                 INTEGER,         OPTIONAL, POSITIVE,     "",        0, 0, "that share the work of a run or an equilibrium out, up to 256; default: as many as pay for a mesh of this size, 1 for a small one, no more than there are processors, nor than OMP_NUM_THREADS says; of an FMU 1. It changes nothing of the answer, to the last bit"},

  {"checkpoint",              SCHEMA_SHORT,    OPTIONAL, ANY,          "",        0, 0, "what corot run --resume goes on from, checkpoint.bin in the run's folder, which a run that is over removes; to the last bit as if nothing had ended it. A number is checkpoint.every"},
  {"checkpoint.every",        SCHEMA_DURATION, OPTIONAL, NOT_NEGATIVE, "s",       "600.0", 0, "time on the clock from one writing of it to the next; or with a unit: 30 s, 10 min, 2 h, 1 d; 0: as often as steps says. kill -9 costs at most that time and checkpoint.steps steps; a request to end (SIGTERM, SIGINT, a limit of time) at most these steps. It changes nothing of the answer"},
  {"checkpoint.steps",        INTEGER,         OPTIONAL, POSITIVE,     "",        "500", 0, "the integrator begins anew after every so many steps, from what is to be written, whether it is written or not; cvode and ida take some ten short steps of low order then, so that few steps cost, and many lose more. It is part of the answer, as a tolerance is"},
};
/* clang-format on */

static const schema_synonym synonyms[] = {
    {.path = "", .key = "input", .name = "inputs"},
    {.path = "inputs.NAME", .key = "file", .name = "values.file"},
    {.path = "inputs.NAME", .key = "amplitude", .name = "values"},
    {.path = "inputs.NAME", .key = "factor", .name = "values"},
    {.path = "inputs.NAME", .key = "force", .name = "loads[].amplitude.file"},
    {.path = "inputs.NAME", .key = "path", .name = "boundary[].move.amplitude.file"},
    {.path = "", .key = "initial", .name = "start"},
    {.path = "", .key = "initial_conditions", .name = "start"},
    {.path = "", .key = "initial_velocity", .name = "start.velocity"},
    {.path = "", .key = "velocity", .name = "start.velocity"},
    {.path = "", .key = "spin", .name = "start.spin"},
    {.path = "start", .key = "angular_velocity", .name = "spin"},
    {.path = "start", .key = "omega", .name = "spin"},
    {.path = "groups.NAME", .key = "ball", .name = "sphere"},
    {.path = "groups.NAME", .key = "distance", .name = "near"},
    {.path = "groups.NAME", .key = "within", .name = "near"},
    {.path = "groups.NAME", .key = "minus", .name = "difference"},
    {.path = "groups.NAME", .key = "subtract", .name = "difference"},
    {.path = "groups.NAME", .key = "and", .name = "intersection"},
    {.path = "groups.NAME", .key = "or", .name = "union"},
    {.path = "boundary[]", .key = "displacement", .name = "move"},
    {.path = "boundary[]", .key = "displace", .name = "move"},
    {.path = "boundary[]", .key = "amplitude", .name = "move.amplitude"},
    {.path = "boundary[].translate", .key = "displacement", .name = "boundary[].move.direction"},
    {.path = "boundary[].translate", .key = "amplitude", .name = "boundary[].move.amplitude"},
    {.path = "boundary[].rotate", .key = "angle", .name = "boundary[].move.rotate.angle"},
    {.path = "boundary[].rotate", .key = "amplitude", .name = "boundary[].move.amplitude"},
    {.path = "boundary[].move", .key = "displacement", .name = "direction"},
    {.path = "boundary[].move", .key = "translate", .name = "direction"},
    {.path = "boundary[].move.amplitude", .key = "spline", .name = "smooth"},
    {.path = "boundary[].move.amplitude", .key = "table", .name = "file"},
    {.path = "loads[].amplitude", .key = "spline", .name = "smooth"},
    {.path = "loads[].amplitude", .key = "table", .name = "file"},
};

const schema scenario_schema = {
    .key = keys,
    .nkey = sizeof keys / sizeof *keys,
    .synonym = synonyms,
    .nsynonym = sizeof synonyms / sizeof *synonyms,
};

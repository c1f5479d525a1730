/* Each runs as it is, within a second or two, and says in comments what to change. */
#include "starters.h"

#define HEAD                                                                                  \
  "# yaml-language-server: $schema=corot.schema.json\n"                                       \
  "# The line above makes editors complete and check the keys; the file that it names comes " \
  "from\n"                                                                                    \
  "#   corot schema --json >corot.schema.json\n"                                              \
  "#\n"

#define TAIL                                                                                 \
  "\n"                                                                                       \
  "# Numbers are in SI units, or have their unit behind them: 20 ms, 2 MPa, 5 mm, 30 deg.\n" \
  "# All keys, and what they are when they are not given: corot schema\n"

static const char bar[] = HEAD
    "#   corot check FILE     what this amounts to\n"
    "#   corot run FILE       the motion, to out/NAME; then corot report out/NAME shows it\n"
    "#   corot modes FILE     its frequencies\n"
    "title: a soft bar that is pulled aside at its free end\n"
    "\n"
    "mesh:\n"
    "  # A file instead: file: part.msh (gmsh, Abaqus, VTK and others; corot mesh info part.msh)\n"
    "  box: {size: [10 cm, 10 cm, 60 cm], cells: [1, 1, 6]} # sides: groups xmin ... zmax\n"
    "  order: 2 # ten-node tets, which bend well\n"
    "\n"
    "material:\n"
    "  E: 1 MPa # Young's modulus, of soft rubber\n"
    "  nu: 0.4  # Poisson's ratio\n"
    "  density: 1000 kg/m^3\n"
    "  damping: {mu: 200 Pa s} # viscosity; without it the bar never comes to rest\n"
    "\n"
    "boundary:\n"
    "  - {group: zmin, fix: [x, y, z]} # clamped\n"
    "\n"
    "loads:\n"
    "  - group: zmax\n"
    "    traction: [400 Pa, 0, 0] # force per area, of fixed direction\n"
    "    amplitude: [[0, 0], [0.1, 1]] # [time, factor]: it sets in within a tenth of a second\n"
    "\n"
    "time: {end: 1 s, output: 20 ms}\n"
    "\n"
    "integrator:\n"
    "  rtol: 1.0e-4 # the error of a step; smaller is more accurate, and takes longer\n"
    "\n"
    "probes:\n"
    "  tip: {point: [10 cm, 10 cm, 60 cm]} # columns tip.ux tip.uy tip.uz of probes.csv\n"
    "\n"
    "quantities: # numbers of result.json\n"
    "  largest: max(tip.ux)\n"
    "  last: tip.ux@end\n" TAIL;

static const char bracket[] = HEAD
    "#   corot static FILE    the equilibrium, to out/NAME-static\n"
    "#   corot solve FILE --static --goal tip.uz@end --within 0.02\n"
    "#                        the deflection with an error of at most two per cent\n"
    "title: a steel bracket on a wall, with a load on its end\n"
    "\n"
    "mesh:\n"
    "  # A file instead: file: bracket.msh, with groups of its own for wall and load\n"
    "  box: {size: [80 mm, 30 mm, 6 mm], cells: [10, 4, 1]}\n"
    "  order: 2 # ten-node tets, which bend well\n"
    "\n"
    "material: {E: 210 GPa, nu: 0.3, density: 7.85 g/cm^3}\n"
    "\n"
    "boundary:\n"
    "  - {group: xmin, fix: [x, y, z]} # the wall\n"
    "\n"
    "loads:\n"
    "  - {group: xmax, force: [0, 0, -200 N]} # in all, spread over the nodes of the end\n"
    "  - {gravity: [0, 0, -9.81 m/s^2]}\n"
    "\n"
    "time: {end: 1 s} # of corot run; corot static takes the loads of this time\n"
    "\n"
    "probes:\n"
    "  tip: {point: [80 mm, 15 mm, 0]}\n"
    "  wall: {group: xmin, of: reaction} # the forces of the wall: wall.fx wall.fy wall.fz\n"
    "  stress: {of: von_mises, take: max}\n"
    "\n"
    "quantities:\n"
    "  deflection: tip.uz@end\n" TAIL;

static const char body[] = HEAD
    "#   corot run FILE       the motion, to out/NAME; then corot report out/NAME shows it\n"
    "title: a body that nothing holds, tumbling\n"
    "\n"
    "mesh:\n"
    "  box: {size: [30 cm, 20 cm, 5 cm], cells: [2, 2, 1], origin: [-15 cm, -10 cm, -2.5 cm]}\n"
    "  order: 2 # ten-node tets\n"
    "\n"
    "material: {E: 1 MPa, nu: 0.4, density: 1 g/cm^3, damping: {mu: 100 Pa s}}\n"
    "\n"
    "start: # no boundary, no loads: what it has at the beginning it keeps\n"
    "  velocity: [0.5 m/s, 0, 0]\n"
    "  # turned about the axis between the longest and the shortest one, it tumbles\n"
    "  spin: {axis: [0.01, 1, 0], rate: 360 deg/s}\n"
    "\n"
    "time: {end: 2 s, output: 20 ms}\n"
    "\n"
    "integrator: {method: arkode, rtol: 1.0e-4} # keeps momentum and energy better than cvode\n"
    "\n"
    "probes:\n"
    "  corner: {point: [15 cm, 10 cm, 2.5 cm]}\n"
    "  elastic: {of: elastic} # energy: as much as the spin strains it\n" TAIL;

const starter starters[] = {
    {"bar", "a soft bar that is pulled aside, in motion", bar},
    {"bracket", "a steel bracket under a load, in equilibrium", bracket},
    {"free", "a body that nothing holds, tumbling", body},
};
const int nstarter = sizeof starters / sizeof *starters;

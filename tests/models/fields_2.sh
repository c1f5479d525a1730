# usage: fields_2.sh COROT FOLDER: ten-node tets with curved edges, their fields read back by VTK
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=/usr/bin/python3 # Debian's python3-vtk9 is for this one
[ -x $python ] || exit 77
mkdir -p "$2" && cd "$2"
cat >quarter.yaml <<END
mesh: {file: "$here/../unit/data/quarter.msh"}
groups:
  base: {plane: {axis: z, at: 0.0}}
  top: {plane: {axis: z, at: 1.0}}
material: {lambda: 1.0e+5, mu: 1.0e+4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
strain: polar
boundary:
  - {group: base, fix: [x, y, z]}
  - {group: top, translate: {velocity: [0.4, -0.2, 0.1]}}
time: {end: 0.5, output: 0.25}
integrator: {rtol: 1.0e-3}
END
"$1" run quarter.yaml -o quarter --quiet
$python -B "$here/check_fields_2.py" quarter
"$1" run quarter.yaml -o packed --quiet --set output.compression=zlib
exec $python -B "$here/same_fields.py" quarter packed

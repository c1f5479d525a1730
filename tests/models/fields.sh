# usage: fields.sh COROT FOLDER: a bar that bends far, its fields read back by VTK
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=/usr/bin/python3 # Debian's python3-vtk9 is for this one
[ -x $python ] || exit 77
mkdir -p "$2" && cd "$2"
cat >bent.yaml <<END
mesh: {box: {size: [0.1, 0.1, 0.6], cells: [2, 2, 12]}}
groups:
  base: {plane: {axis: z, at: 0.0}}
  top: {plane: {axis: z, at: 0.6}}
material: {lambda: 1.0e+5, mu: 1.0e+4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
strain: polar
boundary: [{group: base, fix: [x, y, z]}]
loads: [{group: top, traction: [200.0, 50.0, 0.0]}]
time: {end: 1.0, output: 0.25}
integrator: {rtol: 1.0e-3}
probes: {corner: {point: [0.1, 0.1, 0.6]}, middle: {point: [0.05, 0.05, 0.3]}}
END
"$1" run bent.yaml -o bent --quiet
$python -B "$here/check_fields.py" bent 0.5
"$1" run bent.yaml -o packed --quiet --set output.compression=zlib
exec $python -B "$here/same_fields.py" bent packed

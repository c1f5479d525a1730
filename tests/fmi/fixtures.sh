# The FMUs that the tests import, unpacked, beside the runs that they have to agree with.
# usage: fixtures.sh COROT FOLDER
set -eu
corot=$1
rm -rf "$2"
mkdir -p "$2/made"
cd "$2/made"

# Steps of output that are exact in binary: the communication points are those of the run.
cat >block.yaml <<'YAML'
title: a block under a shear load & <its> "motion"
mesh: {box: {size: [0.1, 0.1, 0.2], cells: [2, 2, 4], split: kuhn}}
groups:
  base: {plane: {axis: z, at: 0.0}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary:
  - {group: base, fix: [x, y, z]}
time: {end: 0.125, output: 0.0078125}
integrator: {method: cvode, rtol: 1.0e-6}
output: {fields: none, space_error: false}
YAML

# free: no inputs; a mesh from a file, a table that bends, and all sorts of probes, energies too.
"$corot" mesh box --size 0.1,0.1,0.2 --cells 2,2,4 -o block.msh 2>/dev/null
printf 'time factor\n0 0\n0.03 1\n0.05 1\n0.06 -0.5\n' >push.csv
sed '/^mesh/s/.*/mesh: {file: block.msh}/' block.yaml >free.yaml
cat >>free.yaml <<'YAML'
loads:
  - {group: zmax, traction: [200.0, 0.0, 0.0], amplitude: {file: push.csv}}
probes:
  corner: {point: [0.1, 0.1, 0.2]}
  speed: {point: [0.1, 0.1, 0.2], of: velocity}
  push: {point: [0.1, 0.1, 0.2], of: acceleration}
  hold: {group: base, of: reaction}
  worst: {of: von_mises, take: max}
  size: {of: volume}
  inner: {of: elastic}
  moving: {of: kinetic}
  spin: {of: angular_momentum}
  lost: {of: dissipated}
  given: {of: external_work}
  off: {of: balance}
YAML

# driven: two inputs, whose values change at some of the communication points.
cat block.yaml - >driven.yaml <<'YAML'
loads:
  - {group: zmax, traction: [200.0, 0.0, 0.0]}
  - {gravity: [0.0, 0.0, -9.81], amplitude: {sine: {frequency: 6.0}}}
probes:
  corner: {point: [0.1, 0.1, 0.2]}
  speed: {point: [0.1, 0.1, 0.2], of: velocity}
  push: {point: [0.1, 0.1, 0.2], of: acceleration}
  hold: {group: base, of: reaction}
  worst: {of: von_mises, take: max}
inputs:
  push: {load: 0, values: [[0.0, 0.5]]}
  flesh: {material: 0, values: [[0.0, 1.0]]}
YAML
# What the importer sets at the k-th point (driven_push and driven_flesh in test_fmu_simulation.c).
python3 - <<'PY'
h, n = 0.0078125, 16
push = [0.5 + 0.25 * (k // 2 % 5) for k in range(n)]
flesh = [1.0 if k < 6 else 1.5 for k in range(n)]
points = [[0.0, push[0]]]
for k in range(1, n):
    points += [[k * h, push[k - 1]], [k * h, push[k]]]
text = open("driven.yaml").read()
text = text.replace("[[0.0, 0.5]]", repr(points)).replace("[[0.0, 1.0]]", repr([[0.0, 1.0], [6 * h, 1.5]]))
open("driven_run.yaml", "w").write(text)
PY

# held: frames that are found anew at times of their own, with the same inputs.
for name in driven driven_run; do
  sed 's/^output:/frames: {policy: hold, max_angle: 0.02, interval: 0.0078125}\n&/
    s/^probes:/&\n  off: {of: balance}\n  turned: {of: frame_energy}/' $name.yaml >held"${name#driven}".yaml
done

# stepped: a method of constant step, which ends a step at each communication point.
for name in driven driven_run; do
  sed 's/^integrator:.*/integrator: {method: generalized-alpha, step: 0.001953125}/' $name.yaml \
    >stepped"${name#driven}".yaml
done

# strained: begins in equilibrium under what the inputs say.
sed 's/^output:/start: equilibrium\n&/' driven.yaml >strained.yaml

# bent: supports that move, amplitudes with kinks, for Model Exchange.
cat block.yaml - >bent.yaml <<'YAML'
loads:
  - {group: zmax, traction: [200.0, 0.0, 0.0], amplitude: [[0, 0], [0.03, 1], [0.05, 1], [0.06, -0.5]]}
probes:
  corner: {point: [0.1, 0.1, 0.2]}
  speed: {point: [0.1, 0.1, 0.2], of: velocity}
YAML
sed -i '/group: base, fix/s/.*/  - {group: base, move: {direction: [0.01, 0.0, 0.0], amplitude: [[0, 0], [0.02, 0], [0.07, 1]]}}/' bent.yaml

for name in free driven held stepped strained bent; do
  run=$name.yaml
  [ -f "${name}_run.yaml" ] && run=${name}_run.yaml
  "$corot" run "$run" -o "../$name.run" --quiet --set linear_solver=klu
  "$corot" export-fmu $name.yaml -o $name.fmu --quiet
  python3 - $name.fmu ../$name <<'PY'
import sys, zipfile
zipfile.ZipFile(sys.argv[1]).extractall(sys.argv[2])
PY
done
"$corot" run free.yaml -o ../stiff.run --quiet --set linear_solver=klu --set material.mu=2.0e4
"$corot" run free.yaml -o ../coarse.run --quiet --set linear_solver=klu --set integrator.rtol=1e-3
cp free.fmu driven.fmu block.msh push.csv free.yaml ..
# Nothing is left of where they were made.
cd ..
rm -r made

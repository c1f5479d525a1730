# Each warning is given where it is true and not beside that, and whoever shows warnings shows all.
. "$(dirname "$0")/lib.sh"

# Pulled slowly: even one cell across will do, and nothing is to be said.
cat >pull.yaml <<'YAML'
title: a bar that is pulled
mesh: {box: {size: [0.1, 0.1, 0.4], cells: [1, 1, 4], split: kuhn}}
material: {lambda: 1.0e5, mu: 1.0e5, density: 1000.0}
boundary: [{group: zmin, fix: [x, y, z]}]
loads: [{group: zmax, traction: [0.0, 0.0, 1.0e3], amplitude: [[0.0, 0.0], [0.5, 1.0]]}]
time: {end: 0.6, output: 0.01}
output: {fields: none}
probes: {corner: {point: [0.1, 0.1, 0.4]}}
YAML

# Let go and left alone: it swings with a period of 0.84 s. The mesh is too coarse for bending.
sed 's/mu: 1.0e5/mu: 1.0e4/; s/^loads.*/loads: [{group: zmax, traction: [30.0, 0.0, 0.0]}]/
     s/^time.*/time: {end: 5.0, output: 0.05}/' pull.yaml >swing.yaml

# Two blocks that touch, of which one is held.
cat >blocks.py <<'PY'
"""blocks.py A.msh B.msh C.msh: C is A and B side by side, their nodes not joined."""
import sys
def read(name):
    lines = open(name).read().split("\n")
    part = lambda word: lines[lines.index("$" + word) + 2 : lines.index("$End" + word)]
    return [n.split()[1:] for n in part("Nodes")], [e.split() for e in part("Elements")]
nodes, tets = [], []
for name in sys.argv[1:3]:
    x, elements = read(name)
    for e in elements:
        if e[1] == "4":
            tets.append([str(int(n) + len(nodes)) for n in e[-4:]])
    nodes += x
with open(sys.argv[3], "w") as f:
    f.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(nodes))
    f.write("".join("%d %s\n" % (i + 1, " ".join(x)) for i, x in enumerate(nodes)))
    f.write("$EndNodes\n$Elements\n%d\n" % len(tets))
    f.write("".join("%d 4 2 1 1 %s\n" % (i + 1, " ".join(t)) for i, t in enumerate(tets)))
    f.write("$EndElements\n")
PY
block() { "$corot" mesh box --size 0.1,0.1,0.1 --cells 1,1,1 --split kuhn "$@" 2>stderr; }
block -o one.msh || complain "no box"
block --origin 0.1,0,0 -o other.msh || complain "no other box"
python3 blocks.py one.msh other.msh two.msh || complain "no two blocks"
sed 's/^mesh:.*/mesh: {file: two.msh}/; s/^boundary.*/boundary: [{group: wall, fix: [x, y, z]}]/
     s/^loads.*/loads: [{gravity: [0.0, 0.0, -1.0]}]/; s/0.1, 0.1, 0.4/0.1, 0.1, 0.1/
     s/^title.*/groups: {wall: {plane: {axis: x, at: 0.0}}, end: {plane: {axis: x, at: 0.2}}}/' \
  pull.yaml >blocks.yaml
sed 's/^mesh:.*/mesh: {file: one.msh}/; /end:/s/, end.*/}/' blocks.yaml >block.yaml

codes() { python3 -c "
import json
print(*sorted({w['code'] for w in json.load(open('$1'))['warnings']}))"; }

# has CODE ARGUMENTS...: corot gives it. lacks CODE ARGUMENTS...: corot does not.
has() {
  word=$1
  shift
  expect 0 "$@" --json
  echo " $(codes stdout) " | grep -q " $word " || complain "$what: no $word but: $(codes stdout)"
  echo "$word" >>fired
}
lacks() {
  word=$1
  shift
  expect 0 "$@" --json
  echo " $(codes stdout) " | grep -q " $word " && complain "$what: $word"
  true
}
run() { echo run "$1" -o r --quiet; }
# As pull.yaml, by a mesh that leaves out less than a twentieth of the displacement.
fine="--set mesh.box.cells=[4,4,12]"
constant() { echo "integrator={method: $1, step: $2}"; }

# Nothing where nothing is wrong, in a run, in statics and before either.
# shellcheck disable=SC2086
expect 0 run pull.yaml -o r --json --set integrator.method=arkode $fine; [ -z "$(codes stdout)" ] || complain "$what: $(codes stdout)"
grep -q warning stderr && complain "a warning of nothing"
# shellcheck disable=SC2086
expect 0 static pull.yaml -o r --json $fine; [ -z "$(codes stdout)" ] || complain "$what: $(codes stdout)"
expect 0 check pull.yaml --set integrator.method=arkode; no_err; grep -q warning stdout && complain "a warning of nothing"

# Before the first step.
has locking check pull.yaml --set material.lambda=1.1e6
lacks locking check pull.yaml --set material.lambda=0.9e6
lacks locking check pull.yaml --set material.lambda=1.1e6 --set dilatation=nodal
has locking check pull.yaml --set material.lambda=1.1e6 --set dilatation=element # a linear tet's own
ten="--set mesh.order=2"
has locking check pull.yaml $ten --set material.lambda=5.1e6
lacks locking check pull.yaml $ten --set material.lambda=4.9e6
lacks locking check pull.yaml $ten --set material.lambda=1e9 --set dilatation=element
lacks locking check pull.yaml $ten --set material.lambda=1e9 --set dilatation=nodal
block --order 2 -o ten.msh || complain "no ten-node box"
lacks locking check pull.yaml --set 'mesh={file: ten.msh}' --set 'boundary=[]' --set 'loads=[]' --set material.lambda=4.9e6 # its order is the file's
expect 0 check pull.yaml $ten --set material.lambda=5.1e6
out "nu = 0.4904: ten-node tets"; out "dilatation: element is the remedy [locking]"

has threads check pull.yaml --set threads=$(($(nproc) + 1))
lacks threads check pull.yaml --set threads=$(nproc)

has parts check blocks.yaml; has unheld check blocks.yaml
has parts mesh info two.msh; json '[p["nodes"] for p in d["parts"]] == [8, 8] and d["parts"][1]["first"] == 8'
lacks parts mesh info one.msh; json '[(p["first"], p["nodes"]) for p in d["parts"]] == [(0, 8)]'
expect 0 mesh info two.msh; out "parts     2"; out "8 nodes with node 8"; out "[parts]"
lacks parts check block.yaml; lacks unheld check block.yaml
lacks unheld check block.yaml --set boundary=[]  # one that flies is meant to
lacks unheld check blocks.yaml --set boundary=[] # and so may two
has parts check blocks.yaml --set boundary=[]
lacks unheld check blocks.yaml --set 'boundary=[{group: wall, fix: [x, y, z]}, {group: end, fix: [z]}]' # in some way held
expect 0 check blocks.yaml; out "nothing holds the part of the body with node 8 (8 nodes)"
out "it can move along x, y and z and turn about x, y and z"

has probe check pull.yaml --set 'probes.corner.point=[0.1, 0.1, 0.6]'
has probe check pull.yaml --set 'probes.corner.point=[0.1, 0.1, 0.42]'
lacks probe check pull.yaml --set 'probes.corner.point=[0.1, 0.1, 0.4000001]'
has probe check pull.yaml --set 'probes.corner={point: [0.1, 0.1, 0.6], nearest: true}'
lacks probe check pull.yaml --set 'probes.corner={point: [0.1, 0.1, 0.42], nearest: true}'
lacks probe check pull.yaml --set 'probes.corner.point=[0.05, 0.05, 0.35]' # the middle of a cell
lacks probe check pull.yaml --set 'probes.corner={node: 3}'

has rtol check pull.yaml --set integrator.rtol=1e-15
lacks rtol check pull.yaml --set integrator.rtol=1e-12
has rtol check pull.yaml --set "integrator={method: newmark, step: 0.01, newton: {tolerance: 1e-16}}"
lacks rtol check pull.yaml --set "$(constant newmark 0.01)"
# What is known only when the body has moved; and it is said once.
lacks rtol check pull.yaml --set 'integrator={method: erk, order: 8, rtol: 1e-14}'
has rtol $(run pull.yaml) --set 'integrator={method: erk, order: 8, rtol: 1e-14}' --set time.end=0.1
json 'sum(w["code"] == "rtol" for w in d["warnings"]) == 1'

# A body that hardly moves: the absolute tolerance is all there is.
has atol $(run pull.yaml) --set 'loads.0.traction=[0,0,1]'
lacks atol $(run pull.yaml) --set 'loads.0.traction=[0,0,1]' --set integrator.atol.displacement=1e-10
lacks atol $(run pull.yaml) --set 'loads.0.traction=[0,0,1]' --set "$(constant newmark 0.01)"
lacks atol $(run pull.yaml) --set 'loads.0.traction=[0,0,100]'

# Another integrator, where nothing damps the body, or nothing holds it.
for method in cvode ida; do
  for rtol in 1e-3 1e-4 1e-6; do
    has integrator check swing.yaml --set "integrator={method: $method, rtol: $rtol}"
    json 'any("nothing damps the body, so that the errors of '$method'" in w["text"] for w in d["warnings"])'
  done
  lacks integrator check swing.yaml --set "integrator={method: $method, rtol: 1e-7}"
  for damping in '{lambda: 10, mu: 1}' '{mass: 0.1}'; do
    lacks integrator check swing.yaml --set "integrator.method=$method" --set "material.damping=$damping"
  done
done
for integrator in '{method: arkode}' '{method: erk}' '{method: newmark, step: 0.01}'; do
  lacks integrator check swing.yaml --set "integrator=$integrator"
done
has integrator $(run swing.yaml)
lacks integrator static swing.yaml -o r --quiet # which takes no steps in time
lacks integrator check swing.yaml --set 'frames={policy: hold, interval: 0.1}' # whose error is larger
lacks integrator check swing.yaml --set 'loads=[]'
lacks integrator check swing.yaml --set start=equilibrium # nothing moves it
has integrator check swing.yaml --set start=equilibrium --set 'loads.0.amplitude=[[0, 1], [1, 0]]'
has integrator check swing.yaml --set 'loads=[]' --set 'start={velocity: [0.1, 0, 0]}'
has integrator check swing.yaml --set 'loads=[]' \
  --set 'boundary=[{group: zmin, translate: {velocity: [0.1, 0, 0]}}]'

sed 's/^boundary.*/boundary: []/; s/^loads.*/loads: [{gravity: [0.0, 0.0, -9.81]}]/' \
  swing.yaml >thrown.yaml
spin='{spin: {axis: [1, 2, 3], rate: 4}}'
for damping in 0 10; do # damped, it still turns
  damped="material.damping={lambda: $damping, mu: $damping}"
  has integrator check thrown.yaml --set "start=$spin" --set "$damped"
  json 'any("nothing holds" in w["text"] and "angular momentum" in w["text"] for w in d["warnings"])'
  has integrator check thrown.yaml --set 'start={group: zmax, velocity: [1, 0, 0]}' --set "$damped"
  lacks integrator check thrown.yaml --set 'start={velocity: [1, 0, 0]}' --set "$damped"
  lacks integrator check thrown.yaml --set "start=$spin" --set "$damped" --set integrator.rtol=1e-7
  lacks integrator check thrown.yaml --set "start=$spin" --set "$damped" \
    --set integrator.method=arkode
done
lacks integrator check swing.yaml --set "start=$spin" --set "$damped" # held

# Energy: lost to the method, or never there.
has numerical-dissipation $(run swing.yaml) --set "$(constant backward-euler 0.01)"
lacks ledger $(run swing.yaml) --set "$(constant backward-euler 0.01)"
lacks numerical-dissipation $(run swing.yaml) --set "$(constant midpoint 0.01)"
has numerical-dissipation $(run swing.yaml) --set integrator.rtol=1e-2
lacks numerical-dissipation $(run swing.yaml) --set integrator.rtol=1e-4
# viscosity takes nearly all, and the method is not blamed for it
lacks numerical-dissipation $(run swing.yaml) --set 'material.damping={lambda: 1000, mu: 1000}'
json 'd["energy"]["dissipated"] > 0.4 * d["energy"]["external_work"]'
has ledger $(run swing.yaml) --set "$(constant newmark 0.15)" --set 'loads.0.traction=[100,0,0]' \
  --set time.end=10
lacks numerical-dissipation $(run swing.yaml) --set "$(constant newmark 0.15)" \
  --set 'loads.0.traction=[100,0,0]' --set time.end=10
lacks ledger $(run swing.yaml) --set "$(constant newmark 0.02)" --set 'loads.0.traction=[100,0,0]' \
  --set time.end=10

# A bar of steel, loaded slowly in few long steps: nothing is lost, and the work is that of the load.
sed 's/^material.*/material: {E: 2.1e11, nu: 0.3, density: 7850, damping: {lambda: 2.0e6, mu: 2.0e6}}/
     s/1.0e3\], amplitude: .*/1.0e6], amplitude: [[0, 0], [1, 1]]}]/
     s/^time.*/time: {end: 10.0, output: 0.5}/' pull.yaml >steel.yaml
for method in cvode ida arkode; do
  lacks numerical-dissipation $(run steel.yaml) --set integrator.method=$method
  lacks ledger $(run steel.yaml) --set integrator.method=$method
done

# Strains.
for command in run static; do
  # Newton's iteration of statics is not for warp.
  for strain in $([ $command = run ] && echo warp) polar hybrid green; do
    has strain-range $command pull.yaml -o r --quiet --set strain=$strain --set 'loads.0.traction=[0,0,8e4]'
    lacks strain-range $command pull.yaml -o r --quiet --set strain=$strain --set 'loads.0.traction=[0,0,3e4]'
  done
  has strain-range $command swing.yaml -o r --quiet --set strain=cauchy --set 'loads.0.traction=[400,0,0]'
  lacks strain-range $command swing.yaml -o r --quiet --set strain=cauchy
  lacks strain-range $command swing.yaml -o r --quiet --set 'loads.0.traction=[200,0,0]' # turns
  has inverted $command pull.yaml -o r --quiet --set strain=cauchy --set 'loads.0.traction=[0,0,-3e5]'
  json 'any("det F = -" in w["text"] for w in d["warnings"])'
  lacks inverted $command pull.yaml -o r --quiet --set strain=cauchy --set 'loads.0.traction=[0,0,-1e5]'
done

# The mesh, by the stress: bent, two cells and four are told, eight will do; pulled, one will.
stress="--set output.space_error=false"
for across in 2 4; do
  has bending static swing.yaml -o r --quiet --set material.lambda=2e4 $stress \
    --set mesh.box.cells=[$across,$across,$((4 * across))]
done
lacks bending static swing.yaml -o r --quiet --set material.lambda=2e4 $stress \
  --set mesh.box.cells=[8,8,32]
lacks bending static pull.yaml -o r --quiet $stress
has bending $(run swing.yaml) $stress --set mesh.refine=1
json '"mesh.order: 2, mesh.refine: 2" in d["warnings"][-1]["text"]'
has bending $(run swing.yaml) --lean

# And by ten-node tets, which takes the place of that: bent, two cells and four are told (eight
# still leave out 7 %); pulled, one is, for what the clamped end lets the sides do, and four are not.
for across in 2 4; do
  has space static swing.yaml -o r --quiet --set material.lambda=2e4 --set output.space_error=true \
    --set mesh.box.cells=[$across,$across,$((4 * across))]
  json 'not any(w["code"] == "bending" for w in d["warnings"])'
  json 'any("mesh.order: 2" in w["text"] and "probe corner lacks (" in w["text"] for w in d["warnings"])'
done
has space static pull.yaml -o r --quiet; lacks space static pull.yaml -o r --quiet $fine
for command in run static; do
  has space $command swing.yaml -o r --quiet
  json 'd["space_error"]["left_out"] is None and 0.05 < d["space_error"]["relative"] < 1'
  json 'len(d["space_error"]["probes"]["corner"]) == 3 and d["space_error"]["error"] > 0'
  for why in "output.space_error=false" "mesh.order=2"; do
    lacks space $command swing.yaml -o r --quiet --set $why
    json 'list(d["space_error"]) == ["left_out"] and len(d["space_error"]["left_out"]) > 10'
  done
  lacks space $command swing.yaml -o r --quiet --lean; json 'd["space_error"]["left_out"] == "option --lean"'
  has space $command swing.yaml -o r --quiet --lean --set output.space_error=true
done
# A fine mesh costs too much for few steps, by counts: not by the clock.
lacks space static swing.yaml -o r --quiet --set mesh.box.cells=[6,6,24]
json '"more than a tenth" in d["space_error"]["left_out"]'
# What moves as one has no error, whatever the steps leave; nor what is shorter than a tolerance.
for method in cvode ida arkode; do
  lacks space $(run block.yaml) --set boundary=[] --set integrator.method=$method
  lacks space $(run block.yaml) --set boundary=[] --set loads=[] --set integrator.method=$method \
    --set 'start={velocity: [1, 0, 0], spin: {axis: [0, 1, 1], rate: 0.01}}'
done

# Time.
has step $(run swing.yaml) --set "$(constant newmark 0.15)"
lacks step $(run swing.yaml) --set "$(constant newmark 0.08)"
has output $(run swing.yaml) --set time.output=0.15
json '0.8 < d["observed"]["period"] < 0.88'
lacks output $(run swing.yaml) --set time.output=0.08
lacks output $(run swing.yaml) --set time.output=5 # who asks for the end alone
lacks output $(run pull.yaml) --set time.output=0.3 # it does not swing
for start in rest equilibrium; do # nothing moves but the last digits
  lacks output $(run swing.yaml) --set start=$start --set time.output=0.3 \
    --set 'loads.0.amplitude=[[0, 0.001], [5, 1]]' --set integrator.max_step=0.05
done
for method in cvode ida arkode; do # a free fall, without stress
  lacks bending $(run block.yaml) --set boundary=[] --set integrator.method=$method
done

# Modes: of a damped body and not of one that is not; of a column beyond what buckles it; of a block
# pressed on one side, which has a free edge, and not of one pressed all around.
if ! "$corot" modes pull.yaml -o modes 2>stderr && grep -q "built without ARPACK" stderr; then
  printf '%s\n' undamped unstable symmetric >>fired
else
  about='-n 2 -o modes --quiet --about equilibrium'
  has undamped modes pull.yaml -n 2 -o modes --quiet --set material.damping.mu=1
  lacks undamped modes pull.yaml -n 2 -o modes --quiet --set material.damping=null
  column='--set mesh.box.size=[0.1,0.1,1] --set mesh.box.cells=[1,1,8] --set mesh.order=2 --set strain=green'
  has unstable modes pull.yaml $about $column --set 'loads=[{group: zmax, traction: [0, 0, -900]}]'
  lacks unstable modes pull.yaml $about $column --set 'loads=[{group: zmax, traction: [0, 0, 900]}]'
  has symmetric modes pull.yaml $about --set 'loads=[{group: xmax, pressure: 500}]'
  lacks symmetric modes pull.yaml $about
fi
# What is asked has no answer: the exit code says so, too.
expect 1 run pull.yaml -o r --json --set 'quantities.T=period(frame_energy)'
echo " $(codes stdout) " | grep -q " quantity " || complain "no quantity but: $(codes stdout)"
echo quantity >>fired
lacks quantity $(run swing.yaml) --set 'quantities.T=period(corner.uz)'

# Mesh files that are mended, or whose cells are cut; and one whose names cannot be written.
data=$(cd "$(dirname "$0")/../unit/data" && pwd)
"$corot" mesh box --size 1,1,1 --cells 1,1,1 -o sound.msh 2>stderr
awk '/^\$Nodes/ {print; getline; print $1 + 1; next} /^\$EndNodes/ {print "999 9 9 9"} {print}' sound.msh >unsound.msh
has mesh-mended mesh info unsound.msh
lacks mesh-mended mesh info sound.msh
has mesh-cut mesh info "$data/cells.msh" --cut
lacks mesh-cut mesh info sound.msh --cut
expect 0 mesh convert sound.msh sound.mesh; err " [mesh-lost]"
expect 0 mesh convert sound.msh again.msh; no_out
if grep -q mesh-lost stderr; then complain "$what: mesh-lost"; fi
echo mesh-lost >>fired

# No code without its case, and no case of another code.
expect 0 check --warnings; no_err
cut -d ' ' -f 1 stdout | sort >table
sort -u fired | cmp -s - table || complain "codes: $(sort -u fired | comm -3 - table)"

# All that shows warnings shows the same: stderr, result.json, check, the study.
told() { sed -n 's/^warning: .* \[\(.*\)\]$/\1/p' "$1" | sort -u | tr '\n' ' '; }
many='--set material.lambda=1.1e6 --set time.output=0.15'
for command in run static; do
  # shellcheck disable=SC2086
  expect 0 $command swing.yaml -o m $many
  [ "$(told stderr)" = "$(codes m/result.json) " ] ||
    complain "$command tells $(told stderr), result.json $(codes m/result.json)"
  json_of='import json; d = json.load(open("m/result.json"))["warnings"]'
  python3 -c "$json_of
told = open('stderr').read()
assert len(d) >= 2, d
for w in d:
    assert set(w) == {'code', 'text'} and 'warning: %(text)s [%(code)s]\n' % w in told, w
    assert len(w['text']) > 60, w" || complain "$command: what stderr and result.json say"
done
expect 0 check swing.yaml --set material.lambda=1.1e6; out "dilatation: nodal is the remedy [locking]"

cat >study.yaml <<'YAML'
study: which of them warn
base: swing.yaml
axes:
  - {key: integrator.method, values: [cvode]}
  - {key: integrator.rtol, values: [1.0e-2, 1.0e-4]}
YAML
expect 0 study study.yaml; err "warning: numerical-dissipation: 1 of 2 cells: "
err "warning: bending: 2 of 2 cells: "
python3 - <<'PY' || complain "what the study says of its cells"
import csv, json
cells = json.load(open("out/study/table.json"))["cells"]
rows = {r["id"]: r for r in csv.DictReader(open("out/study/table.csv"))}
for c in cells:
    result = json.load(open("out/study/runs/%s/result.json" % c["id"]))
    codes = [w["code"] for w in result["warnings"]]
    assert codes and c["warnings"] == codes, (c["warnings"], codes)
    assert json.loads(rows[c["id"]]["warnings"]) == codes, rows[c["id"]]
assert any("numerical-dissipation" in c["warnings"] for c in cells)
PY
exit $failed

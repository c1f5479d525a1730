# Factors of loads and of materials that come in while a run goes on: inputs.
. "$(dirname "$0")/lib.sh"
cat >>model.yaml <<'YAML'
integrator: {rtol: 1.0e-8}
output: {fields: none, space_error: false}
YAML

# with FILE INPUT: the model with these inputs.
with() {
  cp model.yaml "$1"
  echo "inputs: {$2}" >>"$1"
}

# near A B TOLERANCE: the last rows of probes.csv of two runs differ by no more than so much of the
# largest number.
near() {
  python3 - "$@" <<'PY' || complain "$1 and $2 do not agree to $3"
import sys
a, b = ([float(x) for x in open(name + "/probes.csv").readlines()[-1].split(",")[1:]] for name in sys.argv[1:3])
off = max(abs(x - y) for x, y in zip(a, b)) / max(map(abs, a))
print(off)
assert off <= float(sys.argv[3])
PY
}

# A load's factor does what its amplitude does, jump and constant ends included; and both may stand.
printf 'time factor\n-1 0\n0.01 1\n0.03 1\n0.03 -1\n0.04 0.5\n' >push.txt
with live.yaml 'push: {load: 0, values: {file: push.txt}}'
sed 's/200.0, 0.0, 0.0]}/200.0, 0.0, 0.0], amplitude: {file: push.txt}}/' model.yaml >known.yaml
for method in cvode ida arkode erk; do
  for name in live known; do
    expect 0 run $name.yaml -o $name.$method --quiet --set integrator.method=$method
  done
  near live.$method known.$method 1e-6
done
expect 0 static live.yaml -o live.static --quiet
expect 0 static known.yaml -o known.static --quiet
near live.static known.static 1e-12
expect 0 run live.yaml -o live.equilibrium --quiet --set start=equilibrium
expect 0 run known.yaml -o known.equilibrium --quiet --set start=equilibrium
near live.equilibrium known.equilibrium 1e-6
sed 's/200.0, 0.0, 0.0]}/200.0, 0.0, 0.0], amplitude: [[0, 0], [0.05, 1]]}/' model.yaml >both.yaml
echo 'inputs: {push: {load: 0, values: [[0, 2], [0.05, 2]]}}' >>both.yaml
sed 's/200.0, 0.0, 0.0]}/400.0, 0.0, 0.0], amplitude: [[0, 0], [0.05, 1]]}/' model.yaml >twice.yaml
expect 0 run both.yaml -o both --quiet
expect 0 run twice.yaml -o twice --quiet
near both twice 1e-6

# A constant step stops where a change is.
for method in backward-euler midpoint; do
  for name in live known; do
    expect 0 run $name.yaml -o $name.$method --quiet --set integrator.method=$method --set integrator.step=0.001
  done
  near live.$method known.$method 1e-9
done
expect 3 run live.yaml -o refused --set integrator.method=backward-euler --set integrator.step=0.007
err 'push.txt:3:1: t = 0.01 s is not at the end of a step of 0.007 s, and a constant step is not cut'

# A material that is another from the start; one that changes on the way, whose ledger is closed: the
# energy that it gains is work from outside.
with softer.yaml 'flesh: {material: 0, values: [[0.02, 0.5]]}'
sed 's/lambda: 1.0e5, mu: 1.0e4/lambda: 0.5e5, mu: 0.5e4/; s/lambda: 10.0, mu: 1.0/lambda: 5.0, mu: 0.5/' model.yaml >soft.yaml
expect 0 run softer.yaml -o softer --quiet
expect 0 run soft.yaml -o soft --quiet
near softer soft 1e-6
expect 0 static softer.yaml -o softer.static --quiet
expect 0 static soft.yaml -o soft.static --quiet
near softer.static soft.static 1e-8
with tense.yaml 'flesh: {material: 0, values: [[0.02, 1], [0.03, 4]]}'
expect 0 run tense.yaml -o tense --quiet
python3 - <<'PY' || complain "the ledger of a material that changes"
import csv
row = {name: [dict((k, float(v)) for k, v in r.items()) for r in csv.DictReader(open(name + "/energy.csv"))]
       for name in ("tense", "live.cvode")}
at = {name: {round(r["t"], 6): r for r in rows} for name, rows in row.items()}
plain, tense = at["live.cvode"], at["tense"]
assert max(abs(r["balance"]) for r in row["tense"]) < 1e-5 * max(r["elastic"] for r in row["tense"])
assert tense[0.05]["external_work"] > tense[0.03]["external_work"] + 2 * tense[0.03]["elastic"], tense
PY
[ "$(grep -c kink tense/steps.csv)" = 2 ] ||
  complain "steps.csv does not show where the inputs change"

# What the run was made with is in its folder; check says what comes in.
grep -q '"sha256"' live.cvode/*.json || complain "no sum of the file"
expect 0 check live.yaml
out 'input          push: factor of loads[0], amplitude: 5 points, 1 jump, t = -1 to 0.04 s, values -1 to 1'
expect 0 check softer.yaml
out 'input          flesh: factor of material[0], amplitude: 1 point, t = 0.02 to 0.02 s, values 0.5 to 0.5'

# Each refusal with its place.
refuse() { # MESSAGE INPUT
  with bad.yaml "$2"
  expect 3 run bad.yaml -o refused
  err "$1"
}
refuse 'bad.yaml:15:20: inputs.a.load: there is no load 1: there are 1, counted from 0' 'a: {load: 1, values: [[0, 1]]}'
refuse 'inputs.a.material: there is no material 1: there are 1, counted from 0' 'a: {material: 1, values: [[0, 1]]}'
refuse 'inputs.a.load: must be >= 0, found -1' 'a: {load: -1, values: [[0, 1]]}'
refuse 'inputs.a: load or material is missing' 'a: {values: [[0, 1]]}'
refuse 'load and material exclude each other' 'a: {load: 0, material: 0, values: [[0, 1]]}'
refuse 'inputs.a: values is missing' 'a: {load: 0}'
refuse 'inputs.a.values[1][0]: the amplitude'"'"'s times do not increase at point 1: 0 follows 1' 'a: {load: 0, values: [[1, 1], [0, 2]]}'
refuse 'inputs.a.values[1][0]: a factor of a material is above 0, not -2' 'a: {material: 0, values: [[0, 1], [1, -2]]}'
refuse 'inputs.a.values: expected a list of [time, value]' 'a: {load: 0, values: []}'
refuse 'inputs.a.values.file: no.csv: No such file' 'a: {load: 0, values: {file: no.csv}}'
refuse 'inputs.b.load: inputs.a is of the same load' 'a: {load: 0, values: [[0, 1]]}, b: {load: 0, values: [[0, 1]]}'
refuse 'inputs.a.file: unknown key; did you mean values.file?' 'a: {load: 0, file: push.txt}'
expect 3 run live.yaml -o refused --set 'compare=[polar]'
err 'inputs.push: compare knows nothing of inputs'
expect 3 modes live.yaml -o refused
err 'inputs.push: corot modes knows nothing of inputs'
[ ! -e refused ] || complain "a folder of what was refused"

# A study may vary them.
cat >study.yaml <<'YAML'
study: how stiff
base: softer.yaml
axes: [{key: inputs.flesh.values, values: [[[0.02, 0.5]], [[0.02, 2]]]}]
measure: ["max(corner.ux)"]
reference: none
YAML
expect 0 study study.yaml -o studied --quiet
python3 - <<'PY' || complain "a study of inputs"
import json
soft, stiff = (c["quantity"]["max(corner.ux)"] for c in json.load(open("studied/table.json"))["cells"])
assert json.dumps(soft) != json.dumps(stiff), (soft, stiff)
PY
exit $failed

. "$(dirname "$0")/lib.sh"

# A study over frames that are held for 20 ms: its errors are those of time, 1e-5 of the displacement,
# where frames found in every evaluation are 1e-3 away. That is said wherever the errors are.
cat >held.yaml <<'YAML'
study: frames that are held
base: model.yaml
set: {strain: polar, frames: {policy: hold, interval: 0.02}, mesh.box.split: kuhn}
axes: [{key: integrator.rtol, values: [1e-5, 1e-6]}]
YAML
expect 0 study held.yaml -o held --quiet; no_err
shares='Errors are those of time alone; all runs and references share: frames hold 0.02 s, mesh of 12 tets, strain polar, mass lumped.'
expect 0 study table held; out "$shares"; out "corot budget"
grep -qF "$shares" held/report.html || complain "the page says nothing of it"
expect 0 run model.yaml -o exact --quiet --set strain=polar --set integrator.rtol=1e-8 --set mesh.box.split=kuhn
python3 - <<'PY' || complain "what is shared is not said, or is not as large"
import csv, json
d = json.load(open('held/table.json'))
assert d['shared'].startswith('Errors are those of time alone; all runs and references share: frames hold')
assert all(c['shared'] == 'frames hold 0.02 s, mesh of 12 tets, strain polar, mass lumped' for c in d['cells'])
rows = list(csv.DictReader(open('held/table.csv')))
assert [r['shared'] for r in rows] == [c['shared'] for c in d['cells']], rows
def probe(folder):
    return [[float(x) for x in row[1:4]] for row in list(csv.reader(open(folder + '/probes.csv')))[1:]]
cell = d['cells'][-1]
apart = max(sum((x - y) ** 2 for x, y in zip(p, q)) ** 0.5
            for p, q in zip(probe('held/runs/' + cell['id']), probe('exact')))
assert cell['error']['probe.corner'] < 0.05 * apart, (cell['error'], apart)
assert d['space'] == []
PY

# What the references have in common with some cells only is no longer shared; what each cell shares
# with its own is told apart. Frames as old as the steps are: a reference's are younger.
cat >mixed.yaml <<'YAML'
study: references by green
base: model.yaml
set: {time.end: 0.02, integrator.rtol: 1e-3}
reference: {set: {strain: green}, mesh: own, rtol: 1e-6}
axes: [{key: strain, values: [polar, green]}, {key: mesh.refine, values: [0, 1, 2]}]
YAML
expect 0 study mixed.yaml -o mixed --quiet; no_err
expect 0 study table mixed
out "Errors are those of time, strain measure; all runs and references share: mass lumped; each run shares with its reference: its mesh."
# The references of three levels say what the meshes do.
out "space, by references of neighbouring levels"
out "mesh.refine 0, reference 0: "; out "mesh.refine 1, reference 1: at least "; out "no cell has it"
python3 - <<'PY' || complain "the meshes"
import json
d = json.load(open('mixed/table.json'))
assert [(s['refine'], s['levels']) for s in d['space']] == [(0, 3), (1, 2)], d['space']
s = d['space'][0]
assert 0 < s['low'] <= s['error'] and d['space'][1]['bound'] == 'at least' and d['space'][1]['order'] is None
PY
grep -q "Error of the mesh at mesh.refine 0" mixed/report.html || complain "the page says nothing of the meshes"
cat >steps.yaml <<'YAML'
study: frames of every step
base: model.yaml
set: {time.end: 0.02, frames: {policy: step}, strain: polar}
axes: [{key: integrator.rtol, values: [1e-3]}]
YAML
expect 0 study steps.yaml -o steps --quiet; no_err
expect 0 study table steps; grep -q "share: .*frames" stdout && complain "frames that are not shared"

# Without references there are no errors, and nothing that they are of.
cat >bare.yaml <<'YAML'
study: no references
base: model.yaml
set: {time.end: 0.02}
axes: [{key: integrator.rtol, values: [1e-3]}]
reference: none
YAML
expect 0 study bare.yaml -o bare --quiet; no_err
expect 0 study table bare; grep -q "Errors are" stdout && complain "errors that are not there"
exit $failed

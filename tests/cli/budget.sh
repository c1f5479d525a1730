. "$(dirname "$0")/lib.sh"

# A run with a large step, old frames and an inexact strain, on a coarse mesh: each is found, and its
# size is that which the tables of the two runs give.
expect 0 budget model.yaml -o parts --json --quiet --set time.end=0.2 --set strain=warp \
  --set 'frames={policy: hold, interval: 0.05}' --set 'integrator={method: bdf2, step: 0.02}'
no_err
cat >same.py <<'PY'
import csv, json
d = json.load(open('parts/budget.json'))
assert d == json.load(open('stdout'))
names = ['algebraic solver', 'time integration', 'frame age', 'frame rule', 'strain measure', 'space']
assert [p['part'] for p in d['parts']] == names, d['parts']
def probe(i):
    with open('parts/runs/%s/probes.csv' % d['runs'][i]['id']) as f:
        return [[float(x) for x in row[1:4]] for row in list(csv.reader(f))[1:]]
for k, p in enumerate(d['parts']):
    # run 0 as given, 1 to n the chain
    apart = [sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5 for a, b in zip(probe(k), probe(k + 1))]
    said = p['probes']['corner']
    # of space more is claimed than the bare difference of two meshes
    names = ('difference', 'difference_end') if p['part'] == 'space' else ('max', 'end')
    assert abs(said[names[0]] - max(apart)) <= 1e-12 * max(apart), (p, max(apart))
    assert abs(said[names[1]] - apart[-1]) <= 1e-12 * max(apart), (p, apart[-1])
    assert p['cost'] > 0 and (k == 0 or p['error'] > 0 and p['alone'] > 0), p
# with held frames a step is one linear equation: Newton's method leaves no error
assert d['parts'][0]['error'] < 1e-9
# distances: the whole is at most the sum of its parts, but for their different scales
assert 0 < d['total'] < 1.5 * d['sum'], d
assert abs(d['interaction'] - (d['total'] - d['sum'])) < 1e-15
largest = max(d['parts'], key=lambda p: p['error'])
assert largest['part'] in d['first'] and largest['advice'] in d['first'], d['first']
assert ('Parts cancel' in d['first']) == (d['total'] < 0.7 * largest['error']), d['first']
# two methods agree on time's part far better than what it is
assert d['check'] < 1e-2 * d['parts'][1]['error'], d['check']
PY
python3 same.py || complain "the budget is not that of its runs"

grep -q "The largest part is that of" parts/report.html || complain "no page of the budget"

# The second time nothing is run; the table names the parts.
touch before
expect 0 budget model.yaml -o parts --set time.end=0.2 --set strain=warp \
  --set 'frames={policy: hold, interval: 0.05}' --set 'integrator={method: bdf2, step: 0.02}'
[ -z "$(find parts/runs -name result.json -newer before)" ] || complain "a run was repeated"
out "frame rule"; out "sum of the parts"; out "The largest part is that of "

# What is not approximated has no part.
expect 0 budget model.yaml -o exact --quiet --set strain=green --set time.end=0.05
out "time integration"; grep -q "strain measure\|frame" stdout && complain "a part that is not there"

# Overrides count in their order, as they do for `run`, and whatever is in them: a later map takes the
# place of what was set below it.
expect 0 budget model.yaml -o order --quiet --set strain=green --set time.end=0.02 \
  --set integrator.rtol=1e-2 --set 'integrator={method: ida}' --set "title='a: \"b\", # c'"
cat >given.py <<'PY'
import json
d = json.load(open('order/budget.json'))
s = json.load(open('order/runs/%s/result.json' % d['runs'][0]['id']))['scenario']
assert s['integrator']['method'] == 'ida' and s['integrator']['rtol'] == 1e-4, s['integrator']
assert d['title'] == s['title'] == 'a: "b", # c', (d['title'], s['title'])
PY
python3 given.py || complain "the run as given is not what was given"

# A run that fails leaves its part open: so many steps do for the run as given, not for a fine one.
expect 1 budget model.yaml -o fails --quiet --set strain=green --set time.end=0.1 \
  --set integrator.rtol=1e-2 --set integrator.max_steps=40
grep -q "^time integration  *?  *?  *?  *?  integrator.rtol=1e-06" stdout || complain "a part of a failed run"
grep -q "^algebraic solver  *[<0-9]" stdout || complain "the parts of runs that did not fail"

# Parts may be left out, but not all of them.
expect 0 budget model.yaml -o exact --quiet --set strain=green --set time.end=0.05 --skip space
grep -q "^space" stdout && complain "a part that was left out"
expect 0 budget model.yaml -o exact --quiet --set strain=green --set time.end=0.05 --skip space \
  --skip "time integration"
grep -q "^check of time  *?" stdout || complain "a check of nothing"
expect 2 budget model.yaml --skip spice; err "--skip spice: expected a part"
expect 3 budget model.yaml --set strain=green --skip space --skip "time integration" \
  --skip "algebraic solver" -o nothing; err "nothing is left"; no_out

expect 2 budget; err "expected one scenario, found 0"
expect 2 budget model.yaml --jobs 0; err "--jobs 0: expected 1 to"
expect 2 budget model.yaml --sett a=b; err "--sett"
expect 3 budget none.yaml; err "none.yaml"; no_out
expect 3 budget model.yaml --set strain=gren; err "did you mean green?"; no_out
expect 3 budget model.yaml -o bad --set mesh.refine=99; err "--set mesh.refine=99: mesh.refine: "; no_out
echo 0 >marks.txt # numbers of tets that a finer mesh would have elsewhere
expect 3 budget model.yaml -o bad --set mesh.marks=marks.txt; no_out
err "--set mesh.marks=marks.txt: mesh.marks: these numbers are of one mesh, and the budget would refine it"
expect 0 budget model.yaml --static -o marked --set mesh.marks=marks.txt --levels 2 --quiet
expect 0 budget --help; out "example: corot budget"; no_err
exit $failed

. "$(dirname "$0")/lib.sh"

# claim NAME EXPRESSION...: python says whether each is true of NAME/budget.json, d; part(P) is a part.
claim() {
  where=$1
  shift
  python3 - "$where" "$@" <<'PY' || complain "$what: $where does not claim what it should"
import csv, json, sys
where = sys.argv[1]
d = json.load(open(where + '/budget.json'))
def part(name):
    return [p for p in d['parts'] if p['part'] == name][0]
def rows(folder):
    with open(folder + '/probes.csv') as f:
        return [[float(x) for x in row[1:4]] for row in list(csv.reader(f))[1:]]
def apart(a, b):
    return max(sum((x - y) ** 2 for x, y in zip(p, q)) ** 0.5 for p, q in zip(rows(a), rows(b)))
for text in sys.argv[2:]:
    if not eval(text):
        sys.exit('not %s: %s' % (text, json.dumps(d, indent=1)))
PY
}

# What every budget says, whatever it is of. The numbers are those of the parts, to rounding.
sound() {
  claim "$1" "abs(d['sum'] - sum(p['error'] for p in d['parts'])) <= 1e-15 * d['sum']" \
    "abs(d['interaction'] - (d['total'] - d['sum'])) <= 1e-15 * d['sum']" \
    "abs(sum(p['share'] for p in d['parts']) - 1) < 1e-9" \
    "all(abs(sum(p['probes']['corner']['signed'][k] for p in d['parts']) - d['total_probes']['corner']['signed'][k]) < 1e-12 for k in range(3))" \
    "all(p['bound'] in ('about', 'at least', 'at most') for p in d['parts'])" \
    "all(p['low'] <= p['error'] and (p['high'] is None or p['error'] <= p['high']) for p in d['parts'])" \
    "all((p['bound'] == 'at most') == (p['error'] < p['floor']) for p in d['parts'])" \
    "all((p['bound'] == 'at least') == (p['high'] is None) for p in d['parts'])" \
    "d['complete'] and d['missing'] == [] and d['verdict'] == d['first']"
}

# A slender bar of 36 tets, far too stiff: 0.069 m where 18432 tets say 0.319, and the next difference
# is larger than the first. Nobody can extrapolate that, and the budget does not.
cat >bar.yaml <<'YAML'
title: a slender bar under a shear load
mesh: {box: {size: [0.1, 0.1, 0.6], cells: [1, 1, 6]}}
groups:
  base: {plane: {axis: z, at: 0.0}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary:
  - {group: base, fix: [x, y, z]}
loads:
  - {group: zmax, traction: [200.0, 0.0, 0.0]}
time: {end: 0.5, output: 0.05}
probes:
  corner: {point: [0.1, 0.1, 0.6]}
YAML
expect 0 budget bar.yaml --static -o bar --quiet --set strain=green; no_err
out "not asymptotic: at least"; out "is not smaller than the first"
out "The largest part is that of space, at least"
grep -q "^space  *>" stdout || complain "a bound that is not shown as one"
sound bar
claim bar "part('space')['bound'] == 'at least' and part('space')['levels'] == 3" \
  "part('space')['order'] < 0.5 and d['total_bound'] == 'at least'" \
  "0.15 < part('space')['probes']['corner']['low'] < 0.25" "d['static'] and d['check'] is None" \
  "[p['part'] for p in d['parts']] == ['algebraic solver', 'load steps', 'space']"
grep -q "≥ " bar/report.html || complain "a page that shows no bound"
expect 0 budget bar.yaml --static --quiet --set strain=green --skip space
[ -s out/bar-static-budget/budget.json ] || complain "another default folder of statics"

# A block that is pulled converges. By `corot static pull.yaml --set mesh.refine=R` its corner moves
# by (-0.870428, -0.870428, 14.192801) mm at R = 3 and (-0.918530, -0.918530, 14.229343) at R = 4; their
# differences are 2.9 and 3.0 times smaller than those before, which leaves about half of the last:
# it tends to (-0.943, -0.943, 14.247). R = 1 says (-0.411513, -0.411513, 13.782444): 0.885 mm off.
# The bare difference to R = 2 is 0.543 mm.
cat >pull.yaml <<'YAML'
title: a block that is pulled
mesh: {box: {size: [0.1, 0.1, 0.2], cells: [1, 1, 2], split: kuhn}, refine: 1, diagonal: consistent}
groups:
  base: {plane: {axis: z, at: 0.0}}
material: {lambda: 1.0e4, mu: 1.0e4, density: 1000.0}
strain: green
boundary:
  - {group: base, fix: [x, y, z]}
loads:
  - {group: zmax, traction: [0.0, 0.0, 2000.0]}
time: {end: 1.0}
probes:
  corner: {point: [0.1, 0.1, 0.2]}
YAML
expect 0 budget pull.yaml --static -o pull --quiet
out "three levels, observed order 1."
sound pull
claim pull "part('space')['bound'] == 'about' and 1 < part('space')['order'] < 2" \
  "part('space')['probes']['corner']['low'] < 0.885e-3 < part('space')['probes']['corner']['high']" \
  "abs(part('space')['probes']['corner']['max'] / 0.885e-3 - 1) < 0.2" \
  "abs(part('space')['probes']['corner']['difference'] / 0.543e-3 - 1) < 0.01" \
  "part('space')['difference'] < part('space')['low'] and d['total_bound'] == 'about'"
# two levels are a lower bound, and say what is missing
expect 0 budget pull.yaml --static -o pull --quiet --levels 2
out "two levels show no order; the third was left out (--levels 2 was asked for)"
sound pull
claim pull "part('space')['bound'] == 'at least' and part('space')['order'] is None" \
  "part('space')['error'] == part('space')['difference']"
expect 2 budget pull.yaml --levels 4; err "--levels 4: expected 2 or 3"
expect 2 budget pull.yaml --levels 1; err "--levels 1: expected 2 or 3"

# Two parts that work against one another are seen to: the tets are too stiff, polar too soft.
expect 0 budget pull.yaml --static -o cancel --quiet --set strain=polar
sound cancel
claim cancel "part('strain measure')['probes']['corner']['signed'][2] < 0 < part('space')['probes']['corner']['signed'][2]"
out "corner.uz at the end changes by -"; out "by strain measure, +"
# and on the page: bars of the total's length and sign, numbers with theirs
python3 - <<'PY' || complain "the page's bars and signs"
import json, re
d = json.load(open('cancel/budget.json'))
page = open('cancel/report.html').read()
bars = [(float(w), int(s)) for w, s in re.findall(r'width:([0-9.]+)%"[^>]*></div>([+-][0-9]+) %', page)]
shares = [p['share'] for p in d['parts']] + [1]
assert len(bars) == len(shares), bars
wide = max(shares + [1]) - min(shares + [0])
for (width, percent), share in zip(bars, shares):
    assert abs(width - 100 * abs(share) / wide) < 0.06 and abs(percent - 100 * share) < 0.51, (bars, shares)
for p in d['parts']:
    for x in p['probes']['corner']['signed']:
        assert '%+.3e' % x in page, x
PY

# A constant step so short that its error is less than that of a run at rtol 1e-6: the reference is
# tightened until it is better than what it judges. The truth is a run of another method at 1e-11.
expect 0 budget model.yaml -o short --quiet --set strain=green --skip space \
  --set 'integrator={method: newmark, step: 4e-5}'
sound short
expect 0 run model.yaml -o truth --quiet --set strain=green --set 'integrator={method: erk, rtol: 1e-11}'
claim short "abs(part('time integration')['probes']['corner']['max'] / apart('short/runs/' + d['runs'][0]['id'], 'truth') - 1) < 0.05" \
  "apart('short/runs/' + d['runs'][2]['id'], 'truth') > 20 * part('time integration')['probes']['corner']['max']" \
  "part('time integration')['bound'] == 'about' and d['check'] < 0.1 * part('time integration')['error']" \
  "d['check_rtol'] < 1e-7 and 'rtol: 1e-10' in part('time integration')['pair']"

# Where no tolerance is left that would do, the error is below its floor and is not claimed.
expect 0 budget model.yaml -o tight --quiet --set strain=green --skip space \
  --set 'integrator={method: arkode, order: 5, rtol: 1e-11}' --set time.end=0.01
grep -q "^time integration  *<" stdout || complain "an error below its floor is claimed"
out "below its floor: at most"; out "No part is above its floor; none is larger than"
claim tight "part('time integration')['bound'] == 'at most' and part('time integration')['low'] == 0" \
  "part('time integration')['high'] >= 10 * d['check']" "d['first'].find('largest part') < 0"

# A part that is missing: the finer mesh needs more steps than it may take. Which part is the largest
# nobody knows, and nobody is told.
cat >steps.py <<'PY'
import json
d = json.load(open('stdout'))
print(d['statistics']['nst'] + 2)
PY
expect 0 run model.yaml -o steps --quiet --json --set strain=green
most=$(python3 steps.py)
expect 1 budget model.yaml -o missing --quiet --skip "time integration" --skip "algebraic solver" \
  --set strain=polar --set integrator.max_steps=$most
out "Parts are missing, as runs failed: space. So it is not known which part is the largest"
out "No run has checked the references of: strain measure."
grep -q "The largest part is" stdout && complain "a part is called the largest"
grep -q "^strain measure  *(*[0-9]" stdout || complain "the part that is known"
claim missing "not d['complete'] and d['missing'] == ['space'] and d['sum'] is None" \
  "part('space')['bound'] == 'missing' and part('space')['verdict'] == 'not known, as a run failed'" \
  "part('space')['error'] is None and part('strain measure')['bound'] == 'unchecked'"
grep -q "Parts are missing" missing/report.html || complain "the page says nothing of it"
exit $failed

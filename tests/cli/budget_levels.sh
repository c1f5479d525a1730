. "$(dirname "$0")/budget_lib.sh"

# A slender bar of 36 tets, far too stiff: its corner moves by 0.0695 m where ten-node tets refined
# twice, 2304 of them, say 0.3429 in x and -0.1951 in z. The next octasection of four-node tets would
# show less than half of that. Tets of ten nodes show it, and what they are known by.
sed -e 's/a block under/a slender bar under/' -e 's/0\.1, 0\.1, 0\.2\]/0.1, 0.1, 0.6]/' \
  -e 's/\[1, 1, 2\], split: kuhn}/[1, 1, 6], split: kuhn}, diagonal: consistent/' \
  -e 's/end: 0.05, output: 0.01/end: 0.5, output: 0.05/' model.yaml >bar.yaml
expect 0 budget bar.yaml --static -o bar --quiet --set strain=green; no_err
out "by order: against finer tets of ten nodes, between 7."
out "The largest part is that of space, 8."; out "Change first: mesh.order 2."
sound bar
expect 0 static bar.yaml -o bar-truth --quiet --set strain=green --set mesh.order=2 --set mesh.refine=2
claim bar "part('space')['bound'] == 'about' and part('space')['levels'] == 3" \
  "part('space')['by'] == 'order' and part('space')['pair'] == 'mesh.order=2'" \
  "part('space')['order'] is None and d['total_bound'] == 'about'" \
  "part('space')['probes']['corner']['low'] < apart('bar/runs/' + d['runs'][0]['id'], 'bar-truth') < part('space')['probes']['corner']['high']" \
  "part('space')['probes']['corner']['high'] < 1.2 * part('space')['probes']['corner']['low']" \
  "d['static'] and d['check'] is None" \
  "[p['part'] for p in d['parts']] == ['algebraic solver', 'load steps', 'space']"
# without finer ones nothing checks them
expect 0 budget bar.yaml --static -o bar --quiet --set strain=green --levels 2; no_err
out "by order: at least"; out "were left out (--levels 2 was asked for)"
out "The largest part is that of space, at least"
grep -q "^space  *>" stdout || complain "a bound that is not shown as one"
sound bar
claim bar "part('space')['bound'] == 'at least' and part('space')['levels'] == 2" \
  "d['total_bound'] == 'at least'"
grep -q "≥ " bar/report.html || complain "a page that shows no bound"
expect 0 budget bar.yaml --static --quiet --set strain=green --skip space
[ -s out/bar-static-budget/budget.json ] || complain "another default folder of statics"

# A block that is pulled. By `corot static pull.yaml --set mesh.refine=R` its corner moves
# by (-0.870428, -0.870428, 14.192801) mm at R = 3 and (-0.918530, -0.918530, 14.229343) at R = 4; their
# differences are 2.9 and 3.0 times smaller than those before, which leaves about half of the last:
# it tends to (-0.943, -0.943, 14.247). R = 1 says (-0.411513, -0.411513, 13.782444): 0.885 mm off.
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
out "by order: against finer tets of ten nodes"
sound pull
claim pull "part('space')['bound'] == 'about' and part('space')['by'] == 'order'" \
  "part('space')['probes']['corner']['low'] < 0.885e-3 < part('space')['probes']['corner']['high']" \
  "abs(part('space')['probes']['corner']['max'] / 0.885e-3 - 1) < 0.05" \
  "part('space')['difference'] < part('space')['high'] and d['total_bound'] == 'about'"

# Tets of ten nodes are judged by their own octasections, whether the scenario asks for them or the
# file has them. At R = 2 the corner moves by (-0.932721, -0.932721, 14.235271) mm, at R = 0 by
# (-0.892929, -0.892929, 14.221008): 0.0741 mm off what the four-node tets tend to, and 0.0375 mm off
# R = 1.
expect 0 budget pull.yaml --static -o second --quiet --set mesh.order=2 --set mesh.refine=0
out "by refinement: three levels, observed order 2."; out "Change first: mesh.refine one more."
sound second
claim second "part('space')['bound'] == 'about' and 1 < part('space')['order'] < 3" \
  "part('space')['by'] == 'refinement' and part('space')['pair'] == 'mesh.refine=1'" \
  "abs(part('space')['probes']['corner']['max'] / 0.0741e-3 - 1) < 0.25" \
  "abs(part('space')['probes']['corner']['difference'] / 0.0375e-3 - 1) < 0.01" \
  "part('space')['difference'] < part('space')['low'] and d['total_bound'] == 'about'"
# two levels are a lower bound, and say what is missing
expect 0 budget pull.yaml --static -o second --quiet --set mesh.order=2 --set mesh.refine=0 --levels 2
out "by refinement: at least"
out "two levels show no order; the third was left out (--levels 2 was asked for)"
sound second
claim second "part('space')['bound'] == 'at least' and part('space')['order'] is None" \
  "part('space')['error'] == part('space')['difference']"
expect 2 budget pull.yaml --levels 4; err "--levels 4: expected 2 or 3"
expect 2 budget pull.yaml --levels 1; err "--levels 1: expected 2 or 3"

# Where time is a small part, the third level takes steps as they are given: what is known of space is
# less by what these are off by, and nothing is said below ten times both.
expect 0 budget model.yaml -o steps --quiet --set strain=green
sound steps
claim steps "part('space')['levels'] == 3 and 40 * part('time integration')['error'] < part('space')['difference']" \
  "abs(part('space')['floor'] / (10 * part('time integration')['error'] + part('time integration')['floor']) - 1) < 1e-6"

# Two parts that work against one another are seen to: the tets are too stiff, polar too soft.
expect 0 budget pull.yaml --static -o cancel --quiet --set strain=polar --levels 2
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

# A part that is larger than the total, and one that works against it: the bars share one zero.
mkdir -p bars
cat >bars/budget.json <<'JSON'
{"title": "T", "total": 0.5, "complete": true, "parts": [
 {"part": "strain measure", "error": 0.7, "share": 1.5, "bound": "about"},
 {"part": "space", "error": 0.3, "share": -0.5, "bound": "at least"},
 {"part": "frame age", "error": 1e-9, "high": 2e-8, "share": 0, "bound": "at most"}]}
JSON
expect 0 report bars
for text in 'margin-left:25.0%;width:75.0%"></div>+150 %' 'margin-left:0.0%;width:25.0%" class="against"></div>-50 %' \
  'margin-left:25.0%;width:50.0%"></div>+100 %' '≥ 3.00e-01' '≤ 2.00e-08'; do
  grep -qF -e "$text" bars/report.html || complain "the page lacks $text"
done
exit $failed

# What a study says while it goes on, and what it leaves at any time.
. "$(dirname "$0")/lib.sh"

# Cells run first, in the order of the table but for the cheapest, which tells what is to come.
cat >study.yaml <<'YAML'
study: cells and references
base: model.yaml
axes: [{key: integrator.rtol, values: [1.0e-3, 1.0e-4, 1.0e-2]}, {key: strain, values: [polar]}]
reference: {rtol: 1.0e-7}
YAML
expect 0 study study.yaml -o first --dry-run
[ "$(awk '{ print $3 }' stdout | uniq | tr '\n' ' ')" = "cell reference " ] || complain "not cells first"
expect 0 study study.yaml -o first -j 1
err "pilot: rtol=0.01,strain=polar took "; err "the other cells are about "; err "their references "
order=$(ls -tr first/runs/*/result.json | sed 's|.*runs/||; s|/.*||' | tr '\n' ' ')
want=$(for name in rtol=0.01 rtol=0.001 rtol=0.0001; do basename "$(readlink "first/names/$name,strain=polar")"; done; \
  for name in cvode arkode; do basename "$(readlink "first/names/reference-0-$name")"; done)
[ "$order" = "$(echo $want) " ] || complain "runs in the order $order, not $want"
for link in first/names/*; do [ -f "$link/result.json" ] || complain "$link leads nowhere"; done
[ "$(ls first/names | wc -l)" = 5 ] || complain "not a name for each run"

# Nothing is estimated where nothing is left to do, or one run is; nor where nobody is to be told.
expect 0 study study.yaml -o first; ! grep -q pilot stderr || complain "a pilot of nothing"
expect 0 study study.yaml -o quiet -q; no_err

# A diagram of a study without a table, as one that still runs: it is of the runs there are now.
mkdir cut && cp -r first/runs first/study.json cut
expect 0 plot cut; out "cut/precision-"

# The piece by which methods are compared may end before the window of a quantity begins.
sed '/^axes/i measure: ["mean(corner.ux, 0.04, end)"]' study.yaml >late.yaml
expect 0 study late.yaml -o late; err "pilot: a reference takes about "
grep -q 'about ?\|, ? by' stderr && complain "a pilot that knows nothing: a window beyond its end"

# Methods of references that were chosen for a study remain its own.
python3 - <<'PY'
import json
d = json.load(open('first/study.json'))
assert d['pilot']['methods'] == ['cvode', 'arkode'] and len(d['pilot']['cost']) == 3, d['pilot']
d['pilot']['methods'] = ['arkode', 'erk']
json.dump(d, open('chosen.json', 'w'))
PY
mkdir chosen && mv chosen.json chosen/study.json
expect 0 study study.yaml -o chosen --dry-run; out "method: erk"
[ "$(grep -c 'method: cvode' stdout)" = 0 ] || complain "the choice is forgotten"
echo 'reference: {rtol: 1.0e-7, methods: [ida, arkode]}' | cat study.yaml - | sed '/rtol: 1.0e-7}$/d' >said.yaml
expect 0 study said.yaml -o chosen --dry-run; out "method: ida"

# What is no link stays as it is; a link that leads elsewhere is set right.
rm first/names/reference-0-cvode && mkdir first/names/reference-0-cvode
ln -sfn nowhere first/names/rtol=0.01,strain=polar
expect 0 study study.yaml -o first -q
[ -d first/names/reference-0-cvode ] && [ ! -L first/names/reference-0-cvode ] || complain "a folder was replaced"
[ -f first/names/rtol=0.01,strain=polar/result.json ] || complain "a wrong link stays"

# While it goes on: how far each run is, and a table of what is done.
cat >long.yaml <<'YAML'
study: a long run after a short one
base: model.yaml
axes:
  - name: run
    variants:
      - {label: short, set: {time.end: 0.05}}
      - {label: long, set: {time.end: 2000, time.output: 0.01, integrator: {method: backward-euler, step: 1.0e-3}}}
reference: none
YAML
"$corot" study long.yaml -o long -j 2 >stdout.long 2>stderr.long &
going=$!
says() { "$corot" study status long >stdout 2>stderr && grep -q "$1" stdout; }
until_true says " running, [1-9][0-9]* %: run=long"; until_true says ": 1 done, 0 failed, 1 missing"
what="status while it goes on"
out "2 cells, 2 runs: 1 done, 0 failed, 1 missing"; out " % of the work is done"
expect 0 study table long; out "short"; out "missing"
expect 0 study collect long
expect 0 study table long; out "missing"
kill -TERM $going; wait $going
says " running" && complain "it says that a run goes on which was ended"

# Many steps: not each has a row, which result.json says; the last one has.
steps() { expect 0 run model.yaml -o "$1" -q --set 'integrator={method: backward-euler, step: 1.0e-6}' --set time.end=0.012 --set output.history=false $2; }
steps thin ""
what=thin
cp thin/result.json stdout; json 'd["steps_csv"]["steps"] == 12000 and d["steps_csv"]["rows"] == 10200 and "10th" in d["steps_csv"]["kept"]'
[ "$(wc -l <thin/steps.csv)" = 10201 ] || complain "not 10200 rows"
tail -1 thin/steps.csv | grep -q '^0.012' || complain "no row for the last step"
expect 0 report thin -o thin.html; grep -q "Of 12000 steps, 10200 are shown" thin.html || complain "the page does not say that rows are missing"
steps all '--set output.steps=all'
cp all/result.json stdout; json 'd["steps_csv"]["rows"] == 12000 and d["steps_csv"]["kept"] == "every step"'
exit $failed

# Every result says which build made it, and results of several builds are never mixed in silence.
# usage: provenance.sh COROT SCRATCH_FOLDER SCRIPT CMAKE, the script that finds the commit
. "$(dirname "$0")/lib.sh"
script=$3 cmake=$4

# --- One run ---

# is_told FILE: of a build whose libraries are known.
is_told() {
  cp "$1" stdout
  json "d['versions']['corot'] == d['provenance']['corot'] and d['versions']['sundials'] == d['provenance']['sundials']"
  json "d['versions']['compiler'] == d['provenance']['compiler']"
  json "__import__('re').fullmatch('[0-9a-f]{40}(-dirty)?', d['provenance']['commit'] or 40 * '0')"
  json "__import__('re').fullmatch('[0-9a-f]{16,}', d['provenance']['build'] or 40 * '0')"
  json "d['provenance']['suitesparse']['klu'][0].isdigit() and d['provenance']['processor']"
  json "d['provenance']['suitesparse']['cholmod'] is None or d['provenance']['blas']['library'].startswith('/')"
}
for command in run static; do
  expect 0 $command model.yaml -o single --quiet; is_told single/result.json
done
# OpenBLAS is kept to one thread, unless somebody asks for more.
expect 0 run model.yaml -o single --quiet --force
cp single/result.json stdout && json "d['provenance']['blas']['threads'] in (None, 1)"
OPENBLAS_NUM_THREADS=2 "$corot" run model.yaml -o two --quiet
cp two/result.json stdout && json "d['provenance']['blas']['threads'] in (None, 2)"
expect 4 run model.yaml -o gave-up --quiet --set integrator.max_steps=2; is_told gave-up/result.json
expect 0 report single; grep -q '>kernels</th>' single/report.html || complain "the page of a run does not tell"

# --- A study ---

cat >study.yaml <<'YAML'
study: which one
base: model.yaml
axes: [{key: strain, values: [polar, green, cauchy]}]
YAML

# change FOLDER: its result is that of a build of another commit.
change() {
  python3 - "$1/result.json" <<'PY'
import json, sys
d = json.load(open(sys.argv[1]))
d["provenance"]["commit"] = 40 * "7"
json.dump(d, open(sys.argv[1], "w"))
PY
}

expect 0 study study.yaml -o study; grep -qi 'build' stderr && complain "one build is told of"
cp study/table.json stdout
json "d['mixed'] is None and len(d['builds']) == 1 and len(d['builds'][0]['runs']) == len(set(d['builds'][0]['runs'])) == 9 and d['builds'][0]['references'] == 6"
python3 - <<'PY' >ids
import json
t = json.load(open("study/table.json"))
print(t["cells"][1]["id"], t["references"][0]["runs"][1])
PY
read -r cell reference <ids
change "study/runs/$cell"
change "study/runs/$reference"
sentence='The runs are of 2 different builds of corot: 7, 5 of them references, of commit'
expect 0 study collect study; err "warning: $sentence"
cp study/table.json stdout
json "d['mixed'].startswith('$sentence') and [len(b['runs']) for b in d['builds']] == [7, 2]"
json "'; 2, 1 of them references, of commit 777777777777 ($reference, $cell)' in d['mixed'] and [b['references'] for b in d['builds']] == [5, 1]"
expect 0 study table study; out "$sentence"
expect 0 report study; grep -q "<p class=\"warning\">$sentence" study/report.html || complain "the page does not say it"

# Who goes on with it hears of it at once; what is done is kept.
expect 0 study study.yaml -o study; err "2 of the runs that are done are of another build (commit 777777777777; this is "; err "they are kept"; err "(0 now)"; err "warning: $sentence"
expect 0 study study.yaml -o study --quiet; no_err
# One that says nothing at all is of another build, too.
python3 - "study/runs/$cell/result.json" <<'PY'
import json, sys
d = json.load(open(sys.argv[1]))
del d["provenance"]
json.dump(d, open(sys.argv[1], "w"))
PY
expect 0 study collect study; err "The runs are of 3 different builds"; err "1 of a build that is not recorded ($cell)"

# --- A budget, and the search for a limit ---

expect 0 budget model.yaml -o budget --levels 2 --skip space --set time.end=0.02
cp budget/budget.json stdout
json "d['mixed'] is None and len(d['builds']) == 1"
change "$(ls -d budget/runs/*/ | head -n 1)"
expect 0 budget model.yaml -o budget --levels 2 --skip space --set time.end=0.02; err "1 of the runs that are done are of another build (commit 777777777777; this is "; out "The runs are of 2 different builds"
[ "$(grep -c 'another build' stderr)" = 1 ] || complain "it is told more than once"
grep -q '<p class="warning">The runs are of 2 different builds' budget/report.html || complain "the page of a budget does not say it"
limit='find-limit model.yaml -o limit --key time.end --from 0.01 --to 0.02 --scan 2'
expect 0 $limit; no_err
cp limit/limit.json stdout; json "d['mixed'] is None"
for run in limit/runs/*/; do change "$run"; done
expect 0 $limit; err "of the runs that are done are of another build (commit 777777777777; this is "
cp limit/limit.json stdout; json "d['mixed'] is None"
mixed='The runs are of 2 different builds of corot: '
rm -r "$(ls -d limit/runs/*/ | head -n 1)"
expect 0 $limit; out "$mixed"
cp limit/limit.json stdout; json "d['mixed'].startswith('$mixed')"

# Times of another build are no times of this one.
printf '%s\n' 'repeat: 2' 'reference: none' >>study.yaml
sed -i 's/polar, green, cauchy/polar/' study.yaml
expect 0 study study.yaml -o timed; grep -qi 'build' stderr && complain "one build is told of"
python3 - timed/runs/*/timings.json <<'PY'
import json, sys
d = json.load(open(sys.argv[1]))
d["runs"][1]["provenance"]["commit"] = 40 * "7"
json.dump(d, open(sys.argv[1], "w"))
PY
expect 0 study collect timed; err "$mixed"; err ' of commit 777777777777 ('"$(ls timed/runs)"', timed)'

# --- The commit of a checkout ---

if command -v git >/dev/null && [ -x "$cmake" ]; then
  commit() { "$cmake" -D "SOURCE=$PWD/checkout${1-}" -D "OUT=$PWD/commit.c" -P "$script" >stdout 2>stderr || complain "commit.cmake"; }
  is() { grep -qF "provenance_commit = $1;" commit.c || { cp commit.c stdout; complain "$what: not $1"; }; }
  git="git -C checkout -c user.name=somebody -c user.email=somebody@example.org"
  mkdir -p checkout/inner
  what="no checkout"; GIT_CEILING_DIRECTORIES=$PWD commit; is NULL
  what="a checkout without a commit"; git init -q checkout; commit; is NULL
  echo one >checkout/file; $git add file; $git commit -q -m one
  head=$($git rev-parse HEAD)
  what="a checkout"; commit; is "\"$head\""
  what="it stays as it is"; touch -d '2001-01-01' commit.c; cp -p commit.c before; commit; [ ! commit.c -nt before ] || complain "$what"
  what="sources in a checkout of something else"; commit /inner; is NULL
  what="changed"; echo two >>checkout/file; commit; is "\"$head-dirty\""
fi
exit $failed

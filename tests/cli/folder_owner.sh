# What no run of corot has left is not replaced, unless that is asked for; and what a run has left
# does not say "ok" of one that failed.
. "$(dirname "$0")/lib.sh"

# same FOLDER: the files of `theirs` stand there as they were, and nothing beside them.
same() { diff -r theirs "$1" >/dev/null || complain "$what: $1 has changed: $(diff -r theirs "$1")"; }
refused() { err "$1"; err "--force"; no_out; }

# One file of each name that a run writes, in a folder of somebody else's.
for name in report.html probes.csv energy.csv steps.csv history.csv compare.csv reactions.csv \
  groups.json groups.json.tmp states.bin fields.pvd fields/fields_000001.vtu fields/frame.tmp \
  result.json result.json.tmp checkpoint.bin checkpoint.bin.tmp; do
  for command in run static; do
    rm -rf theirs out && mkdir -p theirs/fields && echo mine >theirs/$name
    cp -r theirs out
    expect 5 $command model.yaml -o out --quiet; refused "out/$name"; same out
    expect 0 $command model.yaml -o out --quiet --force
    grep -q '"status": "ok"' out/result.json || complain "$what: no result"
    [ "$(cat out/$name 2>/dev/null)" != mine ] || case $name in *.tmp) ;; reactions.csv | compare.csv) complain "$name stays" ;; esac
  done
done

# What looks like a result is one only if a run has written it.
rm -rf theirs && mkdir theirs
for text in '{"status": "ok"}' '{"status": "ok", "exit_code": 0}' '{"status": "great", "exit_code": 0, "versions": {"corot": "1"}}' '[]' '' '{"status": "ok", "exit_'; do
  printf '%s' "$text" >theirs/result.json
  echo mine >theirs/probes.csv
  rm -rf out && cp -r theirs out
  expect 5 run model.yaml -o out --quiet; refused out/result.json; same out
done

# Other names are no matter, nor is an empty folder; and they stay.
rm -rf theirs out && mkdir -p theirs/fields theirs/runs
for name in notes.txt my-report.html fields/fields_old.vtu runs/probes.csv; do echo mine >theirs/$name; done
cp -r theirs out
expect 0 run model.yaml -o out --quiet
for name in notes.txt my-report.html fields/fields_old.vtu runs/probes.csv; do
  cmp -s theirs/$name out/$name || complain "$name has changed"
done

# Here, too, and before anything takes long.
rm -rf here theirs && mkdir here && cp model.yaml here && echo mine >here/report.html
cp -r here theirs
cd here
expect 5 run model.yaml -o . --quiet; mv stdout stderr ..
cd ..
err ./report.html; same here

# A run's own folder is replaced, whatever has become of it; but for a page that is somebody's own.
rm -rf out
expect 0 run model.yaml -o out --quiet
expect 0 report out
sed -i 's/"title": "[^"]*"/"title": "edited by hand"/' out/result.json
rm out/probes.csv
expect 0 run model.yaml -o out --quiet
[ ! -e out/report.html ] || complain "the page of an earlier run stays"
echo mine >out/report.html
expect 5 run model.yaml -o out --quiet; refused out/report.html
[ "$(cat out/report.html)" = mine ] || complain "a page of somebody's own is gone"
rm out/report.html
head -c 300 out/result.json >cut && cp cut out/result.json
expect 5 run model.yaml -o out --quiet; refused out/result.json
cmp -s cut out/result.json || complain "a result that was cut has changed"
expect 0 run model.yaml -o out --quiet --force

# A lock that a killed run has left is its mark; a file of the lock's name is not.
rm -rf out && mkdir out && echo mine >out/probes.csv && echo "process 1 on a machine" >out/.lock-run
expect 0 run model.yaml -o out; err "process 1 on a machine was writing to out"
rm -rf theirs && mkdir theirs && echo mine >theirs/.lock-run
rm -rf out && cp -r theirs out
expect 5 run model.yaml -o out --quiet; err "out/.lock-run: is no lock of a run"; same out

# Where the result itself could not be written, the lock says whose files these are.
if [ -w /dev/full ]; then
  rm -rf out && mkdir out && ln -s /dev/full out/result.json.tmp
  expect 5 run model.yaml -o out --quiet --force; err "No space left"
  [ ! -e out/result.json ] || complain "a result in spite of that"
  rm -f out/result.json.tmp
  expect 0 run model.yaml -o out; err "has left no result"
fi
# What is found at rest is not what is found in motion: they have identities of their own, in a
# budget's folder, too.
rm -rf run still parts
expect 0 run model.yaml -o run --quiet
expect 0 static model.yaml -o still --quiet
python3 - <<'PY2' || complain "hashes of run and static"
import json
run, still = [json.load(open(d + "/result.json"))["hashes"] for d in ("run", "still")]
assert run["scenario"] == still["scenario"] and run["mesh"] == still["mesh"] and run["run"] != still["run"]
PY2
expect 0 budget model.yaml --static -o parts --quiet --skip space
grep -h '"command"\|"hash"' parts/study.json | grep -o '[0-9a-f]\{64\}' | sort -u >planned
cat parts/runs/*/result.json | grep -o '"run": "[0-9a-f]\{64\}' | grep -o '[0-9a-f]\{64\}' | sort -u >made
cmp -s planned made || complain "$what: what was planned is not what was made"
touch before; sleep 1
expect 0 budget model.yaml --static -o parts --quiet --skip space
[ -z "$(find parts/runs -name result.json -newer before)" ] || complain "$what: a run was repeated"
# The folder of a study, of a budget, of a search for a limit.
cat >study.yaml <<'YAML'
study: which one
base: model.yaml
axes: [{key: integrator.rtol, values: [1e-2, 1e-3]}]
repeat: 0
YAML
limit='find-limit model.yaml --key integrator.step --from 1e-4 --to 2e-4 --scan 2 --set integrator.method=newmark'
for name in study.json table.json table.csv index.sqlite report.html budget.json limit.json; do
  rm -rf theirs && mkdir theirs && echo mine >theirs/$name
  for command in 'study study.yaml' 'study export study.yaml --format commands' 'budget model.yaml --skip space' "$limit"; do
    rm -rf store && cp -r theirs store
    # shellcheck disable=SC2086
    expect 5 $command -o store; err "store/$name"; err "--force"; no_out
    rm -f store/.lock; same store
  done
done
rm -rf store && cp -r theirs store && echo mine >store/study.json
expect 0 study study.yaml -o store --quiet --force
expect 0 study study.yaml -o store; err "(0 now)"
mkdir -p store/runs/other && echo mine >store/runs/other/probes.csv && echo mine >store/notes.txt
expect 0 study study.yaml -o store --quiet
[ "$(cat store/runs/other/probes.csv store/notes.txt)" = "mine
mine" ] || complain "files of others in a study's folder have changed"
echo mine >store/report.html
expect 5 study study.yaml -o store --quiet; err store/report.html; err "--force"
[ "$(cat store/report.html)" = mine ] || complain "a page of somebody's own is gone"
expect 0 study study.yaml -o store --quiet --force

# Pages and diagrams replace their like, and nothing else.
expect 0 run model.yaml -o run --quiet
for page in run/report.html page.html; do
  expect 0 report run -o $page
  expect 0 report run -o $page
  echo mine >$page
  expect 5 report run -o $page; err "$page: is not a file that corot has written"; err "--force"; no_out
  [ "$(cat $page)" = mine ] || complain "$page has changed"
  expect 0 report run -o $page --force
done
expect 0 plot store -o figure.svg
for suffix in svg csv gp py; do
  expect 0 plot store -o figure.svg
  echo mine >figure.$suffix
  expect 5 plot store -o figure.svg; err "figure.$suffix: is not a file that corot has written"; err "--force"; no_out
  [ "$(cat figure.$suffix)" = mine ] || complain "figure.$suffix has changed"
  expect 0 plot store -o figure.svg --force
done
exit $failed

. "$(dirname "$0")/lib.sh"

study() { printf '%s\n' "study: which one" "base: model.yaml" "set: {time.end: 0.02}" "$@" >study.yaml; }

# What does not make sense is answered for with its place in the file.
refuse() {
  study "$@"
  expect 3 study study.yaml -o refused
  no_out
  [ ! -e refused ] || complain "a folder for $*"
}
refuse 'axes: [{key: integrator.methd, values: [cvode]}]'
err "study.yaml:4:14: integrator.methd: unknown key; did you mean method?"
refuse 'axes: [{key: integrator.method, values: [cvod, ida]}]'; err "did you mean cvode?"
refuse 'axes: [{key: integrator.rtol, values: []}]'; err "study.yaml:4:39: axes[0].values: the list is empty"
refuse 'axes: []'; err "axes is missing"
refuse 'axs: []'; err "study.yaml:4:1: axs: unknown key; did you mean axes?"
refuse 'axes: [{key: integrator.rtol, values: [1e-3]}]' 'exclude: [{integrator.rtol: 0.001}]'
err "study.yaml:5:1: exclude: nothing is left to run"
refuse 'axes: [{key: integrator.rtol, values: [1e-3]}]' 'exclude: [{integrator.rtl: 1e-3}]'
err "no axis varies integrator.rtl; did you mean integrator.rtol?"
refuse 'axes: [{key: integrator.method, values: [cvode, bdf2]}]'
err "(in the cell integrator.method = bdf2"
refuse 'axes: [{zip: {strain: [green, polar], integrator.rtol: [1e-3]}}]'; err "1 values, but strain has 2"
refuse 'axes: [{key: strain, values: [green]}]' 'reference: {methods: [cvode]}'; err "two methods"
study 'axes: [{key: strain, values: [green]}]'
printf '%s\n' 'study: of a study' 'base: study.yaml' 'axes: [{key: strain, values: [green]}]' >outer.yaml
expect 3 study outer.yaml; err "outer.yaml:2:7: base: study.yaml is a study itself"
expect 3 study none.yaml; err "none.yaml"
expect 3 study model.yaml; err "this is a scenario; a study names one as its base"
expect 2 study study.yaml -j 0; err "--jobs 0: expected 1 to"
expect 2 study study.yaml --shard 3/2; err "--shard 3/2"
expect 2 study study.yaml --dryrun; err "did you mean --dry-run?"
expect 2 study status; err "status: expected one folder"
expect 5 study status nowhere; err "nowhere/study.json"
expect 0 study schema axes; out "axes[].zip"
expect 2 study schema axs; err "did you mean axes?"

# A study, twice: the second time there is nothing left to do, until there is more to it.
study 'axes: [{key: integrator.rtol, values: [1e-3, 1e-4]}, {key: integrator.method, values: [cvode, ida]}]' 'repeat: 1'
expect 0 study study.yaml --dry-run; no_err
[ "$(grep -c missing stdout)" = 6 ] || complain "not 6 runs"
[ ! -e out/study ] || complain "a dry run leaves a folder"
expect 0 study study.yaml; err "out/study: 6 of 6 runs done (6 now), 0 failed"
err "out/study/report.html"; grep -q "which one" out/study/report.html || complain "no page of the study"
[ "$(cat out/study/runs/*/timings.json | grep -c '"cpu"')" = 4 ] || complain "not one timing for each cell"
[ "$(ls out/study/runs/*/states.bin | wc -l)" = 6 ] || complain "not 6 files of states"
expect 0 study study.yaml --quiet; no_err
study 'axes: [{key: integrator.method, values: [ida, cvode, arkode]}, {key: integrator.rtol, values: [0.001, 1e-4]}]' 'repeat: 1'
expect 0 study study.yaml -j 1; err "8 of 8 runs done (2 now)"
expect 0 study status out/study; out "6 cells, 8 runs: 8 done, 0 failed, 0 missing"
expect 0 study table out/study; out "too few points to say of 3 series"
[ "$(grep -c 'too few points' stdout)" = 1 ] || complain "too few points, more than once"

# Results of another version, or of another scenario by the same name, are not taken for ours.
sed -i 's/"corot": "[^"]*"/"corot": "0.0.1"/' out/study/study.json
run=$(ls -d out/study/runs/* | head -1)
sed -i 's/"run": "./"run": "x/' "$run/result.json"
expect 0 study study.yaml; err "out/study: made by corot 0.0.1; this is "; err "8 of 8 runs done (1 now)"

# Another study's folder is refused, and so is one that is in use.
sed -i 's/which one/which other one/' study.yaml
expect 3 study study.yaml -o out/study; err 'out/study: belongs to the study "which one"; choose another folder'
sed -i 's/which other one/which one/' study.yaml
sed 's/density: 1000/density: 1001/' model.yaml >other.yaml
sed 's/model.yaml/other.yaml/' study.yaml >on_other.yaml
expect 3 study on_other.yaml -o out/study; err "out/study: holds this study for another base"
exec 9>>out/study/.lock
flock 9
expect 3 study study.yaml; err "out/study: another study is at work here"
exec 9>&-

# Failures: recorded with their reason, not repeated unless asked for, and no matter to the rest.
study 'axes: [{key: integrator.max_steps, values: [none, 3]}]' 'reference: none'
expect 1 study study.yaml -o f; err "1 of 2 runs done (1 now), 1 failed"; err "max_steps"
expect 1 study study.yaml -o f; err "1 of 2 runs done (0 now), 1 failed"
expect 1 study study.yaml -o f --retry-failed; err "1 of 2 runs done (0 now), 1 failed"
expect 0 study status f; out "failed: "; out "1 done, 1 failed, 0 missing"
study 'axes: [{key: boundary.0.group, values: [bse, base]}]' 'reference: none'
expect 1 study study.yaml -o g; err "did you mean base?"
grep -q '"exit_code": 3' g/runs/*/failure.json || complain "no exit code in failure.json"

# Shards: between them, all of it.
study 'axes: [{key: integrator.rtol, values: [1e-3, 1e-4, 1e-5]}]'
for i in 1 2 3; do "$corot" study study.yaml -o shards --shard $i/3 -q 2>"shard$i" & done
wait
cat shard1 shard2 shard3 >stderr; what="three shards at once"; no_err
expect 0 study status shards; out "5 runs: 5 done, 0 failed, 0 missing"

# The runs by other engines, and what they left collected: the same table.
study 'axes: [{key: integrator.rtol, values: [1e-3, 1e-4]}, {key: boundary.0.fix, values: [[x, y, z]]}]'
expect 0 study study.yaml -o e/ours
expect 0 study export study.yaml --format commands -o e/commands; no_err
[ "$(wc -l <stdout)" = 4 ] || complain "not 4 commands"
sh ./stdout || complain "a command failed"
expect 0 study export study.yaml --format slurm -o e/slurm
cp stdout job
for i in 1 2 3 4; do SLURM_ARRAY_TASK_ID=$i sh ./job || complain "task $i"; done
expect 0 study export study.yaml --format snakemake -o e/snakemake; out 'rule run:'
python3 - <<'PYTHON' || complain "the Snakefile's runs"
import json, subprocess
values = {}
exec(open("stdout").read().split("rule all:")[0], values)
for id, settings in values["RUNS"].items():
    subprocess.run(f"'{values['PROGRAM']}' run '{values['BASE']}' -q --lean -o '{values['DIR']}/runs/{id}' {settings}", shell=True, check=True)
PYTHON
for engine in commands slurm snakemake; do
  expect 0 study collect e/$engine; no_out; err "warning: bending: 2 of 2 cells: "
  python3 - e/ours e/$engine <<'PYTHON' || complain "the table by $engine"
import json, sys
a, b = (json.load(open(f"{d}/table.json")) for d in sys.argv[1:])
for t in a, b:
    t["rankings"] = [sorted(b["series"] for b in r["best"]) for r in t["rankings"]]
    for c in t["cells"]:
        for name in list(c["cost"]):
            if name[:3] in ("cpu", "wal"): del c["cost"][name]
assert a == b
PYTHON
done
expect 2 study export study.yaml; err "--format is missing"
expect 2 study export study.yaml --format make; err "expected commands, slurm or snakemake"

# What is collected: as JSON, CSV, SQL and for people.
expect 0 study table e/ours; out "integrator.rtol"; out "cvode and arkode agree to"; out "cheapest by cpu"
expect 0 study csv e/ours; out "id,series,boundary.0.fix,integrator.rtol,tolerance,"
[ "$(wc -l <stdout)" = 3 ] || complain "not 3 lines"
python3 - <<'PYTHON' || complain "the index"
import sqlite3
rows = sqlite3.connect("e/ours/index.sqlite").execute(
    'select "integrator.rtol", "error.displacement", "cost.steps", status from runs order by 1').fetchall()
assert [r[0] for r in rows] == [1e-4, 1e-3] and rows[0][1] < rows[1][1] and rows[0][2] > rows[1][2], rows
PYTHON
# A column may be called as one of ours is, in any case.
cat >names.yaml <<'YAML'
study: names
base: model.yaml
set: {time.end: 0.02}
axes:
  - {name: Status, variants: [{label: a, set: {}}]}
  - {name: error.energy, variants: [{label: b, set: {}}]}
reference: none
YAML
expect 0 study names.yaml -o names --quiet; no_err
expect 0 study csv names; out "id,series,settings.Status,settings.error.energy,tolerance,"
expect 5 study table nowhere; err "nowhere/table.json: cannot open it"
echo '{"cells": 3}' >e/table.json
expect 3 study table e; err "not a table of a study"

# A reference that is wrong is caught.
python3 - <<'PYTHON'
import array, glob, hashlib, json
study = json.load(open("e/ours/study.json"))
path = "e/ours/runs/" + study["runs"][study["references"][0]["runs"][1]]["id"] + "/states.bin"
data = bytearray(open(path, "rb").read())
n = int.from_bytes(data[16:24], "little")
head = 24 + 4 * (n + n % 2)
states = array.array("d", data[head:])
for k in range(0, len(states), 1 + 2 * n):
    for i in range(n): states[k + 1 + i] *= 1.01
data = data[:head] + states.tobytes()
open(path, "wb").write(data)
result = json.load(open(path.replace("states.bin", "result.json")))
for file in result["files"]:  # as if the run had written that
    if file["name"] == "states.bin": file["sha256"] = hashlib.sha256(data).hexdigest()
json.dump(result, open(path.replace("states.bin", "result.json"), "w"))
PYTHON
expect 0 study collect e/ours; err "reference 0: cvode and arkode part ways"; err "2 of 2 cells are not rated"
expect 0 study table e/ours; out "cvode and arkode part ways: from t = 0.0"

# A full disk loses what was under way, and no more.
if [ -w /dev/full ]; then
  study 'axes: [{key: integrator.rtol, values: [1e-3, 1e-4, 1e-5]}]'
  run=$(ls -d shards/runs/* | head -1)
  rm "$run/result.json" && ln -sf /dev/full "$run/steps.csv"
  expect 5 study study.yaml -o shards; err "4 of 5 runs done (0 now), 0 failed"; err "No space left"
  rm "$run/steps.csv"
  expect 0 study study.yaml -o shards; err "5 of 5 runs done (1 now), 0 failed"
fi

# Interrupted: what there is stays, and the exit code says by what.
study 'axes: [{key: time.end, values: [1e6, 2e6, 0.01]}]' 'reference: none'
for signal in INT:130 TERM:143; do
  "$corot" study study.yaml -o i -j 3 >stdout 2>stderr &
  what="interrupted study"
  tries=0
  until [ "$(ls i/runs/*/steps.csv 2>/dev/null | wc -l)" = 3 ] || [ $tries = 100 ]; do sleep 0.05; tries=$((tries + 1)); done
  sleep 0.3
  kill -"${signal%:*}" $!
  wait $!
  got=$?
  [ $got = "${signal#*:}" ] || complain "signal ${signal%:*}: exit code $got"
  err "the same command goes on from here"
  expect 0 study status i; out "1 done, 0 failed, 2 missing"
done
exit $failed

# A study that is killed 50 times, at moments that nobody has chosen, and goes on each time: its
# table is that of a study which nothing disturbed, to the last bit, but for the times on the clock.
. "$(dirname "$0")/lib.sh"

cat >study.yaml <<'YAML'
study: to be killed
base: model.yaml
set: {time.end: 0.03, time.output: 0.005}
axes:
  - {key: strain, values: [polar, green]}
  - {key: integrator.method, values: [cvode, ida, arkode]}
  - {key: integrator.rtol, log: {from: 1e-2, to: 1e-5, per_decade: 1}}
repeat: 1
YAML
expect 0 study study.yaml -o undisturbed

python3 - "$corot" <<'PYTHON' || complain "what killing leaves"
import glob, json, os, random, shutil, subprocess, sys, time

corot = sys.argv[1]
random.seed(20040601)
command = [corot, "study", "study.yaml", "-o", "killed", "-j", "2", "--quiet"]

def kill_once(after):
    study = subprocess.Popen(command, stderr=subprocess.PIPE)
    try:
        study.wait(after)
    except subprocess.TimeoutExpired:
        study.kill()
    errors = study.communicate()[1]
    assert study.returncode in (0, -9), (study.returncode, errors)
    return study.returncode == -9

kills = complete = 0
while kills < 50:
    if kill_once(random.uniform(0, 0.12)):
        kills += 1
        for path in glob.glob("killed/**/*.json", recursive=True):
            json.load(open(path))  # whole, or not there
    else:
        complete += 1
        shutil.rmtree("killed")
print(f"{kills} kills, {complete} studies came through in between")
end = subprocess.run(command, stderr=subprocess.PIPE)
assert end.returncode == 0, end

def without_times(name):
    table = json.load(open(name + "/table.json"))
    table["rankings"] = [sorted(b["series"] for b in r["best"]) for r in table["rankings"]]
    for c in table["cells"]:
        assert c["cost"]["repeats"] == 1, c
        for key in list(c["cost"]):
            if key.startswith(("cpu", "wall")): del c["cost"][key]
    return json.dumps(table)

assert without_times("undisturbed") == without_times("killed")
PYTHON

# Nothing outlives a study that is killed: neither its runs, which are copies of a template, nor the
# template; beside sanitizers there is none. One short cell comes first, as a pilot.
cat >endless.yaml <<'YAML'
study: without an end
base: model.yaml
set: {output.fields: none}
axes: [{key: time.end, values: [0.02, 1.0e6, 1.1e6]}]
reference: none
YAML
what="the children of a study that is killed"
"$corot" study endless.yaml -o endless -j 2 --quiet >stdout 2>stderr &
study=$!
find_children() {
  children=$(cat /proc/$study/task/*/children)
  names=$(for child in $children; do tr '\0' ' ' </proc/$child/cmdline; done 2>/dev/null)
}
has_runs() {
  find_children
  for end in 1.0e6 1.1e6; do
    case $names in *"corot run "*"time.end=$end"*) ;; *) return 1 ;; esac
  done
}
until_true has_runs
has_runs || complain "ps does not tell the runs: $names"
kill -KILL $study
wait $study 2>/dev/null
is_there() { grep -qs '^State:[^ZX]*$' "/proc/$1/status"; }
for child in $children; do
  until_true eval '! is_there $child'
  if is_there "$child"; then complain "$what: $child is still there"; kill -KILL "$child"; fi
done

# The same by one process at a time, and with the axes the other way round.
expect 0 study study.yaml -o one -j 1 --quiet
python3 - <<'PYTHON'
lines = open("study.yaml").read().split("\n")
lines[4:7] = lines[6:3:-1]
open("turned.yaml", "w").write("\n".join(lines))
PYTHON
expect 0 study turned.yaml -o turned --quiet
for other in one turned; do
  python3 - $other <<'PYTHON' || complain "the table of $other"
import json, sys
tables = [json.load(open(f"{d}/table.json")) for d in ("undisturbed", sys.argv[1])]
for t in tables:
    del t["rankings"]
    for c in t["cells"]:
        for key in list(c["cost"]):
            if key.startswith(("cpu", "wall")): del c["cost"][key]
assert json.dumps(tables[0]) == json.dumps(tables[1])
PYTHON
done
exit $failed

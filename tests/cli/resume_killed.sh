# A run with checkpoints that is killed at whichever call that changes a file, and so is the one that
# goes on: what goes on then is the run that nothing disturbed. And a study's runs go on.
# usage: resume_killed.sh COROT SCRATCH_FOLDER DISTURB, the library of disturb.c
. "$(dirname "$0")/lib.sh"
disturb=$3
cat >>model.yaml <<'YAML'
output: {states: binary, every: 2}
checkpoint: {every: 0, steps: 12}
YAML

# same FOLDER: all its files are those of the run that nothing disturbed.
cat >same.py <<'PYTHON'
import json, os, sys

def files(folder):
    read = {os.path.relpath(os.path.join(d, f), folder): open(os.path.join(d, f), "rb").read()
            for d, _, all in os.walk(folder) for f in all if f != ".lock-run"}
    result = json.loads(read["result.json"])
    resumed, _ = result.pop("resumed"), result.pop("timings")
    result["memory"].pop("peak")
    read["result.json"] = result
    return resumed, read

(_, whole), (resumed, other) = files("whole"), files(sys.argv[1])
assert whole.keys() == other.keys(), whole.keys() ^ other.keys()
assert whole == other, [f for f in whole if whole[f] != other[f]]
print(resumed)
PYTHON

run() { # FOLDER, with the environment of the caller
  "$corot" run model.yaml -o "$1" --resume --quiet
}
DISTURB_COUNT=count LD_PRELOAD=$disturb run whole 2>stderr || complain "a run with checkpoints"
n=$(cat count)

# Each eleventh call, and at each of these the run that goes on is killed at another one.
k=1 resumed=0
while [ $k -le "$n" ]; do
  what="killed at change $k of $n"
  rm -rf cut
  (DISTURB_KILL=9:$k LD_PRELOAD=$disturb run cut) >stdout 2>stderr
  [ $? = 137 ] || complain "$what: it was not"
  (DISTURB_KILL=9:$((k % 13 + 1)) LD_PRELOAD=$disturb run cut) >stdout 2>stderr
  (DISTURB_KILL=9:$((k % 37 + 1)) LD_PRELOAD=$disturb run cut) >stdout 2>stderr
  run cut >stdout 2>stderr || complain "$what: it does not go on"
  python3 same.py cut >stdout 2>stderr || complain "$what: it is another run"
  resumed=$((resumed + $(cat stdout)))
  k=$((k + 11))
done
[ $resumed -gt 12 ] || complain "it has gone on $resumed times"

# The same by a request that finds the run in a step that it does not end, with what is kept in
# memory: the second request does not wait.
sed -i 's/every: 0,/every: 1 h,/; s/end: 0.05/end: 1000.0/' model.yaml
"$corot" run model.yaml -o busy --quiet --set output.fields=none >stdout 2>stderr &
until_true eval '[ -s busy/history.csv ] && [ "$(stat -c %s busy/history.csv)" -gt 20000 ]'
kill -STOP $!; kill -TERM $!; sleep 0.3; kill -INT $!; kill -CONT $!; wait $!
[ -s busy/checkpoint.bin ] || complain "two requests at once: no checkpoint"
sed -i 's/end: 1000.0/end: 0.05/' model.yaml

# A study that is killed goes on with its runs, whose results are the same.
cat >study.yaml <<'YAML'
study: long
base: model.yaml
set: {time.end: 4.0, output: {fields: none, states: none}, checkpoint: {every: 0, steps: 50}}
axes: [{key: integrator.rtol, values: [1.0e-5, 1.0e-6]}]
reference: none
repeat: 1
YAML
expect 0 study study.yaml -o undisturbed --quiet
for wait in 1 2 3; do
  "$corot" study study.yaml -o studied -j 2 --quiet >stdout 2>stderr &
  until_true eval '[ "$(ls studied/runs/*/checkpoint.bin 2>/dev/null | wc -l)" = 2 ] || ! kill -0 $! 2>/dev/null'
  kill -KILL $!; wait $! 2>/dev/null
done
expect 0 study study.yaml -o studied --quiet
python3 - <<'PYTHON' || complain "a study whose runs went on"
import glob, json, os
resumed = 0
for path in glob.glob("undisturbed/runs/*/result.json"):
    whole, cut = json.load(open(path)), json.load(open(path.replace("undisturbed", "studied")))
    assert whole["resumed"] == 0
    assert [f["sha256"] for f in whole["files"]] == [f["sha256"] for f in cut["files"]], path
    assert not os.path.exists(os.path.dirname(path).replace("undisturbed", "studied") + "/checkpoint.bin")
    resumed += cut["resumed"]
assert resumed > 1, resumed
PYTHON
exit $failed

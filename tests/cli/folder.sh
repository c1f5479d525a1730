# A folder has one writer at a time, and what is in the way of a run is never the loss of its user.
. "$(dirname "$0")/lib.sh"

# The equilibrium of a scenario leaves its motion alone.
expect 0 run model.yaml --quiet
cp out/model/result.json before.json
expect 0 static model.yaml --quiet
cmp -s before.json out/model/result.json || complain "static has replaced the results of run"

# While one writes, another is refused by name, and touches nothing.
rm -rf out
"$corot" run model.yaml -o out --quiet --set time.end=1000 >first.out 2>first.err &
first=$!
for wait in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15; do [ -s out/steps.csv ] || sleep 1; done
for command in run static; do
  expect 5 $command model.yaml -o out --quiet; err "process $first on "; err "is writing there"
  [ ! -e out/result.json ] || complain "$command: who was refused has written"
done

# The lock of a process that was killed is taken over, and it is said.
kill -KILL $first
wait $first 2>/dev/null
expect 0 run model.yaml -o out; err "process $first on "; err "has left no result"
[ ! -e out/.lock-run ] || complain "the lock stays"
expect 0 run model.yaml -o out
grep -q "has left no result" stderr && complain "an old lock is told of again"

# What is not a file of ours stays.
rm -rf out && mkdir -p out/result.json/kept
expect 5 run model.yaml -o out --quiet; err "result.json"
[ -d out/result.json/kept ] || complain "a folder is gone"
rm -rf out && echo text >out
expect 5 run model.yaml -o out --quiet; err "is not a folder"
[ "$(cat out)" = text ] || complain "a file is gone"
if [ -c /dev/full ]; then
  expect 5 run model.yaml -o /dev/full --quiet; err "/dev/full"
  [ -c /dev/full ] || complain "a device is gone"
fi

# result.json vouches for each file, and a study makes again what is lost or cut.
rm -rf out
expect 0 run model.yaml -o out --quiet --json
python3 - <<'PY' || complain "result.json does not list the files as they are"
import hashlib, json, os
listed = json.load(open("out/result.json"))["files"]
there = sorted(os.path.relpath(os.path.join(d, f), "out") for d, _, all in os.walk("out") for f in all)
assert sorted([f["name"] for f in listed] + ["result.json"]) == there, (listed, there)
for f in listed:
    data = open(os.path.join("out", f["name"]), "rb").read()
    assert len(data) == f["size"] and hashlib.sha256(data).hexdigest() == f["sha256"], f
PY
cat >study.yaml <<'YAML'
study: which one
base: model.yaml
axes: [{key: strain, values: [polar, green]}]
reference: none
YAML
expect 0 study study.yaml -o study
set -- study/runs/*/
cp "$1/probes.csv" whole.csv
: >"$1/probes.csv"
rm "$2/energy.csv"
expect 0 study study.yaml -o study; err "2 of 2 runs done (2 now)"
cmp -s whole.csv "$1/probes.csv" || complain "a file that was cut is not made again"
expect 0 study study.yaml -o study; err "2 of 2 runs done (0 now)"
exit $failed

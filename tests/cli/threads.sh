# Threads make a run no other than one thread does; how many there are is said, asked for, and limited.
. "$(dirname "$0")/lib.sh"

cat >a.yaml <<'YAML'
mesh: {box: {size: [0.1, 0.1, 0.3], cells: [3, 3, 8]}}
groups:
  base: {plane: {axis: z, at: 0.0}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary:
  - {group: base, fix: [x, y, z]}
loads:
  - {group: zmax, traction: [100.0, 0.0, 0.0]}
linear_solver: pcg
time: {end: 0.02, output: 0.005}
probes:
  corner: {point: [0.1, 0.1, 0.3]}
  worst: {of: von_mises, take: max}
output: {states: binary}
checkpoint: {every: 0, steps: 10}
YAML

# holds FILE EXPRESSION of its contents d.
holds() { python3 -c "import json; d = json.load(open('$1')); assert $2, d" || complain "$1: not $2"; }

# same A B: all files but result.json, which tells of times.
same() { diff -r -x result.json "$1" "$2" >stdout 2>stderr || complain "$1 and $2 differ"; }

for method in cvode arkode newmark; do
  step=null
  case $method in newmark) step=0.001 ;; esac
  sed "s/^linear_solver/integrator: {method: $method, step: $step}\nlinear_solver/; s/, step: null//" a.yaml >$method.yaml
  for n in 1 3; do
    expect 0 run $method.yaml -o "$method-$n" --quiet --set threads=$n
    holds "$method-$n/result.json" "d['threads'] == $n and d['scenario']['threads'] == $n"
  done
  same $method-1 $method-3
done
expect 0 static a.yaml -o still-1 --quiet --set threads=1
expect 0 static a.yaml -o still-2 --quiet --set threads=2
holds still-2/result.json "d['threads'] == 2"
same still-1 still-2

# They are no part of the answer, but of what it costs: another run, and the same checkpoint.
python3 - <<'PY' || complain "the hashes"
import json
a, b = (json.load(open(f"cvode-{n}/result.json"))["hashes"] for n in (1, 3))
assert a["mesh"] == b["mesh"] and a["run"] != b["run"], (a, b)
PY

# By default a small body has one; a host says how many are its own.
expect 0 run a.yaml -o default --quiet; holds default/result.json "d['threads'] == 1"
expect 0 run a.yaml -o big --quiet --set mesh.box.cells='[9,9,18]' --set time.end=0.0001 --set output.fields=none --set output.space_error=false
if [ "$(nproc)" -gt 1 ]; then holds big/result.json "d['threads'] >= 2"; fi
OMP_NUM_THREADS=1 expect 0 run a.yaml -o one --quiet --set mesh.box.cells='[9,9,18]' --set time.end=0.0001 --set output.fields=none --set output.space_error=false
holds one/result.json "d['threads'] == 1"

# What makes no sense.
expect 3 check a.yaml --set threads=0; err "threads: must be > 0, found 0"
expect 3 check a.yaml --set threads=-2; err "threads: must be > 0, found -2"
expect 3 check a.yaml --set threads=1.5
expect 3 check a.yaml --set threads=10000; err "threads: must be at most 256, found 10000"
echo 'threads: 10000' | cat a.yaml - >many.yaml
expect 3 run many.yaml -o many; err "many.yaml:16:10: threads: must be at most 256, found 10000"
[ -e many ] && complain "a run that was refused has left a folder"
expect 0 check a.yaml --set threads=200; out "200 threads share $(nproc) processor"
expect 0 check a.yaml --set threads=200 --json; json 'any(w["code"] == "threads" for w in d["warnings"])'

# A study may ask what they cost: each is a run of its own.
cat >study.yaml <<'YAML'
study: what threads cost
base: a.yaml
axes:
  - {key: threads, values: [1, 2]}
YAML
expect 0 study study.yaml -o cost -j 1
python3 - <<'PY' || complain "a study of threads"
import csv
rows = list(csv.DictReader(open("cost/table.csv")))
assert len(rows) == 2 and rows[0]["id"] != rows[1]["id"], rows
PY
exit $failed

# What a study costs beside its runs: `corot study -j 1` against the same commands run one after the
# other by a shell. Every cell is a solid of its own, which is the worst case.
# usage: sh study.sh COROT [RUNS [ROUNDS]]     default: 1000 runs of some 50 ms, the least of 3 rounds
set -eu
corot=$1
runs=${2:-1000}
rounds=${3:-3}
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir"
export OPENBLAS_NUM_THREADS=1

cat >model.yaml <<'YAML'
mesh: {box: {size: [0.1, 0.1, 0.6], cells: [2, 2, 8]}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary:
  - {group: zmin, fix: [x, y, z]}
loads:
  - {group: zmax, traction: [200.0, 0.0, 0.0]}
time: {end: 0.8, output: 0.02}
YAML
python3 - "$runs" >study.yaml <<'PYTHON'
import sys
print("study: overhead\nbase: model.yaml\nreference: none\naxes:\n  - key: loads.0.traction")
print("    values:", [[200 + 0.01 * k, 0, 0] for k in range(int(sys.argv[1]))])
PYTHON

python3 - "$corot" "$runs" "$rounds" <<'PYTHON'
import resource, shutil, subprocess, sys, time
corot, runs, rounds = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])

def cpu():
    r = resource.getrusage(resource.RUSAGE_CHILDREN)
    return r.ru_utime + r.ru_stime

def measure(*command):
    start = time.monotonic(), cpu()
    subprocess.run(command, check=True)
    return time.monotonic() - start[0], cpu() - start[1]

bare, study, idle = [], [], []
for _ in range(rounds):
    with open("commands", "w") as out:
        subprocess.run([corot, "study", "export", "study.yaml", "--format", "commands", "-o", "bare"], stdout=out, check=True)
    bare.append(measure("sh", "./commands"))
    study.append(measure(corot, "study", "study.yaml", "-o", "study", "-j", "1", "-q"))
    idle.append(measure(corot, "study", "study.yaml", "-o", "study", "-j", "1", "-q"))
    shutil.rmtree("bare")
    shutil.rmtree("study")
for i, name in enumerate(("wall", "cpu")):
    b, s, again = (min(m[i] for m in measured) for measured in (bare, study, idle))
    print(f"{name}: {runs} runs of {1e3 * b / runs:.1f} ms by a shell, {b:.2f} s; as a study {s:.2f} s, {100 * (s / b - 1):+.1f} %; "
          f"again, with nothing left to run, {again:.2f} s, {100 * again / b:.1f} %")
PYTHON

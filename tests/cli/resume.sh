# A run that is killed ten times, at moments that nobody has chosen, and goes on each time, is the run
# that nothing disturbed, to the last bit: all files, and result.json but for the clock.
. "$(dirname "$0")/lib.sh"

# Held frames, a jump of a load, inputs with jumps, quantities, all outputs.
cat >a.yaml <<'YAML'
mesh: {box: {size: [0.1, 0.1, 0.2], cells: [1, 1, 3], split: kuhn}}
groups:
  base: {plane: {axis: z, at: 0.0}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary:
  - {group: base, fix: [x, y, z]}
loads:
  - {group: zmax, traction: [100.0, 0.0, 0.0], amplitude: [[0, 0], [0.3, 1], [0.3, 0.5], [1, 1.5]]}
inputs: {push: {load: 0, values: [[0, 1], [0.35, 1], [0.35, -1], [0.4, 1]]}}
time: {end: 2, output: 0.02}
frames: {policy: hold, interval: 0.03}
probes:
  corner: {point: [0.1, 0.1, 0.2]}
  worst: {of: von_mises, take: max}
  wall: {group: base, of: reaction}
quantities: {peak: max(worst.value), mean: "mean(corner.ux, 0.1, 1)", T: period(corner.ux), end: corner.ux@end}
output: {states: binary, steps: all, every: 3}
checkpoint: {every: 0, steps: 20}
YAML
# Extrapolated frames by their angle, forces compared, ten-node tets, a support that is shaken.
cat >b.yaml <<'YAML'
mesh: {box: {size: [0.1, 0.1, 0.2], cells: [1, 1, 1]}, order: 2}
groups:
  base: {plane: {axis: z, at: 0.0}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary:
  - {group: base, move: {direction: [0.01, 0, 0], amplitude: {sine: {frequency: 3}}}}
loads:
  - {gravity: [0.0, 1.0, -5.0]}
time: {end: 1, output: 0.02}
start: {from: equilibrium}
frames: {policy: extrapolate, max_angle: 0.01}
probes:
  corner: {point: [0.1, 0.1, 0.2]}
  fastest: {of: velocity, take: max}
compare: [cauchy]
output: {states: binary, every: 5}
checkpoint: {every: 0, steps: 15}
YAML

"$corot" schema --json >schema.json
cat >killed.py <<'PYTHON'
import filecmp, json, os, random, shutil, signal, subprocess, sys, time

corot = sys.argv[1]
random.seed(20040601)
methods = json.load(open("schema.json"))["properties"]["integrator"]["properties"]["method"]["enum"]

def files(folder):
    return sorted(os.path.relpath(os.path.join(d, f), folder) for d, _, all in os.walk(folder) for f in all)

def run(command):
    began = time.time()
    done = subprocess.run([corot] + command, stderr=subprocess.PIPE)
    assert done.returncode in (0, 1), (command, done)
    return done.returncode, time.time() - began

def number_of(file):
    try:
        return os.stat(file).st_ino
    except FileNotFoundError:
        return None

# Kills it at any moment after it has written a checkpoint, but for a first time: before it has.
def killed(command, longest, times):
    file = command[command.index("-o") + 1] + "/checkpoint.bin"
    for kill in range(times + 1):
        before = number_of(file)
        p = subprocess.Popen([corot] + command, stderr=subprocess.PIPE)
        while 0 < kill < times and number_of(file) == before and p.poll() is None:
            time.sleep(0.001)
        try:
            p.wait(random.uniform(0, longest) if kill < times else None)
        except subprocess.TimeoutExpired:
            p.kill()
        err = p.communicate()[1]
        if p.returncode != -signal.SIGKILL:
            return p.returncode, err
    raise AssertionError("killed once more")

# What the clock and the processes say.
def lasting(folder):
    r = json.load(open(folder + "/result.json"))
    r["memory"].pop("peak")
    return r.pop("resumed"), {k: v for k, v in r.items() if k != "timings"}

resumed = 0
for model, method in [("a", m) for m in methods] + [("b", m) for m in ("cvode", "arkode", "newmark")]:
    sets = ["--quiet", "--set", "integrator.method=" + method]
    if method not in ("cvode", "ida", "arkode", "erk"):
        sets += ["--set", "integrator.step=0.005", "--set", "time.end=1"]
    name = f"{model} by {method}"
    for folder in ("whole", "cut"):
        shutil.rmtree(folder, ignore_errors=True)
    code, took = run(["run", model + ".yaml", "-o", "whole"] + sets)
    got, err = killed(["run", model + ".yaml", "-o", "cut", "--resume"] + sets, took / 15, 10)
    assert got == code, (name, code, got, err)
    there = files("whole")
    extra = set(files("cut")) - {".lock-run"} ^ set(there)
    assert not extra, (name, extra)
    other = [f for f in there if f != "result.json" and not filecmp.cmp("whole/" + f, "cut/" + f, False)]
    assert not other, (name, other)
    (none, whole), (n, cut) = lasting("whole"), lasting("cut")
    assert none == 0 and whole == cut, (name, [k for k in whole if whole[k] != cut[k]])
    resumed += n
assert resumed > 5 * len(methods), resumed
PYTHON
python3 killed.py "$corot" || complain "what killing leaves"
exit $failed

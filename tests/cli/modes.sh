# Frequencies and shapes: files, what they are about, what is refused.
. "$(dirname "$0")/lib.sh"

expect 0 modes --help; out "usage: corot modes MODEL.yaml"; no_err
expect 2 modes; err "expected one scenario, found 0"
if ! "$corot" modes model.yaml -o probe 2>stderr && grep -q "built without ARPACK" stderr; then exit 77; fi

# holds FOLDER CONDITION: of modes.csv, in Python's words, f being the frequencies.
table='import csv; rows = list(csv.DictReader(open("%s/modes.csv"))); f = [float(r["frequency"]) for r in rows]'
holds() {
  # shellcheck disable=SC2059
  python3 -c "$(printf "$table" "$1"); assert $2, rows" || complain "$1: not $2"
}

expect 0 modes model.yaml; no_out; err "mode 1: "; err "10 modes about rest, to "; err "[undamped]"
head -n 1 out/model-modes/modes.csv | grep -q '^mode,frequency,' || complain "header of modes.csv"
holds out/model-modes '[int(r["mode"]) for r in rows] == list(range(1, 11)) and f == sorted(f) and f[0] > 1'

# The same again, bit for bit; and not by the scenario's conjugate gradients.
expect 0 modes model.yaml -o a -n 4 --quiet --json --set linear_solver=pcg; no_err
json 'd["status"] == "ok" and d["modes"]["about"] == "rest" and d["modes"]["rigid"] == 0'
json 'not d["modes"]["linear_solver"].startswith("pcg")'
json '[m["mode"] for m in d["modes"]["list"]] == [1, 2, 3, 4] and all(m["residual"] < 1e-9 for m in d["modes"]["list"])'
json '{"modes.csv", "fields.pvd", "fields/fields_000003.vtu"} <= {f["name"] for f in d["files"]}'
json '"commit" in d["provenance"] and d["hashes"]["run"] and d["scenario"]["linear_solver"]'
expect 0 modes model.yaml -o b --number=4 --quiet --set linear_solver=pcg
cmp -s a/modes.csv b/modes.csv && cmp -s a/fields/fields_000002.vtu b/fields/fields_000002.vtu || complain "another answer"
expect 0 modes model.yaml -o b -n 2 --quiet --set output.fields=none
[ ! -e b/fields.pvd ] && [ ! -e b/fields/fields_000002.vtu ] || complain "fields of earlier modes"
expect 0 static model.yaml -o b --quiet
[ ! -e b/modes.csv ] || complain "earlier modes"

# A shape, of both orders: largest component positive, held nodes still, x' M x = 1 with lumped mass,
# drawn so that the farthest node moves by a tenth of the body's length.
for order in 1 2; do
  expect 0 modes model.yaml -o s -n 3 --quiet --set mesh.order=$order --set mass=lumped
  python3 - s/fields/fields_000001.vtu $order <<'PY' || complain "the shape, of order $order"
import re, struct, sys
data = open(sys.argv[1], "rb").read()
head, body = data.split(b'encoding="raw">\n')[0].decode(), data[data.index(b"_", data.index(b'encoding="raw"')) + 1:]
def array(name, code):
    at = int(re.search('Name="%s"[^>]*offset="([0-9]+)"' % name, head).group(1))
    size = struct.unpack_from("<Q", body, at)[0]
    return struct.unpack_from("<%d%s" % (size // struct.calcsize(code), code), body, at + 8)
three = lambda a: [a[i:i + 3] for i in range(0, len(a), 3)]
mode, u, x = (three(array(n, "d")) for n in ("mode", "displacement", "Points"))
assert array("TimeValue", "d") == (2.0,)
assert set(array("types", "B")) == {10 if sys.argv[2] == "1" else 24}
assert not any(n in head for n in ("velocity", "von_mises", "strain"))
flat = [c for m in mode for c in m]
assert max(flat) >= -min(flat) * (1 - 1e-6) and max(flat) > 0
assert all(m == (0, 0, 0) for m, p in zip(mode, x) if p[2] == 0)
length = lambda v: sum(c * c for c in v) ** 0.5
center = [sum(p[c] for p in x) / len(x) for c in range(3)]
far = max(map(length, u)) / (2 * max(length([p[c] - center[c] for c in range(3)]) for p in x))
assert 0.09 < far < 0.11, far
k = flat.index(max(flat))
scale = u[k // 3][k % 3] / flat[k]
assert all(abs(a - scale * b) < 1e-12 for v, w in zip(u, mode) for a, b in zip(v, w))
PY
done

# A free body: six times nothing, exactly, in the table and in words.
expect 0 modes model.yaml -o free -n 8 --set boundary=[]; err "mode 6: 0 Hz, a rigid motion"
holds free 'f[:6] == [0] * 6 and f[6] > 1 and all(float(r["growth"]) == 0 for r in rows)'
holds free 'abs(sum(float(r["mass_x"]) for r in rows) - 2) < 1e-12'

# A column: its frequency falls with the load, and beyond the load that buckles it the mode grows.
column='--set mesh.box={size:[0.1,0.1,1.0],cells:[1,1,10]} --set mesh.order=2 --set material.lambda=0 --set probes.corner.point=[0,0,1]'
for load in 0 5 9 14; do # Euler's is 2.47 E I / L^2 over the area: 2e4 0.1^2 / 12 2.47 = 41 Pa
  expect 0 modes model.yaml -o c$load -n 3 --about equilibrium $column \
    --set "loads=[{group: zmax, traction: [0, 0, $(awk "BEGIN { print -4.1 * $load }")]}]"
done
err "mode 1: unstable, grows as e^("; err "the equilibrium is unstable: 2 of the modes grow"
holds c14 'f[0] == 0 and float(rows[0]["growth"]) > 0.1 and float(rows[0]["eigenvalue"]) < 0'
python3 - <<'PY' || complain "the column"
import csv
f = [float(next(csv.DictReader(open("c%d/modes.csv" % k)))["eigenvalue"]) for k in (0, 5, 9)]
assert 0.4 < f[1] / f[0] < 0.55 and 0.02 < f[2] / f[0] < 0.18, f
PY

# About where a run starts: under the loads of t = 0, if it starts in equilibrium.
ramp='--set loads.0.amplitude=[[0,0],[0.05,1]]'
expect 0 modes model.yaml -o r0 -n 2 --quiet
expect 0 modes model.yaml -o r1 -n 2 --quiet --about rest --set start=equilibrium
expect 0 modes model.yaml -o r2 -n 2 --quiet --json --set start=equilibrium $ramp
json 'd["modes"]["about"] == "equilibrium" and d["modes"]["t"] == 0'
expect 0 modes model.yaml -o r3 -n 2 --quiet --set start=equilibrium
expect 0 modes model.yaml -o r4 -n 2 --quiet --json --about equilibrium $ramp
json 'd["modes"]["t"] == 0.05'
python3 - <<'PY' || complain "what modes are about"
import csv
f = [float(next(csv.DictReader(open("r%d/modes.csv" % k)))["frequency"]) for k in range(5)]
assert f[0] == f[1] and abs(f[2] / f[0] - 1) < 1e-9, f
assert abs(f[3] / f[0] - 1) > 1e-3 and abs(f[4] / f[3] - 1) < 1e-8, f
PY

# At rest all measures are one.
for strain in cauchy warp hybrid green; do
  expect 0 modes model.yaml -o m -n 3 --quiet --set strain=$strain
  python3 - <<'PY' || complain "$strain at rest"
import csv
a, b = ([float(r["frequency"]) for r in csv.DictReader(open(n + "/modes.csv"))] for n in ("a", "m"))
assert all(abs(x / y - 1) < 1e-10 for x, y in zip(a, b)), (a, b)
PY
done

# What is refused, before anything is looked for.
expect 2 modes model.yaml -n 0; err "--number: 0 is not a whole number"
expect 2 modes model.yaml -n two; err "--number: two is not a whole number"
expect 2 modes model.yaml --about res; err "--about: res is neither rest, equilibrium nor start"
expect 2 modes model.yaml --abut rest; err "did you mean --about?"
expect 2 run model.yaml -n 3; err "unknown option -n"
expect 3 modes model.yaml -o no -n 24; no_out; err "model.yaml: modes: 24 modes are asked for, of a model with 24 degrees of freedom: at most 23"
expect 0 modes model.yaml -o most -n 23 --quiet
expect 3 modes model.yaml -o no --set groups.base.plane.at=0.1 --set 'boundary=[{group: zmin, fix: [x, y, z]}, {group: base, fix: [x, y, z]}, {group: zmax, fix: [x, y, z]}]'
err "nothing can move"
expect 3 modes model.yaml -o no --about equilibrium --set strain=warp; err "the stiffness matrix of warp"
expect 3 modes model.yaml -o no --about equilibrium --set boundary=[]; err "about equilibrium: statics: the body can move"
expect 4 modes model.yaml -o gone --about equilibrium --set 'statics={max_iterations: 1, min_step: 0.5}'
err "about equilibrium: no equilibrium found"
[ ! -e no ] || complain "a folder for nothing"
expect 3 report a; err "holds the modes of corot modes"
mkdir own && echo mine >own/modes.csv
expect 5 modes model.yaml -o own; err "own"
grep -qx mine own/modes.csv || complain "a foreign file is gone"

# A mesh of four-node tets is told by how much its lowest frequency is too high: on ten-node tets it is
# there, to the two digits of the warning and what the shape changes, a twentieth.
expect 0 modes model.yaml -o coarse -n 2; err "mode 1, at "; err "[space]"
cp stderr told
expect 0 modes model.yaml -o fine -n 2 --set mesh.order=2
! grep -q "\[space\]" stderr || complain "$what: [space]"
python3 - <<'PY' || complain "the frequency of ten-node tets"
import csv, re
near = float(re.search("would be near ([0-9.e+-]+) Hz", open("told").read()).group(1))
coarse, fine = (float(next(csv.DictReader(open(d + "/modes.csv")))["frequency"]) for d in ("coarse", "fine"))
assert coarse > 1.05 * fine and abs(near / fine - 1) < 0.05, (coarse, near, fine)
PY
expect 0 modes model.yaml -o coarse -n 2 --set output.space_error=false
! grep -q "\[space\]" stderr || complain "$what: [space]"
expect 0 modes model.yaml -o free -n 7 --set boundary=[]; err "mode 7, at "
exit $failed

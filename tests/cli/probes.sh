. "$(dirname "$0")/lib.sh"

# Probes of points, nodes, groups and the body, from the file to the page.
sed '/^probes/,$d' model.yaml >probed.yaml
cat >>probed.yaml <<'YAML'
probes:
  corner: {point: [0.1, 0.1, 0.2]}
  in: {point: [0.03, 0.04, 0.11]}
  wall: {group: base, of: reaction}
  load: {of: force}
  top: {group: zmax, take: mean}
  hot: {of: von_mises, take: max}
  E: {of: elastic}
  sig: {point: [0.03, 0.04, 0.11], of: stress}
  tip: {group: zmax, of: velocity, take: max, component: magnitude}
YAML
expect 0 check probed.yaml; no_err
out "probe          corner: node 11 at (0.1, 0.1, 0.2)"
out "probe          in: tet "; out "at (0.03, 0.04, 0.11)"
out "probe          wall: reaction, base (4 nodes)"
out "probe          hot: von_mises, max, the whole body"
out "probe          tip: velocity magnitude, max, zmax (4 nodes)"
expect 0 check probed.yaml --json
json '[p["name"] for p in d["probes"]][:3] == ["corner", "in", "wall"]'
json 'd["probes"][1]["node"] is None and d["probes"][1]["distance"] == 0 and d["probes"][2]["group"] == "base"'
expect 0 check probed.yaml --resolved; cp stdout resolved.yaml
expect 0 check resolved.yaml --resolved
cmp -s stdout resolved.yaml || complain "the resolved scenario does not resolve to itself"

expect 0 run probed.yaml -o r --quiet --set time.end=0.5; no_err
cat >dynamic.py <<'PY'
import csv, json
def table(name):
    rows = list(csv.reader(open(name)))
    return [dict(zip(rows[0], map(float, r))) for r in rows[1:]]
result = json.load(open("r/result.json"))
probes, history, energy = (table(f"r/{n}.csv") for n in ("probes", "history", "energy"))
names = "t corner.ux corner.uy corner.uz in.ux in.uy in.uz wall.fx wall.fy wall.fz wall.mx wall.my " \
    "wall.mz load.fx load.fy load.fz load.mx load.my load.mz top.ux top.uy top.uz hot.value E.value " \
    "sig.xx sig.yy sig.zz sig.xy sig.yz sig.zx tip.value"
assert list(probes[0]) == names.split(), list(probes[0])
assert list(history[0])[:len(probes[0])] == names.split()
# the forces of supports and loads make the momentum: by the trapezoidal rule over the steps
for f, p in (("fx", "px"), ("fz", "pz")):
    pushed = sum((b["t"] - a["t"]) / 2 * (a["wall." + f] + b["wall." + f] + a["load." + f] + b["load." + f])
                 for a, b in zip(history, history[1:]))
    size = max(abs(row[p]) for row in history)
    assert abs(pushed - history[-1][p]) < 0.02 * size, (pushed, history[-1][p])
for row, e in zip(probes, energy):
    assert row["E.value"] == e["elastic"] and abs(row["load.fx"] - 2) < 1e-12
# extremes over the steps, and where they were
hot = result["extremes"]["hot.value"]["max"]
best = max(history, key=lambda row: row["hot.value"])
assert hot["value"] == best["hot.value"] and hot["t"] == best["t"]
assert hot["at"]["tet"] >= 0 and len(hot["at"]["x"]) == 3, hot
assert "at" not in result["extremes"]["wall.fx"]["max"] and "top.u" in result["extremes"]
last = result["probes"]
assert last["wall"]["value"]["fx"] == probes[-1]["wall.fx"] and last["wall"]["unit"]["mx"] == "N m"
assert last["corner"]["node"] == 11 and last["in"]["node"] is None
assert [last["in"]["u"][k] for k in range(3)] == [probes[-1]["in.u" + "xyz"[k]] for k in range(3)]
assert last["tip"]["at"]["value"]["node"] >= 0 and last["tip"]["take"] == "max"
PY
python3 dynamic.py || complain "probes of a run"
expect 0 report r
for id in probe-0 probe-1 probe-2 quantity-0 quantity-1 quantity-6; do
  grep -q "id=\"$id\"" r/report.html || complain "the page lacks $id"
done
grep -q 'wall.fx</th>\|wall.fx \[N\]' r/report.html || complain "the page has no unit of wall.fx"

# What is recorded does not change what is computed, and history.csv can go.
expect 0 run model.yaml -o plain --quiet --set time.end=0.5
cmp -s r/energy.csv plain/energy.csv && cmp -s r/steps.csv plain/steps.csv || complain "probes change the run"
expect 0 run probed.yaml -o h --quiet --set output.history=false --set time.end=0.5
cmp -s r/probes.csv h/probes.csv || complain "the history changes the probes"

# An equilibrium: the wall holds the load, as reactions.csv says.
expect 0 static probed.yaml -o s --quiet; no_err
cat >static.py <<'PY'
import csv
def last(name):
    rows = list(csv.reader(open(name)))
    return dict(zip(rows[0], map(float, rows[-1])))
p, r = last("s/probes.csv"), last("s/reactions.csv")
for c in "xyz":
    assert abs(p["wall.f" + c] + p["load.f" + c]) < 1e-9 and abs(p["wall.m" + c] + p["load.m" + c]) < 1e-9
    assert p["wall.f" + c] == r["base.f" + c]
assert p["tip.value"] == 0
PY
python3 static.py || complain "probes of an equilibrium"
expect 0 report s; grep -q 'id="quantity-0"' s/report.html || complain "no quantities in statics"

# A study measures the displacements among them.
write_study
sed -i 's/model.yaml/probed.yaml/' study.yaml
expect 0 study study.yaml -o study --quiet
expect 0 study table study
grep -q 'probe.in' study/table.csv || complain "no error at the point"
grep -q 'probe.wall' study/table.csv && complain "an error of a reaction as a displacement"

# Before anything runs.
bad() {
  expect 3 run probed.yaml -o bad --set "$1"
  err "$2"
  [ ! -e bad ] || complain "$what: a folder"
}
bad 'probes.x={of: stres}' "did you mean stress?"
bad 'probes.x={group: zmax, take: maxx}' "probes.x.take"
bad 'probes.x={group: bas, of: reaction}' "did you mean base?"
bad 'probes.x={node: 12, of: stress}' "the mesh has 12 nodes"
bad 'probes.x={node: 1, take: max}' "a node has one value"
bad 'probes.x={group: base, about: [0, 0, 0]}' "a displacement has no moment"
expect 3 check probed.yaml --set 'groups.two={nodes: [0, 7]}' --set 'probes.x={group: two, of: stress}'
err "probes.x.group"; err "neither tets nor faces for a stress"

# A point outside stands for the nearest of the surface, and that is said; one on it is not outside.
expect 0 check probed.yaml --set 'probes.x={point: [0.05, 0.05, 0.25]}'
out "it records the nearest point of the surface, (0.05, 0.05, 0.2)"; out "0.05 m outside the body"
expect 0 check probed.yaml --set 'probes.x={point: [0.05, 0.05, 0.20000001]}'; ! grep -q warning stdout || complain "$what: a warning"
expect 0 check probed.yaml --set 'probes.x={point: [0.05, 0.05, 0.25], nearest: true}'
out "x: node "; out "from its point"

# Pulled along its axis between supports that let it draw in, a block has one stress, and its tractions
# are the load above and the reaction below; the load is that of the area at rest, 2 kPa on 0.01 m^2. Of
# any strain measure but warp, whose stress is not symmetric, and of either order.
cat >pulled.yaml <<'YAML'
mesh: {box: {size: [0.1, 0.1, 0.2], cells: [1, 1, 2]}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0}
boundary: [{group: zmin, fix: [z]}, {group: xmin, fix: [x]}, {group: ymin, fix: [y]}]
loads: [{group: zmax, traction: [0, 0, 2.0e3]}]
time: {end: 1}
statics: {tolerance: 1.0e-13}
probes:
  above: {group: zmax, of: traction, take: sum}
  below: {group: zmin, of: traction, take: sum}
  side: {group: xmax, of: traction, take: max}
  mean: {group: zmax, of: traction, component: z}
  wall: {group: zmin, of: reaction}
YAML
cat >tractions.py <<'PY'
import json, sys
p = {n: q["value"] for n, q in json.load(open("pulled/result.json"))["probes"].items()}
load = 20.0
assert abs(p["above"]["tz"] - load) < 1e-9 * load and abs(p["below"]["tz"] + load) < 1e-9 * load, p
assert abs(p["wall"]["fz"] + load) < 1e-9 * load and abs(p["side"]["value"]) < 1e-6 * 2e3, p
# it draws in: the same force on a smaller area
assert (p["mean"]["value"] > 2.02e3) == (sys.argv[1] != "cauchy"), p
PY
expect 0 check pulled.yaml --set 'groups.one={nodes: [3]}' --set 'probes.n={group: one}'
out "one (1 node)"
expect 0 check pulled.yaml; out "probe          side: traction magnitude, max, xmax"
for strain in cauchy polar hybrid green; do
  for order in 1 2; do
    expect 0 static pulled.yaml -o pulled --quiet --force --set strain=$strain --set mesh.order=$order
    python3 tractions.py $strain || complain "tractions of a pulled block, $strain, order $order"
  done
done
expect 3 run pulled.yaml --set 'groups.two={nodes: [0, 5]}' --set probes.above.group=two
err "group 'two' has no faces for a traction (2 nodes, 0 tets)"
exit $failed

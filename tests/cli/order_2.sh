. "$(dirname "$0")/lib.sh"
# Ten-node tets through the commands: a small bar that bends, and what its files say.

at2='--set mesh.order=2 --set compare=[cauchy,hybrid]'
expect 0 mesh box --size 0.1,0.1,0.2 --cells 1,1,2 --order 2 -o bar.msh
expect 0 mesh info bar.msh --json; json 'd["order"] == 2 and d["tets"] > 0 and len(d["parts"]) == 1'
expect 0 check model.yaml --set mesh.order=2; out "ten-node tets"
expect 0 check model.yaml --set mesh.order=2 --json; json 'd["mesh"]["order"] == 2'
expect 0 check model.yaml --json; json 'd["mesh"]["order"] == 1'

expect 0 run model.yaml -o run --quiet $at2
expect 0 static model.yaml -o still --quiet $at2
expect 0 run model.yaml -o linear --quiet
python3 - <<'PY' || complain "the results"
import csv, json
def table(path):
    return [{k: float(v) for k, v in row.items() if v} for row in csv.DictReader(open(path))]
for folder in "run", "still", "linear":
    result = json.load(open(f"{folder}/result.json"))
    order = 1 if folder == "linear" else 2
    assert result["mesh"]["order"] == order, result["mesh"]
    assert result["mesh"]["tets"] == 12 and result["mesh"]["nodes"] == (12, 0, 45)[2 * order - 2]
# Energies add up to what the tolerance leaves, and momenta are there.
rows = table("run/energy.csv")
largest = max(r["kinetic"] + r["elastic"] for r in rows)
assert largest > 0 and all(abs(r["balance"]) < 0.02 * largest for r in rows), rows
assert rows[-1]["px"] > 0
# The reaction is the load, 200 Pa on 0.01 m^2, to the tolerance of the equilibrium.
reaction = table("still/reactions.csv")[-1]
held = [v for k, v in reaction.items() if k.endswith("x")]
assert any(abs(f + 2) < 1e-6 for f in held), reaction
# Ten-node tets are more flexible.
tip = [table(f"{folder}/probes.csv")[-1]["corner.ux"] for folder in ("run", "linear")]
assert tip[0] > tip[1] > 0, tip
row = table("run/compare.csv")[-1]
assert row["hybrid.pressure"] < 1e-6 and row["cauchy.total"] > row["hybrid.total"] > 0, row
PY

# Of each corner of a face the page has the linear field through the tet's points of integration.
expect 0 report run; out run/report.html
expect 0 report still; out still/report.html
expect 0 report linear
python3 - <<'PY' || complain "the pages"
import base64, json, re, struct
def body(folder):
    text = open(f"{folder}/report.html", encoding="utf-8").read()
    return text, json.loads(re.search(r'id="view"><script type="application/json">(.*?)</script>', text, re.S).group(1))
def array(name, type, path="run/fields/fields_000005.vtu"):
    data = open(path, "rb").read()
    offset = int(re.search(rb'Name="%s"[^>]* offset="(\d+)"' % name.encode(), data).group(1))
    at = data.index(b"_", data.index(b"<AppendedData")) + 1 + offset
    size, = struct.unpack_from("=Q", data, at)
    return struct.unpack_from(f"={size // struct.calcsize(type)}{type}", data, at + 8)
text, data = body("linear")
assert "middles" not in data and "constant in it" in text and "ten-node tets (" not in text
text, data = body("run")
assert "12 ten-node tets (" in text and "linear in it" in text
n, frames = data["triangles"], 6
assert len(data["corners"]) == len(data["middles"]) == 3 * n
nodes, rest = array("connectivity", "i"), array("Points", "d")
assert len(nodes) == 120 and set(array("types", "B")) == {24}
points, A, B = array("von_mises_points", "d"), (5 + 3 * 5 ** 0.5) / 20, (5 - 5 ** 0.5) / 20
field = next(f for f in data["fields"] if f["name"] == "von Mises stress")["data"]
raw = base64.b64decode(field["q"])
q = struct.unpack(f"<{len(raw) // 2}H", raw)
assert len(q) == frames * 3 * n, (len(q), n)
place = lambda node: tuple(round(x, 9) for x in rest[3 * node:3 * node + 3])
found = 0
faces = {}
for e in range(12):
    tet, p = nodes[10 * e:10 * e + 4], points[4 * e:4 * e + 4]
    corner = [max(0, (x - B * sum(p)) / (A - B)) for x in p]
    for out in range(4):
        key = frozenset(place(tet[k]) for k in range(4) if k != out)
        faces[key] = {place(tet[k]): corner[k] for k in range(4)}
shown = lambda node: tuple(round(x, 9) for x in data["rest"][3 * node:3 * node + 3])
for i in range(n):
    face = [shown(c) for c in data["corners"][3 * i:3 * i + 3]]
    for k in range(3):
        value = field["low"] + field["step"] * q[(frames - 1) * 3 * n + 3 * i + k]
        assert abs(value - faces[frozenset(face)][face[k]]) <= 0.51 * field["step"], (i, k, value)
PY

# A study of them, and its diagram; what their meshes approximate is said.
write_study
sed -i 's/^base: .*/&\nset: {mesh.order: 2}/' study.yaml
expect 0 study study.yaml -o study --quiet
grep -q 'mesh of 12 ten-node tets' study/table.json || complain "the study says nothing of its tets"
expect 0 plot study; out .svg
expect 0 report study

expect 3 check model.yaml --set mesh.order=3; err "mesh.order"
exit $failed

# Meshes that are not sound as they are: mended and told by all who read them, or refused with all
# that is wrong; and meshes from format to format.
. "$(dirname "$0")/lib.sh"
data=$(cd "$(dirname "$0")/../unit/data" && pwd)

# Two tets: node 9 is in none, the second is left-handed; node 8 would be, too.
cat >bad.msh <<'MSH'
$MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
3 1 "body"
2 2 "base"
$EndPhysicalNames
$Nodes
6
1 0 0 0
2 1 0 0
3 0 1 0
4 0 0 1
5 1 1 1
9 3 3 3
$EndNodes
$Elements
3
1 2 2 2 1 1 2 3
2 4 2 1 1 1 2 3 4
3 4 2 1 1 3 2 4 5
$EndElements
MSH
unused="1 node of the mesh file is in no tet and is left out (9 in the file); the others are numbered without it [mesh-mended]"
turned="1 left-handed tet of the mesh file is turned round (element 3) [mesh-mended]"
expect 0 mesh info bad.msh; out "warning   $turned"; out "warning   $unused"; out "nodes     5"; no_err
expect 0 mesh info bad.msh --json
json '[w["code"] for w in d["warnings"]] == ["mesh-mended"] * 2 and d["nodes"] == 5'
expect 0 mesh refine bad.msh -o fine.msh; err "warning: $turned"; err "fine.msh: 14 nodes, 16 tets"

cat >bad.yaml <<'YAML'
mesh: {file: bad.msh}
material: {lambda: 1.0e5, mu: 1.0e5, density: 1000.0}
boundary: [{group: base, fix: [x, y, z]}]
loads: [{gravity: [0.0, 0.0, -1.0]}]
time: {end: 0.01, output: 0.01}
YAML
expect 0 check bad.yaml; out "warning        $unused"; out "warning        $turned"
expect 0 check bad.yaml --json; json '"mesh-mended" in [w["code"] for w in d["warnings"]]'
expect 0 run bad.yaml -o run; err "warning: $unused"; err "warning: $turned"
python3 -c 'import json; w = json.load(open("run/result.json"))["warnings"]
assert sum(x["code"] == "mesh-mended" for x in w) == 2, w' || complain "result.json lacks the warnings"
expect 0 static bad.yaml -o rest; err "warning: $turned"
expect 0 modes bad.yaml -n 1 -o modes; err "warning: $turned"
expect 0 check --warnings; out "mesh-mended"; out "mesh-cut"; out "mesh-lost"

# repair: to another file, which is sound
cp bad.msh copy.msh
expect 0 mesh repair bad.msh -o good.msh; no_out; err "warning: $unused"; err "good.msh: 5 nodes, 2 tets, 2 groups"
expect 0 mesh info good.msh; out "body: 5 nodes, 0 triangles, 2 tets"
if grep -q warning stdout; then complain "$what: it is not mended"; fi
expect 0 mesh repair good.msh -o again.msh; cmp -s good.msh again.msh || complain "a sound file changes"
expect 2 mesh repair bad.msh -o bad.msh; err "bad.msh is the input: write to another file"
ln bad.msh link.msh
expect 2 mesh repair bad.msh -o link.msh; err "link.msh is the input"
expect 2 mesh repair bad.msh -o ./bad.msh; err "is the input"
cmp -s bad.msh copy.msh || complain "the input has changed"
expect 2 mesh repair bad.msh; err "-o FILE is missing"
expect 2 mesh repair -o x.msh; err "expected one mesh file, found 0"
expect 2 mesh repair bad.msh --merge 0 -o x.msh; err "--merge 0: expected a length > 0"
expect 2 mesh repair bad.msh -o x.stl; err "x.stl: the name does not tell the format: it may end in .msh"
expect 2 mesh repair bad.msh --to stl -o x.msh; err "there is no mesh format 'stl' to write: gmsh, gmsh-2.2, "
expect 0 mesh repair --help; no_err; out "example: corot mesh repair"

# nothing is written where something is left wrong, and all of it is told
sed 's/^5 1 1 1/5 1 nan 1/; s/1 1 2 3 4$/1 1 2 3 7/' bad.msh >worse.msh
expect 3 mesh repair worse.msh -o x.msh; no_out
err "worse.msh:21: element 2: node 7 does not exist"; err "worse.msh:15: node 5: y is nan"
expect 3 check bad.yaml --set mesh.file=worse.msh
err "mesh.file: worse.msh:21: element 2: node 7 does not exist"
err "worse.msh:15: node 5: y is nan"
expect 3 mesh repair none.msh -o x.msh; err "none.msh"
expect 5 mesh repair bad.msh -o none/x.msh; err "none/x.msh"
[ ! -e x.msh ] || complain "x.msh was written"

# merged: two boxes side by side become one part
expect 0 mesh box --size 1,1,1 --cells 2,2,2 -o a.msh
python3 - <<'PY'
text = open("a.msh").read()
part = lambda word: text.split("$%s\n" % word)[1].split("$End")[0].split("\n")[1:-1]
nodes = [n.split()[1:] for n in part("Nodes")]
tets = [e.split()[-4:] for e in part("Elements") if e.split()[1] == "4"]
n = len(nodes)
nodes += [[repr(float(x) + 1), y, z] for x, y, z in nodes]
tets += [[str(int(v) + n) for v in t] for t in tets]
with open("b.msh", "w") as f:
    f.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n" % len(nodes))
    f.write("".join("%d %s\n" % (i + 1, " ".join(x)) for i, x in enumerate(nodes)))
    f.write("$EndNodes\n$Elements\n%d\n" % len(tets))
    f.write("".join("%d 4 2 1 1 %s\n" % (i + 1, " ".join(t)) for i, t in enumerate(tets)))
    f.write("$EndElements\n")
PY
expect 0 mesh info b.msh; out "parts     2"
expect 0 mesh repair b.msh --merge 1e-9 -o c.msh
err "warning: 9 nodes of the mesh file are merged with others within 1e-09 m ("
expect 0 mesh info c.msh; out "parts     1"; out "nodes     45"; out "volume    2 m^3"

# other cells: refused by kind, or cut
cells="the file has 4 pyramids, 28 prisms and 8 hexahedra beside 107 tets: only tets are supported"
cut="4 pyramids, 28 prisms and 8 hexahedra of the mesh file are cut into 140 tets, each face by the diagonal from its corner of the lowest number [mesh-cut]"
expect 3 mesh info "$data/cells.msh"; err "$cells"
expect 0 mesh info --cut "$data/cells.msh"; out "warning   $cut"; out "bottom: 9 nodes, 8 triangles"
expect 3 mesh convert "$data/cells.msh" cells.msh; err "$cells"
expect 0 mesh convert "$data/cells.msh" cells.msh --cut; err "warning: $cut"
expect 0 mesh info cells.msh; out "tets      247"; out "volume    2.5 m^3"
sed 's/bad.msh/cells.msh/; s/base/bottom/' bad.yaml >cells.yaml
cp "$data/cells.msh" .
expect 3 check cells.yaml; err "mesh.file: "; err "$cells"
expect 0 check cells.yaml --set mesh.cut=true; out "warning        $cut"; out "$(printf 'bottom: 9 nodes, 8 triangles')"
expect 0 run cells.yaml --set mesh.cut=true -o cut; err "warning: $cut"
expect 3 check cells.yaml --set mesh.cut=yes; err "mesh.cut"

# from format to format, and back
for to in m.vtk m.inp; do
  expect 0 mesh convert "$data/two.msh22.msh" $to; err "$to: 23 nodes, 48 tets, 7 groups"
  expect 0 mesh convert $to back.msh
  expect 0 mesh info back.msh; out "middle: 5 nodes, 4 triangles, 0 tets"; out "lower: 14 nodes, 0 triangles, 24 tets"
done
expect 0 mesh convert "$data/two.msh22.msh" m.ele
err "warning: the file has numbers in the place of the names of groups of tets: lower is 1, all is 2 [mesh-lost]"
for file in m.node m.ele m.face; do [ -s $file ] || complain "there is no $file"; done
expect 2 mesh convert m.ele m.node; err "m.node is the input"
expect 0 mesh convert m.ele m.mesh
expect 0 mesh convert m.mesh m.msh --to gmsh-2.2
head -2 m.msh | grep -q '^2.2 0 8' || complain "m.msh is not gmsh 2.2"
expect 2 mesh convert m.msh; err "expected two mesh files, FROM and TO, found 1"
expect 2 mesh convert m.msh x.msh -o y.msh; no_out
expect 0 mesh convert --help; no_err; out "example: corot mesh convert"
expect 0 mesh --help; out "corot mesh repair FILE"; out "corot mesh convert FROM TO"
exit $failed

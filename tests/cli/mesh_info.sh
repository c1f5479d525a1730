# From a mesh file of any format to its facts and its picture.
. "$(dirname "$0")/lib.sh"
data=$(cd "$(dirname "$0")/../unit/data" && pwd)

# picture FILE STATEMENT: of the lists `fill` (of each view's triangles and dots, as drawn) and `text`.
picture() {
  python3 - "$1" <<PYTHON || complain "$what: $1: not $2"
import sys
import xml.etree.ElementTree as E
ns = "{http://www.w3.org/2000/svg}"
root = E.parse(sys.argv[1]).getroot()
root = root if root.tag == ns + "svg" else root.find(".//" + ns + "svg")
fill = [[(e.tag[len(ns):], e.get("fill")) for e in g] for g in root.findall(ns + "g")]
text = ["".join(e.itertext()) for e in root.iter(ns + "text")]
assert $2, (fill, text)
PYTHON
}

# each format, of either order; a triangle of a convex body faces one of two opposite eyes
for file in two.msh1.msh two.msh22.msh two.msh22b.msh two.msh40.msh two.msh41b.msh two.partsb.msh two.ele two.mesh \
  two.meshb two.inp two.vtk two.vtkb.vtk; do
  expect 0 mesh info "$data/$file" --svg a.svg; no_err; out "volume    2 m^3"; out "surface   10 m^2"
  out "in $(grep -c '^<path d="[^"]*Z" fill' a.svg) triangles"
done
for file in quarter.feb quarter.msh quarter.inp quarter.mesh quarter.vtk quarter.vtu quarter.vol; do
  expect 0 mesh info "$data/$file" --svg a.svg; no_err; out "volume    0.785349 m^3"; out "in 60 triangles"
  out "shapes    0 0 0 0 1 7 17 24 13 4:"
done

# facts of groups; the curved side of a quarter of a cylinder is pi/2, by its nodes a little less
expect 0 mesh info "$data/quarter.msh" --json
json '[(abs(g["area"] - 1.568) < 1e-3, [round(x, 6) for x in g["normal"]]) for g in d["groups"] if g["name"] == "round"] == [(True, [0.707107, 0.707107, 0])]'
expect 0 mesh info "$data/sides.node"
out "group     face-1: 4 nodes, 2 triangles, 0 tets; area 1 m^2, mean normal (0, 0, -1)"

# units; parts with their volumes; cells through the thickness
cat >parts.mesh <<'MESH'
MeshVersionFormatted 2 Dimension 3
Vertices 8
0 0 0 0  1 0 0 0  0 1 0 0  0 0 1 0
-2 3.4 -1.8 0  0 3.4 -1.8 0  -2 5.4 -1.8 0  -2 3.4 0.2 0
Tetrahedra 2
5 6 7 8 2
1 2 3 4 1
End
MESH
expect 0 mesh info parts.mesh --unit mm; out "part      of node 0: 4 nodes, 1 tets, 1.66667e-10 m^3"
out "part      of node 4: 4 nodes, 1 tets, 1.33333e-09 m^3"
expect 2 mesh info parts.mesh --unit inch; err "--unit inch: expected m, km, cm, mm, um, nm, in or ft"
expect 0 mesh convert parts.mesh feet.vtu --unit ft
expect 0 mesh info feet.vtu --json; json 'd["min"][0] == -2 * 0.3048'
expect 0 mesh box --size 4,3,2 --cells 4,3,2 -o box.msh
expect 0 mesh info box.msh --json; json 'abs(d["through"]["min"] - 2) < 1e-9 and d["through"]["below_2"] == 0'
cat >unit.yaml <<'YAML'
mesh: parts.mesh
material: {lambda: 1.0e5, mu: 1.0e5, density: 1000.0}
time: {end: 0.01}
YAML
expect 0 check unit.yaml --set mesh.unit=cm --json; json 'd["mesh"]["min"][0] == -0.02'

# what is nearer is drawn later: group 1, of which a tet is in front of group 2's in the first view, and
# behind it in the second
expect 0 mesh info parts.mesh --svg parts.svg
picture parts.svg '(lambda v: v == sorted(v) and v[0] != v[-1])([c[5:7] < c[1:3] for e, c in fill[0]])'
picture parts.svg '(lambda v: v == sorted(v) and v[0] != v[-1])([c[5:7] > c[1:3] for e, c in fill[1]])'

# names may hold what a page would take for its own; groups of nodes are dots
sed 's/"tip"/"<b>\&"/' "$data/two.msh22.msh" >names.msh
expect 0 mesh info names.msh --html page.html --svg names.svg
picture names.svg '"<b>&: 1 nodes, 0 triangles, 0 tets" in text'
picture names.svg 'sum(e == "circle" for v in fill for e, c in v) >= 3'
grep -q '&lt;b&gt;&amp;: 1 nodes' page.html || complain "the page lacks the facts"
grep -q '<b>' page.html && complain "the page has a name as it is"
grep -q '<svg ' page.html || complain "the page has no picture"

expect 5 mesh info names.msh --svg none/a.svg; err "none/a.svg"; no_out
expect 3 mesh info "$data/hexahedron.msh" --svg no.svg; no_out
[ ! -e no.svg ] || complain "there is a picture of what is refused"
exit $failed

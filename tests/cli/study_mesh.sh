# Studies of equilibria, and of meshes: one reference for all of their resolutions.
. "$(dirname "$0")/lib.sh"

table() { what="$1"; cp "$1/table.json" stdout; json "$2"; }

# A block that is sheared, by cells of three sizes and both orders, against the finest of both.
cat >mesh.yaml <<'YAML'
study: the orders of the mesh
base: model.yaml
static: true
set: {material: {lambda: 1.0e3, mu: 1.0e4, density: 1000.0}, loads: [{group: zmax, traction: [100, 0, 0]}]}
axes: [{key: mesh.refine, values: [0, 1, 2]}, {key: mesh.order, values: [1, 2]}]
YAML
expect 0 study mesh.yaml -o mesh
expect 0 study status mesh; out "6 cells, 8 runs: 8 done"
expect 0 study table mesh
out "Errors are those of the iteration, mesh"; out "They are total errors, the mesh's included, at the nodes of each cell's mesh"
out "1 of 6 cells have the reference's own mesh, whose error is not in theirs."
out "tolerance 1e-12: newton and newton in half steps agree to "
table mesh 'd["static"] and len(d["references"]) == 1 and d["references"][0]["settings"]["mesh.refine"] == 2 and d["references"][0]["settings"]["mesh.order"] == 2'
# Each halving takes the error down, and ten-node tets are the better; near the held corners the order is below two.
python3 - <<'PY' || complain "the errors of meshes"
import json
d = json.load(open('mesh/table.json'))
error = {(c['settings']['mesh.order'], c['settings']['mesh.refine']): c['error']['displacement_end'] for c in d['cells']}
assert error[1, 0] > 1.5 * error[1, 1] > 3 * error[1, 2], error
assert error[2, 0] > 2 * error[2, 1] > 1e3 * error[2, 2], error
assert all(error[1, r] > 3 * error[2, r] for r in (0, 1, 2)), error
assert [c['tolerance'] for c in d['cells']] == [1, 0.5, 0.25] * 2
fit = {f['series']: f for f in d['fits']}
assert 0.7 < fit['order 1']['exponent'] < 2.2 and fit['order 1']['points'] == 3, fit
assert 1.3 < fit['order 2']['exponent'] < 4 and fit['order 2']['points'] == 2, fit
assert all(b['id'] != c['id'] for c in d['cells'] if c['error']['displacement'] < 1e-9
           for r in d['rankings'] for b in r['best'])
assert all(c['drift']['energy'] is None for c in d['cells'])
PY
grep -q '"statics": {' mesh/names/order=1,refine=0/result.json || complain "runs are no equilibria"

# The mesh of the reference may be said, finer ones, too; what has nodes that it lacks is not held
# against it. The nodes of tets of ten nodes are those of the next octasection.
sed 's/values: \[0, 1, 2\]/values: [0, 1]/; $a reference: {set: {mesh.refine: 1, mesh.order: 1}}' mesh.yaml >coarse.yaml
expect 0 study coarse.yaml -o coarse -q
table coarse 'len(d["references"]) == 1 and all((c["error"] is None) == (c["settings"] == {"mesh.refine": 1, "mesh.order": 2}) for c in d["cells"])'
table coarse '[c["note"] for c in d["cells"] if c["error"] is None][0].startswith("the reference has no free component")'
sed 's/values: \[0, 1, 2\]/values: [0, 1]/; $a reference: {set: {mesh.refine: 2}}' mesh.yaml >finer.yaml
expect 0 study finer.yaml -o finer -q
table finer 'all(1e-3 < c["error"]["displacement"] < 1 for c in d["cells"]) and [f["points"] for f in d["fits"]] == [2, 2] and all(f["exponent"] > 0.7 for f in d["fits"])'
sed 's/values: \[0, 1, 2\]/values: [0, 1]/; $a reference: {mesh: own}' mesh.yaml >own.yaml
expect 0 study own.yaml -o own -q
table own 'len(d["references"]) == 4 and all(c["error"]["displacement"] < 1e-9 for c in d["cells"])'

# Of motions, too: the mesh is finer in the reference alone, and all that is said of space is in the errors.
cat >moving.yaml <<'YAML'
study: a motion on two meshes
base: model.yaml
axes: [{key: mesh.refine, values: [0, 1]}]
reference: {rtol: 1.0e-7}
YAML
expect 0 study moving.yaml -o moving -q
table moving 'len(d["references"]) == 1 and not d["static"] and d["cells"][0]["error"]["displacement"] > 10 * d["cells"][1]["error"]["displacement"] and d["space"] == []'

# The studies that come with the models are studies. Cook's membrane, a level less: its two
# fits say that ten-node tets gain an order and more on four-node ones, that are still too stiff.
models=$(cd "$(dirname "$0")/../../models" && pwd)
for study in "$models"/studies/*.yaml "$models"/benchmarks/*-study.yaml; do
  expect 0 study "$study" -o dry --dry-run
done
sed "s|base: |&$models/benchmarks/|; s/\[1, 2, 3\]/[1, 2]/; s/\[0, 1, 2\]/[0, 1]/; s/refine: 3/refine: 2/" \
  "$models/benchmarks/cook-study.yaml" >cook.yaml
expect 0 study cook.yaml -o cook -q
table cook '[f["series"] for f in d["fits"]] == ["order 1", "order 2"] and 1 < d["fits"][0]["exponent"] < 2 and 2.3 < d["fits"][1]["exponent"] < 4'
# to the limit of two-dimensional elements by another program, 0.021945
table cook 'abs(d["cells"][-1]["quantity"]["tip.uy@end"] / 0.021945 - 1) < 0.01'

# Other engines are told the command.
expect 0 study export mesh.yaml --format commands -o mesh; out " static "
expect 0 study export mesh.yaml --format snakemake -o mesh; out '{PROGRAM:q} static {BASE:q}'

# What makes no sense of an equilibrium.
refuse() { sed "\$a $1" mesh.yaml >refused.yaml; expect 3 study refused.yaml -o refused; err "$2"; }
refuse 'measure: velocity' "refused.yaml:6:10: measure: nothing moves in a static study"
refuse 'reference: {methods: [cvode, ida]}' "a static study has no methods: its references are Newton's"
sed 's/static: true/static: yes/' mesh.yaml >refused.yaml; expect 3 study refused.yaml; err "refused.yaml:3:9: static: "
exit $failed

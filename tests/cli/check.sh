. "$(dirname "$0")/lib.sh"

expect 0 check model.yaml; no_err
out "model.yaml: ok"
out "box: 12 nodes, 12 tets, 0.002 m^3"
out "base: 4 nodes, 2 triangles, 0 tets; fixed x y z"
out "zmax: 4 nodes, 2 triangles, 0 tets; traction"
out "mass           2 kg"
out "24 of 36 components"
out "corner: node 11 at (0.1, 0.1, 0.2)"
out "cvode"

expect 0 check model.yaml --json; no_err
! grep -q ' $' stdout || complain "blanks at the end of a line"
json 'd["mesh"]["tets"] == 12 and d["dofs"] == 24 and abs(d["mass"] - 2) < 1e-12'
json 'd["probes"][0]["node"] == 11 and d["integrator"]["method"] == "cvode"'

expect 0 check model.yaml --set integrator.rtol=1e-6 --set strain=green --resolved; no_err
json 'd["integrator"]["rtol"] == 1e-6 and d["strain"] == "green" and d["linear_solver"]["name"] == "auto"'
out '"rtol": 1.0e-06'
cp stdout resolved.yaml
expect 0 check resolved.yaml --resolved
cmp -s stdout resolved.yaml || complain "the resolved scenario does not resolve to itself"

# What is prescribed and chosen shows up.
expect 0 check model.yaml --set 'boundary.0={group: base, rotate: {axis: [0, 0, 1], rate: 1}}' \
  --set 'loads.0={group: zmax, pressure: 5}' --set 'frames={policy: extrapolate, max_angle: 0.5}' \
  --set 'integrator={method: bdf2, step: 0.01, solution: linear}' --set linear_solver=pcg
out "base: 4 nodes, 2 triangles, 0 tets; rotated"; out "0 tets; pressure"
out "frames: extrapolate, beyond 0.5 rad"
out "bdf2, steps of 0.01 s, one linear solve each, linear solver pcg"

# What drives a run is said in words.
expect 0 check model.yaml --set 'loads.0.amplitude={sine: {frequency: 5, phase: 0.5}}' --set \
  'boundary.0={group: base, move: {direction: [0, 0, 0.1], amplitude: {smooth: [[0, 0], [1, 1]]}}}' \
  --set 'start={velocity: [1, 0, 0], spin: {axis: [0, 0, 1], rate: 2}}'; no_err
out "load           traction on zmax: (200, 0, 0) Pa, amplitude: sine of 5 Hz, phase 0.5 rad"
out "motion         of base: (0, 0, 0.1) m, amplitude: smooth through 2 points, t = 0 to 1 s, values 0 to 1"
out "start          body at (1, 0, 0) m/s, spinning at 2 rad/s about (0, 0, 1) through (0, 0, 0) m"
printf '0,1\n0.02,1\n0.02,0\n' >pulse.csv
expect 0 check model.yaml --set loads.0.amplitude.file=pulse.csv
out "amplitude: 3 points, 1 jump, t = 0 to 0.02 s, values 0 to 1"
expect 0 check model.yaml --json --set loads.0.amplitude.file=pulse.csv
json '"1 jump" in d["amplitudes"][0]["amplitude"] and d["amplitudes"][0]["of"] == "loads[0]"'
expect 0 check model.yaml --resolved --set loads.0.amplitude.file=pulse.csv; cp stdout resolved.yaml
expect 0 check resolved.yaml; echo '1 0' >>pulse.csv
expect 3 check resolved.yaml; err "loads[0].amplitude.sha256: pulse.csv has another sum"
expect 3 check model.yaml --set 'initial={velocity: [0, 0, 1]}'; err "did you mean start?"

# Locking is named, and so is the remedy.
expect 0 check model.yaml --set material.lambda=1e6
out "warning        material: nu = 0.495: "; out "dilatation: nodal is the remedy"
expect 0 check model.yaml --set material.lambda=1e6 --set dilatation=nodal
out "dilatation     averaged at the nodes, but for 1 mu of lambda"

# Refined: groups by position see the new nodes.
expect 0 check model.yaml --set mesh.refine=1; no_err
out "box, refine 1: 45 nodes, 96 tets, 0.002 m^3"; out "base: 9 nodes, 8 triangles"
out "mass           2 kg"
expect 0 check model.yaml --set mesh.refine=2 --json
json 'd["mesh"]["refine"] == 2 and d["mesh"]["tets"] == 768 and d["warnings"] == []'

# Cut where a file says; the second pass is of tets that the first has made.
printf '# at the base\n0 1\n\n20\n' >marks.txt
expect 0 check model.yaml --set mesh.marks=marks.txt; out "box, marks marks.txt: "
expect 0 check model.yaml --set mesh.marks=marks.txt --json
json 'd["mesh"]["marks"] == "marks.txt" and d["mesh"]["tets"] > 12 + 3 * 7 and abs(d["mesh"]["volume"] - 0.002) < 1e-15'
expect 0 check model.yaml --set mesh.marks=marks.txt --set mesh.refine=1 --set mesh.order=2 --json
json 'd["mesh"]["order"] == 2 and d["mesh"]["tets"] > 96 + 3 * 7'
printf '0 1\n2000\n' >marks.txt
expect 3 check model.yaml --set mesh.marks=marks.txt; err "marks.txt:2:1: tet 2000 does not exist"
expect 3 check model.yaml --set mesh.marks=none.txt; err "--set mesh.marks=none.txt: mesh.marks: none.txt"
expect 3 check model.yaml --set mesh.marks=.; err "mesh.marks: .: not a file"

# A slender tet, whose octahedron has a long diagonal: cut along the short one it comes out better.
printf '$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 0.5 3 0\n3 1 0 0\n4 0.5 3 1\n%s\n' \
  '$EndNodes' >tet.msh
printf '$Elements\n1\n1 4 2 1 1 1 3 2 4\n$EndElements\n' >>tet.msh
sed -n 's/^mesh:.*/mesh: {file: tet.msh, refine: 1}/p; /^material:/p; /^time:/p' model.yaml >tet.yaml
expect 0 check tet.yaml --json --set mesh.diagonal=consistent
json 'd["mesh"]["shape"]["min"] < 0.1'
expect 0 check tet.yaml --json; json 'd["mesh"]["shape"]["min"] > 0.4'

# A mesh lies beside its scenario, wherever the tool is called from.
mkdir sub
expect 0 mesh box --size 0.1,0.1,0.2 --cells 1,1,2 --split kuhn -o sub/block.msh
sed 's/^mesh:.*/mesh: {file: block.msh}/' model.yaml >sub/model.yaml
expect 0 check sub/model.yaml; out "sub/block.msh: 12 nodes"

# Fields of very many output times are thinned, where nobody says how often.
expect 0 check model.yaml --set time.output=1e-7; out "fields         of every 15th output time"
out "output.every: 1 writes all 500001"
expect 0 check model.yaml --set time.output=1e-7 --json
json 'd["fields"]["thinned"] and 90e6 < d["fields"]["bytes"] <= 100e6'
expect 0 check model.yaml --set time.output=1e-7 --set output.every=1 --json
json 'd["fields"]["frames"] == 500001 and not d["fields"]["thinned"]'

# What is wrong, and where.
expect 3 check none.yaml; no_out; err "none.yaml: No such file"
expect 3 check .; no_out
expect 3 check model.yaml --set loads.0.group=zmin2; err "--set loads.0.group=zmin2: loads[0].group: no group"
expect 3 check model.yaml --set material.nu=0.6; err "must be > -1, < 0.5"
expect 3 check model.yaml --set material.density=-1; err "material.density: must be > 0, found -1"
expect 3 check model.yaml --set frames.policy=hold --set frames.interval=0
err "frames.interval: must be > 0, found 0"
expect 3 check model.yaml --set integrator.method=newmark; err "newmark needs integrator.step"
sed 's/fix: .*/rotate: {axis: [0, 0, 0], rate: 1}}/' model.yaml >bad.yaml
expect 3 check bad.yaml; err "bad.yaml:7:34: boundary[0].rotate.axis: the axis has no direction: it is [0, 0, 0]"
sed '7a\  - {group: xmin, translate: {velocity: [1, 0, 0]}}' model.yaml >bad.yaml
expect 3 check bad.yaml; no_out
err "bad.yaml:8:13: boundary[1].group: node 0 of group 'xmin' is already held in x: it is in 'base', too; see boundary[0]"
expect 3 check model.yaml --set mesh.refine=20; no_out
err "--set mesh.refine=20: mesh.refine: refining 12 tets 20 times makes 1.38e+19"
printf 'mesh: {file: none.msh}\n' >bad.yaml
sed 1,2d model.yaml >>bad.yaml
expect 3 check bad.yaml; no_out; err "bad.yaml:1:14: mesh.file: none.msh"; err "  mesh: {file: none.msh}"
sed 's/strain/starin/; s/^time/tim/' model.yaml >bad.yaml
expect 3 check bad.yaml; err "bad.yaml:10:1: tim: unknown key; did you mean time?"
expect 2 check model.yaml --set
exit $failed

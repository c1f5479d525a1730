. "$(dirname "$0")/lib.sh"

expect 0 mesh box --size 0.1,0.1,0.6 --cells 2,2,12 --origin -1,0,1e-1 -o box.msh; no_out
err "box.msh: 117 nodes, 288 tets"
expect 0 mesh info box.msh; no_err
out "nodes     117"; out "[-1, -0.9] x [0, 0.1] x [0.1, 0.7]"; out "zmax: 9 nodes, 8 triangles"
expect 0 mesh info box.msh --json
json 'd["tets"] == 288 and len(d["groups"]) == 6 and abs(d["volume"] - 0.006) < 1e-12'

for split in symmetric:192 alternating:48 kuhn:48; do
  expect 0 mesh box --size 1,1,1 --cells 1,1,8 --split "${split%:*}" -o split.msh
  err " ${split#*:} tets"
done
rm split.msh
expect 2 mesh box --size 1,1 --cells 1,1,1 -o x.msh; err "--size 1,1: expected X,Y,Z"
expect 2 mesh box --size 1,1,1 --cells 1,1,0 -o x.msh; err "--cells 1,1,0"
expect 2 mesh box --size 1,1,1 --cells 1,1,1.5 -o x.msh; err "--cells"
expect 2 mesh box --size 1,1,-1 --cells 1,1,1 -o x.msh; no_out
expect 2 mesh box --size 1,1,1 -o x.msh; err "--cells is missing"
expect 2 mesh box --size 1,1,1 --cells 1,1,1 --split even -o x.msh
err "--split even: expected symmetric, alternating or kuhn"
expect 2 mesh box --size 1,1,1 --cells 1,1,1; err "-o FILE is missing"
expect 2 mesh box --size 1,1,1 --cells 1,1,1 -o x.msh y; err "unexpected: y"
expect 5 mesh box --size 1,1,1 --cells 1,1,1 -o none/x.msh; err "none/x.msh"
[ ! -e x.msh ] || complain "x.msh was written"

expect 0 mesh refine box.msh --levels 2 -o fine.msh; no_out
err "box.msh: 117 nodes, 288 tets; shape mean 0."; err "fine.msh: 3969 nodes, 18432 tets; shape"
expect 0 mesh info fine.msh
out "[-1, -0.9] x [0, 0.1] x [0.1, 0.7]"; out "zmax: 81 nodes, 128 triangles"
expect 0 mesh refine box.msh -o once.msh
expect 0 mesh refine once.msh -o twice.msh
cmp -s fine.msh twice.msh || complain "twice one level is not two levels"
expect 0 mesh refine box.msh --diagonal shortest -o fine.msh; err "2304 tets"
expect 0 mesh refine --help; no_err; out "example: corot mesh refine"

rm fine.msh
expect 2 mesh refine box.msh; err "-o FILE is missing"
expect 2 mesh refine -o fine.msh; err "expected one mesh file, found 0"
expect 2 mesh refine box.msh --levels -1 -o fine.msh; err "--levels -1: expected a whole number >= 0"
expect 2 mesh refine box.msh --levels 1.5 -o fine.msh; err "--levels 1.5"
expect 2 mesh refine box.msh --diagonal long -o fine.msh
err "--diagonal long: expected consistent or shortest"
expect 3 mesh refine box.msh --levels 7 -o fine.msh
err "box.msh: refining 288 tets 7 times makes 6.04e+08, "
expect 3 mesh refine none.msh -o fine.msh; err "none.msh"; no_out
[ ! -e fine.msh ] || complain "fine.msh was written"
expect 5 mesh refine box.msh -o none/fine.msh; err "none/fine.msh"

# ten-node tets: made, refined, lowered
expect 0 mesh box --size 1,1,1 --cells 2,2,2 --order 2 -o two.msh; err "two.msh: 125 nodes, 48 tets"
expect 0 mesh info two.msh; out "nodes     125: 27 corners and 98 on edges"; out "order     2"
out "volume    1 m^3"; out "zmax: 25 nodes, 8 triangles"
expect 0 mesh info two.msh --json
json 'd["order"] == 2 and d["corners"] == 27 and d["nodes"] == 125 and abs(d["volume"] - 1) < 1e-12'
expect 0 mesh info box.msh; out "order     1"
expect 0 mesh info box.msh --json; json 'd["order"] == 1 and d["corners"] == d["nodes"]'
expect 0 mesh box --size 1,1,1 --cells 2,2,2 -o one.msh
expect 0 mesh refine one.msh --levels 0 --order 2 -o raised.msh
cmp -s two.msh raised.msh || complain "a box of order 2 is not the raised box"
expect 0 mesh refine two.msh --levels 0 --order 1 -o lowered.msh
cmp -s one.msh lowered.msh || complain "lowering does not undo raising"
expect 0 mesh refine two.msh -o fine.msh; err "fine.msh: 729 nodes, 384 tets"
expect 0 mesh refine one.msh --order 2 -o again.msh
cmp -s fine.msh again.msh || complain "refining and raising do not commute"
rm fine.msh
expect 2 mesh refine two.msh --order 3 -o fine.msh; err "--order 3: expected 1 or 2"
expect 2 mesh box --size 1,1,1 --cells 1,1,1 --order two -o x.msh; err "--order two: expected 1 or 2"
[ ! -e fine.msh ] && [ ! -e x.msh ] || complain "a file was written"

# local refinement: by a file of marks, and at a point
printf '# the first two tets\n0 1\n\n3 # then one more\n' >marks.txt
expect 0 mesh refine one.msh --marks marks.txt -o local.msh; no_out
expect 0 mesh info local.msh --json
json '48 + 3 * 7 <= d["tets"] <= 400 and d["shape"]["min"] > 0.6 and abs(d["volume"] - 1) < 1e-12 and len(d["groups"]) == 6'
printf '0 1\n' >first.txt
printf '3\n' >second.txt
expect 0 mesh refine one.msh --marks first.txt -o step.msh
expect 0 mesh refine step.msh --marks second.txt -o steps.msh
cmp -s local.msh steps.msh || complain "two passes are not two refinements"
expect 0 mesh refine one.msh --levels 1 --marks first.txt --order 2 -o both.msh
expect 0 mesh info both.msh; out "order     2"
expect 0 mesh refine one.msh --near 0,0,0 --times 6 -o near.msh
expect 0 mesh info near.msh --json; json 'd["edge"][0] < 0.02 and d["tets"] < 4000 and d["shape"]["min"] > 0.6'
expect 0 mesh refine two.msh --near 0.5,0.5,0.5 -o near.msh
expect 0 mesh info near.msh; out "order     2"
expect 3 mesh refine one.msh --marks none.txt -o none.msh; err "none.txt"
printf '0\n5 1000\n' >bad.txt
expect 3 mesh refine one.msh --marks bad.txt -o none.msh; err "bad.txt:2:3: tet 1000 does not exist"
expect 2 mesh refine one.msh --near 0,0 -o none.msh; err "--near 0,0: expected X,Y,Z"
expect 2 mesh refine one.msh --near 0,0,0 --times 0 -o none.msh; err "--times 0: expected"
expect 2 mesh refine one.msh --times 2 -o none.msh; err "--times is for --near"
[ ! -e none.msh ] || complain "none.msh was written"

# formats by what is in a file, whatever it is called; refinement keeps the groups
data=$(cd "$(dirname "$0")/../unit/data" && pwd)
for file in two.inp two.mesh two.vtk two.vtkb.vtk two.parts.msh two.msh40.msh; do
  expect 0 mesh info "$data/$file"; out "tets      48"; out "volume    2 m^3"
done
expect 0 mesh info "$data/sides_2.ele"; out "face-3: 9 nodes, 2 triangles"
expect 0 mesh refine "$data/quarter.inp" --levels 1 -o fine.msh
expect 0 mesh info fine.msh; out "order     2"; out "round: 165 nodes, 72 triangles"
rm fine.msh

expect 3 mesh info none.msh; err "none.msh"; no_out
echo garbage >bad.msh
expect 3 mesh info bad.msh; err "bad.msh"; no_out
expect 2 mesh info
exit $failed

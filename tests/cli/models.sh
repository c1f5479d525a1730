# The models that come with a mesh: that they load, are of the size they claim, and run.
. "$(dirname "$0")/lib.sh"
models=$(dirname "$0")/../../models

# size NAME COARSE FINE: tets before and after the refinement of the scenario.
size() {
  expect 0 check "$models/$1/$1.yaml" --json
  json "d['mesh']['tets'] == $3"
  expect 0 check "$models/$1/$1.yaml" --json --set mesh.refine=0 --set hierarchy=null \
    --set linear_solver=auto
  json "d['mesh']['tets'] == $2"
}
size bar 337 337
size bar-hierarchical 70 4480
size liver 327 2616

# The least dihedral angles of the meshes of our own making, in degrees.
for pair in bar-hierarchical/bar.msh:21 liver/liver.msh:31; do
  expect 0 mesh info "$models/${pair%:*}" --json
  json "d['dihedral_degrees'][0] > ${pair#*:}"
done

# A moment of each, with error control and as the paper does it.
for name in bar-hierarchical liver; do
  expect 0 run "$models/$name/$name.yaml" -o $name --quiet --json --set time.end=0.3 \
    --set output.fields=none
  json "d['t_reached'] == 0.3 and d['integrator']['method'] == 'cvode'"
  expect 0 run "$models/$name/$name.yaml" -o $name --quiet --json --set time.end=0.3 \
    --set output.fields=none --set 'frames={policy: hold, interval: 0.15}' \
    --set 'integrator={method: bdf3, step: 0.03, solution: linear}'
  json "d['statistics']['nst'] == 10 and d['frames']['updates_by']['interval'] == 1"
done
exit $failed

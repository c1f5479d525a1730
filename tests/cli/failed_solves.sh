. "$(dirname "$0")/lib.sh"

# A thin plate under its weight: bending is 1e11 times as soft as stretching, which asks much of
# conjugate gradients. Each solver gives the deflection of the static one, or the run says why not.
cat >plate.yaml <<'YAML'
mesh: {box: {size: [1, 1, 1.0e-4], cells: [4, 4, 1], split: kuhn}}
groups: {base: {plane: {axis: x, at: 0}}}
material: {E: 2.0e11, nu: 0.3, density: 7800}
boundary: [{group: base, fix: [x, y, z]}]
loads: [{gravity: [0, 0, -9.81]}]
time: {end: 0.5, output: 0.1}
probes: {corner: {point: [1, 1, 0]}}
output: {fields: none}
YAML
w='d["probes"]["corner"]["u"][2]'

expect 0 static plate.yaml -o static --quiet --json --set linear_solver=klu; no_err
json "abs($w / -8.284921e-6 - 1) < 1e-6 and d['statistics']['nlsfail'] == 0"
for solver in auto pcg '{name: pcg, preconditioner: block-jacobi}'; do
  expect 0 static plate.yaml -o static --quiet --json --set "linear_solver=$solver"
  json "abs($w / -8.284921e-6 - 1) < 1e-6"
done

# The methods that damp what is too fast for them come to rest there.
for method in cvode ida; do
  for solver in klu auto pcg; do
    expect 0 run plate.yaml -o $method --quiet --json --set integrator.method=$method \
      --set linear_solver=$solver
    json "abs($w / -8.284921e-6 - 1) < 1e-3 and d['statistics']['nlsfail'] == 0"
  done
done

# The others let it swing between nothing and twice as much, but for a tolerance of 1e-6 m a step.
for solver in klu auto pcg; do
  expect 0 run plate.yaml -o arkode --quiet --json --set integrator.method=arkode \
    --set linear_solver=$solver
  json "-1.1 * 1.657e-5 < $w < 2e-6"
  expect 0 run plate.yaml -o newmark --quiet --json --set linear_solver=$solver \
    --set 'integrator={method: newmark, step: 0.01}'
  json "-1.001 * 1.657e-5 < $w < 1e-8"
done

# A ten thousandth of that is too thin for double precision.
for integrator in '{method: newmark, step: 0.01}' '{method: ida, min_step: 0.01}' \
  '{method: cvode, min_step: 0.01}'; do
  expect 4 run plate.yaml -o thin --quiet --json --set linear_solver=pcg \
    --set 'mesh.box={size: [1, 1, 1.0e-8], cells: [4, 4, 1], split: kuhn}' --set "integrator=$integrator"
  err "pcg: "; err "; use a direct linear_solver: "; err "klu"
  json 'd["status"] == "failed" and d["exit_code"] == 4 and d["statistics"]["nlsfail"] > 0'
done
exit $failed

# usage: report.sh COROT FOLDER: reports of a run and of a study, looked at by headless Chromium
set -eu
here=$(cd "$(dirname "$0")" && pwd)
python=/usr/bin/python3 # Debian's python3-selenium is for this one
if ! command -v chromedriver >/dev/null || ! $python -c 'import selenium' 2>/dev/null; then
  echo "skipped: wants chromium, chromium-driver and python3-selenium; .ci/setup browser installs them"
  exit 77
fi
rm -rf "$2" && mkdir -p "$2" && cd "$2"
cat >bar.yaml <<'END'
title: A bar <that> bends & swings
mesh: {box: {size: [0.1, 0.1, 0.4], cells: [2, 2, 8]}}
groups:
  base: {plane: {axis: z, at: 0.0}}
  top: {plane: {axis: z, at: 0.4}}
material: {lambda: 1.0e+5, mu: 1.0e+4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary: [{group: base, fix: [x, y, z]}]
loads: [{group: top, traction: [200.0, 50.0, 0.0]}]
time: {end: 1.0, output: 0.02}
frames: {policy: hold, interval: 0.05}
integrator: {rtol: 1.0e-3}
probes: {corner: {point: [0.1, 0.1, 0.4]}, middle: {point: [0.05, 0.05, 0.2]}}
END
cat >which.yaml <<'END'
study: Which integrator?
base: bar.yaml
set: {time.end: 0.2, frames: {policy: exact}}
axes:
  - {key: integrator.method, values: [cvode, ida]}
  - {key: integrator.rtol, values: [1.0e-2, 1.0e-3, 1.0e-4]}
END
cat >moving.yaml <<'END'
title: "</script><b id=bad onclick=alert(1)>A title & \"others\" </b>"
mesh: {box: {size: [0.1, 0.1, 0.4], cells: [2, 2, 8]}}
groups:
  base: {plane: {axis: z, at: 0.0}}
  top: {plane: {axis: z, at: 0.4}}
  side: {plane: {axis: x, at: 0.0}}
material: {lambda: 1.0e+6, mu: 1.0e+4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary:
  - {group: base, fix: [x, z]}
  - {group: top, rotate: {axis: [0, 0, 1], center: [0.05, 0.05, 0], rate: 1.0}}
loads:
  - {group: side, traction: [300.0, 0.0, 0.0], amplitude: [[0.0, 1.0], [0.2, -1.0]]}
  - {gravity: [0.0, 0.0, -9.81]}
  - {group: side, pressure: 10.0}
time: {end: 0.2, output: 0.02}
probes: {middle: {point: [0.05, 0.05, 0.2]}}
END
"$1" run bar.yaml -o run --quiet
"$1" report run
"$1" run moving.yaml -o moving --quiet 2>/dev/null
"$1" report moving
"$1" run bar.yaml -o bare --quiet --set output.fields=none
"$1" report bare
"$1" run bar.yaml -o gone --quiet \
  --set 'integrator={method: newmark, step: 0.004, newton: {iterations: 1}}' 2>/dev/null || true
"$1" report gone
"$1" static bar.yaml -o still --quiet --set 'statics={first_step: 0.25, max_step: 0.25}'
"$1" report still
"$1" static bar.yaml -o one --quiet --set 'loads.0.traction=[2.0, 0.0, 0.0]'
"$1" report one
# A run of 200 000 steps, as far as its tables go.
cp -r run long
$python "$here/long_run.py" long
"$1" report long
"$1" solve bar.yaml --goal corner.ux@end --within 0.05 --static -o goal --quiet \
  --set mesh.box.cells=[1,1,4] >/dev/null
"$1" study which.yaml -o study --quiet
"$1" report study -o study.html
exec $python "$here/report.py" run study

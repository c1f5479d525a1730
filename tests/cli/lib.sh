# What the tests of the command line share. Each runs as: sh NAME.sh COROT SCRATCH_FOLDER
set -u
corot=$1
rm -rf "$2"
mkdir -p "$2"
cd "$2" || exit 1
failed=0
# As most users have it: nothing said of threads, and nothing measured of solvers.
unset OPENBLAS_NUM_THREADS OMP_NUM_THREADS
export XDG_CONFIG_HOME=$PWD/no-configuration

complain() {
  echo "FAILED: $*"
  echo "--- stdout"; head -c 2000 stdout
  echo "--- stderr"; head -c 2000 stderr
  failed=1
}

# expect CODE ARGUMENTS...: corot ends with this exit code; its streams are left in two files.
expect() {
  what="corot $*"
  code=$1
  shift
  "$corot" "$@" >stdout 2>stderr
  got=$?
  [ "$got" = "$code" ] || complain "$what: exit code $got"
}

out() { grep -qF -e "$1" stdout || complain "$what: stdout lacks: $1"; }
err() { grep -qF -e "$1" stderr || complain "$what: stderr lacks: $1"; }
no_out() { [ ! -s stdout ] || complain "$what: something on stdout"; }
no_err() { [ ! -s stderr ] || complain "$what: something on stderr"; }
json() { python3 -c "import json, sys; d = json.load(open('stdout')); assert $1, d" || complain "$what: not $1"; }

# until_true COMMAND...: waits for it, half a minute at most.
until_true() {
  tries=0
  until "$@" || [ $tries = 600 ]; do sleep 0.05; tries=$((tries + 1)); done
}

cat >model.yaml <<'YAML'
title: a block under a shear load
mesh: {box: {size: [0.1, 0.1, 0.2], cells: [1, 1, 2], split: kuhn}}
groups:
  base: {plane: {axis: z, at: 0.0}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary:
  - {group: base, fix: [x, y, z]}
loads:
  - {group: zmax, traction: [200.0, 0.0, 0.0]}
time: {end: 0.05, output: 0.01}
probes:
  corner: {point: [0.1, 0.1, 0.2]}
YAML

# write_study: of that model, with references.
write_study() {
  cat >study.yaml <<'YAML'
study: which one
base: model.yaml
axes: [{key: strain, values: [polar, green]}]
reference: {rtol: 1.0e-7}
YAML
}

# The example of models/fmu, whose importer has declarations of its own: what it prints is what its
# README shows, but for what the processor's vectors do to the last digits.
# usage: example.sh COROT MODELS FOLDER
set -eu
corot=$1
models=$2
mkdir -p "$3"
cd "$3"
"$corot" export-fmu "$models/beam.yaml" -o beam.fmu --quiet
python3 "$models/control.py" beam.fmu >printed
sed -n 's/^      //p' "$models/README.md" | grep '^ *\(t \[s\]\|[0-9]\)' >shown
python3 - <<'PY'
shown, printed = ([line.split() for line in open(name)] for name in ("shown", "printed"))
assert shown[0] == printed[0] and len(shown) == len(printed) == 10, (len(shown), len(printed))
# a step that is chosen otherwise may change what the tolerance leaves: 1e-4, and forces add it up
for a, b in zip(shown[1:], printed[1:]):
    assert all(abs(float(x) - float(y)) <= 2e-3 for x, y in zip(a, b)), (a, b)
assert abs(float(printed[-1][1]) - 0.05) < 0.005, printed[-1]
PY

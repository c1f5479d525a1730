# What table1 and figures share; to be sourced.
# The corot of build/release is used, brought up to date, or the one named by COROT.
set -eu
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
corot=${COROT:-$root/build/release/src/main/corot}
[ "${COROT-}" ] || "$root/models/run" bar >/dev/null # builds corot, and runs the model

# The paper's three experiments: name, model, step [s], time between updates of the frames [s]
experiments="shear-20 bar.yaml 0.02 0.02
shear-200 bar.yaml 0.02 0.2
turn-300 rotating.yaml 0.06 0.3"

# One of them with constant steps, as the paper does it: warp and polar by one linear solve a step,
# hybrid by Newton's method, all on held frames; green by Newton's method, without frames.
run_fixed() { # folder, method, strain, model, step, interval
  local solution=newton frames="{policy: hold, interval: $6, history: keep}"
  case $3 in
    warp | polar) solution=linear ;;
    green) frames="{policy: exact}" ;;
  esac
  "$corot" run "$here/$4" -o "$1" --quiet --set output.fields=none --set strain="$3" \
    --set "integrator={method: $2, step: $5, solution: $solution}" --set "frames=$frames"
}

# A number of a result.json by its name.
number() { # folder, name
  grep -o "\"$2\": *[-+0-9.e]*" "$1/result.json" | head -n 1 | sed 's/.*: *//'
}

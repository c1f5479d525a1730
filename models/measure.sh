# What the scripts beside the models share; to be sourced by one of them.
# The corot of build/release is used, brought up to date, or the one named by COROT.
set -eu
here=$(cd "$(dirname "${BASH_SOURCE[-1]}")" && pwd)
root=$(cd "$here/../.." && pwd)
name=$(basename "$here")
out=$root/out/$name
corot=${COROT:-$root/build/release/src/main/corot}
[ "${COROT-}" ] || "$root/models/run" "$name" >/dev/null # builds corot, and runs the model
mkdir -p "$out"
export OPENBLAS_NUM_THREADS=1 # idle threads count as CPU time

# A number of a result.json by its name.
number() { # folder, name
  grep -o "\"$2\": *[-+0-9.e]*" "$1/result.json" | head -n 1 | sed 's/.*: *//'
}

# Runs a model without fields some times over (REPEAT, default 3) and sets cpu to the least CPU time
# [s]; fails where the run does, with the reason in $1.log.
timed() { # folder, model, options of corot run
  local folder=$1 k all=
  shift
  for ((k = 0; k < ${REPEAT:-3}; k++)); do
    "$corot" run "$1" -o "$folder" --quiet --set output.fields=none "${@:2}" 2>"$folder.log" || return 1
    all+="$(number "$folder" cpu)"$'\n'
  done
  rm -f "$folder.log"
  cpu=$(sort -g <<<"$all" | sed '/./!d' | head -n 1)
}

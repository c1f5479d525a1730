# What the scripts that run corot-bench share; to be sourced by one of them.

# bench NAME COMMAND OPTION...: builds corot-bench if need be; what it says is left in out/bar/NAME.txt,
# too.
bench() {
  local root log name=$1
  root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
  shift
  export OPENBLAS_NUM_THREADS=1 # one core for all of it
  "$root/.ci/setup" build test
  command -v ninja >/dev/null && export CMAKE_GENERATOR=${CMAKE_GENERATOR-Ninja}
  mkdir -p "$root/out/bar"
  cd "$root"
  log=$root/out/bar/$name.log
  if ! { cmake --preset release -DCOROT_TESTS=ON && cmake --build --preset release -j "$(nproc)" -t corot-bench
       } >"$log" 2>&1 </dev/null; then
    tail -n 50 "$log" >&2
    exit 1
  fi
  build/release/tests/bench/corot-bench "$@" | tee "$root/out/bar/$name.txt"
}

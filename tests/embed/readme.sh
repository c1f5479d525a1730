#!/bin/sh
# The program printed in README.md compiles as printed, without a warning, and does what it says: by
# corot::core of the build alone. CC and CFLAGS are those of the build.
# usage: readme.sh TREE BUILD
set -eu
tree=$1 build=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

awk '/^## In your own program/ { here = 1 }
     /^```$/ { if (inside) exit }
     inside { print }
     here && /^```c$/ { inside = 1 }' "$tree/README.md" >"$work/readme.c"
[ "$(wc -l <"$work/readme.c")" -ge 10 ] || fail "no program under 'In your own program'"
core=$(find "$build/src/core" -name 'libcorot_core.*' | head -n 1)
# shellcheck disable=SC2086
${CC:-cc} -std=c11 ${CFLAGS-} -Wall -Wextra -Wno-missing-field-initializers -Werror \
  -I"$tree/include" "$work/readme.c" "$core" -Wl,-rpath,"$(dirname "$core")" -lm -o "$work/readme"
cp "$tree/models/bar/bar.msh" "$work"
cd "$work"
# Leaks are what a short program may leave to its end.
ASAN_OPTIONS=detect_leaks=0 ./readme >out || { cat out; fail "exit code"; }
cat out
# Free, it would fall by 0.196 m in that time; the springs of the bar hold a part of it back.
awk '/^the top sinks by/ { good = $5 > 0.02 && $5 < 0.196 } END { exit !good }' out || fail "its answer"
ASAN_OPTIONS=detect_leaks=0 ./readme | cmp - out || fail "another answer the second time"
rm bar.msh
if ASAN_OPTIONS=detect_leaks=0 ./readme >out; then fail "no failure without the mesh"; fi
grep -q "bar.msh: No such file" out || { cat out; fail "the reason"; }

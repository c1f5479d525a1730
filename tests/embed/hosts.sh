#!/bin/sh
# The host programs of models/embedding as a stranger builds and runs them: with an installed corot
# that was moved, far from the tree. Those whose libraries are not there are named and left out.
# usage: hosts.sh BUILD
set -eu
build=$1
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { cat "$work/log"; echo "FAILED: $*"; exit 1; }

cmake --install "$build" --prefix "$work/first" >"$work/log" || fail "cmake --install"
mv "$work/first" "$work/prefix"
cp -r "$here/../../models/embedding" "$work/hosts"

# A SUNDIALS of single precision is refused where the headers meet, in words.
mkdir -p "$work/single/sundials"
config=$(echo '#include <sundials/sundials_config.h>' | ${CC:-cc} -E - |
  sed -n 's/^# 1 "\(.*sundials_config.h\)".*/\1/p' | head -n 1)
sed 's/define SUNDIALS_DOUBLE_PRECISION/define SUNDIALS_SINGLE_PRECISION/' "$config" \
  >"$work/single/sundials/sundials_config.h"
echo '#include <corot/solve.h>' >"$work/single/one.c"
if ${CC:-cc} -fsyntax-only -I"$work/single" -I"$work/prefix/include" "$work/single/one.c" \
  2>"$work/log"; then fail "single precision was taken"; fi
grep -q "corot needs a SUNDIALS of double precision" "$work/log" || fail "the reason"
cd "$work/hosts"
export CXXFLAGS="${CFLAGS-}" FFLAGS="${CFLAGS-}"
cmake -S . -B build -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_C_COMPILER="${CC:-cc}" \
  >"$work/log" 2>&1 || fail "cmake"
sed -n 's/^-- left out: /left out: /p' "$work/log"
cmake --build build >"$work/log" 2>&1 || fail "a host does not compile"
if grep -n "warning:" "$work/log"; then fail "warnings"; fi
ctest --test-dir build --output-on-failure >"$work/log" 2>&1 || fail "a host's answer"
grep "Passed" "$work/log"
[ "$(grep -c "Passed" "$work/log")" -ge 5 ] || fail "too few hosts"

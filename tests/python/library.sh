#!/bin/sh
# Builds the shared libraries that Python loads, beside a build of archives and as that is built.
# usage: library.sh CMAKE SOURCE BUILD OPTION...
set -eu
cmake=$1 source=$2 build=$3
shift 3
mkdir -p "$build"
quietly() { "$@" >"$build/log" 2>&1 || { tail -n 60 "$build/log"; echo "FAILED: $*"; exit 1; }; }
quietly "$cmake" -S "$source" -B "$build" -DBUILD_SHARED_LIBS=ON -DCOROT_APP=OFF -DCOROT_TESTS=OFF "$@"
quietly "$cmake" --build "$build" -j 2

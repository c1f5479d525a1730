#!/bin/sh
# Uses corot as a stranger does: installs the build BUILD, moves what was installed, and works far
# from the build. CC, CFLAGS and CMAKE_GENERATOR are those of the build.
# usage: run.sh cmake|pkg-config|headers|symbols BUILD
set -eu
kind=$1 build=$2
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cc=${CC:-cc} cxx=${CXX:-c++}

fail() { echo "FAILED: $*"; exit 1; }

cmake --install "$build" --prefix "$work/first" >"$work/log" || { cat "$work/log"; exit 1; }
mv "$work/first" "$work/prefix"
if grep -rIl -e "$build" -e "$work/first" "$work/prefix"; then fail "a path is baked in there"; fi
mkdir "$work/host"
cp "$here"/../../models/embedding/*.[ch] "$here"/CMakeLists.txt "$work/host"
cp -r "$here/../examples" "$work/host"
cd "$work/host"

# The three hosts agree on where the bar goes, and none has more of SUNDIALS than it asked for.
compare_hosts() {
  ./host_integrate >integrate
  ./host_cvode >cvode
  ./host_rk4 >rk4
  head -n 1 integrate cvode rk4
  for host in cvode rk4; do
    paste integrate $host | awk '
      { for (i = 1; i <= 3; i++) { d += ($i - $(i+3))^2; s += $i^2 } n++ }
      END { exit !(n == 1 && s > 1e-6 && d < 1e-10 * s) }' ||
      fail "host_$host is off by more than 1e-5 of the displacement"
  done
  if readelf -d host_rk4 | grep -E 'sundials|klu|cholmod|blas'; then
    fail "host_rk4 links more than corot::core"
  fi
  if readelf -d host_cvode | grep cvodes; then fail "host_cvode has both CVODE and CVODES"; fi
}

# The examples of the public headers, which do as they say.
check_examples() {
  for example in "$here"/../examples/*.c; do
    name=$(basename "$example" .c)
    sh "$here/../examples/check.sh" "$name" "./example_$name"
  done
}

case $kind in
  cmake)
    cmake -S . -B build -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_C_COMPILER="$cc" \
      -DCMAKE_BUILD_TYPE=Release >log 2>&1 && cmake --build build >>log 2>&1 || { cat log; exit 1; }
    cd build
    compare_hosts
    check_examples
    "$work/prefix/bin/corot" --version
    ;;
  pkg-config)
    PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name corot.pc)")
    export PKG_CONFIG_PATH
    # shellcheck disable=SC2086
    compile() {
      program=$1 package=$2 source=${3-$1}
      $cc -std=c11 ${CFLAGS-} $(pkg-config --cflags "$package") "$source.c" -o "$program" \
        $(pkg-config --libs "$package") $libs
    }
    libs= compile host_rk4 corot
    libs="-lsundials_cvode -lsundials_nvecserial" compile host_cvode corot-solve
    libs= compile host_integrate corot-integrate
    compare_hosts
    for name in base mesh model hierarchy ode; do
      libs= compile "example_$name" corot "examples/$name"
    done
    libs= compile example_solve corot-solve examples/solve
    for name in checkpoint inputs integrate statics modes space; do
      libs= compile "example_$name" corot-integrate "examples/$name"
    done
    check_examples
    ;;
  headers)
    PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name corot.pc)")
    export PKG_CONFIG_PATH
    flags=$(pkg-config --cflags corot-integrate) # those of SUNDIALS may want headers of MPI
    for header in "$work"/prefix/include/corot/*.h; do
      name=corot/$(basename "$header")
      echo "#include <$name>" >>all.cc
      echo "#include <$name>" >one.c
      # shellcheck disable=SC2086
      $cc -std=c11 -pedantic -Wall -Wextra -Werror -fsyntax-only $flags one.c ||
        fail "$name does not stand on its own"
    done
    [ "$(wc -l <all.cc)" -ge 5 ] || fail "headers are missing"
    command -v "$cxx" >/dev/null || { echo "no C++ compiler"; exit 77; }
    # C++14 is what the headers of SUNDIALS ask for.
    # shellcheck disable=SC2086
    $cxx -std=c++14 -Wall -Wextra -Werror -fsyntax-only $flags all.cc
    ;;
  symbols)
    find "$work/prefix" -name 'libcorot_*.a' >archives
    [ "$(wc -l <archives)" = 3 ] || fail "archives are missing"
    # Names beginning with __ are the compiler's.
    while read -r archive; do nm -g --defined-only "$archive"; done <archives |
      awk 'NF == 3 && $3 !~ /^(corot_|__)/ { print $3 }' | sort -u >foreign
    [ ! -s foreign ] || fail "global names that may clash with a host's:" $(cat foreign)
    ;;
  *) fail "no such kind: $kind" ;;
esac

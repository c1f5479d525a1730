#!/bin/sh
# Builds corot from SOURCE in one of the ways in which packagers and hosts do, as they give flags of
# their own, and uses it: by CMake, by pkg-config, or as a part of another project. CC is the compiler.
# usage: variant.sh static|shared|core|subdirectory SOURCE
set -eu
variant=$1 source=$2
here=$(cd "$(dirname "$0")" && pwd)
examples=$here/../../models/embedding
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cc=${CC:-cc}
export CC="$cc"
# Of the compiler's cache, if one is used, only what is the same in any folder.
export CCACHE_BASEDIR="$work" CCACHE_NOHASHDIR=1

fail() { echo "FAILED: $*"; exit 1; }
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; fail "$*"; }; }

mkdir "$work/host"
cp "$here"/variant/* "$examples"/host_rk4.c "$examples"/host_integrate.c "$examples"/bar.h \
  "$here"/../examples/solve.c "$work/host"

# build OPTION...: corot, with a packager's flags, installed into $work/prefix and moved from there.
build() {
  CFLAGS=-O0 quietly cmake -S "$source" -B "$work/build" -DCMAKE_BUILD_TYPE=None \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_INSTALL_LIBDIR=lib/somewhere "$@"
  quietly cmake --build "$work/build" -j 2
  DESTDIR="$work/stage" quietly cmake --install "$work/build" --prefix /first
  mv "$work/stage/first" "$work/prefix"
  if grep -e ' -O[123]' "$work/build/compile_commands.json"; then fail "the packager's -O0"; fi
  if grep -rIl -e "$work" -e /first "$work/prefix"; then fail "a path is baked in there"; fi
  PKG_CONFIG_PATH=$work/prefix/lib/somewhere/pkgconfig
  export PKG_CONFIG_PATH
}

# host OPTION...: the host's project.
host() {
  CFLAGS=-O0 quietly cmake -S "$work/host" -B "$work/host/build" -DCMAKE_BUILD_TYPE=None \
    -Dcorot_DIR="$work/prefix/lib/somewhere/cmake/corot" "$@"
  quietly cmake --build "$work/host/build" -j 2
}

# compile PROGRAM PACKAGE [PKG-CONFIG'S OPTION [CC'S OPTION...]]: from its source, by pkg-config.
compile() {
  program=$1 package=$2 static=${3-}
  shift $(($# < 3 ? $# : 3))
  # shellcheck disable=SC2046,SC2086
  quietly $cc -std=c11 "$@" $(pkg-config --cflags $package) "$work/host/$program.c" \
    -o "$work/$program" $(pkg-config $static --libs $package)
}

# needs FILE: the libraries that it asks for.
needs() { readelf -d "$1" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p'; }
# needs_not FILE PATTERN
needs_not() {
  if needs "$1" | grep -E "$2"; then fail "$1 asks for more than it uses"; fi
}

# goes PROGRAM: the bar's corner is where it should be, or it says nothing and succeeds.
goes() {
  "$1" >"$work/out" || fail "$1: exit code $?"
  case $1 in
    *host_*) awk 'NF == 3 && ($1 / 0.00463 - 1)^2 < 1e-6 { n++ } END { exit n != 1 }' "$work/out" || {
      cat "$work/out"
      fail "$1: the bar is not there"
    } ;;
  esac
}

# The functions that the public headers declare, in order.
list_declared() {
  cat "$work"/prefix/include/corot/*.h | tr '\n' ' ' |
    grep -oE 'COROT_API [^;(]*(\(\*)?corot_[a-z0-9_]+\(' | grep -oE 'corot_[a-z0-9_]+\($' |
    tr -d '(' | sort -u
}

# Exported are the functions of the headers, under the version of the ABI; to libraries of the same
# release, what these use; and nothing else.
check_exports() {
  list_declared >"$work/declared"
  [ "$(wc -l <"$work/declared")" -ge 20 ] || fail "hardly any declarations"
  for library in "$work"/prefix/lib/somewhere/libcorot_*.so; do
    nm -D --defined-only "$library" | awk '$2 != "A" { print $3 }' >>"$work/exported"
    nm -D --undefined-only "$library" | awk '{ print $NF }' >>"$work/used"
  done
  sed -n 's/@@COROT_[0-9.]*$//p' "$work/exported" | sort >"$work/public"
  diff "$work/declared" "$work/public" || fail "declared (<) is not what is exported (>)"
  sed -n 's/@@\(COROT_PRIVATE_.*\)/@\1/p' "$work/exported" | sort >"$work/private"
  grep COROT_PRIVATE_ "$work/used" | sort -u >"$work/shared" || true
  [ "$variant" = core ] || diff "$work/private" "$work/shared" || fail "exported to sisters (<) is not what they use (>)"
  if grep -v @@COROT_ "$work/exported"; then fail "that has no version"; fi
}

# The package for Python finds its library by the way from itself, wherever both were moved to.
check_python() {
  for python in /usr/bin/python3 python3 none; do
    "$python" -c 'import cffi, numpy' 2>/dev/null && break
  done
  if [ "$python" = none ]; then
    echo "No python3 with cffi and numpy: its package was not looked at."
    return
  fi
  (cd / && unset COROT_LIBRARY && PYTHONPATH=$work/prefix/lib/python3/dist-packages \
    PYTHONDONTWRITEBYTECODE=1 "$python" -m corot) >"$work/out" || fail "python3 -m corot"
  grep -q "^library: *$work/prefix/lib/somewhere/libcorot_integrate" "$work/out" || {
    cat "$work/out"
    fail "Python does not find the library"
  }
}

check_soname() {
  for library in "$work"/prefix/lib/somewhere/libcorot_*.so; do
    readelf -d "$library" | grep -q 'SONAME.*libcorot_[a-z]*\.so\.[0-9.]*\]' || fail "$library: soname"
  done
}

case $variant in
  static) # a library without parts under the GPL
    build -DCOROT_APP=OFF -DCOROT_CHOLMOD=OFF
    [ ! -e "$work/prefix/bin" ] || fail "a program was installed"
    host -DCOMPONENTS="solve;integrate"
    goes "$work/host/build/host_rk4"
    goes "$work/host/build/host_integrate"
    goes "$work/host/build/example_solve"
    needs_not "$work/host/build/host_integrate" 'cholmod|metis'
    for package in corot-solve corot-integrate; do
      case $(pkg-config --variable=license $package) in *GPL-2.0*) fail "the licence of $package" ;;
        *LGPL*) ;; *) fail "no licence in $package" ;; esac
    done
    nm -D --defined-only "$work"/host/build/libplugin.so | awk '{ print $3 }' >"$work/exported"
    [ "$(cat "$work/exported")" = plugin_entry ] || fail "exported:" $(cat "$work/exported")
    for static in "" --static; do
      compile host_rk4 corot "$static"
      goes "$work/host_rk4"
      compile solve corot-solve "$static"
      goes "$work/solve"
      compile host_integrate corot-integrate "$static"
      goes "$work/host_integrate"
    done
    # Nothing but archives, where all of them are there: MPI, with which SUNDIALS may be built, has none.
    case $(pkg-config --static --libs corot-solve) in
      *.so*) echo "Not linked from archives alone: $(pkg-config --static --libs corot-solve)" ;;
      *)
        if echo 'int main(void) { return 0; }' >"$work/host/none.c" && cd "$work" &&
          $cc "$work/host/none.c" -static -lklu -lamd -lbtf -lcolamd -lsuitesparseconfig -lm \
            -lsundials_sunlinsolpcg -o none 2>none.log; then
          compile solve corot-solve --static -static
          goes "$work/solve"
        else
          echo "Not linked from archives alone:" && cat none.log
        fi
        ;;
    esac
    ;;
  shared)
    build -DCOROT_APP=OFF -DBUILD_SHARED_LIBS=ON
    check_exports
    check_soname
    check_python
    host
    goes "$work/host/build/host_rk4"
    goes "$work/host/build/host_integrate"
    goes "$work/host/build/example_solve"
    needs_not "$work/host/build/host_rk4" 'sundials|klu|cholmod|corot_solve'
    needs_not "$work/host/build/example_solve" 'klu|cholmod|metis|nvecserial|pcg'
    needs_not "$work/host/build/host_integrate" 'cvodes|klu|arpack'
    export LD_LIBRARY_PATH="$work/prefix/lib/somewhere"
    case $(pkg-config --libs corot-integrate) in
      *sundials* | *klu* | *-lm*) fail "what shared libraries use leaks into pkg-config --libs" ;;
    esac
    case $(pkg-config --libs --static corot-integrate) in
      *sundials*klu*) ;; *) fail "pkg-config --static says too little" ;;
    esac
    compile host_rk4 corot
    goes "$work/host_rk4"
    compile host_integrate corot-integrate
    goes "$work/host_integrate"
    ;;
  core) # nothing but a compiler and libm
    build -DCOROT_SOLVE=OFF -DCMAKE_DISABLE_FIND_PACKAGE_SUNDIALS=ON \
      -DCMAKE_DISABLE_FIND_PACKAGE_SuiteSparse=ON -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON \
      -DBUILD_SHARED_LIBS=ON
    check_exports
    needs "$work/prefix/lib/somewhere/libcorot_core.so" | grep -vE '^(libm|libc|ld-linux.*)\.' &&
      fail "corot::core asks for more than libm"
    [ ! -e "$work/prefix/include/corot/solve.h" ] || fail "a header of what is not there"
    host -DCOMPONENTS=core -DCMAKE_DISABLE_FIND_PACKAGE_SUNDIALS=ON
    goes "$work/host/build/host_rk4"
    # A component that was not built is refused by name.
    if cmake -S "$work/host" -B "$work/host/none" -DCOMPONENTS=solve \
      -Dcorot_DIR="$work/prefix/lib/somewhere/cmake/corot" >"$work/log" 2>&1; then fail "corot::solve is not there"; fi
    grep -q "built without its component solve" "$work/log" || { cat "$work/log"; fail "why"; }
    ;;
  subdirectory)
    host -DCOROT_SOURCE="$source"
    goes "$work/host/build/host_rk4"
    goes "$work/host/build/host_integrate"
    goes "$work/host/build/example_solve"
    quietly cmake --install "$work/host/build" --prefix "$work/prefix"
    [ "$(find "$work/prefix" -type f | sed 's/.*\///')" = host_rk4 ] ||
      fail "installed:" $(find "$work/prefix" -type f)
    ;;
  *) fail "no such variant: $variant" ;;
esac

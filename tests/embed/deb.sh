#!/bin/sh
# Makes the packages of Debian from SOURCE, installs them in a root of its own, uses all three, and
# removes them, which leaves nothing. The root is this system's with a layer of memory above it, in a
# namespace: nothing is written to the system. Skipped where that takes rights that there are not.
# usage: deb.sh SOURCE
set -eu
if [ "$1" = --inside ]; then
  # --- In the root -------------------------------------------------------------------------------
  fail() { echo "FAILED: $*"; exit 1; }
  cd "$2"
  find /usr /etc -name '*corot*' >before
  dpkg -i libcorot1_*.deb libcorot-dev_*.deb corot_*.deb >log 2>&1 || { cat log; fail "dpkg -i"; }
  PATH=/usr/sbin:/usr/bin:/sbin:/bin
  corot --version | grep -q '^corot 1\.' || fail "corot --version"
  for kind in bar bracket; do corot new $kind -o $kind.yaml 2>/dev/null || fail "corot new"; done
  corot run bar.yaml -q || fail "corot run"
  [ -s out/bar/probes.csv ] || fail "no results"
  corot export-fmu bar.yaml -q -o bar.fmu || fail "corot export-fmu"
  if command -v man >/dev/null; then
    man -w corot-run >log 2>&1 || { cat log; fail "man"; }
  fi
  bash -c '. /usr/share/bash-completion/completions/corot
    COMP_WORDS=(corot ru) COMP_CWORD=1; _corot; [ "${COMPREPLY[*]}" = run ]' || fail "completion for bash"
  # A host, compiled by pkg-config, asks for the shared libraries that were installed.
  # shellcheck disable=SC2046
  cc -std=c11 host.c -o host $(pkg-config --cflags --libs corot-integrate) -lm >log 2>&1 || { cat log; fail "cc"; }
  ldd host | grep -q ' /.*libcorot_integrate\.so\.1 ' || { ldd host; fail "another library"; }
  ./host >log || fail "the host"
  dpkg -P corot libcorot-dev libcorot1 >log 2>&1 || { cat log; fail "dpkg -P"; }
  find /usr /etc -name '*corot*' | diff before - || fail "that was left behind (>)"
  exit 0
fi

# --- Outside -------------------------------------------------------------------------------------
source=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
skip() { echo "skipped: $1"; exit 77; }
fail() { echo "FAILED: $*"; exit 1; }
[ "$(id -u)" = 0 ] || skip "a root takes root"
for tool in dpkg-deb dpkg-shlibdeps file cpack pkg-config; do
  command -v $tool >/dev/null || skip "no $tool"
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/root"
# layered COMMAND...: in the root.
layered() {
  unshare --mount sh -c '
    root=$1
    shift
    mount -t tmpfs tmpfs "$root" && mkdir "$root/above" "$root/work" "$root/all" &&
      mount -t overlay overlay -o "lowerdir=/,upperdir=$root/above,workdir=$root/work" "$root/all" &&
      mount --rbind /dev "$root/all/dev" && mount -t proc proc "$root/all/proc" || exit 77
    exec chroot "$root/all" "$@"' sh "$work/root" "$@"
}
layered true 2>"$work/log" || skip "no layers of file systems: $(tail -n 1 "$work/log")"
quietly() { "$@" >"$work/log" 2>&1 || { cat "$work/log"; fail "$*"; }; }

# Without optimisation, as the other tests of packagers' builds: it is quick, and shares their cache.
export CCACHE_BASEDIR="$work" CCACHE_NOHASHDIR=1
CFLAGS=-O0 quietly cmake -S "$source" -B "$work/build" -DCMAKE_BUILD_TYPE=None -DBUILD_SHARED_LIBS=ON \
  -DCMAKE_INSTALL_PREFIX=/usr -DCMAKE_SKIP_INSTALL_RPATH=ON -DCOROT_ZSH_DIR=share/zsh/vendor-completions \
  -DCOROT_TESTS=OFF -DCOROT_PYTHON=OFF
quietly cmake --build "$work/build" -j 2
cd "$work/build"
quietly cpack -G DEB -B "$work/packages"

# What they say of themselves.
cd "$work/packages"
says() {
  dpkg-deb -f "$1"_1*.deb "$2" | grep -qE "$3" || { dpkg-deb -f "$1"_1*.deb; fail "$1: $2 is not $3"; }
}
says corot Section '^science$'
says libcorot1 Section '^libs$'
says libcorot-dev Section '^libdevel$'
says corot Depends 'libsundials-cvode.*libsundials|libsundials.*libsundials-cvode'
says libcorot1 Depends 'libklu'
says libcorot-dev Depends '^libcorot1 \(= 1\.'
for package in corot libcorot1 libcorot-dev; do
  says $package Maintainer '<.*@.*>'
  dpkg-deb -c ${package}_1*.deb | grep "/usr/share/doc/$package/copyright" >"$work/log" || fail "$package: no licence"
done
dpkg-deb -c corot_1*.deb | grep "corot-run\.1" >"$work/log" || fail "no man pages"
if dpkg-deb -c corot_1*.deb | grep -E '\.(a|h|so\.[0-9.]*)$'; then fail "that is no part of the program"; fi

cp "$here/../../models/embedding/host_integrate.c" host.c
cp "$here/../../models/embedding/bar.h" .
cp "$here/deb.sh" inside.sh
layered sh "$work/packages/inside.sh" --inside "$work/packages"

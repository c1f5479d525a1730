#!/bin/sh
# Runs the tests of a file, python/test_NAME.py, with the first python3 that has cffi and numpy; skipped
# (77) where none has. Under AddressSanitizer, Python has to load it first, and what Python itself
# leaves behind is not looked at.
# usage: run.sh NAME SOURCE LIBRARY SANITIZED PYTHON
set -eu
name=$1 source=$2 library=$3 sanitized=$4 python=$5
here=$(cd "$(dirname "$0")" && pwd)

found=
for each in "$python" /usr/bin/python3 python3; do
  "$each" -c 'import cffi, numpy' 2>/dev/null && found=$each && break
done
if [ -z "$found" ]; then
  echo "No python3 here has cffi and numpy (apt-get install python3-cffi python3-numpy python3-scipy)."
  exit 77
fi
if ! "$found" -c 'import scipy' 2>/dev/null; then
  echo "$found has no scipy (apt-get install python3-scipy): the tests want its matrices."
  exit 77
fi

if [ "$sanitized" = ON ]; then
  asan=$(${CC:-cc} -print-file-name=libasan.so)
  stdcxx=$(${CC:-cc} -print-file-name=libstdc++.so) # SciPy's, whose exceptions are caught else too early
  case $asan in
    /*) ;;
    *) echo "The compiler's AddressSanitizer cannot be loaded before Python (no libasan.so)." && exit 77 ;;
  esac
  case $stdcxx in /*) asan="$asan $stdcxx" ;; esac
  export LD_PRELOAD="$asan"
  export ASAN_OPTIONS="${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0"
fi
export COROT_LIBRARY="$library" PYTHONPATH="$source/src/python" PYTHONDONTWRITEBYTECODE=1
export OPENBLAS_NUM_THREADS=1 PYTHONFAULTHANDLER=1
cd "$here"
exec "$found" -m unittest -q "test_$name"

# However little address space there is: a run ends, either well or with a message and no "ok" on the
# disk, and it ends when it is asked to.
. "$(dirname "$0")/lib.sh"
unset OPENBLAS_NUM_THREADS OMP_NUM_THREADS OMP_THREAD_LIMIT
# Sanitizers need more address space than a limit could be of.
(ulimit -v 2000000 && "$corot" --version) >stdout 2>stderr || exit 77

# Large enough for dense blocks, and so for the BLAS.
large='mesh.box={size: [0.1, 0.1, 0.2], cells: [11, 11, 25]}'
for megabytes in 60 100 130 150 180 200 230 260 300 600; do
  for command in run static; do
    what="$command in $megabytes MB"
    rm -rf out
    (ulimit -v $((1024 * megabytes)) && exec timeout -s KILL 120 "$corot" $command model.yaml -o out --quiet \
      --set "$large" --set time.end=0.001) >stdout 2>stderr
    got=$?
    case $got in
      0) grep -q '"status": "ok"' out/result.json || complain "$what: no result" ;;
      1 | 2 | 3 | 134 | 137 | 139) complain "$what: exit code $got" ;;
      *)
        [ -s stderr ] || complain "$what: exit code $got without a message"
        grep -qs '"status": "ok"' out/result.json && complain "$what: exit code $got beside ok"
        ;;
    esac
    [ $megabytes != 600 ] || [ $got = 0 ] || complain "$what: exit code $got"
  done
done

# The room for the BLAS is looked for before it is needed; some take it as they are loaded, before
# there is a result to write to.
(ulimit -v 150000 && exec timeout -s KILL 120 "$corot" run model.yaml -o out --quiet --set "$large") >stdout 2>stderr
got=$?
if "$corot" check model.yaml --set "$large" 2>/dev/null | grep -q supernodal; then
  [ $got = 5 ] || complain "no room for the BLAS: no exit code 5"
  if ! grep -q 'its libraries find no room' stderr; then
    grep -q 'no memory for' stderr || complain "no room for the BLAS: no message"
    grep -q '"kind": "memory"' out/result.json || complain "no room for the BLAS: not for want of memory"
  fi
fi
exit $failed

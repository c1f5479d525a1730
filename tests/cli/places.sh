# Bad places to write to: each ends in a sentence and with exit code 5, and nothing of the user's is
# touched. Parts that need to mount something, or a library to preload, are left out where that
# cannot be.
# usage: places.sh COROT SCRATCH_FOLDER [DISTURB], the library of disturb.c
if [ -z "${OWN_MOUNTS-}" ] && unshare -m true 2>/dev/null; then
  OWN_MOUNTS=1 exec unshare -m sh "$0" "$@"
fi
disturb=${3-}
. "$(dirname "$0")/lib.sh"
ulimit -c 0

write_study
expect 0 mesh box --size 1,1,1 --cells 9,9,9 -o box.msh
expect 0 run model.yaml -o run --quiet
expect 0 study study.yaml -o study --quiet
sums() { (cd "$1" && find . -type f | sort | xargs cksum); }
sums run >run.sums
sums study >study.sums

# fail_in PLACE WORDS...: every command that writes there fails with one of these words, and leaves
# what it was made from alone.
fail_in() {
  place=$1
  shift
  for arguments in 'run model.yaml' 'static model.yaml' 'study study.yaml' 'budget model.yaml --levels 2 --skip space' \
    'find-limit model.yaml --key time.end --from 0.01 --to 0.02 --scan 2' 'report run' 'report study' 'plot study' \
    'mesh box --size 1,1,1 --cells 9,9,9' 'mesh refine box.msh'; do
    # shellcheck disable=SC2086
    expect 5 $arguments -o "$place/${arguments%% *}"
    said=
    for words in "$@"; do grep -qF -e "$words" stderr && said=yes; done
    [ -n "$said" ] || complain "$what: not a word of why"
  done
  sums run | cmp -s - run.sums && sums study | cmp -s - study.sums || complain "$place: the folders it was made from have changed"
}

# --- What is no folder ---

echo text >file
ln -s file link
ln -s nowhere/at/all dangling
for place in file link dangling; do
  fail_in $place 'is not a folder' 'Not a directory' 'No such file'
  [ "$(cat file)" = text ] && [ ! -e nowhere ] && [ -L link ] && [ -L dangling ] || complain "$place has changed"
done

# A link to a folder is as good as the folder.
mkdir real
ln -s real alias
expect 0 run model.yaml -o alias --quiet
[ -f real/result.json ] && [ -L alias ] || complain "a link to a folder"

# --- Single files: what is no file stays what it is ---

mkdir folder
mkfifo pipe
for place in link dangling folder pipe; do
  for arguments in 'mesh box --size 1,1,1 --cells 1,1,1' 'mesh refine box.msh' 'report run'; do
    # shellcheck disable=SC2086
    expect 5 $arguments -o $place; err "$place: is not a regular file"
  done
done
[ "$(cat file)" = text ] && [ ! -e nowhere ] && [ -L link ] && [ -L dangling ] && [ -d folder ] && [ -p pipe ] || complain "a file's place has changed"
for name in table.json table.csv index.sqlite report.html; do
  rm -rf copy
  cp -r study copy
  rm copy/$name
  ln -s ../file copy/$name
  expect 5 study study.yaml -o copy; err "copy/$name"
  [ "$(cat file)" = text ] && [ -L copy/$name ] || complain "$name: a link, or where it leads, has changed"
done

# Pipes that nobody reads, and sockets, in the place of each file: nothing waits for them.
expect 0 study csv study
socket() { python3 -c 'import socket, sys; socket.socket(socket.AF_UNIX).bind(sys.argv[1])' "$1"; }
# among FOLDER CODE NAME COMMAND...: with that file of a copy of the folder replaced by each.
among() {
  folder=$1 code=$2 name=$3
  shift 3
  for make in mkfifo socket; do
    rm -rf there
    cp -r "$folder" there
    rm -f there/$name
    $make there/$name
    what="corot $*, $name made by $make"
    timeout -s KILL 60 "$corot" "$@" >stdout 2>stderr
    got=$?
    [ $got = "$code" ] || complain "$what: exit code $got"
    err "${name##*/}"
    [ ! -f there/$name ] && [ -e there/$name ] || complain "$what: it is replaced"
  done
}
for name in steps.csv history.csv energy.csv probes.csv fields.pvd fields/fields_000000.vtu result.json; do
  among run 5 $name run model.yaml -o there --quiet
done
among run 5 fields/fields_000000.vtu report there
among study 5 table.csv study csv there
run=runs/$(ls study/runs | head -n 1)
for name in energy.csv messages.txt; do
  rm -rf undone
  cp -r study undone
  rm undone/$run/result.json
  among undone 5 $run/$name study study.yaml -o there --quiet --timeout 30
done

# --- A limit of the size of files ---

mkdir small
(ulimit -f 1; ulimit -c 0; fail_in small 'too large' 'disk I/O'; exit $failed) || failed=1
find small -name result.json | grep -q . && complain "a limit of the size of files: there is a result"

# --- Read-only, full, out of files ---

mkdir disk
# on OPTIONS WORDS: the same on a disk of that kind.
on() {
  mount -t tmpfs -o "$1" tmpfs disk 2>stderr || { echo "left out, as nothing can be mounted: $1"; return; }
  fail_in disk "$2"
  grep -rqs '"status": "ok"' disk --include=result.json && complain "$1: there is a result"
  umount disk
}
if [ -n "${OWN_MOUNTS-}" ]; then
  on ro 'Read-only file system'
  on size=16k 'No space left'
  on nr_inodes=3 'No space left'
  on nr_inodes=2 'No space left'
else
  echo "left out, as nothing can be mounted: disks that are read-only, full, out of files"
fi

# --- A folder that vanishes; a clock that jumps ---

if [ -z "$disturb" ]; then
  echo "left out, as no library is preloaded here: folders that vanish, clocks that jump"
  exit $failed
fi

# vanish FOLDER ARGUMENTS: removed at some of the changes. All is there, or nothing says so.
vanish() {
  what="corot $*, vanished"
  folder=$1
  shift
  rm -rf "$folder"
  DISTURB_COUNT=count LD_PRELOAD=$disturb "$corot" "$@" >stdout 2>stderr || complain "$what: not at all"
  find "$folder" -type f | sort >all
  n=$(cat count) k=1
  while [ $k -le "$n" ]; do
    rm -rf "$folder"
    DISTURB_FOLDER=$folder DISTURB_VANISH=$k LD_PRELOAD=$disturb "$corot" "$@" >stdout 2>stderr
    got=$?
    find "$folder" -type f 2>/dev/null | sort >left
    case $got in
      # Once the last file is in place its writer is not asked again.
      0) cmp -s all left || [ $k -ge $((n - 6)) ] || complain "$what at change $k of $n: exit code 0, and files are missing" ;;
      5)
        [ -s stderr ] || complain "$what at change $k of $n: no message"
        grep -q 'not a regular file' stderr && complain "$what at change $k of $n: the wrong words"
        grep -qs '"status": "ok"' "$folder/result.json" && complain "$what at change $k of $n: a result that says ok"
        ;;
      *) complain "$what at change $k of $n: exit code $got" ;;
    esac
    k=$((k + 1 + n / 20))
  done
}
vanish gone run model.yaml -o gone --quiet
vanish gone static model.yaml -o gone --quiet
vanish gone study study.yaml -o gone --quiet -j 1

# The clocks go back by an hour: results are the same, and nothing takes less than no time.
for command in run static; do
  expect 0 $command model.yaml -o steady --quiet
  for k in 1 2 3 5 10 30 100 300; do
    what="$command, clocks go back at look $k"
    DISTURB_CLOCK=$k LD_PRELOAD=$disturb "$corot" $command model.yaml -o jumped >stdout 2>stderr
    got=$?
    [ $got = 0 ] || complain "$what: exit code $got"
    grep -q ' -[0-9.e+]* s' stderr && complain "$what: it has taken less than no time"
    for name in probes.csv energy.csv steps.csv; do cmp -s steady/$name jumped/$name || complain "$what: $name"; done
    cp jumped/result.json stdout
    json "all(t >= 0 for name, t in d['timings'].items() if name != 'other') and abs(d['timings']['other']) < 60"
  done
done
DISTURB_CLOCK=5 LD_PRELOAD=$disturb "$corot" study study.yaml -o jumped-study >stdout 2>stderr || complain "a study, clocks go back"
exit $failed

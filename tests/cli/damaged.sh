# What was read back is not what was written: a folder in its place, cut, or changed by hand. Every
# command ends in good order, says which file it is, and makes again what it can.
. "$(dirname "$0")/lib.sh"

write_study
cat >damage.py <<'PY'
import json, os, sys
path, kind = sys.argv[1:]
text = open(path).read()
plain = {"null": None, "text": "x", "nested": [[]]}

def replaced(x, value, top=True):
    """All that is in it, but for what says that a run is done, and which."""
    if isinstance(x, dict):
        return {k: v if top and k in ("hashes", "status") else replaced(v, value, False) for k, v in x.items()}
    return [replaced(v, value, False) for v in x] if isinstance(x, list) else value

if kind == "folder":
    os.unlink(path)
    os.mkdir(path)
    open(path + "/kept", "w").write("kept")
    sys.exit()
whole = json.loads(text)
if kind.startswith("deep-"):
    text = json.dumps(replaced(whole, plain[kind[5:]]))
else:
    text = {
        "empty": "",
        "cut": text[: len(text) // 2],
        "array": "[]",
        "brackets": 100000 * "[",
        "missing": json.dumps({"status": "ok"}),
    }[kind]
open(path, "w").write(text)
PY
unreadable='folder empty cut array brackets'
changed='missing deep-null deep-text deep-nested'

expect 0 run model.yaml -o run --quiet
expect 0 study study.yaml -o study --quiet
expect 0 budget model.yaml --levels 2 --skip space -o budget --quiet
mkdir before
cp -r run study budget before
cell=$(python3 -c 'import json; print(json.load(open("study/table.json"))["cells"][0]["id"])')
part=$(python3 -c 'import json; print(json.load(open("budget/budget.json"))["runs"][1]["id"])')

# damage KIND FILE: the file as no command has left it, all others whole.
damage() {
  rm -rf "${2%%/*}"
  cp -r "before/${2%%/*}" .
  python3 damage.py "$2" "$1"
}

# ends ARGUMENTS: in good order; what is wrong is said with a file's name, and a folder stays.
ends() {
  what="corot $*, $kind $file"
  timeout -s KILL 120 "$corot" "$@" >stdout 2>stderr
  got=$?
  case $got in
    0 | 1) ;;
    3 | 5) err ".json" ;;
    *) complain "$what: exit code $got" ;;
  esac
  [ "$kind" = folder ] || return
  [ $got = 5 ] || complain "$what: exit code $got"
  err "is a folder, not a file"
  [ "$(cat "$file/kept")" = kept ] || complain "$what: a folder is gone"
}
is_unreadable() { case " $unreadable " in *" $kind "*) true ;; *) false ;; esac }

for kind in $unreadable $changed; do
  file=run/result.json
  damage "$kind" $file; ends report run
  is_unreadable && [ $got = 0 ] && complain "$what: exit code 0"

  # A run whose result does not count is made again.
  file=study/runs/$cell/result.json
  damage "$kind" "$file"; ends study collect study; ends study status study; ends study study.yaml -o study
  if is_unreadable && [ "$kind" != folder ]; then
    err '(1 now)'
    cmp -s "before/study/runs/$cell/states.bin" "study/runs/$cell/states.bin" ||
      complain "$what: it is another run"
  fi

  file=study/table.json
  damage "$kind" $file; ends report study; ends plot study; ends study table study
  file=study/study.json
  damage "$kind" $file; ends study status study; ends study collect study; ends study study.yaml -o study
  file=budget/budget.json
  damage "$kind" $file; ends report budget
  file=budget/runs/$part/result.json
  damage "$kind" "$file"; ends budget model.yaml --levels 2 --skip space -o budget --quiet
done
exit $failed

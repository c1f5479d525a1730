# Man pages and completion: they name all options and no others, and man and the shells take them.
# The further arguments: the folder of what the build has made, and the sources.
pages=$3 source=$4
. "$(dirname "$0")/lib.sh"
tab=$(printf '\t')

# The same again, to the last byte.
sh "$source/src/install/pages/make.sh" "$corot" again "$(sed -n 's/^## [0-9.]* - //p' "$source/CHANGELOG.md" | head -n 1)" || complain "make.sh"
diff -r "$pages" again >stdout || complain "they are not what the program says now"

# Each option is known, with an argument or without one; none is carried out.
noption=0
while IFS=$tab read -r row page _ long argument _; do
  [ "$row" = option ] || continue
  noption=$((noption + 1))
  # shellcheck disable=SC2086
  if [ "$argument" = - ]; then
    expect 2 $page $long=1; err "$long takes no value"
  else
    expect 2 $page $long; err "$long needs a value"
  fi
done <"$pages/table"
[ $noption -gt 80 ] || complain "$noption options only"

# And each that the sources have is named.
grep -rhoE '\{"[a-z-]+", (no|required)_argument' "$source/src" --include='*.c' |
  sed 's/{"\(.*\)", \(.*\)_argument/\1 \2/' | sort -u | grep -v '^help ' >coded
awk -F'\t' '$1 == "option" { print substr($4, 3), ($5 == "-" ? "no" : "required") }' "$pages/table" | sort -u >told
diff coded told >stdout || complain "options of the sources (<) and of the pages (>)"

# Man pages, one for each command.
for command in $("$corot" --help | awk '/^Data/ { exit } /^  [a-z]/ && $1 != "help" { print $1 }'); do
  [ -s "$pages/man/corot-$command.1" ] || complain "no page of $command"
done
if man --version >/dev/null 2>&1; then
  for page in "$pages"/man/*.1; do
    man --warnings -E UTF-8 -l -Tutf8 -Z "$page" >/dev/null 2>>warned
  done
  [ ! -s warned ] || { cat warned; complain "man --warnings"; }
  MANWIDTH=100 man -l -Tutf8 "$pages/man/corot-run.1" 2>/dev/null | sed 's/.\x08//g; s/\x1b\[[0-9;]*m//g' >stdout
  out "integrate a scenario and write its tables"; out "--resume"; out "SEE ALSO"
fi
if command -v mandoc >/dev/null; then
  mandoc -T lint -W warning "$pages"/man/*.1 >stdout || complain "mandoc -T lint"
fi

# Completion, by the shells themselves.
mkdir folder && touch one.yaml two.json three.txt
bash -s "$pages/bash/corot" "$corot" <<'BASH' || complain "completion for bash"
. "$1"
failed=0
PATH=$(dirname "$2"):$PATH
# of WORD... -- WANTED...: what is offered for the last word; none of those that begin with !
of() {
  local typed=() wanted i
  while [ "$1" != -- ]; do typed+=("$1"); shift; done
  shift
  COMP_WORDS=(corot "${typed[@]}") COMP_CWORD=${#typed[@]} COMPREPLY=()
  _corot 2>/dev/null
  for wanted; do
    for ((i = 0; i < ${#COMPREPLY[@]}; i++)); do [ "${COMPREPLY[i]}" != "${wanted#!}" ] || break; done
    case $wanted in !*) [ $i = ${#COMPREPLY[@]} ] ;; *) [ $i -lt ${#COMPREPLY[@]} ] ;; esac ||
      { echo "${typed[*]}: $wanted: ${COMPREPLY[*]}"; failed=1; }
  done
}
of ru -- run !static
of "" -- run static mesh new help --version
of run "" -- one.yaml two.json folder !three.txt
of run --o -- --output
of run --output "" -- folder !one.yaml
of run --output = f -- folder
of run -o d --set integrator.rt -- integrator.rtol=
of find-limit --key time.e -- time.end
of mesh b -- box
of mesh box --s -- --size --split
of mesh info t -- three.txt two.json
of new b -- bar bracket
of study st -- status
of study status "" -- folder !one.yaml
of study export --f -- --format --force !--shard
of schema integr -- integrator integrator.rtol
of help mesh con -- convert
of wombat - -- --help
exit $failed
BASH
if command -v zsh >/dev/null; then
  zsh -n "$pages/zsh/_corot" || complain "zsh"
  zsh -fc "fpath=('$pages/zsh' \$fpath); autoload -Uz compinit; compinit -D; [[ \$_comps[corot] == _corot ]]" ||
    complain "zsh does not find the completion"
fi
if command -v fish >/dev/null; then
  HOME=$PWD PATH=$(dirname "$corot"):$PATH fish --no-config -c "source '$pages/fish/corot.fish'
    complete -C 'corot ru'; complete -C 'corot run --o'; complete -C 'corot mesh box --si'; complete -C 'corot new bar --fo'
    complete -C 'corot schema integrator.rt'" | cut -f 1 | tr '\n' ' ' >stdout
  [ "$(cat stdout)" = "run --output --size --force integrator.rtol " ] || complain "fish"
fi
exit $failed

#!/bin/sh
# Writes man pages and completion for shells from what the program says of itself, so that they say
# what --help says:
#   make.sh COROT DIR DATE
# DATE is that of the man pages.
# DIR/man has corot.1 and a page for each command; DIR/bash, DIR/zsh and DIR/fish what these shells read.
set -eu
corot=$1 dir=$2 date=$3
here=$(cd "$(dirname "$0")" && pwd)
LC_ALL=C
export LC_ALL
rm -rf "$dir"
mkdir -p "$dir/man" "$dir/bash" "$dir/zsh" "$dir/fish"

# Names of commands in the list of `corot help`, and the words that the usage of one begins with.
commands() { awk '/^Data/ { exit } /^  [a-z]/ { print $1 }' "$dir/corot.help"; }
words() {
  awk -v command="$1" '
    !/^usage:/ && !/^       corot/ { exit }
    {
      sub(/^ *(usage:)? *corot /, "")
      if (index($0, command " ") != 1) next
      n = split(substr($0, length(command) + 2), word, " ")
      for (i = 1; i <= n && word[i] ~ /^([a-z][a-z-]*|\|)$/; i++)
        if (word[i] != "|" && !(word[i] in seen)) { seen[word[i]]; print word[i] }
    }' "$2"
}

# The help of all commands, and of those commands of commands that have one of their own.
"$corot" --help >"$dir/corot.help"
: >"$dir/help"
for command in $(commands); do
  [ "$command" != help ] || continue
  "$corot" "$command" --help >"$dir/one"
  { echo "@page $command"; cat "$dir/one"; } >>"$dir/help"
  for word in $(words "$command" "$dir/one"); do
    echo "@word $command $word" >>"$dir/words"
    "$corot" "$command" "$word" --help >"$dir/two"
    cmp -s "$dir/one" "$dir/two" || { echo "@page $command $word"; cat "$dir/two"; } >>"$dir/help"
  done
done

version=$("$corot" --version | head -n 1)
awk -f "$here/table.awk" "$dir/corot.help" "$dir/words" "$dir/help" >"$dir/table"
awk -v dir="$dir/man" -v version="$version" -v date="$date" -f "$here/man.awk" "$dir/table" "$dir/corot.help" "$dir/help"
for shell in bash zsh fish; do
  case $shell in bash) name=corot ;; zsh) name=_corot ;; fish) name=corot.fish ;; esac
  awk -f "$here/kinds.awk" -f "$here/$shell.awk" "$dir/table" >"$dir/$shell/$name"
done
rm -f "$dir/one" "$dir/two" "$dir/help" "$dir/words" "$dir/corot.help"

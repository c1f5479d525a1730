# Completion for fish, of the table.
function quoted(text) {
  gsub(/\\/, "\\\\", text)
  gsub(/'/, "\\'", text)
  return "'" text "'"
}
# Behind a command and a word: there; behind a command: there, but not behind those of its words that
# are pages, or all of them.
function condition(page, but,  part) {
  split(page, part, " ")
  if (part[2] != "")
    return "'__fish_seen_subcommand_from " part[1] "; and __fish_seen_subcommand_from " part[2] "'"
  return "'__fish_seen_subcommand_from " page (but ? "; and not __fish_seen_subcommand_from" but : "") "'"
}
function argument(kind) {
  if (kind == "yaml") return " -ka '(__fish_complete_suffix .yaml; __fish_complete_suffix .json)'"
  if (kind == "file") return " -F"
  if (kind == "dir") return " -xa '(__fish_complete_directories)'"
  if (kind == "key") return " -xa '(__corot_keys)'"
  if (kind == "setting") return " -xa '(__corot_keys | string replace -r \"\\$\" =)'"
  return " -x"
}
BEGIN {
  print "# Completion of corot for fish; made from what corot --help says."
  print "function __corot_keys"
  print "    corot schema 2>/dev/null | sed -n '2,$s/ .*//p'"
  print "end"
  print "complete -c corot -f"
  print "complete -c corot -s h -l help -d 'what it does'"
  print "complete -c corot -n __fish_use_subcommand -s v -l version -d 'of corot and its libraries'"
}
$1 == "command" { print "complete -c corot -n __fish_use_subcommand -a " $2 " -d " quoted($3) }
$1 == "word" && !($2 in words) { parent[++nparent] = $2 }
$1 == "word" { words[$2] = words[$2] " " $3; next }
($1 == "place" || $1 == "option") && $2 ~ / / && !($2 in seen) {
  seen[$2]
  split($2, part, " ")
  pages[part[1]] = pages[part[1]] " " part[2]
}
$1 == "place" { row[++nrow] = $2 "\t" argument(kind_of($3)) }
$1 == "option" {
  text = ($3 == "-" ? "" : " -s " substr($3, 2)) " -l " substr($4, 3) " -d " quoted($6)
  row[++nrow] = $2 "\t" text ($5 == "-" ? "" : " -r" argument(kind_of($5)))
}
END {
  for (i = 1; i <= nparent; i++)
    print "complete -c corot -n " condition(parent[i], words[parent[i]]) " -a " quoted(substr(words[parent[i]], 2))
  for (i = 1; i <= nrow; i++) {
    split(row[i], f, "\t")
    print "complete -c corot -n " condition(f[1], pages[f[1]]) f[2]
  }
}

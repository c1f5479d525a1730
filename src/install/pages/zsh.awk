# Completion for zsh, of the table.
function quoted(text) {
  gsub(/'/, "'\\''", text)
  return text
}
function about(text) {
  gsub(/\\/, "\\\\", text)
  gsub(/:/, "\\:", text)
  gsub(/\[/, "\\[", text)
  gsub(/\]/, "\\]", text)
  return quoted(text)
}
function action(kind) {
  if (kind == "yaml") return "_files -g \"*.(yaml|yml|json)\""
  if (kind == "file") return "_files"
  if (kind == "dir") return "_files -/"
  if (kind == "key") return "_corot_keys"
  if (kind == "setting") return "_corot_settings"
  return " "
}
$1 == "command" { commands = commands "    '" $2 ":" about($3) "'\n" }
$1 == "word" && !($2 in words) { parent[++nparent] = $2 }
$1 == "word" { words[$2] = words[$2] " " $3 }
$1 == "place" { place[$2] = $3; if (!($2 in spec)) { spec[$2] = ""; page[++npage] = $2 } }
$1 == "option" {
  if (!($2 in spec)) { spec[$2] = ""; page[++npage] = $2 }
  value = $5 == "-" ? "" : ":" quoted($5) ":" action(kind_of($5))
  repeat = $5 == "KEY=VALUE" ? "*" : ""
  equals = $5 == "-" ? "" : "="
  spec[$2] = spec[$2] " \\\n        '" repeat $4 equals "[" about($6) "]" value "'"
  if ($3 != "-") spec[$2] = spec[$2] " \\\n        '" $3 "[" about($6) "]" value "'"
}
END {
  print "#compdef corot"
  print "# Completion of corot for zsh; made from what corot --help says."
  print "_corot_keys() { compadd -- ${(f)\"$($_corot_program schema 2>/dev/null | sed -n '2,$s/ .*//p')\"} }"
  print "_corot_settings() { compadd -S = -- ${(f)\"$($_corot_program schema 2>/dev/null | sed -n '2,$s/ .*//p')\"} }"
  print "_corot() {"
  print "  local curcontext=$curcontext _corot_program=$words[1] page state line"
  print "  local -a commands"
  print "  commands=(\n" commands "  )"
  print "  if (( CURRENT == 2 )); then"
  print "    _describe command commands"
  print "    compadd -- --help --version -h -v"
  print "    return"
  print "  fi"
  print "  if [[ $words[2] == help ]]; then words[2]=(); (( CURRENT-- )); if (( CURRENT == 2 )); then _describe command commands; return; fi; fi"
  print "  page=$words[2]"
  print "  case \"$words[2] ${words[3]-}\" in"
  for (i = 1; i <= npage; i++)
    if (page[i] ~ / /) list = list (list ? "|" : "") "'" page[i] "'"
  print "    " list ") if (( CURRENT > 3 )); then page=\"$words[2] $words[3]\"; words[1,2]=(); (( CURRENT -= 2 )); fi ;;"
  print "  esac"
  print "  if [[ $page != *' '* ]]; then"
  print "    if (( CURRENT == 3 )); then"
  print "      case $page in"
  for (i = 1; i <= nparent; i++) print "        " parent[i] ") compadd --" words[parent[i]] " ;;"
  print "      esac"
  print "    fi"
  print "    words[1]=(); (( CURRENT-- ))"
  print "  fi"
  print "  case $page in"
  for (i = 1; i <= npage; i++) {
    p = page[i]
    rest = p in place ? " \\\n        '*:" quoted(place[p]) ":" action(kind_of(place[p])) "'" : ""
    print "    '" p "')\n      _arguments '(- *)'{-h,--help}'[what it does]'" spec[p] rest " ;;"
  }
  print "  esac"
  print "}"
  print "_corot \"$@\""
}

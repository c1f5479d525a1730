# Completion for bash, of the table.
$1 == "command" { commands = commands " " $2 }
$1 == "word" && !($2 in words) { parent[++nparent] = $2 }
$1 == "word" { words[$2] = words[$2] " " $3 }
$1 == "place" { place[$2] = kind_of($3); placed[++nplace] = $2 }
$1 == "option" {
  if (!($2 in options)) page[++npage] = $2
  options[$2] = options[$2] ($3 == "-" ? "" : " " $3) " " $4
  if ($5 != "-") {
    label = "\"" $2 " " $4 "\"" ($3 == "-" ? "" : " | \"" $2 " " $3 "\"")
    kind = kind_of($5)
    taking[kind] = taking[kind] (taking[kind] ? " | " : "") label
  }
}
END {
  print "# Completion of corot for bash; made from what corot --help says."
  print "_corot_complete() {"
  print "  local kind=$1 program=$2 cur=$3"
  print "  case $kind in"
  print "    yaml)"
  print "      mapfile -t COMPREPLY < <(compgen -d -- \"$cur\"; compgen -f -X '!*.yaml' -- \"$cur\"; compgen -f -X '!*.json' -- \"$cur\")"
  print "      compopt -o filenames 2>/dev/null ;;"
  print "    file) mapfile -t COMPREPLY < <(compgen -f -- \"$cur\"); compopt -o filenames 2>/dev/null ;;"
  print "    dir) mapfile -t COMPREPLY < <(compgen -d -- \"$cur\"); compopt -o filenames 2>/dev/null ;;"
  print "    key | setting)"
  print "      mapfile -t COMPREPLY < <(compgen -W \"$(\"$program\" schema 2>/dev/null | sed -n '2,$s/ .*//p')\" -- \"$cur\")"
  print "      if [ \"$kind\" = setting ]; then"
  print "        COMPREPLY=(\"${COMPREPLY[@]/%/=}\")"
  print "        [ \"${COMPREPLY[*]}\" != = ] || COMPREPLY=()"
  print "        compopt -o nospace 2>/dev/null"
  print "      fi ;;"
  print "  esac"
  print "}"
  print ""
  print "_corot() {"
  print "  local program=${COMP_WORDS[0]} cur=${COMP_WORDS[COMP_CWORD]} prev= command= word= page kind= options= words= i"
  print "  COMPREPLY=()"
  print "  [ \"$COMP_CWORD\" -eq 0 ] || prev=${COMP_WORDS[COMP_CWORD - 1]}"
  print "  # --output=DIR is three words; KEY=VALUE is left alone behind its sign"
  print "  if [ \"$cur\" = = ]; then cur=; elif [ \"$prev\" = = ]; then prev=${COMP_WORDS[COMP_CWORD - 2]}; fi"
  print "  for ((i = 1; i < COMP_CWORD; i++)); do"
  print "    case ${COMP_WORDS[i]} in"
  print "      -*) ;;"
  print "      *) if [ -z \"$command\" ]; then command=${COMP_WORDS[i]}; elif [ -z \"$word\" ]; then word=${COMP_WORDS[i]}; fi ;;"
  print "    esac"
  print "  done"
  print "  if [ \"$command\" = help ]; then command=$word word=; fi"
  print "  if [ -z \"$command\" ]; then"
  print "    mapfile -t COMPREPLY < <(compgen -W \"" substr(commands, 2) " --help --version -h -v\" -- \"$cur\")"
  print "    return"
  print "  fi"
  print "  page=$command"
  print "  case \"$command $word\" in"
  list = ""
  for (i = 1; i <= npage; i++) if (page[i] ~ / /) list = list (list ? " | " : "") "\"" page[i] "\""
  for (i = 1; i <= nplace; i++)
    if (placed[i] ~ / / && !(placed[i] in options)) list = list " | \"" placed[i] "\""
  print "    " list ") page=\"$command $word\" ;;"
  print "  esac"
  print "  case \"$page $prev\" in"
  n = split("yaml file dir key setting none", kinds, " ")
  for (i = 1; i <= n; i++) if (taking[kinds[i]]) print "    " taking[kinds[i]] ") kind=" kinds[i] " ;;"
  print "  esac"
  print "  if [ -n \"$kind\" ]; then"
  print "    _corot_complete \"$kind\" \"$program\" \"$cur\""
  print "    return"
  print "  fi"
  print "  case $page in"
  for (i = 1; i <= npage; i++)
    print "    \"" page[i] "\") options=\"" substr(options[page[i]], 2) " -h --help\" ;;"
  print "    *) options=\"-h --help\" ;;"
  print "  esac"
  print "  case $page in"
  for (i = 1; i <= nparent; i++)
    print "    " parent[i] ") words=\"" substr(words[parent[i]], 2) "\" ;;"
  print "  esac"
  print "  case $page in"
  for (i = 1; i <= nplace; i++) print "    \"" placed[i] "\") kind=" place[placed[i]] " ;;"
  print "  esac"
  print "  case $cur in"
  print "    -*) mapfile -t COMPREPLY < <(compgen -W \"$options\" -- \"$cur\") ;;"
  print "    *)"
  print "      [ -z \"$kind\" ] || _corot_complete \"$kind\" \"$program\" \"$cur\""
  print "      if [ -z \"$word\" ]; then"
  print "        mapfile -t -O \"${#COMPREPLY[@]}\" COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")"
  print "      fi ;;"
  print "  esac"
  print "}"
  print "complete -F _corot corot"
}

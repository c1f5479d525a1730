# The help as a table, a row a line, between tabs:
#   command NAME ABOUT             in the list of the whole
#   word COMMAND WORD              what may stand behind it, by its usage
#   place PAGE PLACE               what else may: MODEL.yaml, DIR, FILE, KEY, or what it is
#   option PAGE SHORT LONG ARGUMENT ABOUT
# Empty fields are "-". A page is a command, or a command and a word: "mesh box".
BEGIN { OFS = "\t" }

# The list: "  run MODEL.yaml   what it does", or the latter in the next line. The text begins in one
# column.
FNR == NR {
  if (/^Data/) done = 1
  if (done || !/^  +[a-z]/) next
  if (/^  [a-z]/) name = $1
  about = substr($0, 24)
  if (about != "" && substr($0, 23, 1) == " ") print "command", name, about
  next
}
/^@word / { print "word", $2, $3; next }
/^@page / { page = substr($0, 7); usage = 1; column = 0; long = ""; next }

# usage: what stands behind the command, without options
usage && /^(usage:| +corot)/ {
  text = $0
  sub(/^ *(usage:)? *corot /, "", text)
  if (index(text, page " ") == 1) {
    text = substr(text, length(page) + 2)
    gsub(/ ?\[?-.*/, "", text)
    split(text, word, " ")
    gsub(/[][]/, "", word[1])
    if (word[1] ~ /^[A-Z]/ && !(page in placed)) print "place", page, page == "study schema" ? "STUDY-KEY" : word[1]
    placed[page]
  }
  next
}
/^$/ { usage = 0 }

# options: "  -o, --output DIR     the folder"; the text begins in one column
/^  (-[a-z],|    --)/ {
  if (!column) {
    match($0, /[^ ]  +[^ ]/)
    column = RSTART + RLENGTH - 1
  }
  tag = substr($0, 1, column - 1)
  about = substr($0, column)
  gsub(/^ +| +$/, "", tag)
  n = split(tag, part, /, /)
  short = "-"
  for (i = 1; i <= n; i++) {
    split(part[i], word, " ")
    if (word[1] ~ /^-[a-z]$/) { short = word[1]; continue }
    print "option", page, short, word[1], word[2] == "" ? "-" : word[2], about
    short = "-"
  }
}

# Man pages of the help: corot.1, and corot-COMMAND.1 for each of its pages.
function plain(text) {
  gsub(/\\/, "\\e", text)
  gsub(/-/, "\\-", text)
  gsub(/`/, "\\(ga", text)
  gsub(/'/, "\\(aq", text)
  gsub(/\^/, "\\(ha", text)
  gsub(/~/, "\\(ti", text)
  if (text ~ /^[.]/) text = "\\&" text
  return text
}
function put(text) { print text >file }
function head(name, about) {
  put(".TH " toupper(plain(name)) " 1 \"" date "\" \"" version "\" \"corot\"")
  put(".SH NAME")
  put(plain(name) " \\- " plain(about))
  put(".SH SYNOPSIS")
  put(".nf")
}
# Fills paragraphs; what is indented stays as it is.
function set_mode(new) {
  if (mode == new) return
  if (mode == "code") { put(".fi"); put(".RE") }
  if (new == "code") { if (mode != "start") put(".PP"); put(".RS"); put(".nf") }
  if (new == "text" && mode != "start") put(".PP")
  mode = new
}
function finish() {
  if (!file) return
  set_mode("text_end")
  put(".SH SEE ALSO")
  put(is_main ? others : ".BR corot (1)")
  close(file)
}

FNR == 1 { number++ }
number == 1 {
  split($0, f, "\t")
  if (f[1] == "command") about_of[f[2]] = f[3]
  if (f[1] == "place" || f[1] == "option" || f[1] == "word") {
    name = f[2]
    gsub(/ /, "-", name)
    if (f[1] != "word" && !(name in seen)) {
      seen[name]
      others = others (others ? ",\n" : "") ".BR corot\\-" plain(name) " (1)"
    }
  }
  next
}
number == 2 && FNR == 1 {
  file = dir "/corot.1"
  is_main = 1
  sub(/^corot: /, "")
  head("corot", $0)
  waiting = 1
  next
}
/^@page / {
  finish()
  page = substr($0, 7)
  name = "corot-" page
  gsub(/ /, "-", name)
  file = dir "/" name ".1"
  is_main = 0
  waiting = 1
  about = about_of[page]
  first = 1
  held = ""
  next
}
# The synopsis. A page without a line in the list is about what its text says first.
waiting && /^(usage:|      )/ {
  sub(/^usage: |^       /, "")
  held = held plain($0) "\n"
  next
}
waiting && /^$/ {
  if (!is_main && about == "") { about_next = 1; waiting = 0; next }
  if (is_main && held == "") next
  begin_text()
  next
}
function begin_text() {
  if (!is_main) head(name, about)
  printf "%s", held >file
  put(".fi")
  put(".SH DESCRIPTION")
  waiting = about_next = 0
  mode = "start"
  column = 0
}
about_next {
  about = $0
  sub(/[.:;,].*/, "", about)
  about = tolower(substr(about, 1, 1)) substr(about, 2)
  begin_text()
}
/^$/ { if (mode == "text" || mode == "option") mode = "gap"; else if (mode == "code") put(""); next }
/^example:/ || /^Exit codes/ || /exit codes:$/ {
  set_mode("text_end")
  put($0 ~ /^example/ ? ".SH EXAMPLE" : ".SH EXIT STATUS")
  mode = "start"
}
/^example:/ { set_mode("code"); sub(/^example: /, ""); put(plain($0)); next }
/^  (-[a-z],|    --)/ {
  if (!column) { match($0, /[^ ]  +[^ ]/); column = RSTART + RLENGTH - 1 }
  if (mode == "code") set_mode("text_end")
  mode = "option"
  tag = substr($0, 1, column - 1)
  gsub(/^ +| +$/, "", tag)
  put(".TP")
  put(".B " plain(tag))
  put(plain(substr($0, column)))
  next
}
mode == "option" && column && substr($0, 1, column - 1) ~ /^ +$/ { put(plain(substr($0, column))); next }
/^ / { set_mode("code"); put(plain($0)); next }
{ if (mode == "gap" || mode == "option" || mode == "code") set_mode("text"); else if (mode == "start") mode = "text"; put(plain($0)) }
END { finish() }

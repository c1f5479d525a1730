# For all shells: what completes an argument: yaml, dir, file, key, setting (KEY=VALUE), or none.
function kind_of(argument) {
  if (argument ~ /\.yaml$/) return "yaml"
  if (argument == "DIR") return "dir"
  if (argument == "KEY") return "key"
  if (argument == "KEY=VALUE") return "setting"
  if (argument ~ /^(FILE|OUT$|FROM$|TO$)/) return "file"
  return "none"
}
BEGIN { FS = "\t" }

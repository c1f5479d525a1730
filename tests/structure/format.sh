#!/bin/sh
# Whether all sources are formatted as clang-format 14 (Debian 12's) leaves them; other versions lay
# some lines out differently, and are not asked. The public headers are left out: their comments and
# the tables in them are wider on purpose, as they are read beside the code that calls them.
# usage: format.sh TREE
set -eu
cd "$1"
for name in clang-format-14 clang-format; do
  version=$("$name" --version 2>/dev/null) || continue
  case $version in
    *" version 14."*)
      find src tests models -name '*.[ch]' -exec "$name" --dry-run -Werror {} + && exit 0
      echo "FAILED: the lines above are not as clang-format leaves them: clang-format -i FILE"
      exit 1
      ;;
  esac
done
echo "There is no clang-format 14 here (${version:-none at all}): the format was not looked at."
exit 77

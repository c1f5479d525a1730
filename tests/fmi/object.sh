# The shared object of an FMU: what it needs, what it shows, and that the FMU can be moved.
# usage: object.sh OBJECT fmi3.h FOLDER
set -eu
object=$1
header=$2
mkdir -p "$3"
cd "$3"
failed=0
complain() {
  echo "FAILED: $*"
  failed=1
}

# Nothing but the C library and libm, and the loader that is a part of it.
for needed in $(readelf -d "$object" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p'); do
  case $needed in
    libc.so.* | libm.so.* | ld-linux*.so.*) ;;
    *) complain "it needs $needed" ;;
  esac
done
readelf -d "$object" | grep -q TEXTREL && complain "it has to be changed where it is loaded"

# The functions of the interface, all of them, and nothing else.
nm -D --defined-only "$object" | awk '{ print $3 }' | sort >shown
grep -v '^fmi3' shown && complain "it shows the names above"
sed -n 's/.*FMI3_VALUES(\([A-Za-z0-9]*\));.*/fmi3Get\1 fmi3Set\1/p; s/.*FMI3_API.* \*\{0,1\}\(fmi3[A-Za-z0-9]*\)(.*/\1/p' \
  "$header" | tr ' ' '\n' | grep -v '##\|^fmi3[GS]et$' | sort -u >declared
diff declared shown || complain "what is declared and what is shown are not the same"
[ "$(grep -c . shown)" -ge 75 ] || complain "only $(grep -c . shown) functions"

# Nothing under the GPL, nothing that was left out.
if nm -D --undefined-only "$object" | grep -iE 'cholmod|metis|dgemm|arpack'; then
  complain "it wants the names above"
fi
exit $failed

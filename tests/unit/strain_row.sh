# A strain measure is one row of a table: what is compiled from the table has it, and an index
# without a row is no program. Runs as: sh strain_row.sh COMPILER SOURCE_FOLDER SCRATCH_FOLDER
set -u
compiler=$1 source=$2
rm -rf "$3"
mkdir -p "$3/core/element"
cd "$3" || exit 1
failed=0
complain() { echo "FAILED: $*"; failed=1; }
compile() { "$compiler" -std=c11 -D_POSIX_C_SOURCE=200809L -I. -I"$source/src" -I"$source/include" -Wno-psabi "$@"; }

row='  row(EXTRA, "extra", BY_FRAME, BY_GRADIENT, FRAME_POLAR) \\'
sed "/#define STRAIN_MEASURES(row)/a\\
$row" "$source/src/core/element/strain.h" >core/element/strain.h
grep -q EXTRA core/element/strain.h || complain "no sixth row"
compile -fsyntax-only "$source/src/core/solid/measures.c" || complain "a sixth row does not compile"
compile -E "$source/src/core/solid/kernel_force.c" | grep -q 'case EXTRA: return .*&strain_measures\[EXTRA\]' ||
  complain "the kernel of forces does not have the sixth row"

sed 's/enum { STRAIN_MEASURES(STRAIN_INDEX) NSTRAIN }/enum { STRAIN_MEASURES(STRAIN_INDEX) EXTRA, NSTRAIN }/' \
  "$source/src/core/element/strain.h" >core/element/strain.h
grep -q 'EXTRA, NSTRAIN' core/element/strain.h || complain "no index without a row"
compile -fsyntax-only "$source/src/core/solid/measures.c" 2>/dev/null && complain "an index without a row compiles"
exit $failed

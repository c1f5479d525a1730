#!/bin/sh
# Runs an example and looks at what it prints: whole numbers and words as they must be, results
# against closed forms or against what is conserved.
# usage: check.sh NAME PROGRAM
set -eu
name=$1 program=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "FAILED: $name: $*"; cat "$work/out"; exit 1; }

"$program" $([ "$name" = mesh ] && echo "$work/bar.msh") >"$work/out" || fail "exit code $?"

# has LINE: the line was printed.
has() { grep -qxF -e "$1" "$work/out" || fail "no line '$1'"; }
# holds CONDITION: of awk, over all lines; `near(a, b, part)` and `at(pattern)`, the first line that
# has the pattern, taken apart at spaces, are there to help.
holds() {
  awk "
    function near(a, b, part) { return b != 0 && (a - b)^2 <= (part * b)^2 }
    { line[NR] = \$0 }
    function at(pattern, field,   i, word) {
      for (i = 1; i <= NR; i++)
        if (line[i] ~ pattern) { split(line[i], word, /[ ,]+/); return word[field] + 0 }
      return \"none\"
    }
    END { exit !($1) }" "$work/out" || fail "not so: $1"
}

case $name in
  checkpoint)
    # the tip of a bar that swings about where half of the load would bring it
    holds 'line[1] ~ /the same bits$/'
    holds 'at("with half", 9) < at("at 1 s", 4)'
    ;;
  base)
    has "missing file: COROT_EIO, -1 tets: /nowhere/bar.msh: No such file or directory"
    has "no path: COROT_EINVAL, -1 tets: the path of the mesh has 0 letters"
    has "the library is that of the headers"
    ;;
  mesh)
    # 2 x 2 x 12 cells of six tets; refined, (5 x 5 x 25) nodes, and two triangles on each of the
    # 2 (4 x 4 + 2 (4 x 24)) squares of the surface. A sixth of the bar is above z = 0.5.
    has "tets 2304 of 288"
    has "nodes 625 of 117"
    has "faces of the boundary 832"
    has "read again: tets 2304, of which 384 are in upper"
    holds 'near(at("volume", 2), 0.006, 1e-11)'
    ;;
  model)
    # Nine of the 13 x 9 nodes move with the support. A quarter of the sine's period is an eighth of
    # a second.
    has "degrees of freedom 324, nodes 117"
    has "kinks 1, the first at 1 s"
    has "a step from t = 0 should end by 0.125 s"
    grep -q "^COROT_EINVAL: no strain measure 'linear'" "$work/out" || fail "the refusal"
    has "strain measure polar: turns with the body"
    has "strain measure green: fixed"
    ;;
  hierarchy)
    # An affine field has no detail, and rigid motions have none: no force is lost.
    has "fine nodes with detail 1 of 117, the last 0.5"
    has "force on 125 nodes 125 N, on 8 coarse ones 125 N"
    holds 'near(at("value", 6), at("value", 8), 1e-11)'
    ;;
  ode)
    # The method conserves angular momentum but for rounding of 10^4 steps, and energy to second
    # order: (h omega)^2 is 1e-3 for the fastest mode, which takes a small part of it.
    holds 'near(at("angular", 9), at("angular", 5), 1e-7)'
    holds 'near(at("energy", 7), at("energy", 3), 1e-4)'
    holds 'at("energy", 11) > 0'
    ;;
  solve)
    # The last but one iteration before rounding squares what is left: three digits become six.
    grep -c '^largest residual' "$work/out" >"$work/count"
    [ "$(cat "$work/count")" -ge 4 ] && [ "$(cat "$work/count")" -le 8 ] || fail "iterations"
    tail -n 2 "$work/out" | head -n 1 | awk '{ exit !($3 < 1e-12) }' || fail "not converged"
    ;;
  inputs)
    # A loop of windows that nothing restarts, and books that close to a few ten times the tolerance. Of the beam that sticks out by b = 0.1 m behind the spring at a = 0.5 m
    # this takes F (1 + 3 b / (2 a)) = 0.26 N, but for what still swings.
    has "restarts 0, convergence failures 0"
    holds 'near(at("energy", 6) + at("energy", 9), at("energy", 12), 5e-5)'
    holds 'near(at("tip", 5), 0.26 / 1e5, 0.15)'
    ;;
  integrate)
    # Eight outputs, and the books close to ten times the tolerance.
    [ "$(grep -c '^t = ' "$work/out")" = 8 ] || fail "outputs"
    holds 'near(at("energy", 5), at("energy", 7) + at("energy", 9), 1e-5)'
    ;;
  statics)
    # Strains are at most density g L / E = 0.6 %, by which a measure may differ from the small
    # strains of the closed form; the clamped end adds nothing, for Poisson's ratio is 0.
    [ "$(grep -c ' stable after' "$work/out")" = 2 ] || fail "load steps"
    holds 'near(at("longer", 3), at("longer", 7), 0.006)'
    ;;
  modes)
    grep -qxF "this corot has no ARPACK" "$work/out" && exit 0
    # Shear makes the bar bend slower by 1.6 (h / L)^2 = 0.4 %, the mesh stiffens it by a few
    # thousandths; along itself, with Poisson's ratio 0, the clamped end changes nothing.
    [ "$(grep -c '^mode ' "$work/out")" = 10 ] || fail "modes"
    holds 'near(at("mode 1", 3), at("bending", 2), 0.01)'
    holds 'near(at("mode 1", 3), at("mode 2", 3), 0.001)'
    grep '^mode .* 0\.81[01] along z' "$work/out" >"$work/along" || fail "8 / pi^2 of the mass"
    awk -v f="$(sed -n 's/along the bar \(.*\) Hz/\1/p' "$work/out")" \
      '{ exit !(($3 / f - 1)^2 < 1e-6) }' "$work/along" || fail "the frequency along the bar"
    ;;
  space)
    # What ten-node tets make of the end's displacement is the first with the correction, but for the
    # square of this; and that is nearly all of what is missing to the beam, which bends by 0.0487 m.
    holds 'near(at("four-node", 3) + at("correction", 2), at("ten-node", 3), 0.01)'
    holds 'near(at("ten-node", 3), 0.0487, 0.01)'
    holds 'at("missing", 2) > 20 && at("missing", 2) < 60'
    # A half of the error is in a few tets, which cut into eight miss a quarter of it.
    holds 'at("half", 5) < 288 / 4'
    holds 'at("cut there", 3) - at("four-node", 3) > 0.4 * at("correction", 2)'
    ;;
  *) fail "no such example" ;;
esac

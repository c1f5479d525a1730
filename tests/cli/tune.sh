# What linear solvers cost: measured, stored, and chosen by.
. "$(dirname "$0")/lib.sh"

cat >model.yaml <<'YAML'
mesh: {box: {size: [1, 1, 1], cells: [10, 10, 10]}}
groups: {foot: {plane: {axis: z, at: 0}}, head: {plane: {axis: z, at: 1}}}
material: {E: 1.0e6, nu: 0.3, density: 1000}
boundary: [{group: foot, fix: [x, y, z]}]
loads: [{group: head, traction: [1000, 0, 0]}]
time: {end: 1}
YAML

solver() { python3 -c 'import json; r = json.load(open("o/result.json"))
print(r["solver_costs"], r["statics"]["linear_solver"])'; }

expect 0 tune --show; no_err
out "nothing has been measured"
[ ! -e "$XDG_CONFIG_HOME" ] || complain "--show has written something"
expect 0 static model.yaml -o o
[ "$(solver)" = "usual pcg, incomplete-cholesky" ] || complain "without costs: $(solver)"

# On a machine where iterations are dear a factor is taken.
mkdir -p "$XDG_CONFIG_HOME/corot"
file=$XDG_CONFIG_HOME/corot/costs.json
cat >"$file" <<'JSON'
{"operation": 0.07, "made": 20, "solved": 1.6, "incomplete": 6, "iterated": 500, "aggregated": 95, "cycled": 650}
JSON
expect 0 static model.yaml -o o
case $(solver) in
  "measured cholmod "* | "measured klu, "*) ;;
  *) complain "with dear iterations: $(solver)" ;;
esac
expect 0 tune --show
out "500"

# What is not such a file is refused by all who choose, with its place.
echo '{"operation": 0.07,' >"$file"
expect 3 static model.yaml -o o; err "$file:2:"
echo '{"operation": -1}' >"$file"
expect 3 check model.yaml; err "$file: operation is not a number of nanoseconds"; err "corot tune"

# Measured here, which takes some seconds; the next run goes by it.
expect 0 tune; err "written to $file"; out "an entry of the factor, made"
expect 0 static model.yaml -o o
case $(solver) in measured*) ;; *) complain "after tune: $(solver)" ;; esac
XDG_CONFIG_HOME='' HOME='' expect 5 tune; err "nowhere to write"
expect 2 tune now; err "unexpected: now"
exit $failed

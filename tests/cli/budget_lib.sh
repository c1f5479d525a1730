# What the tests of error budgets share beside lib.sh, which this one reads.
. "$(dirname "$0")/lib.sh"

# claim NAME EXPRESSION...: python says whether each is true of NAME/budget.json, d; part(P) is a part.
claim() {
  where=$1
  shift
  python3 - "$where" "$@" <<'PY' || complain "$what: $where does not claim what it should"
import csv, json, sys
where = sys.argv[1]
d = json.load(open(where + '/budget.json'))
def part(name):
    return [p for p in d['parts'] if p['part'] == name][0]
def rows(folder):
    with open(folder + '/probes.csv') as f:
        return [[float(x) for x in row[1:4]] for row in list(csv.reader(f))[1:]]
def apart(a, b):
    return max(sum((x - y) ** 2 for x, y in zip(p, q)) ** 0.5 for p, q in zip(rows(a), rows(b)))
for text in sys.argv[2:]:
    if not eval(text):
        sys.exit('not %s: %s' % (text, json.dumps(d, indent=1)))
PY
}

# What every budget says, whatever it is of. The numbers are those of the parts, to rounding.
sound() {
  claim "$1" "abs(d['sum'] - sum(p['error'] for p in d['parts'])) <= 1e-15 * d['sum']" \
    "abs(d['interaction'] - (d['total'] - d['sum'])) <= 1e-15 * d['sum']" \
    "abs(sum(p['share'] for p in d['parts']) - 1) < 1e-9" \
    "all(abs(sum(p['probes']['corner']['signed'][k] for p in d['parts']) - d['total_probes']['corner']['signed'][k]) < 1e-12 for k in range(3))" \
    "all(p['bound'] in ('about', 'at least', 'at most') for p in d['parts'])" \
    "all(p['low'] <= p['error'] and (p['high'] is None or p['error'] <= p['high']) for p in d['parts'])" \
    "all((p['bound'] == 'at most') == (p['error'] < p['floor']) for p in d['parts'])" \
    "all((p['bound'] == 'at least') == (p['high'] is None) for p in d['parts'])" \
    "d['complete'] and d['missing'] == [] and d['verdict'] == d['first']"
}

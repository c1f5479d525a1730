. "$(dirname "$0")/budget_lib.sh"

# A constant step so short that its error is less than that of a run at rtol 1e-6: the reference is
# tightened until it is better than what it judges. The truth is a run of another method at 1e-11.
expect 0 budget model.yaml -o short --quiet --set strain=green --skip space \
  --set 'integrator={method: newmark, step: 4e-5}'
sound short
expect 0 run model.yaml -o truth --quiet --set strain=green --set 'integrator={method: erk, rtol: 1e-11}'
claim short "abs(part('time integration')['probes']['corner']['max'] / apart('short/runs/' + d['runs'][0]['id'], 'truth') - 1) < 0.05" \
  "apart('short/runs/' + d['runs'][2]['id'], 'truth') > 20 * part('time integration')['probes']['corner']['max']" \
  "part('time integration')['bound'] == 'about' and d['check'] < 0.1 * part('time integration')['error']" \
  "d['check_rtol'] < 1e-7 and 'rtol: 1e-10' in part('time integration')['pair']"

# Where no tolerance is left that would do, the error is below its floor and is not claimed.
expect 0 budget model.yaml -o tight --quiet --set strain=green --skip space \
  --set 'integrator={method: arkode, order: 5, rtol: 1e-11}' --set time.end=0.01
grep -q "^time integration  *<" stdout || complain "an error below its floor is claimed"
out "below its floor: at most"; out "No part is above its floor; none is larger than"
claim tight "part('time integration')['bound'] == 'at most' and part('time integration')['low'] == 0" \
  "part('time integration')['high'] >= 10 * d['check']" "d['first'].find('largest part') < 0"

# A part that is missing: the finer mesh needs more steps than it may take. Which part is the largest
# nobody knows, and nobody is told.
cat >steps.py <<'PY'
import json
d = json.load(open('stdout'))
print(d['statistics']['nst'] + 2)
PY
expect 0 run model.yaml -o steps --quiet --json --set strain=green
most=$(python3 steps.py)
expect 1 budget model.yaml -o missing --quiet --skip "time integration" --skip "algebraic solver" \
  --set strain=polar --set integrator.max_steps=$most
out "Parts are missing, as runs failed: space. So it is not known which part is the largest"
out "No run has checked the references of: strain measure."
grep -q "The largest part is" stdout && complain "a part is called the largest"
grep -q "^strain measure  *(*[0-9]" stdout || complain "the part that is known"
claim missing "not d['complete'] and d['missing'] == ['space'] and d['sum'] is None" \
  "part('space')['bound'] == 'missing' and part('space')['verdict'] == 'not known, as a run failed'" \
  "part('space')['error'] is None and part('strain measure')['bound'] == 'unchecked'"
grep -q "Parts are missing" missing/report.html || complain "the page says nothing of it"
exit $failed

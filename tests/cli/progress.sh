. "$(dirname "$0")/lib.sh"

# What a command writes to a terminal, which is stdin, stdout and stderr. It is interrupted once it
# says how much time is left.
cat >on_terminal.py <<'PY'
import os, pty, signal, sys

pid, terminal = pty.fork()
if pid == 0:
    os.execv(sys.argv[1], sys.argv[1:])
text, asked = b"", False
while True:
    try:
        more = os.read(terminal, 4096)
    except OSError:  # the other end is closed
        break
    if not more:
        break
    text += more
    if b"s left" in text and not asked:
        asked = True
        os.kill(pid, signal.SIGINT)
sys.stdout.buffer.write(text)
sys.exit(os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]))
PY

# on_terminal CODE ARGUMENTS...: as expect.
on_terminal() {
  what="corot $* on a terminal"
  code=$1
  shift
  python3 on_terminal.py "$corot" "$@" >stdout 2>stderr
  got=$?
  [ "$got" = "$code" ] || complain "$what: exit code $got"
}

# A run that would take an hour says how far it is, and takes the line away at its end.
on_terminal 130 run model.yaml -o long --set time.end=1e5 --set time.output=1e4 \
  --set integrator.max_step=1e-3
python3 - <<'PY' || complain "$what: not a line of progress that is taken away"
import re
text = open("stdout", newline="").read()
line = r"\r\x1b\[Kt = \S+ of 1e\+05 s  h = 1.00e-03 s  order \d +0 %  \d+ s left"
assert re.match("(?s).*" + line + "\r\x1b\\[K", text), text
assert "s left" not in text[text.rindex("\x1b[K"):], text
PY

# Not with --quiet.
on_terminal 0 run model.yaml -o short --quiet
! grep -q "$(printf '\033')" stdout || complain "$what: a line of progress"
exit $failed

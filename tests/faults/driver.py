"""Fails one call after another of corot's whole process, and judges what comes of it.

usage: driver.py COROT LIBRARY FOLDER [--all] [--seconds S] [--jobs N] [--only CASE] [--kind KIND]
                 [--at K] [--seed N]

Of each command on a tiny scenario each allocation (kind "alloc") and each call that reads, writes,
lists, locks or starts something (kind "io") is refused once: libraries and children included, see
faults.c. Accepted are but two outcomes:

  * the exit code that it has without a failure (0, but where a run gives up), and every file (and
    stdout) has the bytes it has then;
  * another exit code, not 0, a message on stderr, no result on the disk that says "ok" though it is not
    what it would be without; and the same command, once more, repairs everything.

Nothing may hang, and what was there before stays as it was. Callbacks of SUNDIALS are
failed by unit/test_seams.c, for each integrator and each linear solver.

Which calls. A site is a call with its eight innermost callers. By default the last call of each
site is failed (first of those that no command before has), then the first call, then one amid, then
others at random, until S seconds are over; what was reached is printed. --all fails every single
call, however long it takes. --at K fails the K-th call of one case and says what happened.

How it is quick. The program runs once for many trials, and forks before each call that is to fail
(faults.c). An outcome that was judged before is not judged again: what repairs a folder depends on
nothing but the folder. Of a process that a study has started only how it ends and what it leaves
can matter to the study, so that one trial of the whole study stands for all failures in the process
that agree in this.

Crashes. A library of someone else's may not bear a refused allocation: no caller can help it, it
differs from version to version, and a crash leaves no wrong answer behind. A process that is ended
by a signal inside a library (the innermost frame that is not the C library's lies there) has failed
like any other: it must say so (src/main/crash.c), and its folder is judged the same. The functions
are listed. A crash without the message is a failure, and so is every crash in a function of
corot's own.
"""
import argparse, collections, functools, hashlib, json, mmap, multiprocessing, os, random, re
import select, shutil, signal, struct, subprocess, sys, tempfile, threading, time

KINDS = {"alloc": 1, "io": 2}
OFF, RECORD, FAIL, SERVE = range(4)
MOST_CALLS, WHERE = 1 << 17, 8192  # as in faults.c
NUMBERS = struct.Struct("7q")      # mode, kind, at, count, fired, root, trial
AT_WHERE = NUMBERS.size
AT_CRASH = AT_WHERE + WHERE
AT_SITE = AT_CRASH + WHERE
AT_PROCESS = AT_SITE + 8 * MOST_CALLS
AT_WANTED = AT_PROCESS + 4 * MOST_CALLS
TO_DRIVER, FROM_DRIVER = 900, 901
TIME_LIMIT = 30  # for what hangs: a trial takes less than a second
CHUNK = 150      # trials of one server

MODEL = """\
title: a block under a shear load
mesh: {box: {size: [0.1, 0.1, 0.2], cells: [1, 1, 2]}}
groups:
  base: {plane: {axis: z, at: 0.0}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000.0, damping: {lambda: 10.0, mu: 1.0}}
boundary:
  - {group: base, fix: [x, y, z]}
loads:
  - {group: zmax, traction: [200.0, 0.0, 0.0]}
time: {end: 0.02, output: 0.01}
probes:
  corner: {point: [0.1, 0.1, 0.2]}
output: {states: binary}
"""
STUDY = """\
study: how tight
base: model.yaml
set: {output: {fields: none}}
axes:
  - {key: integrator.rtol, values: [1.0e-3, 1.0e-4]}
repeat: 1
"""

# Of two runs the second one needs more steps than it may make.
LIMIT = ("find-limit model.yaml -o out/limit -j 1 --set integrator.method=backward-euler"
         " --set integrator.step=0.005 --set integrator.max_steps=3"
         " --key time.end --from 0.01 --to 0.02 --scan 2 --precision 1")

# Two meshes.
SOLVE = "solve model.yaml --goal corner.ux@end --within 0.9 --set strain=green -o out/solve -j 1"

# Checkpoints after every second step, each written.
LONG = "run model.yaml -o out/long --resume --set checkpoint.every=0 --set checkpoint.steps=2"

# Each: what has been done before (a case, or nothing), the command, and whether an "ok" beside a
# failure is one of several runs, of which others may have failed.
# And its exit code; and whether a failure has cut what was done before, when it had a checkpoint.
Case = collections.namedtuple("Case", "before command several code cut", defaults=(0, False))
CASES = {
    "run": Case(None, "run model.yaml -o out/run", False),
    "run-gives-up": Case(None, "run model.yaml -o out/run --set integrator.max_steps=2", False, 4),
    "static-gives-up": Case(None, "static model.yaml -o out/static --set statics.max_iterations=1", False, 4),
    "static": Case(None, "static model.yaml -o out/static", False),
    "modes": Case(None, "modes model.yaml -n 3 -o out/modes", False),
    "modes-loaded": Case(None, "modes model.yaml -n 3 --about equilibrium -o out/modes", False),
    "check": Case(None, "check model.yaml", False),
    "check-bad": Case(None, "check model.yaml --set threads=many --set time.end=soon", False, 3),
    "new": Case(None, "new bar -o bar.yaml --force", False),
    "export-fmu": Case(None, "export-fmu model.yaml -o model.fmu", False),
    "mesh-box": Case(None, "mesh box --size 0.1,0.1,0.2 --cells 1,1,2 -o box.msh", False),
    "mesh-info": Case("mesh-box", "mesh info box.msh", False),
    "mesh-refine": Case("mesh-box", "mesh refine box.msh -o fine.msh", False),
    "run-again": Case("run", "run model.yaml -o out/run --quiet", False),
    "checkpoint": Case(None, LONG, False),
    "resume": Case("checkpoint", LONG, False, cut=True),
    "resume-done": Case("checkpoint", LONG, False),
    "report": Case("run", "report out/run", True),
    "study": Case(None, "study study.yaml -o out/study -j 1", True),
    "status": Case("study", "study status out/study", True),
    "collect": Case("study", "study collect out/study", True),
    "table": Case("study", "study table out/study", True),
    "csv": Case("study", "study csv out/study", True),
    "report-study": Case("study", "report out/study", True),
    "plot": Case("study", "plot out/study", True),
    "export": Case("study", "study export study.yaml --format slurm -o out/study", True),
    "budget": Case(None, "budget model.yaml -o out/budget -j 1 --skip space", True),
    "budget-again": Case("budget", "budget model.yaml -o out/budget -j 1 --skip space", True),
    "solve": Case(None, SOLVE, True),
    "solve-again": Case("solve", SOLVE, True),
    "report-solve": Case("solve", "report out/solve", True),
    "find-limit": Case(None, LIMIT, True),
    "find-limit-again": Case("find-limit", LIMIT, True),
}

# Crashes of libraries that corot cannot help: the innermost function of the library that has a
# name. They are told as any crash in a library is, but not news; what is never seen in a whole run
# is reported, so that it can go. SUNDIALS 6.4 and libfyaml 0.7.12, of Debian 12.
KNOWN_CRASHES = {
    "fy_parse_input_append": "uses an input that it could not allocate",
    "dseupd_c": "uses an array that it could not allocate",
    "N_VClone": "uses the clone of a vector that it could not allocate",
    "arkAllocVec": "uses the clone of a vector that it could not allocate",
    "ARKodeButcherTable_LoadDIRK": "fills a table that it could not allocate",
    "zipOpenNewFileInZip4_64": "fills a header that it could not allocate",
    "SUNLogger_Create": "uses a logger that it could not allocate",
    "SUNLogger_Destroy": "releases a map of a logger that it could not allocate",
    "SUNContext_Free": "the same, in some of the runs: it depends on where memory is",
}

# What a crash says; a study repeats it.
TOLD = re.compile(rb"corot: ended by (a fault inside the program|an internal error) "
                  rb"\(SIG[A-Z]+( in [^)]+)?\); memory that has run out is a frequent cause; ")

Outcome = collections.namedtuple("Outcome", "code out err tree")


class State:
    """What is shared with the processes of a trial: struct state of faults.c."""

    def __init__(self, path):
        self.path = path
        with open(path, "wb") as f:
            f.truncate(AT_WANTED + MOST_CALLS)
        with open(path, "r+b") as f:
            self.map = mmap.mmap(f.fileno(), 0)

    def reset(self, mode, kind=None, at=0, wanted=()):
        NUMBERS.pack_into(self.map, 0, mode, KINDS.get(kind, 0), at, 0, 0, 0, 0)
        self.map[AT_WHERE], self.map[AT_CRASH] = 0, 0
        self.map[AT_WANTED:] = bytes(MOST_CALLS)
        for k in wanted:
            self.map[AT_WANTED + k - 1] = 1

    def number(self, name):
        return NUMBERS.unpack_from(self.map, 0)[
            ("mode", "kind", "at", "count", "fired", "root", "trial").index(name)]

    def text(self, at):
        return self.map[at : self.map.find(b"\0", at)].decode("utf-8", "replace")

    where = property(lambda self: self.text(AT_WHERE))
    crash = property(lambda self: self.text(AT_CRASH))

    def calls(self):
        """Of each call its site, and whether a process that the first one started made it."""
        count, root = self.number("count"), self.number("root")
        assert count <= MOST_CALLS, count
        return (struct.unpack_from("%dQ" % count, self.map, AT_SITE),
                [p != root for p in struct.unpack_from("%di" % count, self.map, AT_PROCESS)])


# --- Processes and their folders ---

def environment(state, home):
    kept = {name: value for name, value in os.environ.items() if "OMP" not in name}
    return dict(kept, LD_PRELOAD=setting.library, FAULTS_STATE=state.path, FAULTS_HOME=home,
                FAULTS_OFF="no", OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1", LC_ALL="C")


def start(command, folder, state, **more):
    """In folder/work, with stdout and stderr in folder."""
    with open(folder + "/stdout", "wb") as out, open(folder + "/stderr", "wb") as err:
        return subprocess.Popen([setting.corot] + command.split(), cwd=folder + "/work",
                                env=environment(state, setting.home), stdin=subprocess.DEVNULL,
                                stdout=out, stderr=err, start_new_session=True, **more)


def end_group(pid):
    try:
        os.killpg(pid, signal.SIGKILL)
    except ProcessLookupError:
        pass


def whole(command, folder, state):
    """The outcome of one process, from its start."""
    process, hung = start(command, folder, state), []
    limit = threading.Timer(TIME_LIMIT, lambda: (hung.append(True), end_group(process.pid)))
    limit.start()
    code = process.wait()
    limit.cancel()
    end_group(process.pid)  # children that outlive it, too
    return read_outcome(folder, "hangs" if hung else code)


def read(path):
    with open(path, "rb") as f:
        return f.read()


def read_outcome(folder, code):
    return Outcome(code, read(folder + "/stdout"), read(folder + "/stderr"),
                   read_tree(folder + "/work"))


def read_tree(folder):
    tree, beyond = {}, len(folder) + 1
    for where, _, files in os.walk(folder):
        for file in files:
            path = where + "/" + file
            if not os.path.islink(path):  # a name for a run that was not made
                tree[path[beyond:]] = read(path)
    return tree


def renew(folder, tree):
    """A folder with what `tree` says in folder/work."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder + "/work")
    for name, text in tree.items():
        path = folder + "/work/" + name
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "wb") as f:
            f.write(text)


# --- What a case is without a failure ---

Fixture = collections.namedtuple("Fixture", "before plain")


def first_tree():
    texts = {"model.yaml": MODEL, "study.yaml": STUDY, "theirs.txt": "keep\n",
             "out/report.html": "keep\n", "out/result.json": "keep\n"}
    return {name: text.encode() for name, text in texts.items()}


def cut_tree(name, state):
    """What a case leaves when it fails half-way, and has a checkpoint by then."""
    begun, folder = fixture(name).before, setting.folder + "/again"
    renew(folder, begun)
    state.reset(RECORD, "io")
    whole(CASES[name].command, folder, state)
    for k in range(state.number("count") // 2, state.number("count")):
        renew(folder, begun)
        state.reset(FAIL, "io", k)
        o = whole(CASES[name].command, folder, state)
        if o.code and any(n.endswith("/checkpoint.bin") for n in o.tree):
            return o.tree
    raise AssertionError("no failure leaves a checkpoint")


@functools.lru_cache(None)
def fixture(name):
    case = CASES[name]
    state = State(setting.folder + "/state")
    if case.cut:
        before = cut_tree(case.before, state)
    else:
        before = fixture(case.before).plain.tree if case.before else first_tree()
    renew(setting.folder + "/again", before)
    state.reset(OFF)
    plain = whole(case.command, setting.folder + "/again", state)
    assert plain.code == case.code, (name, plain.code, plain.err)
    return Fixture(before, plain)


# --- Judgement ---

def is_result(name):
    """What a run said, which may stay, the lock of one that crashed, and a pilot's piece of a run are
    none."""
    return (os.path.basename(name) not in ("messages.txt", ".lock-run", ".lock")
            and "/pilot/" not in name)


def content(tree, name):
    """What a pilot took is not known where it failed. How often a run went on does not matter."""
    text = tree.get(name)
    if text and os.path.basename(name) == "result.json":
        return re.sub(rb'"resumed": \d+', b"", text)
    if text and os.path.basename(name) == "study.json":
        return re.sub(rb'"cost": \{[^{}]*\}', b"", text)
    return text


def differences(a, b):
    return sorted(n for n in a.keys() | b.keys()
                  if content(a, n) != content(b, n) and is_result(n) and not is_leftover(n, a, b))


def is_leftover(name, *trees):
    """A checkpoint beside the result of a run that is over, which could not be removed."""
    result = os.path.dirname(name) + "/result.json"
    return os.path.basename(name) == "checkpoint.bin" and all(is_ok(t.get(result)) for t in trees)


def is_ok(text):
    try:
        return json.loads(text).get("status") == "ok"
    except (TypeError, ValueError, AttributeError):
        return False


def judge_failure(case, kind, before, plain, o):
    """Of what ended with a message: what is wrong with it and with what it left."""
    wrong = []
    if not o.err.strip():
        wrong.append("exit code %s without a message" % o.code)
    # 5: the system refused; 1: some of several runs failed; 3: a scenario cannot be read
    if o.code not in (5,) + (1,) * case.several + (3,) * (kind == "io"):
        wrong.append("exit code %s" % o.code)
    return wrong + judge_rest(case, before, plain, o)


def judge_rest(case, before, plain, o):
    """What says "ok" though it should not."""
    wrong = []
    for name, text in o.tree.items():
        if os.path.basename(name) != "result.json" or not is_ok(text) or before.get(name) == text:
            continue
        folder = os.path.dirname(name) + "/"
        part = {n for n in plain.tree if n.startswith(folder) and "timed/" not in n[len(folder):]
                and is_result(n)}
        may_lack = ("timings.json", "report.html")
        different = [n for n in part if n in o.tree and content(o.tree, n) != content(plain.tree, n)
                     or n not in o.tree and os.path.basename(n) not in may_lack]
        if not case.several and b"standard output" in o.err:
            if differences(o.tree, plain.tree):  # it was complete before that failed
                wrong.append("standard output failed, and other files")
        elif not case.several and o.code > 0:
            wrong.append("exit code %s beside ok in %s" % (o.code, name))
        elif different:
            wrong.append("ok in %s beside other files: %s" % (name, ", ".join(different)))
    return wrong


def essence(tree):
    """A digest of what can matter to another process: why a run failed is but a text to it."""
    kept = {name: text for name, text in tree.items() if is_result(name)}
    for name, text in kept.items():
        if os.path.basename(name) in ("result.json", "failure.json"):
            if b'"status": "ok"' not in text:
                kept[name] = re.sub(rb'"reason": ".*"', b"", text)
    return digest(kept)


def judge_repair(case, plain, o):
    key = case.command, essence(o.tree)
    if key not in setting.repaired:
        renew(setting.folder + "/again", o.tree)
        setting.again.reset(OFF)
        again = whole(case.command, setting.folder + "/again", setting.again)
        wrong = []
        if again.code != case.code:
            wrong = ["not repaired: exit code %s: %s" % (again.code, again.err[:200])]
        elif differences(again.tree, plain.tree):
            wrong = ["not repaired: " + ", ".join(differences(again.tree, plain.tree))]
        setting.repaired[key] = wrong
    return setting.repaired[key]


def judge(name, kind, o, crash):
    """What is wrong with an outcome: a list of sentences. Whether a crash is excused: see above."""
    case = CASES[name]
    before, plain = fixture(name)
    wrong = ["%s was changed" % n for n in before
             if n.startswith(("model", "study", "box", "theirs", "out/re")) and o.tree.get(n) != before[n]]
    if o.code == "hangs":
        return wrong + ["it hangs"]
    if o.code in (0, case.code):
        different = differences(o.tree, plain.tree)
        if different or o.code != case.code:
            wrong.append("exit code %s, and other bytes in %s" % (o.code, ", ".join(different)))
        if o.out != plain.out:
            wrong.append("exit code %s, and another stdout" % o.code)
        return wrong
    excused = is_foreign(crash)
    if crash and not excused:
        wrong.append("a crash in corot itself")
    if (o.code < 0 or b"killed by signal" in o.err) and not TOLD.search(o.err):
        wrong.append("killed by a signal without a message")
    if o.code < 0:
        wrong += judge_rest(case, before, plain, o)
    else:
        wrong += judge_failure(case, kind, before, plain, o)
    return wrong + judge_repair(case, plain, o)


def blamed(crash):
    """The innermost frame of a crash that is not the C library's, nor of what fails the calls."""
    for frame in crash.strip().split("\n")[1:]:
        if not re.match(r"libc\.so|libc-|ld-|libpthread|libfaults|linux-vdso|libgcc_s|\?", frame):
            return frame
    return ""


def culprit(crash):
    """The innermost function of a library that crashed, and the library."""
    frames = crash.strip().split("\n")[1:]
    inner = blamed(crash)
    library = inner.split("+")[0]
    for frame in frames[frames.index(inner):]:
        module, _, function = re.match(r"([^+]*)(\+0x[0-9a-f]+)? ?(.*)", frame).groups()
        if module != library or function:
            return function if module == library else "?", library
    return "?", library


def is_foreign(crash):
    frame = blamed(crash)
    return bool(frame) and not frame.startswith("corot+")


def digest(tree):
    h = hashlib.blake2b()
    for name in sorted(tree):
        h.update(b"%d %s %d " % (len(name), name.encode(), len(tree[name])))
        h.update(tree[name])
    return h.digest()


# --- Trials ---

Trial = collections.namedtuple("Trial", "name kind k code err where crash wrong")


def key_of(o, crash, inner):
    """Outcomes of one key are judged alike."""
    words = [word in o.err for word in (b"standard output", b"killed by signal")]
    words.append(bool(TOLD.search(o.err)))
    where = crash and blamed(crash) if inner else is_foreign(crash)
    said = digest({"": o.out}), bool(o.err.strip()), tuple(words)
    return inner, o.code, said, essence(o.tree), where


def judge_once(name, kind, k, o, crash, inner):
    key = (name, kind) + key_of(o, crash, inner)
    if key in setting.judged:
        return o, crash, setting.judged[key]
    if inner:
        o, crash = whole_trial(name, kind, k)
    setting.judged[key] = judge(name, kind, o, crash)
    return o, crash, setting.judged[key]


def whole_trial(name, kind, k):
    """The K-th call fails in a program that begins anew."""
    folder = setting.folder + "/again"
    renew(folder, fixture(name).before)
    setting.again.reset(FAIL, kind, k)
    o = whole(CASES[name].command, folder, setting.again)
    return o, setting.again.crash


def try_whole(task):
    name, kind, k = task
    o, crash = whole_trial(name, kind, k)
    where, fired = setting.again.where, setting.again.number("fired")
    wrong = judge(name, kind, o, crash)
    if not fired:
        wrong = wrong + ["the call was never made"]
    return [Trial(name, kind, k, o.code, o.err, where, crash, wrong)]


def next_report(process, reports):
    """What the server says of a trial, or None when it is over; what hangs is ended."""
    hung, state = False, setting.state
    while not select.select([reports], [], [], TIME_LIMIT)[0]:
        hung = True
        end_group(state.number("trial") or process.pid)
    report = os.read(reports, 24)
    if not report:
        return None
    k, ended, inner = struct.unpack("3q", report)
    code = -os.WTERMSIG(ended) if os.WIFSIGNALED(ended) else os.WEXITSTATUS(ended)
    return k, "hangs" if hung else code, inner


def serve(task):
    """The trials of one server."""
    name, kind, ks = task
    folder, state, trials = setting.folder, setting.state, []
    renew(folder + "/main", fixture(name).before)
    shutil.rmtree(folder + "/trial", ignore_errors=True)
    state.reset(SERVE, kind, 0, ks)
    reports, to_driver = os.pipe()
    from_driver, answers = os.pipe()
    os.dup2(to_driver, TO_DRIVER)
    os.dup2(from_driver, FROM_DRIVER)
    process = start(CASES[name].command, folder + "/main", state, pass_fds=(TO_DRIVER, FROM_DRIVER))
    for fd in (to_driver, from_driver, TO_DRIVER, FROM_DRIVER):
        os.close(fd)
    for k, code, inner in iter(lambda: next_report(process, reports), None):
        where, crash = state.where, state.crash
        o = read_outcome(folder + "/trial", code)
        shutil.rmtree(folder + "/trial")
        o, crash, wrong = judge_once(name, kind, k, o, crash, bool(inner))
        trials.append(Trial(name, kind, k, o.code, o.err, where, crash, wrong))
        os.write(answers, bytes(8))
    process.wait()
    os.close(reports)
    os.close(answers)
    o, plain = read_outcome(folder + "/main", process.returncode), fixture(name).plain
    different = differences(o.tree, plain.tree)
    if (o.code, o.out, len(trials)) != (plain.code, plain.out, len(ks)) or different:
        wrong = ["the server was disturbed: code %s, %d of %d trials, %s: %s" % (
            o.code, len(trials), len(ks), different, o.err[:300])]
        trials.append(Trial(name, kind, 0, o.code, o.err, "", "", wrong))
    return trials


def list_calls(task):
    name, kind = task
    renew(setting.folder + "/again", fixture(name).before)
    setting.again.reset(RECORD, kind)
    o = whole(CASES[name].command, setting.folder + "/again", setting.again)
    plain = fixture(name).plain
    assert o.code == plain.code and o.out == plain.out and not differences(o.tree, plain.tree), \
        "%s: the same command twice differs: %s" % (name, differences(o.tree, plain.tree))
    sites, inner = setting.again.calls()
    return name, kind, sites, sum(inner)


setting = argparse.Namespace()


def begin(folder):
    """Of each worker."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    setting.folder = "%s/w%d" % (folder, os.getpid())
    os.makedirs(setting.folder)
    setting.state = State(setting.folder + "/state")
    setting.again = State(setting.folder + "/state-again")


def choose(listed, seed):
    """Rounds of trials, as they are worth: (round, part of it, name, kind, calls)."""
    chunks, known = [], set()
    for name, kind, sites, _ in listed:
        of = collections.defaultdict(list)
        for k, site in enumerate(sites, 1):
            of[site].append(k)
        others = list(range(1, len(sites) + 1))
        random.Random("%s %s %s" % (seed, name, kind)).shuffle(others)
        rounds = [[ks[-1] for site, ks in of.items() if site not in known],
                  [ks[-1] for ks in of.values()], [ks[0] for ks in of.values()],
                  [ks[len(ks) // 2] for ks in of.values()], others]
        known.update(of)
        done = set()
        for i, ks in enumerate(rounds):
            ks = [k for k in ks if k not in done]
            done.update(ks)
            parts = -(-len(ks) // CHUNK)
            for part in range(parts):
                chunks.append((i, part / parts, name, kind, sorted(ks[part::parts])))
    return sorted(chunks)


def symbols(where):
    """A back-trace with the names of corot's own functions."""
    lines = where.strip().split("\n")
    addresses = [m.group(1) for m in (re.match(r"corot\+(0x[0-9a-f]+)", l) for l in lines) if m]
    if not addresses or not shutil.which("addr2line"):
        return lines
    before = ["0x%x" % (int(a, 16) - 1) for a in addresses]
    said = subprocess.run(["addr2line", "-f", "-e", setting.corot] + before, capture_output=True,
                          text=True).stdout
    names = iter(said.split("\n")[::2])
    return [next(names, "?") if l.startswith("corot+") else l for l in lines]


def read_options():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    for word in ("corot", "library", "folder"):
        parser.add_argument(word)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--seconds", type=float, default=85)
    parser.add_argument("--jobs", type=int, default=min(2, len(os.sched_getaffinity(0))))
    parser.add_argument("--only", action="append", choices=list(CASES))
    parser.add_argument("--kind", choices=list(KINDS))
    parser.add_argument("--at", type=int)
    parser.add_argument("--seed", default="1")
    return parser.parse_args()


def choose_folder(folder):
    """In memory where there is room: a trial makes and removes dozens of files and folders. What a
    run that was killed has left is removed by the next."""
    memory = "/dev/shm"
    try:
        room = os.statvfs(memory)
        if room.f_bavail * room.f_frsize > 40e6:
            mark = hashlib.blake2b(folder.encode(), digest_size=6).hexdigest()
            quick = "%s/corot-faults-%d-%s" % (memory, os.getuid(), mark)
            shutil.rmtree(quick, ignore_errors=True)
            os.mkdir(quick, 0o700)
            return quick
    except OSError:
        pass
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    return folder


class Report:
    def __init__(self):
        self.failed, self.tried = collections.OrderedDict(), collections.defaultdict(set)
        self.outcomes, self.crashes = collections.Counter(), collections.Counter()

    def add(self, t):
        self.tried[t.name, t.kind].add(t.k)
        if t.wrong:
            self.failed.setdefault("%s: %s" % (t.name, "; ".join(t.wrong)), []).append(t)
        what = "equal bytes" if t.code == CASES[t.name].code else "a message"
        self.outcomes["FAILED" if t.wrong else what] += 1
        if is_foreign(t.crash):
            self.crashes[culprit(t.crash)] += 1

    def show(self, listed, complete):
        everything, reached = set(), set()
        for name, kind, sites, inner in listed:
            tried = self.tried[name, kind]
            covered = {sites[k - 1] for k in tried if k}
            everything.update(sites)
            reached.update(covered)
            complete = complete and len(covered) == len(set(sites))
            print("%-13s %-5s %6d calls, %5d of them of children, of %4d sites; "
                  "tried %6d calls of %4d sites" %
                  (name, kind, len(sites), inner, len(set(sites)), len(tried), len(covered)))
        print("%d trials at %d of %d sites (a site may occur in several commands): %s" % (
            sum(self.outcomes.values()), len(reached), len(everything),
            ", ".join("%d %s" % (n, what) for what, n in self.outcomes.items())))
        for (function, library), n in self.crashes.most_common():
            print("%d crashes in %s of %s, %s" % (n, function, library, KNOWN_CRASHES.get(
                function, "which is NEW: add it to KNOWN_CRASHES")))
        for function, why in KNOWN_CRASHES.items():
            if complete and function not in {f for f, _ in self.crashes}:
                print("never seen: the crash in %s, which %s" % (function, why))
        for what, trials in self.failed.items():
            print("FAILED (%d times) %s" % (len(trials), what))
            for t in trials[:2]:
                print("  --only %s --kind %s --at %d: code %s, stderr: %s" % (
                    t.name, t.kind, t.k, t.code, t.err.decode("utf-8", "replace")[:300].strip()))
                print("    " + "\n    ".join(symbols(t.where)[:14]))
                if t.crash:
                    print("   crash:\n    " + "\n    ".join(symbols(t.crash)[:8]))


def main():
    a, began = read_options(), time.monotonic()
    setting.corot, setting.library = os.path.abspath(a.corot), os.path.abspath(a.library)
    folder = choose_folder(os.path.abspath(a.folder))
    try:
        report = try_all(a, folder, began)
    finally:
        shutil.rmtree(folder)
    print("%.0f s" % (time.monotonic() - began))
    return 1 if report.failed else 0


def try_all(a, folder, began):
    setting.folder, setting.home = folder + "/first", folder + "/home"
    os.makedirs(setting.folder)
    renew(setting.home, first_tree())
    tasks = [(name, kind) for name in a.only or CASES for kind in ([a.kind] if a.kind else KINDS)]
    for name, _ in tasks:
        fixture(name)  # before the workers begin, which share it
    report, fork = Report(), multiprocessing.get_context("fork")
    with fork.Manager() as manager:
        setting.repaired, setting.judged = manager.dict(), manager.dict()
        with fork.Pool(a.jobs, begin, (folder,)) as pool:
            listed = pool.map(list_calls, tasks, 1)
            if a.at:
                results = pool.imap(try_whole, [task + (a.at,) for task in tasks])
            else:
                results = serve_all(pool, choose(listed, a.seed), a, began)
            for trials in results:
                for t in trials:
                    report.add(t)
                    if a.at:
                        print("code %s: %s" % (t.code, t.err.decode("utf-8", "replace")))
                        print(*symbols(t.where), "crash:", *symbols(t.crash), sep="\n")
    report.show(listed, not (a.only or a.kind or a.at))
    return report


def serve_all(pool, chunks, a, began):
    """Results of a few servers at a time, so that it can end when its time is over."""
    waiting = collections.deque()
    for _, _, name, kind, ks in chunks:
        if not a.all and time.monotonic() - began > a.seconds:
            break
        waiting.append(pool.apply_async(serve, ((name, kind, ks),)))
        if len(waiting) > a.jobs:
            yield waiting.popleft().get()
    while waiting:
        yield waiting.popleft().get()


if __name__ == "__main__":
    sys.exit(main())

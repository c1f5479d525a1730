"""Fails one call after another of corot's whole process, and judges what comes of it.

usage: driver.py COROT LIBRARY FOLDER [--all] [--trials N] [--seconds S] [--jobs N] [--only CASE]
                 [--kind KIND] [--at K] [--seed N]

Of each command on a tiny scenario each allocation (kind "alloc") and each call that reads, writes,
lists, locks or starts something (kind "io") is refused once: libraries and children included, see
faults.c. Accepted are but two outcomes:

  * exit code 0, and every file (and stdout) has the bytes it has without a failure;
  * a non-zero exit code, a message on stderr, no result on the disk that says "ok" though it is not
    what it would be without; and the same command, once more, repairs everything.

Nothing may crash or hang, and what was there before stays as it was.

By default calls are failed of different places in the program (by their back-traces): the first and
the last call of each, N of them in an order that --seed gives, as far as S seconds allow; --all fails
every single call. --at K fails the K-th call of
one case and says what happened.
"""
import argparse, collections, json, mmap, multiprocessing, os, random, re, shutil, signal, struct
import subprocess, sys, time

KINDS = {"alloc": 1, "io": 2}
MOST_SITES, WHERE = 1 << 17, 8192
STATE_SIZE = 4 * 8 + WHERE + 8 * MOST_SITES  # as in faults.c
TIME_LIMIT = 60  # for what hangs: a trial takes less than a second

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

# Each: what has been done before (a case, or nothing), the command, and whether an "ok" beside a
# failure is one of several runs, of which others may have failed.
Case = collections.namedtuple("Case", "before command several")
CASES = {
    "run": Case(None, "run model.yaml -o out/run --quiet", False),
    "static": Case(None, "static model.yaml -o out/static --quiet", False),
    "check": Case(None, "check model.yaml", False),
    "mesh-box": Case(None, "mesh box --size 0.1,0.1,0.2 --cells 1,1,2 -o box.msh", False),
    "mesh-info": Case("mesh-box", "mesh info box.msh", False),
    "run-again": Case("run", "run model.yaml -o out/run --quiet", False),
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
}

# Libraries that crash where memory fails, and corot cannot help it: a pattern in the back-trace of
# the refused call, and why. Only a crash is excused, never a wrong answer.
KNOWN_CRASHES = [
    (r"libfyaml\S* fy_parse_input_append",
     "libfyaml 0.7.12 uses an input it could not allocate (fy_parse_input_append)"),
    (r"libsundials\S* ARKodeButcherTable_Load",
     "SUNDIALS 6.4 fills a table it could not allocate (ARKodeButcherTable_LoadDIRK)"),
    (r"libsundials\S* SUNLogger_Create",
     "SUNDIALS 6.4 uses a logger it could not allocate (SUNLogger_Create)"),
    (r"libsundials\S* N_VClone",
     "SUNDIALS 6.4 uses the clone of a vector it could not allocate (N_VClone)"),
]

Outcome = collections.namedtuple("Outcome", "code out err fired where tree")


class Place:
    """A folder of one worker, in which trials take place one after the other."""

    def __init__(self, corot, library, folder):
        self.corot, self.library, self.root = corot, library, folder
        self.work = os.path.join(folder, "work")
        self.fixture = {}  # case: (the folder before it, its tree, the outcome without a failure)
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(folder)
        with open(os.path.join(folder, "state"), "wb") as f:
            f.truncate(STATE_SIZE)
        self.file = open(os.path.join(folder, "state"), "r+b")
        self.state = mmap.mmap(self.file.fileno(), STATE_SIZE)

    def run(self, command, kind, at, folder=None):
        self.state[: 32 + WHERE] = struct.pack("4q", KINDS.get(kind, 0), at, 0, 0) + bytes(WHERE)
        environment = {name: value for name, value in os.environ.items() if "OMP" not in name}
        environment.update(LD_PRELOAD=self.library, FAULTS_STATE=os.path.join(self.root, "state"),
                           OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1", LC_ALL="C")
        process = subprocess.Popen([self.corot] + command.split(), cwd=folder or self.work, env=environment,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, start_new_session=True)
        try:
            out, err = process.communicate(timeout=TIME_LIMIT)
            code = process.returncode
        except subprocess.TimeoutExpired:
            code = "hangs"
        finally:
            try:
                os.killpg(process.pid, signal.SIGKILL)  # children that outlive it, too
            except ProcessLookupError:
                pass
        if code == "hangs":
            out, err = process.communicate()
        fired = struct.unpack_from("q", self.state, 24)[0]
        where = bytes(self.state[32 : 32 + WHERE]).split(b"\0")[0].decode("utf-8", "replace")
        return Outcome(code, out, err, fired, where, read_tree(folder or self.work))

    def sites(self):
        count = struct.unpack_from("q", self.state, 16)[0]
        assert count <= MOST_SITES, count
        return struct.unpack_from("%dQ" % count, self.state, 32 + WHERE)

    def prepare(self, name):
        """What a case begins with, and what comes of it where nothing fails."""
        if name in self.fixture:
            return self.fixture[name]
        case = CASES[name]
        before = os.path.join(self.root, "before-" + name)
        self.renew(before, None)
        if case.before:
            self.prepare(case.before)
            self.renew(self.work, self.fixture[case.before][0])
            self.run(CASES[case.before].command, None, 0)
            self.renew(before, self.work)
        else:
            for file, text in ("model.yaml", MODEL), ("study.yaml", STUDY), ("theirs.txt", "keep\n"), \
                    ("out/report.html", "keep\n"), ("out/result.json", "keep\n"):
                path = os.path.join(before, file)
                os.makedirs(os.path.dirname(path), exist_ok=True)
                open(path, "w").write(text)
        self.renew(self.work, before)
        plain = self.run(case.command, None, 0)
        assert plain.code == 0, (name, plain.code, plain.err)
        self.fixture[name] = before, read_tree(before), plain
        return self.fixture[name]

    @staticmethod
    def renew(folder, source):
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(source, folder) if source else os.makedirs(folder)


def read_tree(folder):
    tree = {}
    for where, _, files in os.walk(folder):
        for file in files:
            path = os.path.join(where, file)
            tree[os.path.relpath(path, folder)] = open(path, "rb").read()
    return tree


def differences(a, b):
    """Of results: what a run said, which may stay in messages.txt, is not one."""
    return sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name)
                  and os.path.basename(name) != "messages.txt")


def is_ok(text):
    try:
        return json.loads(text).get("status") == "ok"
    except (ValueError, AttributeError):
        return False


def judge_failure(case, before, plain, o):
    """Of what ended with a message: what is wrong with what it left."""
    wrong = []
    if not o.err.strip():
        wrong.append("exit code %s without a message" % o.code)
    if o.code not in (1, 2, 3, 4, 5):
        wrong.append("exit code %s" % o.code)
    for name, text in o.tree.items():
        if os.path.basename(name) != "result.json" or not is_ok(text) or before.get(name) == text:
            continue
        folder = os.path.dirname(name) + "/"
        part = {n for n in plain.tree if n.startswith(folder) and "timed/" not in n[len(folder):]
                and os.path.basename(n) != "messages.txt"}
        different = [n for n in part if n in o.tree and o.tree[n] != plain.tree[n] or n not in o.tree
                     and os.path.basename(n) not in ("timings.json", "report.html")]
        if not case.several and b"standard output" in o.err:
            if differences(o.tree, plain.tree):  # it was complete before that failed
                wrong.append("standard output failed, and other files")
        elif not case.several:
            wrong.append("exit code %s beside ok in %s" % (o.code, name))
        elif different:
            wrong.append("ok in %s beside other files: %s" % (name, ", ".join(different)))
    return wrong


def judge(place, name, o):
    """What is wrong with an outcome: a list of sentences."""
    case = CASES[name]
    before, tree, plain = place.prepare(name)
    wrong = ["%s was changed" % n for n in tree if n.startswith(("model", "study", "theirs", "out/re"))
             and o.tree.get(n) != tree[n]]
    if o.code == "hangs":
        return wrong + ["it hangs"]
    if o.code < 0:
        return wrong + ["killed by signal %d" % -o.code]
    if o.code == 0:
        different = differences(o.tree, plain.tree)
        if different:
            wrong.append("exit code 0, and other bytes in " + ", ".join(different))
        if o.out != plain.out:
            wrong.append("exit code 0, and another stdout")
        return wrong
    wrong += judge_failure(case, tree, plain, o)
    again = place.run(case.command, None, 0)
    if again.code != 0:
        wrong.append("not repaired: exit code %s: %s" % (again.code, again.err[:200]))
    elif differences(again.tree, plain.tree):
        wrong.append("not repaired: " + ", ".join(differences(again.tree, plain.tree)))
    return wrong


def known(name, o, wrong):
    """A crash in one of several runs is booked as that run's failure, which is not tried again."""
    where, booked = o.where, CASES[name].several and o.code == 1 and b"killed by signal 11" in o.err
    if not booked and any(not w.startswith("killed by signal") for w in wrong):
        return None
    return next((why for pattern, why in KNOWN_CRASHES if re.search(pattern, where)), None)


def try_one(task):
    name, kind, k = task
    before = place.prepare(name)[0]
    place.renew(place.work, before)
    o = place.run(CASES[name].command, kind, k)
    wrong = judge(place, name, o)
    if o.fired == 0:
        wrong.append("the call was never made") if o.code != 0 else None
    return task, o._replace(tree=None), wrong


def list_sites(task):
    name, kind = task
    before, _, plain = place.prepare(name)
    place.renew(place.work, before)
    o = place.run(CASES[name].command, kind, 0)
    sites = place.sites()
    steady = o.code == 0 and not differences(o.tree, plain.tree) and o.out == plain.out
    return name, kind, sites, steady, differences(o.tree, plain.tree)


def start(corot, library, folder):
    global place
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    place = Place(corot, library, os.path.join(folder, "w%d" % os.getpid()))


def symbols(corot, where):
    """The back-trace with the names of corot's own functions."""
    lines = where.strip().split("\n")
    addresses = [m.group(1) for m in (re.match(r"corot\+(0x[0-9a-f]+)", l) for l in lines) if m]
    if not addresses or not shutil.which("addr2line"):
        return lines
    names = iter(subprocess.run(["addr2line", "-f", "-e", corot] + ["0x%x" % (int(a, 16) - 1) for a in addresses],
                                capture_output=True, text=True).stdout.split("\n")[::2])
    return [next(names, "?") if l.startswith("corot+") else l for l in lines]


def choose(listed, seed, everything):
    """Of each place the first call and the last, in a random order that gives each case its part."""
    chosen = []
    for name, kind, sites, _, _ in listed:
        if everything:
            ks = list(range(1, len(sites) + 1))
        else:
            first, last = {}, {}
            for k, site in enumerate(sites, 1):
                first.setdefault(site, k)
                last[site] = k
            ks = sorted(set(first.values()) | set(last.values()))
        random.Random("%s %s %s" % (seed, name, kind)).shuffle(ks)
        chosen += [(i / len(ks), (name, kind, k)) for i, k in enumerate(ks)]
    return [task for _, task in sorted(chosen)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for word in ("corot", "library", "folder"):
        parser.add_argument(word)
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--trials", type=int, default=800)
    parser.add_argument("--seconds", type=float, default=100)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--only", action="append", choices=list(CASES))
    parser.add_argument("--kind", choices=list(KINDS))
    parser.add_argument("--at", type=int)
    parser.add_argument("--seed", default="1")
    a = parser.parse_args()
    folder, began = os.path.abspath(a.folder), time.monotonic()
    corot, library = os.path.abspath(a.corot), os.path.abspath(a.library)
    shutil.rmtree(folder, ignore_errors=True)
    kinds = [a.kind] if a.kind else list(KINDS)
    cases = a.only or list(CASES)
    failed, excused, tried = collections.OrderedDict(), collections.Counter(), collections.Counter()
    outcomes = collections.Counter()
    with multiprocessing.Pool(a.jobs, start, (corot, library, folder)) as pool:
        listed = pool.map(list_sites, [(name, kind) for name in cases for kind in kinds], 1)
        for name, kind, sites, steady, different in listed:
            if not steady:
                failed["%s: the same command twice differs: %s" % (name, different)] = []
        tasks = choose(listed, a.seed, a.all)
        possible = len(tasks)
        tasks = tasks if a.all else tasks[: a.trials]
        if a.at:
            tasks = [(name, kind, a.at) for name in cases for kind in kinds]
        # A batch at a time, so that it can end when its time is over.
        for i in range(0, len(tasks), 16 * a.jobs):
            if not a.all and time.monotonic() - began > a.seconds:
                break
            for (name, kind, k), o, wrong in pool.imap_unordered(try_one, tasks[i : i + 16 * a.jobs]):
                tried[name, kind] += 1
                outcomes["equal bytes" if o.code == 0 else "a message"] += not wrong
                if a.at:
                    print(o.code, o.err.decode(), *symbols(corot, o.where), sep="\n")
                why = wrong and known(name, o, wrong)
                if why:
                    excused[why] += 1
                elif wrong:
                    trace = symbols(corot, o.where)
                    failed.setdefault("%s: %s" % (name, "; ".join(wrong)), []).append(
                        (kind, k, o.code, o.err.decode("utf-8", "replace"), trace))
    for name, kind, sites, _, _ in listed:
        print("%-13s %-5s %6d calls, %5d places, %5d tried" %
              (name, kind, len(sites), len(set(sites)), tried[name, kind]))
    print("%d of %d possible trials: %s" % (sum(tried.values()), possible,
                                   ", ".join("%d %s" % (n, what) for what, n in outcomes.items())))
    for why, n in excused.items():
        print("known, not corot's: %d crashes: %s" % (n, why))
    for what, trials in failed.items():
        print("FAILED (%d times) %s" % (len(trials), what))
        for kind, k, code, err, trace in trials[:2]:
            print("  --kind %s --at %d: code %s, stderr: %s" % (kind, k, code, err[:300].strip()))
            print("    " + "\n    ".join(trace[:14]))
    for name in os.listdir(folder):
        shutil.rmtree(os.path.join(folder, name))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

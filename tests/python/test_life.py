"""Objects after close, without their parents, in circles and in threads; memory; arguments by chance."""
import copy
import gc
import os
import pickle
import random
import resource
import subprocess
import sys
import threading
import unittest
import weakref

import numpy as np

import corot
from common import RUBBER, deform, make_bar, make_column


def make_all():
    """One of each object, with what has to be closed for it to be of no use any more."""
    mesh = corot.Mesh.box([0.1, 0.1, 0.3], [1, 1, 3], split="kuhn")
    fine, how = mesh.refine(1, return_refinement=True)
    model = corot.Model(mesh, RUBBER, fix=corot.Fix("zmin"), gravity=[0, 0, -1])
    state, inputs = corot.State(model), corot.Inputs(model)
    integrator = corot.Integrator(state, policy={"frames": "held", "interval": 0.1})
    other = corot.State(model)
    return {
        "mesh": mesh, "fine": fine, "how": how, "model": model, "state": state, "inputs": inputs,
        "integrator": integrator, "clock": integrator.clock, "other": other,
        "pencil": corot.Pencil(other), "mass": corot.MassSolver(model), "statics": corot.Statics(model),
        "points": corot.Points(other, [0], [[0.25] * 4]),
    }


def uses(o):
    """Of each object all that it can be asked: calls that raise ClosedError after close."""
    n = 36
    u = np.zeros(n)
    f = np.zeros((16, 3))
    return {
        "mesh": [lambda: o["mesh"].x, lambda: o["mesh"].tet, lambda: o["mesh"].mid, lambda: o["mesh"].groups,
                 lambda: o["mesh"].group("zmin"), lambda: o["mesh"].order, lambda: o["mesh"].measure(),
                 lambda: o["mesh"].copy(), lambda: o["mesh"].refine(), lambda: o["mesh"].boundary(),
                 lambda: o["mesh"].nearest([0, 0, 0]), lambda: o["mesh"].locate([0, 0, 0]),
                 lambda: o["mesh"].group_nodes("n", [0]), lambda: o["mesh"].write("/nowhere/x"),
                 lambda: corot.Model(o["mesh"], RUBBER), lambda: o["mesh"].refine_marked([0]),
                 lambda: o["mesh"].locate_node(0), lambda: o["mesh"].nnode, lambda: o["mesh"].ntet,
                 lambda: o["mesh"].change_order(2), lambda: o["mesh"].face_nodes([[0, 1, 2]])],
        "how": [lambda: o["how"].nlevel, lambda: o["how"].parent, lambda: o["how"].nnode, lambda: o["how"].node,
                lambda: o["how"].ntet, lambda: o["how"].to_nodal(np.zeros((1, 3))),
                lambda: o["how"].raise_order(o["fine"]), lambda: o["how"].lower_order(o["fine"])],
        "model": [lambda: o["model"].ndof, lambda: o["model"].dof, lambda: o["model"].mass,
                  lambda: o["model"].strain, lambda: o["model"].kinks(0, 1), lambda: o["model"].horizon(0),
                  lambda: corot.State(o["model"]), lambda: corot.Inputs(o["model"]),
                  lambda: corot.statics(o["model"]), lambda: corot.modes(o["model"]),
                  lambda: corot.MassSolver(o["model"]), lambda: corot.space_error(o["model"], 0, u),
                  lambda: o["model"].mesh.x, lambda: o["model"].nbytes],
        "state": [lambda: o["state"].residual(0, u, u), lambda: o["state"].rhs(0, np.zeros(2 * n)),
                  lambda: o["state"].jvp(0, u, u, u, u), lambda: o["state"].K(0, u), lambda: o["state"].M(),
                  lambda: o["state"].energies(0, u, u), lambda: o["state"].frames,
                  lambda: o["state"].nodal(0, u), lambda: o["state"].elements(0, u),
                  lambda: o["state"].use(None), lambda: o["state"].enter(0), lambda: o["state"].stand_still(0),
                  lambda: o["state"].forces(0, u), lambda: o["state"].load_force(0), lambda: o["state"].inverted,
                  lambda: o["state"].mass_multiply(u), lambda: o["state"].update_frames(0, u),
                  lambda: o["state"].deformation(0, u), lambda: o["state"].stress_jumps(0, u),
                  lambda: corot.Integrator(o["state"]), lambda: corot.Pencil(o["state"]),
                  lambda: o["state"].nodal_motion(0, u, u), lambda: o["state"].nbytes,
                  lambda: o["state"].elastic_force(0, u), lambda: o["state"].internal_force(0, u, "polar"),
                  lambda: corot.Points(o["state"], [0], [[0.25] * 4])],
        "inputs": [lambda: o["inputs"].set_force(f), lambda: o["inputs"].set_force(None),
                   lambda: o["inputs"].set_load(0, 1), lambda: o["inputs"].set_feedback(None),
                   lambda: o["inputs"].set_path("zmin", 0, [0, 0, 0]), lambda: o["other"].use(o["inputs"]),
                   lambda: o["inputs"].set_material(0, mu=1.0), lambda: o["inputs"].nbytes,
                   lambda: corot.statics(o["model"], inputs=o["inputs"])],
        "integrator": [lambda: o["integrator"].step(1), lambda: o["integrator"].at(0), lambda: o["integrator"].u,
                       lambda: o["integrator"].advance(1), lambda: o["integrator"].statistics,
                       lambda: o["integrator"].chosen, lambda: o["integrator"].work(),
                       lambda: o["integrator"].energies(), lambda: o["integrator"].kink(),
                       lambda: o["integrator"].changed()],
        "clock": [lambda: o["clock"].stop, lambda: o["clock"].tick()],
        "pencil": [lambda: o["pencil"].assemble(0, u), lambda: o["pencil"].combine(1, 0, 0),
                   lambda: o["pencil"].factor(), lambda: o["pencil"].solve(u), lambda: o["pencil"].solver,
                   lambda: o["pencil"].statistics, lambda: o["pencil"].use("held"), lambda: o["pencil"].invalidate()],
        "mass": [lambda: o["mass"].solve(u)],
        "statics": [lambda: o["statics"].step(), lambda: o["statics"].solve(), lambda: o["statics"].u,
                    lambda: o["statics"].factor, lambda: o["statics"].critical, lambda: o["statics"].solver,
                    lambda: o["statics"].statistics, lambda: o["statics"].nbytes],
        "points": [lambda: o["points"].evaluate(0, u)],
    }


#: What goes out of use with what.
CHILDREN = {
    "mesh": (), "how": (), "model": ("state", "inputs", "integrator", "clock", "pencil", "mass", "statics", "points"),
    "state": ("integrator", "clock"), "inputs": (), "integrator": ("clock",), "clock": (), "pencil": (),
    "mass": (), "statics": (), "points": (),
}


class Closing(unittest.TestCase):
    def test_use_after_close(self):
        for name, children in CHILDREN.items():
            objects = make_all()
            objects[name].close()
            objects[name].close()
            self.assertTrue(objects[name].closed)
            repr(objects[name])
            for each in (name, *children):
                self.assertTrue(objects[each].closed)
                for i, use in enumerate(uses(objects)[each]):
                    with self.assertRaises(corot.ClosedError, msg=f"{each} {i} after {name}.close()"):
                        use()
            if children:
                with self.assertRaisesRegex(corot.ClosedError, "was closed"):
                    uses(objects)[children[0]][0]()

    def test_memory_of_c_goes_with_close(self):
        objects = make_all()
        cells = {name: weakref.ref(o._cell) for name, o in objects.items()}
        for name in reversed(list(objects)):
            objects[name].close()
        gc.collect()
        lent = {name for name, cell in cells.items() if cell() is not None}
        self.assertEqual(lent, set())

    def test_all_uses_are_of_use_before(self):
        objects = make_all()
        for name, calls in uses(objects).items():
            for use in calls:
                try:
                    use()
                except corot.ClosedError as error:
                    self.fail(f"{name}: {error}")
                except corot.Error:
                    pass  # as a solve without a factor

    def test_with(self):
        with make_column() as model, corot.State(model) as state:
            self.assertFalse(state.closed)
        self.assertTrue(state.closed)
        self.assertRaises(corot.ClosedError, model.__enter__)

    def test_parents_live_as_long_as_their_children(self):
        integrator = corot.Integrator(corot.State(make_column(gravity=[0, 0, -1])))
        gc.collect()
        self.assertGreater(abs(integrator.advance(0.1)[0]).max(), 0)
        mass = make_column().mass
        dof = make_column().dof
        gc.collect()
        self.assertTrue((mass > 0).all())
        self.assertEqual(dof.max() + 1, len(mass))

    def test_objects_go_with_their_last_reference(self):
        for name in ("mesh", "model", "state", "integrator", "statics", "inputs"):
            objects = make_all()
            reference = weakref.ref(objects[name])
            if name == "inputs":  # functions of yours that know the inputs make a circle
                inputs = objects[name]
                inputs.set_feedback(lambda t, u, v, inputs=inputs: 0 * u)
                objects["state"].use(inputs)
                del inputs
            del objects
            gc.collect()
            self.assertIsNone(reference(), name)

    def test_circles_are_taken_apart_in_the_right_order(self):
        """Under the sanitizers, or with a library that clears what it frees, a wrong order would show."""
        for _ in range(200):
            objects = make_all()
            for o in objects.values():
                o.circle = objects
        del objects, o
        gc.collect()

    def test_a_closed_parent_is_only_freed_after_its_children(self):
        model = make_column()
        state = corot.State(model)
        K, row = state.K(0, np.zeros(model.ndof)), None
        row = K.indices
        model.close()
        state.close()
        del model, state, K
        gc.collect()
        junk = [make_column(cells=(1, 1, 2)) for _ in range(20)]
        self.assertTrue(((row >= 0) & (row < 36)).all())
        del junk

    def test_no_copies(self):
        model = make_column()
        for make in (copy.copy, copy.deepcopy, pickle.dumps):
            self.assertRaisesRegex(TypeError, "memory of C", make, model)
        record = model.mesh.measure()
        self.assertEqual(pickle.loads(pickle.dumps(record)).volume, record.volume)

    def test_records(self):
        record = make_column().mesh.measure()
        self.assertEqual(record["volume"], record.volume)
        self.assertIn("volume", dict(record))
        self.assertIn("volume", dir(record))
        with self.assertRaises(AttributeError):
            record.volume = 1
        with self.assertRaisesRegex(AttributeError, "has no 'volum'; it has min, max, volume"):
            record.volum  # noqa: B018


class Threads(unittest.TestCase):
    def run_all(self, functions):
        errors = []

        def guarded(function):
            try:
                function()
            except BaseException as error:  # noqa: BLE001
                errors.append(error)
        threads = [threading.Thread(target=guarded, args=(f,)) for f in functions]
        for t in threads:
            t.start()
        for t in threads:
            t.join(120)
            self.assertFalse(t.is_alive(), "a thread hangs")
        if errors:
            raise errors[0]

    def test_two_integrators_of_one_model(self):
        model = make_bar()
        alone, _ = corot.Integrator(corot.State(model)).advance([0.5, 1.0])
        found = {}

        def integrate(i):
            found[i] = corot.Integrator(corot.State(model)).advance([0.5, 1.0])[0]
        self.run_all([lambda i=i: integrate(i) for i in range(4)])
        for u in found.values():
            np.testing.assert_array_equal(u, alone)

    def test_one_state_in_several_threads_takes_turns(self):
        model = make_column()
        state = corot.State(model)
        fields = [deform(model, seed=i) for i in range(4)]
        expected = [state.residual(0, u, v) for u, v in fields]

        def evaluate(i):
            for _ in range(300):
                np.testing.assert_array_equal(state.residual(0, *fields[i]), expected[i])
        self.run_all([lambda i=i: evaluate(i) for i in range(4)])

    def test_messages_are_of_their_thread(self):
        def fail(name):
            for _ in range(200):
                try:
                    corot.Mesh.read(f"/nowhere/{name}")
                except corot.SystemRefusedError as error:
                    if name not in str(error):
                        raise AssertionError(f"{name}: {error}") from None
        self.run_all([lambda i=i: fail(f"mesh{i}") for i in range(4)])

    def test_closing_while_another_thread_evaluates(self):
        for _ in range(10):
            model = make_bar()
            state = corot.State(model)
            integrator = corot.Integrator(state, rtol=1e-6)
            began = threading.Event()

            def integrate(integrator=integrator, began=began):
                began.set()
                try:
                    integrator.advance(5.0)
                except corot.ClosedError:
                    pass

            def close(model=model, state=state, began=began):
                began.wait()
                model.close()
                state.close()
            self.run_all([integrate, close])

    def test_a_feedback_in_two_threads(self):
        model = make_column()

        def integrate():
            state, inputs = corot.State(model), corot.Inputs(model)
            inputs.set_feedback(lambda t, u, v: -0.01 * v)
            state.use(inputs)
            corot.Integrator(state).advance(0.2)
        self.run_all([integrate] * 2)


class Memory(unittest.TestCase):
    @unittest.skipIf("libasan" in os.environ.get("LD_PRELOAD", ""), "sanitizers keep freed memory")
    def test_nothing_is_left_behind(self):
        """After some rounds that warm the allocator up, as many again may add a tenth of what one round
        holds for each: less than any object of it that would be left."""
        def once():
            objects = make_all()
            objects["state"].use(objects["inputs"])
            objects["inputs"].set_feedback(lambda t, u, v: 0 * u)
            objects["integrator"].advance(0.05)
            objects["mesh"].boundary()
            objects["mesh"].refine_marked([0], return_parent=True)
            objects["state"].matrices(0, np.zeros(36))
            corot.statics(objects["model"])
            if corot.modes_available():
                corot.modes(objects["model"], 2)
            try:
                corot.Model(objects["mesh"], corot.Material(1, 0, 1))
            except corot.InvalidError:
                pass

        def peak():
            return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
        held = sum(make_all()[k].nbytes for k in ("model", "state", "inputs"))
        for _ in range(60):
            once()
        gc.collect()
        before = peak()
        rounds = 150
        for _ in range(rounds):
            once()
        gc.collect()
        self.assertLess((peak() - before) / rounds, 0.1 * held)


class Chance(unittest.TestCase):
    """Arguments by chance: whatever comes is a result or an exception that says why, never a crash."""

    VALUES = (None, True, 0, -1, 1, 2**31, -2**63, 10**30, 0.0, -0.5, 1e-300, 1e300, float("nan"), float("inf"),
              "", "z", "zmin", "klu", "polar", "a\0b", "\udcff", b"zmin", [], [0], [[0, 0, 0]], [1, 2, 3],
              np.zeros(36), np.zeros(72), np.zeros((16, 3)), np.full(36, np.nan), np.zeros((4, 4), int),
              np.arange(3), np.zeros(36, complex), np.array(["a"]), object(), {}, {"solver": "klu"}, (1, 2),
              np.zeros(0), np.zeros((0, 3)), np.float32(1), np.int64(5), 1 + 2j, lambda *a: 0)
    FINE = (corot.Error, TypeError, ValueError, KeyError, ZeroDivisionError, OverflowError, AttributeError)

    def test_calls(self):
        chance = random.Random(int(os.environ.get("COROT_SEED", "20041")))
        for _ in range(30):
            o = make_all()
            methods = []
            for name, each in o.items():
                for attribute in dir(type(each)):
                    member = getattr(type(each), attribute)
                    if not attribute.startswith("_") and callable(member) and attribute not in (
                            "close", "write", "read", "box", "refine", "advance", "solve", "set_feedback"):
                        methods.append((name, getattr(each, attribute)))
            makers = [corot.Mesh, corot.Material, corot.Model, corot.State, corot.Inputs, corot.Points,
                      corot.Integrator, corot.Pencil, corot.Statics, corot.mark, corot.Load.traction,
                      corot.Amplitude.linear, corot.Mesh.box, corot.Motion.rotate]
            for _ in range(300):
                if chance.random() < 0.8:
                    name, call = chance.choice(methods)
                else:
                    call = chance.choice(makers)
                values = [chance.choice([*self.VALUES, *o.values()]) for _ in range(chance.randrange(5))]
                try:
                    call(*values)
                except self.FINE:
                    pass
            self.assertTrue(np.isfinite(corot.State(make_column()).residual(0, np.zeros(36), np.zeros(36))).all())

    def test_what_models_are_made_of(self):
        chance = random.Random(7)
        mesh = corot.Mesh.box([1, 1, 1], [1, 1, 1], split="kuhn")
        names = ("strain", "fix", "motion", "load", "gravity", "viscosity", "mass", "dilatation",
                 "dilatation_local", "tet_material", "hierarchy")
        good = [corot.Fix("zmin"), corot.Load.gravity(), corot.Motion.translate("zmax", [0, 0, 1]), RUBBER]
        made = 0
        for _ in range(2000):
            arguments = {chance.choice(names): chance.choice([*self.VALUES, *good])
                         for _ in range(chance.randrange(1, 3))}
            try:
                corot.Model(mesh, chance.choice([*[RUBBER] * 40, [RUBBER], *self.VALUES]), **arguments)
                made += 1
            except self.FINE:
                pass
        self.assertGreater(made, 10)

    def test_damaged_bytes_of_meshes(self):
        """corot's own readers are fuzzed in C; here, that what they say reaches Python as text."""
        import tempfile
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "bad.msh")
            with open(path, "wb") as file:
                file.write(b"$MeshFormat\n\xff\xfe\n")
            with self.assertRaises(corot.FormatError):
                corot.Mesh.read(path)


class AtTheEnd(unittest.TestCase):
    def test_whatever_is_left_at_exit(self):
        script = ("import corot\n"
                  "m = corot.Model(corot.Mesh.box([1,1,1],[1,1,1]), corot.Material(1,1,1))\n"
                  "s = corot.State(m); i = corot.Inputs(m); s.use(i)\n"
                  "i.set_feedback(lambda t, u, v: 0 * u)\n"
                  "n = corot.Integrator(s, policy={'frames': 'held', 'hook': lambda *a: False}); n.step(1)\n"
                  "x = m.mesh.x; keep = [m, s, i, n]; keep.append(keep)\n")
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()

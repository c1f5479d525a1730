"""Integrators, inputs, frames, equilibria, modes and the space error: against the program, closed forms,
and each other."""
import unittest

import numpy as np

import corot
from common import BAR, RUBBER, Folder, deform, make_bar, make_column, program_is_there


@unittest.skipUnless(program_is_there(), "COROT names no program")
class AgainstTheProgram(Folder):
    """The same library, the same steps: the same bits."""

    def compare(self, settings, scenario, start=None):
        run = corot.run(BAR / "bar.yaml", self.folder / "run", set={
            "time.end": 2, "output.states": "binary", "output.fields": "none",
            "output.space_error": False, **scenario})
        self.assertTrue(run.ok)
        with corot.Integrator(corot.State(make_bar()), **settings) as integrator:
            u, v = integrator.advance(run.states.t)
            np.testing.assert_array_equal(u, run.states.u)
            np.testing.assert_array_equal(v, run.states.v)
            self.assertEqual(integrator.statistics.nst, run.result["statistics"]["nst"])
            self.assertEqual(integrator.statistics.nfactor, run.result["statistics"]["nfactor"])
            return run, integrator.energies(), integrator.work()

    def test_the_bar(self):
        run, energies, (dissipated, external) = self.compare({}, {})
        self.assertEqual(energies.elastic, run.result["energy"]["elastic"])
        self.assertEqual((dissipated, external), (run.result["energy"]["dissipated"],
                                                  run.result["energy"]["external_work"]))

    def test_other_methods(self):
        self.compare({"method": "arkode", "rtol": 1e-3}, {"integrator.method": "arkode", "integrator.rtol": 1e-3})
        self.compare({"method": "bdf2", "step": 0.02}, {"integrator.method": "bdf2", "integrator.step": 0.02})
        self.compare({"method": "ida", "linear": "klu"}, {"integrator.method": "ida", "linear_solver.name": "klu"})

    def test_kinks_within(self):
        load = [[0, 0], [0.5, 1], [0.5, 0.25], [1.23, 0]]
        for method in ({"method": "cvode"}, {"method": "newmark", "step": 0.03}):
            words = {f"integrator.{key}": value for key, value in method.items()}
            run = corot.run(BAR / "bar.yaml", self.folder / method["method"], set={
                "time.end": 2, "output.states": "binary", "output.fields": "none",
                "output.space_error": False, "loads.0.amplitude": load, **words})
            model = make_bar(load=corot.Load.traction("top", [200, 0, 0], load))
            integrator = corot.Integrator(corot.State(model), **method)
            u, _ = integrator.advance(run.states.t)
            np.testing.assert_array_equal(u, run.states.u)

    def test_held_frames(self):
        self.compare({"policy": {"frames": "held", "interval": 0.1, "max_angle": 0.05}},
                     {"frames": '{policy: hold, interval: 0.1, max_angle: 0.05}'})

    def test_equilibrium_and_modes(self):
        run = corot.run(BAR / "bar.yaml", self.folder / "static", command="static")
        found = corot.statics(make_bar(), 40.0)
        corner = make_bar().mesh.nearest([0.1, 0.1, 0.6])
        self.assertEqual(found.u[make_bar().dof[corner]].tolist(),
                         [run.probes[f"corner.u{c}"][-1] for c in "xyz"])
        if corot.modes_available():
            run = corot.run(BAR / "bar.yaml", self.folder / "modes", command="modes", options=("-n", "3"))
            np.testing.assert_allclose(corot.modes(make_bar(), 3).frequency, run.modes["frequency"], rtol=1e-9)
            self.assertEqual(run.modes.units["frequency"], "Hz")


class Integrators(unittest.TestCase):
    def test_every_method_follows_a_fall(self):
        """A free body falls by g t^2 / 2 whatever the method; to its tolerance, or exactly."""
        mesh = corot.Mesh.box([1, 1, 1], [1, 1, 1], split="kuhn")
        model = corot.Model(mesh, corot.Material(1e3, 1e3, 10), gravity=[0, 0, -10])
        for kind in corot.methods():
            settings = {} if kind.controls_error else {"step": 0.01}
            integrator = corot.Integrator(corot.State(model), method=kind.name, **settings)
            u, v = integrator.advance(1.0)
            z = model.dof[:, 2]
            tolerance = 0.06 if kind.name in ("backward-euler", "bdf2", "bdf3") else 1e-3
            np.testing.assert_allclose(u[0, z], -5, rtol=tolerance, err_msg=kind.name)
            np.testing.assert_allclose(v[0, z], -10, rtol=tolerance, err_msg=kind.name)

    def test_steps_and_what_lies_between(self):
        model = make_bar()
        integrator = corot.Integrator(corot.State(model), rtol=1e-5)
        self.assertEqual(integrator.t, 0)
        self.assertFalse(integrator.u.any())
        while integrator.t < 0.5:
            step = integrator.step(0.5)
        self.assertEqual((step.t, integrator.t), (0.5, 0.5))
        u, v = integrator.at(0.5)
        np.testing.assert_array_equal(u, integrator.u)
        self.assertIs(integrator.u, integrator.u)
        self.assertFalse(integrator.v.flags.writeable)
        between, _ = integrator.at(0.5 - step.h / 2)
        self.assertLess(abs(between - u).max(), abs(u).max())
        out = np.empty(model.ndof), np.empty(model.ndof)
        self.assertIs(integrator.at(0.5, out)[0], out[0])
        np.testing.assert_array_equal(out[1], v)
        self.assertRaises(corot.InvalidError, integrator.at, 0.5, (out[0], out[0]))
        self.assertRaises(corot.InvalidError, integrator.at, 0.1)
        self.assertRaises(corot.InvalidError, integrator.step, 0.2)
        self.assertRaises(corot.InvalidError, integrator.step, np.nan)
        self.assertEqual(integrator.chosen.method, "cvode")
        self.assertGreater(integrator.statistics.force_s, 0)

    def test_advance_in_parts_is_advance_at_once_where_loads_have_kinks(self):
        """A stop more is a step more; the motion is the same to the tolerance, kinks at stops included."""
        load = corot.Load.traction("zmax", [100, 0, 0], [(0, 0), (0.1, 1), (0.2, 1), (0.2, 0)])
        model = make_column(load=load)
        whole, _ = corot.Integrator(corot.State(model), rtol=1e-7).advance([0.1, 0.2, 0.3])
        parts = corot.Integrator(corot.State(model), rtol=1e-7)
        pieces = [parts.advance(t)[0][0] for t in (0.1, 0.2, 0.3)]
        np.testing.assert_allclose(pieces, whole, atol=2e-5 * abs(whole).max())
        after = corot.Integrator(corot.State(model))
        after.advance(0.2)
        rest = np.zeros(model.ndof)
        self.assertFalse(after.state.residual(0.2, rest, rest).any())  # beyond the jump there is no load
        state = corot.State(model)  # who misses the jump at 0.2 s goes on under the load
        wrong = corot.Integrator(state, rtol=1e-7)
        while wrong.t < 0.3:
            wrong.step(0.3)
        self.assertGreater(abs(wrong.u - whole[-1]).max(), 1e-3 * abs(whole).max())

    def test_each_step(self):
        times, integrator = [], corot.Integrator(corot.State(make_bar()))
        integrator.advance([0.2, 0.5], each=lambda step: times.append(step.t))
        self.assertEqual(len(times), integrator.statistics.nst)
        self.assertEqual(times[-1], 0.5)

        def stop(step):
            raise KeyError("enough")
        self.assertRaises(KeyError, integrator.advance, 1.0, stop)
        self.assertGreater(integrator.advance(1.0)[0].max(), 0)

    def test_refusals(self):
        model = make_column()
        state = corot.State(model)
        with self.assertRaisesRegex(TypeError, "no setting 'rtoll'; it has method, linear, rtol"):
            corot.Integrator(state, rtoll=1)
        with self.assertRaisesRegex(TypeError, "no setting 'bytes'"):
            corot.Integrator(state, bytes=1)
        for settings in ({"method": "euler"}, {"rtol": 0.0}, {"rtol": -1}, {"method": "newmark"},
                         {"max_order": 9}, {"linear": "umfpack"}, {"tangent": "none"}, {"t": np.inf},
                         {"linear": {"solver": "klu", "ordering": "random"}}, {"u": [np.nan] * model.ndof},
                         {"u": [0]}, {"max_order": 2**40}):
            self.assertRaises(corot.InvalidError, corot.Integrator, state, **settings)
        for settings in ({"rtol": "small"}, {"max_order": 1.5}, {"method": 3}, {"max_order": True},
                         {"linear": {"solvers": "klu"}}, {"policy": {"interwal": 1}}):
            self.assertRaises(TypeError, corot.Integrator, state, **settings)
        self.assertRaises(TypeError, corot.Integrator, model)
        integrator = corot.Integrator(state)
        for times in ([], [1, 0], [np.nan], [[1, 2]], [np.inf]):
            self.assertRaises(corot.InvalidError, integrator.advance, times)
        self.assertRaises(corot.InvalidError, integrator.changed, "sometimes")
        with self.assertRaisesRegex(corot.IntegrationError, "max_steps|steps"):
            corot.Integrator(corot.State(make_bar()), max_steps=3).advance(1.0)

    def test_an_integration_that_gives_up_remains_readable(self):
        model = make_column(load=corot.Load.traction("zmax", [0, 0, -1e6]), strain="polar")
        integrator = corot.Integrator(corot.State(model))
        with self.assertRaises(corot.IntegrationError) as caught:
            integrator.advance(1.0)
        self.assertEqual(caught.exception.status, "COROT_EINTEGRATE")
        self.assertIsInstance(caught.exception, RuntimeError)
        self.assertLess(integrator.t, 1)
        self.assertTrue(np.isfinite(integrator.u).all())

    def test_solve_ivp(self):
        try:
            from scipy.integrate import solve_ivp
        except ImportError:
            self.skipTest("scipy is not installed")
        model = make_column(gravity=[0.5, 0, -9.81])
        state, n = corot.State(model), model.ndof
        ours, _ = corot.Integrator(state, rtol=1e-8).advance(0.05)
        theirs = solve_ivp(corot.State(model).rhs, (0, 0.05), np.zeros(2 * n), rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(theirs.y[:n, -1], ours[0], atol=1e-5 * abs(ours).max())

    def test_save_and_restore(self):
        model = make_bar()
        for kind in corot.methods():
            method = kind.name
            settings = {"method": method} if kind.controls_error else {"method": method, "step": 0.02}
            first = corot.Integrator(corot.State(model), **settings)
            first.advance(0.5)
            saved = first.save()
            self.assertIsInstance(saved, bytes)
            expected, _ = first.advance([0.7, 1.0])
            second = corot.Integrator(corot.State(model), **settings)
            second.restore(saved)
            self.assertAlmostEqual(second.t, 0.5)
            np.testing.assert_array_equal(second.advance([0.7, 1.0])[0], expected, method)
            first.restore(saved)
            np.testing.assert_array_equal(first.advance([0.7, 1.0])[0], expected, method)
            for wrong in (b"", saved[:20], b"x" + saved[1:], saved[:-1], saved[:99] + b"x" + saved[100:]):
                self.assertRaises(corot.Error, second.restore, wrong)

    def test_inputs_and_frames_go_along(self):
        model = make_bar()

        def start():
            state = corot.State(model)
            inputs = corot.Inputs(model)
            state.use(inputs)
            return inputs, corot.Integrator(state, policy={"frames": "held", "interval": 0.03})
        inputs, first = start()
        inputs.set_load(0, 2.0)
        self.assertRaises(corot.InvalidError, first.save)
        first.changed()
        first.advance(0.4)
        saved = first.save()
        expected, _ = first.advance([0.7, 1.0])
        _, second = start()
        second.restore(saved)
        np.testing.assert_array_equal(second.advance([0.7, 1.0])[0], expected)
        self.assertRaises(corot.InvalidError, corot.Integrator(corot.State(model)).restore, saved)


class Frames(unittest.TestCase):
    def test_a_hook_decides(self):
        asked = []

        def hook(t, u, v, drift):
            asked.append((t, drift.angle_max))
            return len(asked) % 3 == 0
        model = make_bar()
        integrator = corot.Integrator(corot.State(model), policy={"frames": "held", "hook": hook})
        events = []
        integrator.clock, clock = None, integrator.clock
        for _ in range(30):
            integrator.step(1.0)
            events.append(clock.tick().reason)
        self.assertEqual(len(asked), 30)
        self.assertEqual(events.count("by_hook"), 10)
        self.assertGreater(max(angle for _, angle in asked), 0)
        self.assertEqual(clock.stop, np.inf)

    def test_what_a_hook_raises_comes_out(self):
        def hook(t, u, v, drift):
            raise ZeroDivisionError("mine")
        integrator = corot.Integrator(corot.State(make_bar()), policy={"frames": "held", "hook": hook})
        self.assertRaisesRegex(ZeroDivisionError, "mine", integrator.advance, 0.5)
        self.assertGreater(integrator.t, 0)

    def test_policies(self):
        state = corot.State(make_bar())
        for policy in ({"frames": "held"}, {"frames": "held", "interval": -1.0}, {"frames": "some"}):
            self.assertRaises(corot.InvalidError, corot.Integrator, state, policy=policy)
        integrator = corot.Integrator(state, policy={"frames": "extrapolated", "every_step": True})
        integrator.step(1.0)
        event = integrator.clock.tick()
        self.assertEqual((event.reason, event.change.angle_tet >= 0), ("by_step", True))


class InputsOfARun(unittest.TestCase):
    def test_forces_and_loads(self):
        model = make_column(load=corot.Load.traction("zmax", [10, 0, 0]))
        state, inputs = corot.State(model), corot.Inputs(model)
        rest = np.zeros(model.ndof)
        before = state.residual(0, rest, rest)
        state.use(inputs)
        f = np.random.default_rng(0).normal(size=(model.mesh.nnode, 3))
        inputs.set_force(f)
        np.testing.assert_allclose(state.residual(0, rest, rest) - before, state.free(f), atol=1e-14)
        inputs.ramp_force(0, 0 * f, 2, f)
        np.testing.assert_allclose(state.residual(1, rest, rest) - before, state.free(f) / 2, atol=1e-14)
        inputs.set_force(None)
        inputs.set_load(0, 3.0)
        np.testing.assert_allclose(state.residual(0, rest, rest), 3 * before, atol=1e-14)
        inputs.ramp_load(0, 0, 0.0, 1, 2.0)
        np.testing.assert_allclose(state.residual(0.5, rest, rest), before, atol=1e-14)
        state.use(None)
        np.testing.assert_array_equal(state.residual(0, rest, rest), before)
        for call in (lambda: inputs.set_force(f[:-1]), lambda: inputs.set_load(1, 1.0),
                     lambda: inputs.set_load(0, np.nan), lambda: inputs.ramp_force(1, f, 1, f),
                     lambda: inputs.set_force(f * np.inf)):
            self.assertRaises(corot.InvalidError, call)
        other = corot.Inputs(make_column())
        self.assertRaises(corot.InvalidError, state.use, other)
        self.assertRaises(TypeError, state.use, "inputs")
        self.assertGreater(inputs.nbytes, 0)

    def test_materials(self):
        model = make_column()
        state, inputs = corot.State(model), corot.Inputs(model)
        u, _ = deform(model)
        rest = np.zeros(model.ndof)
        before = state.residual(0, u, rest)
        state.use(inputs)
        inputs.set_material(0, lambda_=2.0, mu=2.0)
        np.testing.assert_allclose(state.residual(0, u, rest), 2 * before, rtol=1e-12, atol=1e-10)
        inputs.reset_material(0)
        np.testing.assert_allclose(state.residual(0, u, rest), before, rtol=1e-12, atol=1e-10)
        self.assertRaises(corot.InvalidError, inputs.set_material, 0, mu=-1.0)
        self.assertRaises(corot.InvalidError, inputs.set_material, 1)

    def test_paths(self):
        model = make_column()
        state, inputs = corot.State(model), corot.Inputs(model)
        state.use(inputs)
        base = model.mesh.group("zmin").node
        inputs.set_path("zmin", 0.0, [0, 0, 0], [1, 0, 0])
        x, v = state.nodal(0.5, np.zeros(model.ndof))
        np.testing.assert_allclose(x[base], np.tile([0.5, 0, 0], (len(base), 1)))
        np.testing.assert_allclose(v[base], np.tile([1.0, 0, 0], (len(base), 1)))
        inputs.reach(0.5, "zmin", 1.0, np.tile([0.5, 0.1, 0], (len(base), 1)))
        np.testing.assert_allclose(state.nodal(1.0, np.zeros(model.ndof))[0][base][:, 1], 0.1)
        inputs.start_path("zmin", 0.0, [0, 0, 0])
        inputs.release("zmin", 0.0)
        for call in (lambda: inputs.set_path("zmin", 0, [1, 0, 0]), lambda: inputs.set_path("none", 0, [0, 0, 0]),
                     lambda: inputs.set_path("zmin", 0, np.zeros((2, 3))),
                     lambda: inputs.set_path("zmin", 0, [0, 0, 0], [[0, 0, 0]] * 2),
                     lambda: inputs.release("none", 0)):
            self.assertRaises(corot.InvalidError, call)

    def test_a_spring_of_python_against_the_closed_form(self):
        """A stiff column on a spring k at its top, that is pulled by F along z: it goes up by about F / k,
        in statics and, damped out, nowhere else. The blocks are what makes Newton's iteration square."""
        mesh = corot.Mesh.box([0.1, 0.1, 0.1], [1, 1, 1], split="kuhn")
        model = corot.Model(mesh, corot.Material(0, 1e6, 1000), fix=corot.Fix("zmin", "xy"),
                            load=corot.Load.force("zmax", [0, 0, 2.0]))
        top, k = mesh.group("zmax").node, 50.0
        inputs = corot.Inputs(model)

        def force(t, u, v):
            f = np.zeros_like(u)
            f[top] = -k * u[top]
            return f

        def blocks(t, u, v, out):
            for i in top:
                out.add(int(i), int(i), K=k * np.eye(3))
        inputs.set_feedback(force, blocks)
        found = corot.statics(model, inputs=inputs)
        z = model.dof[top, 2]
        np.testing.assert_allclose(found.u[z].sum() * k, 2.0, rtol=1e-8)
        self.assertLess(found.steps[-1].iterations, 6)
        state = corot.State(model)
        state.use(inputs)
        u, v = deform(model, 1e-3)
        x, h = np.ones(model.ndof), 1e-7
        slope = (state.residual(0, u + h * x, v) - state.residual(0, u - h * x, v)) / (2 * h)
        K = state.jvp(0, u, v, x, 0 * x)
        np.testing.assert_allclose(K, slope, atol=1e-6 * abs(slope).max())
        inputs.set_feedback(force, blocks, lambda t, u, v, du, dv: force(t, du, dv))
        np.testing.assert_allclose(state.jvp(0, u, v, x, 0 * x), K, atol=1e-9 * abs(K).max())

    def test_what_a_feedback_raises_comes_out(self):
        model = make_column()
        state, inputs = corot.State(model), corot.Inputs(model)
        state.use(inputs)
        rest = np.zeros(model.ndof)
        calls = []

        def wrong(t, u, v):
            calls.append(t)
            if len(calls) > 5:
                raise LookupError("of mine")
            return np.zeros_like(u)
        inputs.set_feedback(wrong)
        self.assertRaisesRegex(LookupError, "of mine", corot.Integrator(state).advance, 1.0)
        self.assertRaisesRegex(LookupError, "of mine", state.residual, 0, rest, rest)
        inputs.set_feedback(lambda t, u, v: np.zeros(3))
        self.assertRaisesRegex(corot.InvalidError, "what the feedback returned has the shape", state.rhs, 0,
                               np.zeros(2 * model.ndof))
        kept = []
        inputs.set_feedback(lambda t, u, v: 0 * u, lambda t, u, v, blocks: kept.append(blocks))
        state.K(0, rest)
        with self.assertRaises(corot.ClosedError):
            kept[0].add(0, 0, np.eye(3))
        inputs.set_feedback(lambda t, u, v: 0 * u, lambda t, u, v, blocks: blocks.add(0, 10**6, np.eye(3)))
        self.assertRaises(corot.InvalidError, state.K, 0, rest)

        def ask_for_less(t, u, v):
            raise corot.RetryError("too far")
        inputs.set_feedback(ask_for_less)
        self.assertRaisesRegex(corot.RetryError, "too far", state.residual, 0, rest, rest)

        def itself(t, u, v):
            return state.residual(t, rest, rest)
        inputs.set_feedback(itself)
        self.assertRaisesRegex(corot.InvalidError, "middle of an evaluation", state.residual, 0, rest, rest)
        inputs.set_feedback(lambda t, u, v: state.close())
        self.assertRaisesRegex(corot.InvalidError, "middle of an evaluation", state.residual, 0, rest, rest)
        inputs.set_feedback(None)
        self.assertTrue(np.isfinite(state.residual(0, rest, rest)).all())

    def test_windows(self):
        model = make_column()
        state, inputs = corot.State(model), corot.Inputs(model)
        state.use(inputs)
        integrator = corot.Integrator(state)
        f, old = np.zeros((model.mesh.nnode, 3)), np.zeros((model.mesh.nnode, 3))
        for window in range(1, 11):
            f = f.copy()
            f[model.mesh.group("zmax").node, 0] = 0.001 * window
            inputs.ramp_force(0.1 * (window - 1), old, 0.1 * window, f)
            integrator.changed()
            integrator.advance(0.1 * window)
            old = f
        self.assertEqual(integrator.statistics.nrestart, 0)
        self.assertGreater(integrator.u.max(), 0)


class Equilibria(unittest.TestCase):
    def test_steps(self):
        model = make_bar()
        solver = corot.Statics(model, 10.0, first_step=0.5, max_step=0.5, linear="klu")
        step = solver.step()
        self.assertEqual((step.factor, solver.factor, step.stability), (0.5, 0.5, "stable"))
        self.assertLess(step.residual[-1], 1e-9 * step.force)
        solver.solve()
        self.assertEqual(solver.factor, 1)
        self.assertIn("klu", solver.solver)
        self.assertTrue(np.isnan(solver.critical).all())
        self.assertRaises(corot.InvalidError, solver.step)
        state = corot.State(model)
        state.stand_still(10.0)
        r = state.residual(10.0, solver.u, 0 * solver.u)
        self.assertLess(abs(r).max(), 1e-9 * step.force)
        self.assertGreater(solver.nbytes, 0)
        self.assertGreater(solver.statistics.nni, 2)

    def test_refusals(self):
        model = make_bar()
        free = corot.Model(corot.Mesh.box([1, 1, 1], [1, 1, 1]), RUBBER)
        self.assertRaises(corot.SingularError, corot.statics, free)
        self.assertRaises(corot.InvalidError, corot.statics, model, tolerance=-1.0)
        self.assertRaises(TypeError, corot.statics, model, stop_data=1)
        self.assertRaises(corot.InvalidError, corot.statics, model, u0=[0.0])
        self.assertRaises(corot.InvalidError, corot.statics, model, inputs=corot.Inputs(free))
        self.assertRaises(corot.IntegrationError, corot.statics, model, 10.0, stop=lambda: True)

        def broken():
            raise OSError("mine")
        self.assertRaisesRegex(OSError, "mine", corot.statics, model, 10.0, stop=broken)

    @unittest.skipUnless(corot.modes_available(), "this corot has no ARPACK")
    def test_modes(self):
        model = make_column()
        found = corot.modes(model, 5)
        self.assertEqual((found.shape.shape, found.effective_mass.shape), ((5, model.ndof), (5, 3)))
        K, M = corot.State(model).K(0, np.zeros(model.ndof)), corot.State(model).M()
        for w2, x in zip(found.eigenvalue, found.shape):
            self.assertLess(abs(K @ x - w2 * (M @ x)).max(), 1e-7 * abs(K @ x).max())
            self.assertAlmostEqual(x @ (M @ x), 1)
        self.assertEqual(found.facts.nrigid, 0)
        for settings in ({"count": 0}, {"count": 10**6}, {"tolerance": 0.0}, {"u": [0]}):
            self.assertRaises(corot.InvalidError, corot.modes, model, **settings)
        self.assertRaises(corot.IntegrationError, corot.modes, model, 2, stop=lambda: True)
        self.assertRaises(ZeroDivisionError, corot.modes, model, 2, stop=lambda: 1 / 0)


class Linear(unittest.TestCase):
    def test_a_pencil(self):
        model = make_column()
        state = corot.State(model)
        u, v = deform(model, 0.002)
        for solver in ("auto", "klu", "pcg"):
            with corot.Pencil(state, {"solver": solver, "tolerance": 1e-13}) as pencil:
                self.assertRaises(corot.InvalidError, pencil.solve, u)
                pencil.use("exact")
                pencil.assemble(0, u, v)
                g = 0.01
                pencil.combine(1, g, g * g)
                pencil.factor()
                M, K, D = state.matrices(0, u, v)
                b = np.arange(1.0, model.ndof + 1)
                x = pencil.solve(b)
                np.testing.assert_allclose((M + g * D + g * g * K) @ x, b, atol=1e-6)
                self.assertEqual(pencil.newton(np.concatenate([b, b])).shape, (2 * model.ndof,))
                self.assertEqual(pencil.newton_dae(np.concatenate([b, b])).shape, (2 * model.ndof,))
                pencil.combine(1, g, 2 * g * g)
                pencil.factor()
                self.assertRaises(corot.InvalidError, pencil.newton, np.concatenate([b, b]))
                pencil.invalidate()
                self.assertGreaterEqual(pencil.statistics.nfactor, 2)
                self.assertTrue(pencil.solver)
        self.assertRaises(corot.InvalidError, corot.Pencil, state, "lu")

    def test_multigrid_takes_a_refinement(self):
        coarse = corot.Mesh.box([0.1, 0.1, 0.3], [1, 1, 3])
        fine, how = coarse.refine(1, return_refinement=True)
        model = corot.Model(fine, RUBBER, fix=corot.Fix("zmin"))
        state, u = corot.State(model), np.zeros(model.ndof)
        linear = {"solver": "pcg", "preconditioner": "multigrid", "refinement": how, "tolerance": 1e-12}
        pencil = corot.Pencil(state, linear)
        how.close()
        pencil.assemble(0, u)
        pencil.combine(1, 0, 1e-4)
        pencil.factor()
        b = np.ones(model.ndof)
        S = state.M() + 1e-4 * state.K(0, u)
        np.testing.assert_allclose(S @ pencil.solve(b), b, atol=1e-9)
        self.assertIn("multigrid", pencil.solver)
        for wrong in (3, coarse, "how"):
            with self.assertRaises(TypeError):
                corot.Pencil(state, {**linear, "refinement": wrong})
        with self.assertRaises(corot.ClosedError):
            corot.Pencil(state, linear)

    def test_the_space_error(self):
        model = make_bar()
        u = corot.statics(model, 40.0).u
        estimate, correction = corot.space_error(model, 40.0, u, load_t=40.0)
        self.assertAlmostEqual(estimate.relative, 0.66, 2)  # as `corot static` says of the bar
        self.assertEqual(correction.shape, (143, 3))
        indicator, total = corot.space_indicators(model, 40.0, u, load_t=40.0)
        self.assertAlmostEqual(indicator.sum(), total.energy)
        goal = np.zeros(model.ndof)
        goal[0] = 1
        indicator, total = corot.space_indicators(model, 40.0, u, goal=goal, load_t=40.0)
        self.assertAlmostEqual(indicator.sum(), total.bound)
        marks = corot.mark(indicator, 0.5)
        self.assertGreaterEqual(indicator[marks].sum(), 0.5 * indicator.sum())
        self.assertGreater(model.mesh.refine_marked(marks).ntet, 337)
        self.assertRaises(corot.InvalidError, corot.mark, indicator, 0.0)
        self.assertRaises(corot.InvalidError, corot.mark, [-1.0], 0.5)
        self.assertRaises(corot.InvalidError, corot.space_error, make_column(order=2), 0,
                          np.zeros(make_column(order=2).ndof))


if __name__ == "__main__":
    unittest.main()

"""Meshes, models and states: values against what C says elsewhere and against differences, shapes, and
all that is refused."""
import unittest

import numpy as np
import scipy.sparse

import corot
from common import BAR, RUBBER, Folder, deform, make_bar, make_column

TET = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]


class Meshes(Folder):
    def test_from_arrays_and_back(self):
        box = corot.Mesh.box([1, 2, 3], [2, 2, 2])
        mesh = corot.Mesh(box.x, box.tet)
        np.testing.assert_array_equal(mesh.x, box.x)
        np.testing.assert_array_equal(mesh.tet, box.tet)
        self.assertEqual((mesh.order, mesh.mid, len(mesh.groups)), (1, None, 0))
        quadratic = box.change_order(2)
        self.assertEqual(quadratic.mid.shape, (quadratic.ntet, 6))
        again = corot.Mesh(quadratic.x, np.hstack([quadratic.tet, quadratic.mid]))
        self.assertEqual(again.order, 2)
        self.assertAlmostEqual(again.measure().volume, 6, 12)
        self.assertEqual(again.change_order(1).nnode, box.nnode)

    def test_files_are_mended_and_written_in_other_formats(self):
        path = self.folder / "bad.msh"
        path.write_text("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
                        "9 5 5 5\n$EndNodes\n$Elements\n1\n7 4 2 1 1 1 3 2 4\n$EndElements\n")
        with self.assertRaisesRegex(corot.FormatError, "element 7 is inverted.*\n.*node 9 is in no tet"):
            corot.Mesh.read(path)
        mesh, told = corot.Mesh.read_mended(path)
        self.assertEqual((mesh.nnode, len(told)), (4, 2))
        self.assertIn("element 7", told[0])
        with self.assertRaisesRegex(corot.InvalidError, "merge is -1"):
            corot.Mesh.read_mended(path, merge=-1)
        self.assertEqual(mesh.write_as(self.folder / "m.vtu"), [])
        self.assertEqual(mesh.write_as(self.folder / "m", "medit"), [])
        np.testing.assert_array_equal(corot.Mesh.read(self.folder / "m.vtu").tet, mesh.tet)
        with self.assertRaisesRegex(corot.InvalidError, "no mesh format 'stl'"):
            mesh.write_as(path, "stl")

    def test_what_is_converted(self):
        expected = corot.Mesh(TET, [[0, 1, 2, 3]]).x
        wide = np.zeros((4, 6))
        wide[:, ::2] = TET
        for x in (TET, np.array(TET, np.float32), np.array(TET, order="F", dtype=float), wide[:, ::2],
                  np.array(TET, dtype=">f8")):
            mesh = corot.Mesh(x, np.array([[0, 1, 2, 3]], np.uint8))
            np.testing.assert_array_equal(mesh.x, expected)

    def test_what_is_refused(self):
        make, tets = corot.Mesh, [[0, 1, 2, 3]]
        for x in (np.zeros(4), np.zeros((4, 2)), np.zeros((3, 4)), [[0, 0, 0], [1, 0]]):
            self.assertRaises(corot.InvalidError, make, x, tets)
        for x in (np.array(TET) * 1j, [["a", "b", "c"]] * 4, object()):
            self.assertRaises((TypeError, corot.InvalidError), make, x, tets)
        with self.assertRaisesRegex(corot.InvalidError, "rows of 4 or of 10"):
            make(TET, [[0, 1, 2]])
        with self.assertRaisesRegex(TypeError, "whole numbers"):
            make(TET, [[0.0, 1, 2, 3]])
        with self.assertRaisesRegex(corot.InvalidError, "32 bits"):
            make(TET, [[0, 1, 2, 2**32 + 3]])
        for wrong in ([[0, 1, 2, 4]], [[0, 1, 2, -1]], [[0, 2, 1, 3]], [[0, 0, 1, 2]], np.zeros((0, 4), int)):
            self.assertRaises(ValueError, make, TET, wrong)
        self.assertRaises(corot.InvalidError, make, np.full((4, 3), np.nan), tets)
        self.assertRaises(corot.InvalidError, corot.Mesh.box, [1, 1, 0], [1, 1, 1])
        self.assertRaises(corot.InvalidError, corot.Mesh.box, [1, 1, 1], [1, 1, 1], split="half")
        self.assertRaises(TypeError, corot.Mesh.box, [1, 1, 1], [1.5, 1, 1])

    def test_files(self):
        mesh = corot.Mesh.read(BAR / "bar.msh")
        self.assertEqual((mesh.nnode, mesh.ntet), (143, 337))
        mesh.group_plane("base", 2, 0.0)
        mesh.write(self.folder / "bar.msh")
        again = corot.Mesh.read(str(self.folder / "bar.msh"))
        np.testing.assert_array_equal(again.x, mesh.x)
        np.testing.assert_array_equal(again.group("base").node, mesh.group("base").node)
        with self.assertRaises(OSError) as caught:
            corot.Mesh.read(self.folder / "none.msh")
        self.assertIsInstance(caught.exception, corot.SystemRefusedError)
        self.assertEqual(caught.exception.status, "COROT_EIO")
        (self.folder / "bad.msh").write_text("$MeshFormat\n2.2 0 8\nnonsense\n")
        with self.assertRaisesRegex(corot.FormatError, r"bad.msh:3"):
            corot.Mesh.read(self.folder / "bad.msh")
        self.assertRaises(corot.InvalidError, corot.Mesh.read, "a\0b")
        self.assertRaises(TypeError, corot.Mesh.read, 3)

    def test_groups(self):
        mesh = corot.Mesh.box([1, 1, 1], [2, 2, 2], split="kuhn")
        self.assertEqual(list(mesh.groups), ["xmin", "xmax", "ymin", "ymax", "zmin", "zmax"])
        top = mesh.group("zmax")
        self.assertEqual((top.tri.shape, top.node.shape), ((8, 3), (9,)))
        self.assertTrue((mesh.x[top.node, 2] == 1).all())
        mesh.group_nodes("nodes", top.node)
        np.testing.assert_array_equal(mesh.group("nodes").tri, top.tri)
        mesh.group_triangles("triangles", top.tri)
        mesh.group_tets("tets", [3, 1, 3])
        np.testing.assert_array_equal(mesh.group("tets").tet, [1, 3])
        mesh.group_box("box", [0, 0, 0], [0.5, 1, 1])
        self.assertEqual(len(mesh.group("box").node), 18)
        mesh.group_sphere("sphere", [0, 0, 0], 0.5)
        mesh.group_cylinder("cylinder", [0.5, 0.5, 0], [0.5, 0.5, 1], 0.1)
        mesh.group_half_space("half", [0, 0, 0.5], [0, 0, -1])
        mesh.group_normal("normal", [0, 0, 1], 0.1)
        mesh.group_near("near", "normal", 0.5)
        mesh.group_combine("both", "intersection", ["half", "near"])
        mesh.group_combine("rest", "difference", ["half", "near"])
        sizes = [len(mesh.group(name).node)
                 for name in ("sphere", "cylinder", "half", "normal", "near", "both", "rest")]
        self.assertEqual(sizes, [4, 3, 18, 9, 18, 9, 9])
        np.testing.assert_array_equal(mesh.group("normal").tri, top.tri)
        with self.assertRaisesRegex(corot.InvalidError, "the nearest is node 0 at"):
            mesh.group_sphere("new", [-1, -1, -1], 0.5)
        self.assertRaises(corot.InvalidError, mesh.group_near, "new", "none", 1.0)
        with self.assertRaisesRegex(corot.InvalidError, "one of union, intersection, difference"):
            mesh.group_combine("new", "minus", ["half", "near"])
        self.assertRaises(TypeError, mesh.group_combine, "new", "union", [1, 2])
        for name in ("nodes", "", 'a"b', "x" * 128, "a\0b"):
            self.assertRaises(corot.InvalidError, mesh.group_nodes, name, [0])
        self.assertRaises(corot.InvalidError, mesh.group_nodes, "new", [27])
        self.assertRaises(corot.InvalidError, mesh.group_nodes, "new", [])
        self.assertRaises(corot.InvalidError, mesh.group_plane, "new", 3, 0.0)
        self.assertRaises(TypeError, mesh.group_plane, "new", "w", 0.0)
        self.assertRaises(corot.InvalidError, mesh.group_plane, "new", "x", np.nan)
        self.assertRaises(corot.InvalidError, mesh.group_triangles, "new", [[0, 1, 26]])
        self.assertRaises(corot.InvalidError, mesh.group_tets, "new", [48])
        self.assertRaises(KeyError, mesh.group, "new")
        with self.assertRaises(TypeError):
            mesh.groups["new"] = top

    def test_refinement(self):
        mesh = corot.Mesh.box([1, 1, 1], [1, 1, 1], split="kuhn")
        fine, how = mesh.refine(2, return_refinement=True)
        self.assertEqual(how.ntet.tolist(), [6, 48, 384])
        self.assertEqual((fine.ntet, how.nlevel, how.node), (384, 2, None))
        middles = fine.x[how.parent].mean(axis=1)
        np.testing.assert_allclose(fine.x[how.nnode[0]:], middles, atol=1e-15)
        field = np.random.default_rng(0).normal(size=(fine.nnode, 3))
        for transposed in (False, True):
            there = how.to_hierarchical(field, transposed)
            np.testing.assert_allclose(how.to_nodal(there, transposed), field, atol=1e-13)
        affine = fine.x @ np.ones((3, 3)) + 1
        self.assertLess(abs(how.to_hierarchical(affine)[how.nnode[0]:]).max(), 1e-14)
        raised = fine.change_order(2)
        how.raise_order(raised)
        self.assertEqual((how.nlevel, how.nnode[-1]), (3, raised.nnode))
        local, parent = mesh.refine_marked([0], return_parent=True)
        self.assertEqual(parent.shape, (local.ntet,))
        self.assertGreaterEqual((parent == 0).sum(), 8)
        self.assertRaises(corot.InvalidError, mesh.refine_marked, [6])
        self.assertRaises(corot.InvalidError, mesh.refine, -1)
        self.assertRaises(corot.InvalidError, mesh.refine, 1, "longest")
        self.assertRaises(corot.InvalidError, how.raise_order, mesh)
        self.assertRaises(TypeError, corot.Refinement)

    def test_places(self):
        mesh = corot.Mesh.box([1, 1, 1], [2, 2, 2])
        self.assertEqual(mesh.boundary().shape, (48, 3))
        corner = mesh.nearest([1.1, 1.2, 1.3])
        np.testing.assert_array_equal(mesh.x[corner], [1, 1, 1])
        place = mesh.locate([0.3, 0.4, 0.55])
        np.testing.assert_allclose(place.weight @ mesh.x[place.node], [0.3, 0.4, 0.55], atol=1e-12)
        self.assertEqual((place.distance, len(place.node)), (0, 4))
        self.assertAlmostEqual(mesh.locate([2, 0.5, 0.5]).distance, 1)
        self.assertEqual(mesh.locate_node(corner).node.tolist(), [corner])
        for wrong in (-1, mesh.nnode):
            self.assertRaises(corot.InvalidError, mesh.locate_node, wrong)
        self.assertRaises(corot.InvalidError, mesh.locate, [np.inf, 0, 0])
        self.assertRaises(corot.InvalidError, mesh.nearest, [np.nan, 0, 0])
        self.assertRaises(corot.InvalidError, mesh.face_nodes, mesh.boundary())
        curved = mesh.change_order(2)
        faces = curved.face_nodes(curved.boundary())
        np.testing.assert_allclose(curved.x[faces[:, 3]],
                                   (curved.x[faces[:, 0]] + curved.x[faces[:, 1]]) / 2, atol=1e-15)
        self.assertRaises(corot.InvalidError, curved.face_nodes, [[0, 1, 10**6]])

    def test_arrays_show_memory_and_outlive_the_mesh(self):
        mesh = corot.Mesh.box([1, 1, 1], [2, 2, 2])
        x = mesh.x
        self.assertTrue(np.shares_memory(x, mesh.x))
        self.assertFalse(x.flags.writeable)
        with self.assertRaises(ValueError):
            x[0] = 1
        kept = x.copy()
        mesh.close()
        del mesh
        for _ in range(50):  # whoever frees too early would see other meshes here
            corot.Mesh.box([9, 9, 9], [2, 2, 2]).close()
        np.testing.assert_array_equal(x, kept)


class Models(unittest.TestCase):
    def test_threads_of_a_state(self):
        model = make_bar()
        u, v = np.full(model.ndof, 1e-4), np.ones(model.ndof)
        state = corot.State(model)
        self.assertEqual(state.threads, 1)
        alone = state.residual(0, u, v)
        for n in (2, 3, 0, 1):
            state.threads = n
            self.assertEqual(state.threads, n or 1)  # it is a small body
            np.testing.assert_array_equal(state.residual(0, u, v), alone)
        for n in (-1, 257):
            with self.assertRaisesRegex(corot.InvalidError, "threads: "):
                state.threads = n
        with self.assertRaises(TypeError):
            state.threads = 1.5

    def test_what_a_model_says(self):
        model = make_bar()
        self.assertEqual((model.ndof, model.strain, model.viscosity, model.mass_kind),
                         (390, "polar", "corotated", "lumped"))
        self.assertEqual(model.dof.shape, (143, 3))
        self.assertEqual(sorted(model.dof[model.dof >= 0]), list(range(390)))
        self.assertAlmostEqual(model.length, 0.61644, 5)
        self.assertGreater(model.mass.min(), 0)
        self.assertEqual(model.kinks(-1, 40).tolist(), [0, 10])
        self.assertEqual(model.horizon(0), np.inf)
        self.assertFalse(model.moves)
        self.assertEqual(model.mesh.ntet, 337)
        self.assertGreater(model.nbytes, 10000)
        self.assertEqual({kind.name for kind in corot.strains()},
                         {"cauchy", "warp", "polar", "hybrid", "green"})

    def test_a_models_mesh_never_changes(self):
        model = make_column()
        self.assertRaises(corot.InvalidError, model.mesh.group_nodes, "new", [0])
        copy = model.mesh.copy()
        copy.group_nodes("new", [0])
        self.assertNotIn("new", model.mesh.groups)

    def test_everything_that_a_definition_can_say(self):
        mesh = corot.Mesh.box([0.1, 0.1, 0.3], [1, 1, 3], split="kuhn")
        mesh.group_tets("soft", range(6))
        loads = [corot.Load.gravity(), corot.Load.pressure("xmin", 5, corot.Amplitude.sine(2, 0.1, 0.5)),
                 corot.Load.force("zmax", [0, 1, 0], corot.Amplitude.smooth([0, 1, 2], [0, 1, 0]))]
        motion = corot.Motion.turn("zmin", [0, 0, 1], 0.2, [(0, 0), (1, 1)])
        materials = [corot.Material(1e4, 1e3, 500, group="soft"),
                     corot.Material.engineering(1e5, 0.25, 1000, damping_mass=0.1)]
        model = corot.Model(mesh, materials, strain="hybrid", motion=motion, load=loads,
                            gravity=[0, 1, 0], mass="consistent", dilatation="nodal",
                            dilatation_local=0.5, viscosity="objective")
        self.assertEqual((model.strain, model.mass_kind, model.viscosity, model.moves),
                         ("hybrid", "consistent", "objective", True))
        self.assertEqual(len(model.loads), 4)
        self.assertLessEqual(model.horizon(0), 0.125)
        state = corot.State(model)
        self.assertTrue(np.isfinite(state.residual(0.5, *deform(model, 0.002))).all())
        x, dx = state.nodal(0.5, np.zeros(model.ndof))
        base = mesh.group("zmin").node
        angle = 0.1
        turned = mesh.x[base] @ np.array([[np.cos(angle), np.sin(angle), 0],
                                          [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        np.testing.assert_allclose(x[base], turned - mesh.x[base], atol=1e-15)
        self.assertGreater(abs(dx[base]).max(), 0)
        both = [corot.Motion.rotate("zmin", [0, 0, 1], 1.0, stop=2), corot.Motion.translate("zmax", [0, 0, 1]),]
        self.assertTrue(corot.Model(mesh, RUBBER, motion=both).moves)
        moved = corot.Model(mesh, RUBBER, motion=corot.Motion.move("zmin", [1, 0, 0], [(0, 0), (2, 1)]))
        np.testing.assert_allclose(corot.State(moved).nodal(1, np.zeros(moved.ndof))[0][base][0], [0.5, 0, 0])

    def test_materials_by_tet(self):
        mesh = corot.Mesh.box([1, 1, 1], [1, 1, 1], split="kuhn")
        soft, hard = corot.Material(0, 1, 1), corot.Material(0, 100, 1)
        model = corot.Model(mesh, [soft, hard], tet_material=[0, 1, 0, 1, 0, 1])
        energy = corot.State(model).elements(0, deform(model, 1e-3)[0], "von_mises")["von_mises"]
        self.assertGreater(energy[1::2].mean(), 20 * energy[::2].mean())
        self.assertRaises(corot.InvalidError, corot.Model, mesh, [soft], tet_material=[0] * 5)
        self.assertRaises(corot.InvalidError, corot.Model, mesh, [soft], tet_material=[0, 0, 0, 0, 0, 1])

    def test_hierarchy(self):
        coarse = corot.Mesh.box([0.1, 0.1, 0.2], [1, 1, 2], split="kuhn")
        fine, how = coarse.refine(1, return_refinement=True)
        model = corot.Model(fine, corot.Material(1e5, 1e4, 1000), fix=corot.Fix("zmin"),
                            hierarchy=corot.Hierarchy(how))
        self.assertEqual(model.strain, "green+polar")
        self.assertTrue(model.approximate_stiffness)
        how.close()
        other = corot.Hierarchy(how)
        self.assertRaises(corot.ClosedError, corot.Model, fine, RUBBER, hierarchy=other)

    def test_what_is_refused(self):
        mesh = corot.Mesh.box([1, 1, 1], [1, 1, 1])
        good = RUBBER
        for message, arguments in (
                ("no strain measure", {"strain": "linear"}),
                ("no group", {"fix": corot.Fix("nowhere")}),
                ("letters of xyz", {"fix": corot.Fix("zmin", "xw")}),
                ("viscosity = 'thick'", {"viscosity": "thick"}),
                ("mass = 'heavy'", {"mass": "heavy"}),
                ("amplitude", {"load": corot.Load.traction("zmax", [1, 0, 0], [(0, 0, 0)])}),
                ("times and 2 values", {"load": corot.Load.traction(
                    "zmax", [1, 0, 0], corot.Amplitude((0.0,), (0.0, 1.0)))}),
                ("load 0", {"load": corot.Load.traction("zmax", [1, 0, 0], [(1, 0), (0, 1)])})):
            with self.assertRaisesRegex(corot.InvalidError, message):
                corot.Model(mesh, good, **arguments)
        with self.assertRaisesRegex(corot.InvalidError, "material 0: mu"):
            corot.Model(mesh, corot.Material(1, 0, 1))
        with self.assertRaisesRegex(corot.InvalidError, "poisson"):
            corot.Material.engineering(1, 0.5, 1)
        with self.assertRaisesRegex(TypeError, "load 0 is a Fix"):
            corot.Model(mesh, good, load=[corot.Fix("zmin")])
        with self.assertRaisesRegex(TypeError, "a corot.Mesh is wanted"):
            corot.Model("bar.msh", good)
        with self.assertRaisesRegex(TypeError, "mu = 'x'"):
            corot.Model(mesh, corot.Material(1, "x", 1))
        self.assertRaises(corot.InvalidError, corot.Load.gravity, [0, 1])
        self.assertRaises(corot.InvalidError, corot.Model, mesh, [])


class States(unittest.TestCase):
    def bodies(self):
        for strain in (kind.name for kind in corot.strains()):
            yield make_column(strain=strain)
        yield make_column(order=2, cells=(1, 1, 1))
        yield make_column(mass="consistent", dilatation="nodal")
        yield make_column(load=corot.Load.pressure("zmax", 2000))

    def test_matrices_are_the_derivatives_of_the_force(self):
        """Central differences: their error is h^2 of the third derivative, and rounding over h; with u of
        1e-2 and h of 1e-6 of that, 1e-8 and 1e-9 of the largest force."""
        random = np.random.default_rng(0)
        for model in self.bodies():
            state, n = corot.State(model), model.ndof
            u, v = deform(model, 0.01)
            M, K, D = state.matrices(0, u, v)
            for matrix in (M, K, D):
                self.assertEqual((matrix.shape, matrix.format), ((n, n), "csc"))
                self.assertLess(abs(matrix - matrix.T).max(), 1e-12 * abs(matrix).max())
            for _ in range(3):
                x, h, rest = random.normal(size=n), 1e-7, np.zeros(n)
                slope = (state.force(0, u + h * x, rest) - state.force(0, u - h * x, rest)) / (2 * h)
                if model.strain != "warp" and not model.loads:  # what K leaves out: corot/ode.h
                    np.testing.assert_allclose(-K @ x, slope, atol=1e-6 * abs(slope).max(), err_msg=model.strain)
                exact = state.jvp(0, u, rest, x, rest)
                np.testing.assert_allclose(exact, slope, atol=1e-6 * abs(slope).max(), err_msg=model.strain)
                slope = (state.force(0, u, v + h * x) - state.force(0, u, v - h * x)) / (2 * h)
                np.testing.assert_allclose(-D @ x, slope, atol=1e-6 * abs(slope).max(), err_msg=model.strain)
                np.testing.assert_allclose(M @ x, state.mass_multiply(x), atol=1e-14 * abs(M).max() * 10)
            if model.loads:  # a pressure on a surface with a free edge: the symmetric part
                bare = state.K(0, u, loads=False)
                self.assertGreater(abs(K - bare).max(), 0)

    def test_what_is_copied_and_what_is_shared(self):
        state = corot.State(make_column())
        u = np.zeros(state.model.ndof)
        K, D = state.K(0, u), state.D(0, u)
        self.assertIsInstance(K, scipy.sparse.csc_array)
        self.assertTrue(np.shares_memory(K.indices, D.indices))
        self.assertTrue(np.shares_memory(K.indptr, D.indptr))
        self.assertFalse(np.shares_memory(K.data, D.data))
        self.assertFalse(K.indices.flags.writeable)
        self.assertFalse(K.copy().indices is K.indices)
        self.assertTrue(np.diff(K.indices[K.indptr[0]:K.indptr[1]]).min() > 0)
        state.model.close()
        state.close()
        np.testing.assert_allclose((K @ np.ones(len(u))).shape, (len(u),))
        lu = scipy.sparse.linalg.splu(K.copy().tocsc())
        self.assertTrue(np.isfinite(lu.solve(np.ones(len(u)))).all())

    def test_rates(self):
        model = make_column()
        state = corot.State(model)
        u, v = deform(model)
        y = np.concatenate([u, v])
        expected = np.concatenate([v, state.residual(0, u, v) / model.mass])
        np.testing.assert_allclose(state.rhs(0, y), expected, rtol=1e-14)
        out = np.empty(2 * model.ndof)
        self.assertIs(state.rhs(0, y, out=out), out)
        np.testing.assert_allclose(out, expected, rtol=1e-14)
        consistent = make_column(mass="consistent")
        with self.assertRaisesRegex(corot.InvalidError, "consistent"):
            corot.State(consistent).rhs(0, y)
        solver = corot.MassSolver(consistent)
        b = np.arange(model.ndof, dtype=float)
        np.testing.assert_allclose(corot.State(consistent).mass_multiply(solver.solve(b)), b, atol=1e-10)

    def test_energy_is_the_potential_of_the_force(self):
        model = make_column()
        state = corot.State(model)
        u, v = deform(model)
        h, x = 1e-7, np.random.default_rng(3).normal(size=model.ndof)
        rest = np.zeros(model.ndof)
        slope = (state.energies(0, u + h * x, rest).elastic - state.energies(0, u - h * x, rest).elastic) / (2 * h)
        self.assertAlmostEqual(slope, -state.residual(0, u, rest) @ x, delta=1e-6 * abs(slope))
        energies = state.energies(0, u, v)
        self.assertAlmostEqual(energies.kinetic, v @ (model.mass * v) / 2)
        self.assertEqual(energies.momentum.shape, (3,))
        force = state.elastic_force(0, u)
        np.testing.assert_allclose(state.free(force), -state.residual(0, u, rest), atol=1e-10)
        np.testing.assert_allclose(state.internal_force(0, u, "polar"), force, atol=1e-10)
        self.assertRaises(corot.InvalidError, state.internal_force, 0, u, "linear")

    def test_forces_balance(self):
        model = make_column(gravity=[0, 0, -9.81])
        state = corot.State(model)
        u, v = deform(model)
        a = state.residual(0, u, v) / model.mass
        parts = state.forces(0, u, v, a)
        base = model.mesh.group("zmin").node
        free = np.setdiff1d(np.arange(model.mesh.nnode), base)
        scale = abs(parts["internal"]).max()
        self.assertLess(abs(parts["reaction"][free]).max(), 1e-12 * scale)
        weight = 9.81 * 1000 * 0.003
        self.assertAlmostEqual(state.load_force(0)[:, 2].sum(), -weight, 10)
        self.assertAlmostEqual(state.load_force(0, 2.0)[:, 2].sum(), -2 * weight, 10)
        _, acceleration = state.nodal_motion(0, v, a)
        np.testing.assert_allclose(state.free(acceleration), a)

    def test_frames(self):
        model = make_column()
        state = corot.State(model)
        u, v = deform(model)
        self.assertEqual(state.frames, "exact")
        rest, exact = np.zeros(model.ndof), state.residual(0, u, v)
        state.frames = "held"
        self.assertEqual(state.frames, "held")
        held = state.residual(0, u, v)
        self.assertGreater(abs(held - exact).max(), 1e-3 * abs(exact).max())
        self.assertGreater(state.frames_drift(0, u).angle_max, 0.01)
        change = state.update_frames(0, u)
        self.assertLess(state.frames_drift(0, u).angle_max, 1e-12)
        self.assertGreater(change.angle_max, 0.01)
        np.testing.assert_allclose(state.residual(0, u, rest), corot.State(model).residual(0, u, rest), atol=1e-9)
        state.frames = "extrapolated"
        self.assertGreater(state.spin_frames(0, u, v), 0)
        with self.assertRaises(corot.InvalidError):
            state.frames = "none"

    def test_fields(self):
        model = make_column(cells=(1, 1, 2))
        state = corot.State(model)
        u = state.free(model.mesh.x * [0, 0, 0.01])  # but for the base a stretch of one per cent along z
        fields = state.elements(0, u)
        self.assertEqual(fields["frame"].shape, (12, 9))
        self.assertEqual(fields["strain_at"].shape, (12, 4, 6))
        np.testing.assert_allclose(fields["det"], 1.01, atol=1e-12)
        np.testing.assert_allclose(fields["volume"].sum(), 0.003)
        expected = 1e5 * 0.01 + 2 * 1e4 * 0.01
        np.testing.assert_allclose(fields["stress"][:, 2], expected, rtol=1e-9)
        self.assertAlmostEqual(fields["energy"].sum(), state.energies(0, u, 0 * u).elastic, 12)
        self.assertEqual(set(state.elements(0, u, ["det", "stress"])), {"det", "stress"})
        self.assertRaises(corot.InvalidError, state.elements, 0, u, "heat")
        place = model.mesh.locate([0.03, 0.04, 0.1])
        points = corot.Points(state, [place.tet], [place.at])
        np.testing.assert_allclose(points.evaluate(0, u, "stress")["stress"][0, 2], expected, rtol=1e-9)
        self.assertEqual(points.evaluate(0, u)["frame"].shape, (1, 9))
        self.assertRaises(corot.InvalidError, corot.Points, state, [99], [place.at])
        self.assertAlmostEqual(state.deformation(0, u).stretch_max, 1.01)
        self.assertLess(state.stress_jumps(0, u), 1e-6)

    def test_an_inverted_tet(self):
        model = make_column()
        state = corot.State(model)
        u = state.free(-2 * model.mesh.x)
        with self.assertRaises(corot.RetryError) as caught:
            state.residual(0, u, 0 * u)
        self.assertGreaterEqual(state.inverted, 0)
        self.assertIn(f"tet {state.inverted}", str(caught.exception))
        self.assertEqual(caught.exception.status, "COROT_RETRY")
        for call in (lambda: state.K(0, u), lambda: state.energies(0, u, u), lambda: state.forces(0, u),
                     lambda: state.elastic_force(0, u), lambda: state.elements(0, u),
                     lambda: state.update_frames(0, u), lambda: state.jvp(0, u, u, u, u)):
            self.assertRaises(corot.RetryError, call)

    def test_wrong_arrays(self):
        model = make_column()
        state, n = corot.State(model), model.ndof
        good, short = np.zeros(n), np.zeros(n - 1)
        with self.assertRaisesRegex(corot.InvalidError, rf"u has the shape \({n - 1},\), and \({n},\) is wanted"):
            state.residual(0, short, good)
        self.assertRaises(corot.InvalidError, state.residual, 0, good, short)
        self.assertRaises(corot.InvalidError, state.residual, 0, good.reshape(1, n), good)
        self.assertRaises(TypeError, state.residual, 0, good + 0j, good)
        self.assertRaises(TypeError, state.residual, "now", good, good)
        with self.assertRaisesRegex(corot.InvalidError, "not a number|not finite|is nan"):
            state.residual(0, np.full(n, np.nan), good)
        for out in (np.zeros(n, np.float32), [0.0] * n, np.zeros(n, ">f8")):
            self.assertRaises(TypeError, state.residual, 0, good, good, out)
        frozen = np.zeros(n)
        frozen.flags.writeable = False
        for out in (np.zeros(n + 1), np.zeros(2 * n)[::2], frozen):
            self.assertRaises(corot.InvalidError, state.residual, 0, good, good, out)
        u = np.zeros(n)
        with self.assertRaisesRegex(corot.InvalidError, "share memory"):
            state.residual(0, u, good, out=u)
        y = np.zeros(2 * n)
        self.assertRaises(corot.InvalidError, state.rhs, 0, y, y)
        self.assertRaises(corot.InvalidError, state.K, 0, good, "auto")
        self.assertRaises(corot.InvalidError, state.free, good)
        big = np.zeros(2 * n)[::2]
        np.testing.assert_array_equal(state.residual(0, big, list(big)), state.residual(0, good, good))


if __name__ == "__main__":
    unittest.main()

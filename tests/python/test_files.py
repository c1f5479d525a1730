"""Folders of runs and studies read back, the program as a process, and python3 -m corot."""
import json
import os
import subprocess
import sys
import unittest

import numpy as np

import corot
from common import BAR, ROOT, Folder, make_bar, program_is_there

SCENARIO = """
mesh: {box: {size: [0.1, 0.1, 0.3], cells: [1, 1, 3]}}
groups: {base: {plane: {axis: z, at: 0}}, top: {plane: {axis: z, at: 0.3}}}
material: {lambda: 1.0e5, mu: 1.0e4, density: 1000}
boundary: [{group: base, fix: [x, y, z]}]
loads: [{group: top, traction: [20, 0, 0]}]
time: {end: 0.2, output: 0.1}
output: {states: binary}
probes:
  tip: {point: [0.1, 0.1, 0.3]}
  wall: {group: base, of: reaction}
  stress: {group: base, of: von_mises, take: max}
quantities: {peak: max(tip.ux), never: "period(tip.ux, 0.15, end)"}
"""


@unittest.skipUnless(program_is_there(), "COROT names no program")
class Runs(Folder):
    def setUp(self):
        super().setUp()
        self.model = self.folder / "column.yaml"
        self.model.write_text(SCENARIO)

    def test_a_run(self):
        run = corot.run(self.model, self.folder / "out", set={"integrator.rtol": 1e-6, "title": '"it is: a bar"',
                                                              "time.end": np.float64(0.3)})
        self.assertTrue(run.ok)
        self.assertEqual(run.result["integrator"]["rtol"], 1e-6)
        self.assertEqual(run.result["t_end"], 0.3)
        np.testing.assert_allclose(run.probes["t"], [0, 0.1, 0.2, 0.3])
        self.assertEqual(run.probes.units["tip.ux"], "m")
        self.assertEqual(run.probes.units["wall.mx"], "N m")
        self.assertEqual(run.probes.units["stress.value"], "Pa")
        self.assertEqual(run.energy.units["px"], "kg m/s")
        self.assertEqual(run.history["t"][-1], run.probes["t"][-1])
        self.assertEqual(run.quantities["peak"], run.history["tip.ux"].max())
        self.assertTrue(np.isnan(run.quantities["never"]))
        self.assertEqual(run.steps.nrow, run.result["statistics"]["nst"])
        self.assertEqual(run.steps["angle_max"].dtype, float)
        array = run.probes.array
        self.assertEqual(array.dtype.names[:2], ("t", "tip.ux"))
        np.testing.assert_array_equal(array["tip.ux"], run.probes["tip.ux"])
        self.assertEqual(run.states.u.shape, (4, run.result["mesh"]["dofs"]))
        nodal = run.states.nodal(run.result["mesh"]["nodes"])
        tip = run.result["probes"]["tip"]["node"]
        np.testing.assert_array_equal(nodal[:, tip, 0], run.probes["tip.ux"])
        self.assertEqual([t for t, _ in run.fields], list(run.probes["t"]))
        self.assertTrue(all(path.exists() for _, path in run.fields))
        self.assertRaises(corot.SystemRefusedError, lambda: run.reactions)
        self.assertRaises(KeyError, lambda: run.probes["nothing"])
        again = corot.read(str(self.folder / "out"))
        np.testing.assert_array_equal(again.probes["tip.ux"], run.probes["tip.ux"])

    def test_what_fails(self):
        with self.assertRaises(corot.ProgramError) as caught:
            corot.run(self.model, self.folder / "out", set={"integrator.method": "euler"})
        self.assertEqual(caught.exception.code, 3)
        self.assertIn("integrator.method", str(caught.exception))
        self.assertIn("integrator.method", caught.exception.output)
        self.assertRaises(corot.ProgramError, corot.run, self.folder / "none.yaml", self.folder / "out")
        before = os.environ["COROT"]
        try:
            os.environ["COROT"] = "/nowhere/corot"
            self.assertRaises(corot.LibraryError, corot.run, self.model, self.folder / "out")
        finally:
            os.environ["COROT"] = before

    def test_a_study(self):
        file = self.folder / "study.yaml"
        file.write_text("study: two\nbase: column.yaml\nset: {output.states: none, quantities: {}}\n"
                        "axes:\n  - {key: integrator.rtol, values: [1.0e-3, 1.0e-5]}\n")
        study = corot.study(file, self.folder / "study", jobs=1)
        self.assertEqual(sorted(study.rows["integrator.rtol"]), [1e-5, 1e-3])
        self.assertEqual(set(study.rows["status"]), {"done"})
        self.assertGreater(study.rows["cost.steps"].max(), study.rows["cost.steps"].min())
        self.assertEqual(len(study.runs), 2)
        for run in study.runs.values():
            self.assertTrue(run.ok)
        self.assertIsInstance(corot.read(self.folder / "study"), corot.Study)
        self.assertIsInstance(study.result, dict)

    def test_settings_as_words(self):
        from corot._program import _word
        for value, word in ((1e-6, "1.0e-06"), (1.5e-6, "1.5e-06"), (2.0, "2.0"), (True, "true"), (None, "null"),
                            ("a: b", "a: b"), ([1, 1e-7], "[1, 1.0e-07]"),
                            ({"a": ["b", None]}, '{"a": ["b", null]}'), (np.arange(2), "[0, 1]"),
                            (1e22, "1.0e+22"), (float("inf"), "inf")):
            self.assertEqual(_word(value), word)


class Damaged(Folder):
    def table(self, text):
        (self.folder / "probes.csv").write_text(text)
        return corot.read_table(self.folder / "probes.csv")

    def test_tables(self):
        self.assertEqual(self.table("t,a.ux\n0,1\n1,\n")["a.ux"][0], 1)
        self.assertTrue(np.isnan(self.table("t,a\n0,1\n1,\n")["a"][1]))
        self.assertEqual(self.table('id,a\n"x, y",1\n')["id"][0], "x, y")
        self.assertEqual(self.table("t,a\n").nrow, 0)
        for text, message in (("", "no head"), ("t,a\n0\n", "probes.csv:2: 1 cells"), ("t,t\n", "one name")):
            with self.assertRaisesRegex(corot.FormatError, message):
                self.table(text)
        with self.assertRaises(corot.SystemRefusedError):
            corot.read_table(self.folder / "none.csv")

    def test_folders(self):
        with self.assertRaisesRegex(corot.SystemRefusedError, "result.json"):
            corot.read(self.folder)
        for text in ("{", "[]", "3"):
            (self.folder / "result.json").write_text(text)
            with self.assertRaises(corot.FormatError):
                corot.read(self.folder)
        (self.folder / "result.json").write_text(json.dumps({"status": "ok"}))
        run = corot.read(self.folder)
        self.assertEqual((run.ok, run.fields, run.warnings, run.quantities), (True, [], [], {}))

    def test_states(self):
        head = b"corot-st" + np.array([1, 0x01020304], np.uint32).tobytes() + np.array([3], np.int64).tobytes()
        places = np.array([0, 1, 5, 0], np.int32).tobytes()
        record = np.arange(7.0).tobytes()
        path = self.folder / "states.bin"
        path.write_bytes(head + places + record + record[:20])
        states = corot.read_states(path)
        self.assertEqual((states.t.tolist(), states.u.tolist(), states.v.tolist(), states.place.tolist()),
                         ([0], [[1, 2, 3]], [[4, 5, 6]], [0, 1, 5]))
        self.assertEqual(states.nodal(2).tolist(), [[[1, 2, 0], [0, 0, 3]]])
        good = head + places + record
        for bad in (b"", b"x" + good[1:], good[:8] + b"\2" + good[9:], good[:12] + b"\1\2\3\4" + good[16:],
                    good[:30], head[:16] + np.array([-1], np.int64).tobytes() + places):
            path.write_bytes(bad)
            self.assertRaises(corot.FormatError, corot.read_states, path)
        self.assertRaises(corot.SystemRefusedError, corot.read_states, self.folder / "none.bin")


class Module(unittest.TestCase):
    def call(self, *arguments):
        return subprocess.run([sys.executable, "-m", "corot", *arguments], capture_output=True, text=True,
                              check=False)

    def test_what_it_is(self):
        done = self.call()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn(f"corot {corot.__version__}", done.stdout)
        self.assertIn(corot.library_path, done.stdout)
        self.assertIn("linear solvers: klu", done.stdout)

    def test_the_demonstration(self):
        done = self.call("--demo")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        rows = [row.split(",") for row in done.stdout.split()]
        self.assertEqual((rows[0], len(rows)), (["t", "tip.ux", "tip.uy", "tip.uz"], 52))
        # the box is its own mirror image: it falls down, and not aside
        self.assertLess(max(abs(float(row[2])) for row in rows[1:]), 1e-12)
        self.assertLess(min(float(row[3]) for row in rows[1:]), -0.1)
        self.assertIn("--demo", self.call("--help").stdout)

    @unittest.skipUnless(program_is_there(), "COROT names no program")
    def test_commands(self):
        said = self.call("--version").stdout.splitlines()
        self.assertEqual(said[0], f"corot {corot.__version__}")
        self.assertEqual(self.call("run", "/nowhere.yaml").returncode, 3)


class Examples(Folder):
    """The programs of models/python, and those of the documents, do what they say."""

    def run_file(self, path):
        return subprocess.run([sys.executable, path], capture_output=True, text=True, check=False,
                              cwd=self.folder)

    def test_models_python(self):
        files = sorted((ROOT / "models" / "python").glob("*.py"))
        self.assertGreaterEqual(len(files), 3)
        for path in files:
            done = self.run_file(path)
            self.assertEqual((done.returncode, done.stderr), (0, ""), path.name)
            self.assertTrue(done.stdout, path.name)

    def test_the_bar_in_ten_lines(self):
        text = (ROOT / "models" / "python" / "bar.py").read_text()
        code = [line for line in text.split('"""')[2].splitlines() if line.strip()]
        self.assertLessEqual(len(code), 11)
        corner = np.array(self.run_file(ROOT / "models" / "python" / "bar.py").stdout.split()[-3:], float)
        # That of models/bar/README.md, but for what its tolerance of 1e-4 leaves to other steps: those of
        # another SUNDIALS end 1e-4 m from it.
        np.testing.assert_allclose(corner, [0.17419, 0.00998, -0.05255], atol=5e-4)

    def test_programs_of_the_documents(self):
        os.symlink(ROOT / "models", self.folder / "models")
        for document in ("src/python/README.md", "README.md"):
            text = (ROOT / document).read_text()
            programs = [p.split("```")[0] for p in text.split("```python\n")[1:]]
            self.assertTrue(programs, document)
            for i, program in enumerate(programs):
                if "corot.run(" in program and not program_is_there():
                    continue
                path = self.folder / f"{i}.py"
                path.write_text(program)
                done = subprocess.run([sys.executable, path], capture_output=True, text=True, check=False,
                                      cwd=self.folder)
                self.assertEqual((done.returncode, done.stderr), (0, ""), f"{document}: {program}")

    def test_the_bar_is_that_of_the_scenario(self):
        self.assertEqual(make_bar().ndof, 390)
        self.assertTrue((BAR / "bar.yaml").exists())


if __name__ == "__main__":
    unittest.main()

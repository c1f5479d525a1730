"""The header reader: all headers, and what it refuses; every function is wrapped or left out on purpose;
the installed text is what the headers say."""
import ctypes
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import corot
from common import ROOT
from corot import _headers, _library

HEADERS = ROOT / "include" / "corot"
PACKAGE = ROOT / "src" / "python" / "corot"

#: Functions that Python does not call, and why. Patterns of whole names.
LEFT_OUT = {
    r"corot_sun_\w+": "for a SUNDIALS integrator of a C host; Integrator has corot's own",
    r"corot_nodal": "corot_state_nodal says the same, and sees inputs",
    r"corot_internal_force_\w+": "none so far",
    r"corot_integrator_controls_error": "methods() has it, of every method",
    r"corot_method_traits": "methods() lists them all",
    r"corot_strain_find": "strains() lists them all",
    r"corot_block_multiply": "matrices are scipy's, and multiply themselves",
    r"corot_pencil_view": "State.matrices has K and D, Pencil solves with S",
    r"corot_mesh_box_\w+": "none so far",
    r"corot_state_parallel": "Python has no parallel loop to lend",
    r"corot_model_threads|corot_processors": "State.threads = 0 takes as many",
    r"corot_linear_costs_\w+": "a linear solver of Python's is chosen by the usual ones",
    r"corot_mesh_format": "write_as refuses what there is not",
    r"corot_sundials_version|corot_version|corot_error|corot_fail": "called, by _library and build_info",
}


def declared():
    return {name for path in _headers.list_headers(HEADERS)
            for name in _headers.list_declared(Path(path).read_text())}


class Reader(unittest.TestCase):
    def test_every_function_of_the_headers_is_declared_to_cffi(self):
        names = declared()
        self.assertGreater(len(names), 150)
        self.assertEqual(names - set(_library.declared), set())
        for name in names:  # and the library has it
            self.assertTrue(hasattr(_library.lib, name), name)

    def test_no_function_is_missed(self):
        """Counted in another way: every COROT_API, but those of #define lines."""
        text = "".join(path.read_text() for path in HEADERS.glob("*.h"))
        count = len(re.findall(r"^COROT_API ", _headers.drop_comments(text), re.M))
        found = sum(len(_headers.list_declared(path.read_text())) for path in HEADERS.glob("*.h"))
        self.assertEqual(count, found)

    def test_every_function_is_wrapped_or_left_out_on_purpose(self):
        source = "".join(path.read_text() for path in PACKAGE.glob("*.py"))
        called = set(re.findall(r"\blib\.(corot_\w+)", source)) | set(re.findall(r"library\.(corot_\w+)", source))
        unknown = [name for name in sorted(declared() - called)
                   if not any(re.fullmatch(pattern, name) for pattern in LEFT_OUT)]
        self.assertEqual(unknown, [], "wrap them, or say in LEFT_OUT why not")
        checkpoint = {"corot_integrator_save", "corot_integrator_restore", "corot_blob_free"}
        self.assertEqual(called - declared() - checkpoint, set(), "called, and in no header")

    def test_structures_are_as_large_as_the_library_has_them(self):
        """A definition of another size is refused, so each that is accepted has the library's size."""
        ffi, lib = _library.ffi, _library.lib
        for kind in ("model", "hierarchy", "integrator", "frame_policy", "statics", "modes"):
            name = f"corot_{kind}" + ("" if kind == "frame_policy" else "_def")
            struct, size = ffi.new(name + " *"), ffi.sizeof(name)
            getattr(lib, f"corot_{kind}_set_defaults")(struct, size)
            self.assertEqual(struct.bytes, size, name)
        model, out = ffi.new("corot_model_def *"), ffi.new("corot_model **")
        lib.corot_model_set_defaults(model, ffi.sizeof("corot_model_def"))
        lib.corot_model_create(model, out)  # without a mesh: but not for its size
        self.assertNotIn("bytes", ffi.string(lib.corot_error()).decode())

    def test_what_the_reader_makes_of_small_headers(self):
        read = _headers.read_header
        self.assertEqual(read("/* a\n b */ COROT_API int f(void); // c")[0], "int f(void);")
        self.assertEqual(read("#ifdef X\nint a;\n#else\nint b;\n#endif")[0], "int b;")
        self.assertEqual(read("#ifndef X\n#define X\nint a;\n#endif")[0], "int a;")
        self.assertEqual(read("static inline int f(void) { if (1) { return 2; } return 3; }\nint g;")[0],
                         "int g;")
        self.assertEqual(read("#define COROT_N 3\nint a[COROT_N];"), ("int a[3];", {"COROT_N": 3.0}))
        for bad in ("#if 1\nint a;", "#pragma once\nint a;", "#endif", "#else",
                    "int f(void) __attribute__((pure));"):
            with self.assertRaises(ValueError, msg=bad):
                read(bad)

    def test_numbers_of_the_headers(self):
        self.assertEqual(corot.EXTRAPOLATION_CAP, 0.1)
        text = (HEADERS / "base.h").read_text()
        self.assertIn(f'"{corot.__version__}"', text)

    def test_the_text_that_is_installed_is_that_of_the_headers(self):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "_cdef.h"
            subprocess.run([sys.executable, PACKAGE / "_headers.py", HEADERS, out], check=True)
            self.assertEqual(out.read_text(), _headers.read_headers(HEADERS))
            self.assertNotEqual(subprocess.run([sys.executable, PACKAGE / "_headers.py"],
                                               stderr=subprocess.PIPE, check=False).returncode, 0)
            with self.assertRaises(FileNotFoundError):
                _headers.read_headers(folder)


class Words(unittest.TestCase):
    def test_words_of_enumerations(self):
        from corot import _convert as cv
        self.assertEqual(set(cv.words("corot_frames")), {"exact", "held", "extrapolated"})
        self.assertEqual(set(cv.words("corot_viscosity")), {"corotated", "objective", "auto"})
        self.assertEqual(cv.words("corot_tangent")["auto"], -1)
        self.assertEqual(cv.choose("corot_coupling", "one-way", "coupling"),
                         cv.words("corot_coupling")["one_way"])
        self.assertEqual(set(cv.words("corot_frame_reason")),
                         {"kept", "by_step", "by_interval", "by_angle", "by_cap", "by_hook"})
        with self.assertRaisesRegex(corot.InvalidError, "frames = 'x': one of exact, held"):
            cv.choose("corot_frames", "x", "frames")
        for name in re.findall(r"typedef enum (corot_\w+)", _library._declarations):
            for word, value in cv.words(name).items():
                self.assertEqual(cv.word(name, value), word)


class Loading(unittest.TestCase):
    """What is said where there is no library, or another one."""

    def load(self, **environment):
        env = {k: v for k, v in os.environ.items() if k not in ("COROT_LIBRARY", "LD_PRELOAD")}
        env.update(environment)
        done = subprocess.run([sys.executable, "-c", "import corot"], env=env, capture_output=True,
                              text=True, check=False)
        return done.returncode, done.stderr.strip().splitlines()[-1] if done.stderr else ""

    @unittest.skipIf(hasattr(ctypes.CDLL(None), "__asan_init"), "without the sanitizer nothing loads")
    def test_no_library(self):
        for path in ("/nowhere/libcorot_integrate.so", str(ROOT)):
            code, said = self.load(COROT_LIBRARY=path)
            self.assertEqual(code, 1)
            self.assertIn("corot's shared library cannot be loaded", said)
            self.assertIn(path, said)
            self.assertIn("set COROT_LIBRARY", said)

    @unittest.skipIf(hasattr(ctypes.CDLL(None), "__asan_init"), "without the sanitizer nothing loads")
    def test_another_library(self):
        code, said = self.load(COROT_LIBRARY="libc.so.6")
        self.assertEqual(code, 1)
        self.assertIn("libc.so.6 is no library of corot", said)

    @unittest.skipIf(hasattr(ctypes.CDLL(None), "__asan_init"), "without the sanitizer nothing loads")
    def test_another_version(self):
        """A package that was installed with headers of another version than the library's."""
        with tempfile.TemporaryDirectory() as folder:
            package = Path(folder) / "corot"
            shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__"))
            text = _headers.read_headers(HEADERS)
            (package / "_cdef.h").write_text(text)
            own = {"PYTHONPATH": folder, "COROT_LIBRARY": corot.library_path}
            self.assertEqual(self.load(**own), (0, ""))
            (package / "_cdef.h").write_text(text.replace("VERSION_MAJOR = 1.0", "VERSION_MAJOR = 7.0"))
            code, said = self.load(**own)
            self.assertEqual(code, 1)
            self.assertIn(f"is corot {corot.__version__}, and this package is for 7.", said)

    @unittest.skipIf(hasattr(ctypes.CDLL(None), "__asan_init"), "without the sanitizer nothing loads")
    def test_a_folder_and_the_core_alone(self):
        path = Path(corot.library_path).resolve()
        code, said = self.load(COROT_LIBRARY=str(path.parent))
        self.assertEqual((code, said), (0, ""))
        core = next((p for p in (path.parent / "libcorot_core.so",
                                 path.parent.parent / "core" / "libcorot_core.so") if p.exists()), None)
        if core is None:
            self.skipTest("there is no libcorot_core.so beside the library")
        script = ("import corot, sys; m = corot.Model(corot.Mesh.box([1, 1, 1], [1, 1, 1]), "
                  "corot.Material(1, 1, 1)); s = corot.State(m); import numpy as np; z = np.zeros(m.ndof)\n"
                  "assert corot.build_info()['parts'] == ['core']; s.residual(0, z, z)\n"
                  "for make in (corot.Integrator, corot.Pencil):\n"
                  "  try: make(s); sys.exit(1)\n"
                  "  except corot.LibraryError as e: assert 'COROT_SOLVE=OFF' in str(e), e\n"
                  "for make in (corot.statics, corot.modes, corot.MassSolver):\n"
                  "  try: make(m); sys.exit(1)\n"
                  "  except corot.LibraryError as e: pass\n")
        env = {**os.environ, "COROT_LIBRARY": str(core)}
        done = subprocess.run([sys.executable, "-c", script], env=env, capture_output=True, text=True,
                              check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()

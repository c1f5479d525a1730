#!/usr/bin/env python3
"""Imports an FMU with nothing but Python's own library, and controls it: a force on the top of a bar
that leads it to a place, by how far it is off and how fast it moves.

usage: control.py BEAM.fmu [PLACE]"""
import ctypes
import os
import sys
import tempfile
import xml.etree.ElementTree as xml
import zipfile
from ctypes import POINTER, byref, c_bool, c_char_p, c_double, c_size_t, c_uint32, c_void_p

OK = 0


@ctypes.CFUNCTYPE(None, c_void_p, ctypes.c_int, c_char_p, c_char_p)
def log(environment, status, category, message):
    print(f"{category.decode()}: {message.decode()}", file=sys.stderr)


class Fmu:
    """A Co-Simulation instance of an FMU that has been unpacked."""

    def __init__(self, folder):
        root = xml.parse(f"{folder}/modelDescription.xml").getroot()
        name = root.find("CoSimulation").get("modelIdentifier")
        self.reference = {v.get("name"): int(v.get("valueReference")) for v in root.find("ModelVariables")}
        self.library = ctypes.CDLL(f"{folder}/binaries/{os.uname().machine}-linux/{name}.so")
        instantiate = self.library.fmi3InstantiateCoSimulation
        instantiate.restype = c_void_p
        instantiate.argtypes = [c_char_p, c_char_p, c_char_p, c_bool, c_bool, c_bool, c_bool,
                                POINTER(c_uint32), c_size_t, c_void_p, c_void_p, c_void_p]
        self.instance = c_void_p(instantiate(
            b"beam", root.get("instantiationToken").encode(), f"{folder}/resources/".encode(), False, False,
            False, False, None, 0, None, ctypes.cast(log, c_void_p), None))
        if not self.instance:
            sys.exit(1)

    def call(self, name, *arguments):
        if getattr(self.library, name)(self.instance, *arguments) != OK:
            sys.exit(f"{name} failed")

    def start(self, stop):
        self.call("fmi3EnterInitializationMode", c_bool(False), c_double(0), c_double(0), c_bool(True),
                  c_double(stop))
        self.call("fmi3ExitInitializationMode")

    def get(self, name):
        value = c_double()
        self.call("fmi3GetFloat64", byref(c_uint32(self.reference[name])), c_size_t(1), byref(value), c_size_t(1))
        return value.value

    def set(self, name, number):
        self.call("fmi3SetFloat64", byref(c_uint32(self.reference[name])), c_size_t(1), byref(c_double(number)),
                  c_size_t(1))

    def step(self, t, h):
        flag, last = [c_bool() for _ in range(3)], c_double()
        self.call("fmi3DoStep", c_double(t), c_double(h), c_bool(True), *map(byref, flag), byref(last))


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    place = float(sys.argv[2]) if len(sys.argv) == 3 else 0.05
    end, h, force, total = 4.0, 0.02, 0.0, 0.0
    with tempfile.TemporaryDirectory() as folder:
        zipfile.ZipFile(sys.argv[1]).extractall(folder)
        fmu = Fmu(folder)
        fmu.start(end)
        print("  t [s]   top [m]   force [N]   wall [N]")
        for k in range(round(end / h) + 1):
            t = k * h
            off, speed = place - fmu.get("top.ux"), fmu.get("speed.vx")
            if k % 25 == 0:
                print(f"{t:7.2f} {fmu.get('top.ux'):9.5f} {force:11.5f} {fmu.get('wall.fx'):10.5f}")
            total += h * off
            force = 4.0 * off + 10.0 * total - 5.0 * speed  # [N/m, N/m/s, N s/m]
            fmu.set("push", force)
            if k < round(end / h):
                fmu.step(t, h)
        fmu.library.fmi3FreeInstance(fmu.instance)


main()

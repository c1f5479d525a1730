#!/usr/bin/env python3
"""A host in Python, by ctypes: bar_shim.c, with corot::core in it, is loaded as a shared library, and
the bar is integrated here, by the classical Runge-Kutta method at a constant step.

usage: host_python.py libbar.so
"""
import ctypes
import sys

library = ctypes.CDLL(sys.argv[1])
pointer, number, numbers = ctypes.c_void_p, ctypes.c_double, ctypes.POINTER(ctypes.c_double)


def declare(name, result, *arguments):
    function = getattr(library, name)
    function.restype, function.argtypes = result, arguments
    return function


bar_open = declare("bar_open", pointer)
bar_unknowns = declare("bar_unknowns", ctypes.c_int, pointer)
bar_rate = declare("bar_rate", ctypes.c_int, pointer, number, numbers, numbers)
bar_corner = declare("bar_corner", None, pointer, numbers, numbers)
bar_error = declare("bar_error", ctypes.c_char_p)
bar_close = declare("bar_close", None, pointer)

bar = bar_open()
if not bar:
    sys.exit("corot: " + bar_error().decode())
n = bar_unknowns(bar)
array, rate = number * n, (number * n)()


def rate_at(t, y):
    """y' at (t, y), as a list."""
    if bar_rate(bar, t, array(*y), rate) != 0:
        sys.exit("corot: " + bar_error().decode())
    return list(rate)


def ahead(y, h, k):
    return [a + h * b for a, b in zip(y, k)]


y, nstep = [0.0] * n, 500  # (u, v), at rest
h = 2.0 / nstep
for step in range(nstep):
    t = step * h
    k1 = rate_at(t, y)
    k2 = rate_at(t + h / 2, ahead(y, h / 2, k1))
    k3 = rate_at(t + h / 2, ahead(y, h / 2, k2))
    k4 = rate_at(t + h, ahead(y, h, k3))
    y = [a + h / 6 * (b + 2 * c + 2 * d + e) for a, b, c, d, e in zip(y, k1, k2, k3, k4)]

u = (number * 3)()
bar_corner(bar, array(*y), u)
print(*(f"{component:.12g}" for component in u))
bar_close(bar)

"""The twelve problems. A new one is one more entry of PROBLEMS.

Every problem is a lattice of cells under `shape` (or a mesh in a file that is refined), a linear
law between Green's strain and the second Piola-Kirchhoff stress (`linear`: between small ones),
what is held, moved and loaded, and one number, `take`:

    u, reaction, stress   at a point or of a side, at rest
    max, min, end         of a displacement in motion

`truth` is that number and what it is known by; README.md says where it is from. `cells` are meshes
for elements of second order, `coarse` those for first order; `increment` is the part of the load
that a peer of load steps begins with, `steps` are those of a peer of constant steps [s]."""
import math

import numpy as np


def lame(E, nu):
    return E * nu / (1 + nu) / (1 - 2 * nu), E / 2 / (1 + nu)


def box(a, b, c):
    return lambda s, t, w: (a * s, b * t, c * w)


def power(p):
    """Cells that are shorter where the coordinate is 0."""
    return lambda v: v ** p


def flag(s, t, w):
    """A strip of 0.35 x 0.02 m behind a cylinder of radius 0.05 m about (0.2, 0.2)."""
    y = 0.19 + 0.02 * t
    left = 0.2 + np.sqrt(0.05 ** 2 - (y - 0.2) ** 2)
    return left + s * (0.6 - left), y, 0.01 * w


def bend(s, t, w):
    """An eighth of a circle of radius 100, of a section of 1 x 1, that begins along y."""
    radius, angle = 100.5 - t, s * math.pi / 4
    return 100 - radius * np.cos(angle), radius * np.sin(angle), 0.5 - w


def panel(s, t, w):
    """Cook's trapezoid, 48 wide, 44 high at its wall and 16 at its end; half of a depth of 20."""
    return 48 * s, 44 * s + t * (44 - 28 * s), 10 * w


def arch(s, t, w):
    """Half of a shallow circular arch: span 2, rise 0.1, thick 0.04, from its foot to its crown."""
    radius = (1 + 0.1 ** 2) / 0.2
    angle = math.asin(1 / radius) * (1 - s)
    r = radius + 0.04 * (t - 0.5)
    return 1 - r * np.sin(angle), r * np.cos(angle) - radius + 0.1, 0.1 * w


def plate(s, t, w):
    """A quarter between two ellipses, from (2, 1) to (3.25, 2.75), 0.6 thick."""
    angle = t * math.pi / 2
    return (2 + 1.25 * s) * np.cos(angle), (1 + 1.75 * s) * np.sin(angle), 0.6 * w


FIXED, PLANE = "xyz", ("all", "z")
BAR = dict(lame=(1e5, 1e4), density=1000.0, shape=box(0.1, 0.1, 0.6), grades={2: power(1.5)},
           hold=[("w0", FIXED)], tractions=[("w1", (200.0, 0, 0))],
           point=(0.1, 0.1, 0.6), component="x")
FLAG = dict(density=1000.0, shape=flag, grades={0: power(1.5)}, plane=True,
            hold=[("s0", FIXED), PLANE], gravity=(0, -2.0, 0), point=(0.6, 0.2, 0), component="y",
            cells=[(10, 1, 1), (20, 1, 1), (30, 1, 1), (40, 2, 1), (60, 2, 1), (80, 4, 1)],
            coarse=[(30, 1, 1), (60, 2, 1), (80, 4, 1), (160, 8, 1)])

PROBLEMS = {
    "bar-rest": dict(
        BAR, title="The bar at rest", truth=(0.3449, 2e-4), take="u", increment=1.0,
        cells=[(1, 1, 4), (2, 2, 6), (2, 2, 8), (2, 2, 10), (4, 4, 12), (6, 6, 16)],
        coarse=[(1, 1, 6), (2, 2, 12), (4, 4, 24)]),
    "bar-run": dict(
        BAR, title="The bar over 40 s", truth=(0.3688, 6e-4), take="max", end=40.0, rise=10.0,
        output=0.1, steps=[0.4, 0.2], tolerances=[1e-2, 1e-3, 1e-4],
        cells=[(1, 1, 4), (2, 2, 6), (2, 2, 10), (3, 3, 12)],
        coarse=[(1, 1, 6), (2, 2, 12)]),
    "csm1": dict(
        FLAG, title="Turek and Hron, CSM1", truth=(-0.066104, 3e-6), lame=lame(1.4e6, 0.4),
        take="u", increment=1.0),
    "csm2": dict(
        FLAG, title="Turek and Hron, CSM2", truth=(-0.0169744, 1e-6), lame=lame(5.6e6, 0.4),
        take="u", increment=1.0),
    "csm3": dict(
        FLAG, title="Turek and Hron, CSM3", truth=(-0.12964, 4e-5), lame=lame(1.4e6, 0.4),
        take="min", end=0.6, output=0.005, steps=[0.01, 0.005],
        tolerances=[1e-2, 1e-3, 1e-4], cells=[(10, 1, 1), (20, 1, 1), (40, 2, 1)]),
    "3dnlg5": dict(
        title="NAFEMS 3DNLG-5", truth=(53.3095, 3e-3), shape=bend, lame=lame(1e7, 0.0),
        density=1.0, hold=[("s0", FIXED)], tractions=[("s1", (0, 0, 600.0))], take="u",
        point=bend(1.0, 0.5, 0.0), component="z", increment=0.5,
        cells=[(8, 1, 1), (16, 1, 1), (32, 1, 1), (32, 2, 2), (64, 2, 2)],
        coarse=[(24, 1, 1), (64, 2, 2), (128, 4, 4)]),
    "elastica": dict(
        title="The elastica", truth=(0.81341, 5e-5), shape=box(1.0, 0.05, 0.05),
        lame=lame(1.2e9, 0.3), density=1000.0, hold=[("s0", FIXED)],
        tractions=[("s1", (0, 2.5e6, 0))], take="u", point=(1.0, 0.025, 0), component="y",
        increment=0.25, cells=[(5, 1, 1), (10, 1, 1), (20, 1, 1), (20, 2, 2), (40, 2, 2)],
        coarse=[(20, 1, 1), (40, 2, 2), (80, 4, 4)]),
    "cook": dict(
        title="Cook's panel in space", truth=(0.47139, 4e-5), shape=panel,
        grades={0: power(1.5)}, lame=lame(50.0, 0.3), density=1.0,
        hold=[("s0", FIXED), ("w0", "z")], tractions=[("s1", (0, 0.0625, 0))], take="u",
        point=(48.0, 52.0, 0), component="y", increment=1.0,
        cells=[(2, 2, 1), (4, 4, 1), (6, 6, 2), (8, 8, 2), (10, 10, 3), (14, 14, 4)],
        coarse=[(4, 4, 1), (8, 8, 2), (16, 16, 4)]),
    "rod": dict(
        title="The spinning rod", truth=(-0.30755, 1e-4), shape=box(1.0, 0.1, 0.1),
        lame=lame(1e6, 0.3), density=1000.0, hold=[], spin=(20.0, (0.5, 0.05, 0.05)), take="end",
        end=0.3, output=0.003, point=(1.0, 0.05, 0), component="y",
        steps=[3e-3, 1.5e-3], tolerances=[1e-2, 1e-3, 1e-4],
        cells=[(4, 1, 1), (8, 1, 1), (12, 2, 2)], coarse=[(10, 1, 1), (10, 2, 2), (20, 2, 2)]),
    "arch": dict(
        title="A snap-through arch", truth=(-0.4548, 1e-4), shape=arch, lame=lame(1e6, 0.3),
        density=1000.0, hold=[("s0", FIXED)], move=("s1", (0, -0.1, 0)), take="reaction",
        side="s1", component="y", increment=1.0,
        cells=[(4, 1, 1), (8, 1, 1), (16, 1, 1), (20, 2, 2), (24, 2, 2), (32, 3, 3)],
        coarse=[(16, 1, 1), (32, 2, 2), (64, 4, 4)]),
    "liver": dict(
        title="The liver, pushed", truth=(-0.0458, 4e-4), file="models/liver/liver.msh",
        lame=(99e3, 1e3), density=1060.0, hold=[("fixed", FIXED)],
        tractions=[("pushed", (-50.0, 0, -100.0))], take="u", node=48, component="z",
        increment=1.0, refine=[0, 1], coarse=[1], dilatation=["local", "element"]),
    "le10": dict(
        title="NAFEMS LE10", truth=(-5.39e6, 0.02e6), shape=plate,
        grades={0: power(1.5), 1: power(1.5)}, lame=lame(210e9, 0.3), density=7800.0,
        linear=True, hold=[("t0", "y"), ("t1", "x"), ("s1", "xy"), ("middle", "z")],
        line=lambda s, t, w: (s > 1 - 1e-9) & (abs(w - 0.5) < 1e-9),
        tractions=[("w1", (0, 0, -1e6))], take="stress", point=(2.0, 0, 0.6), component="yy",
        cells=[(2, 3, 2), (4, 6, 4), (8, 12, 8)], coarse=[(4, 6, 4), (8, 12, 8), (16, 24, 16)]),
}

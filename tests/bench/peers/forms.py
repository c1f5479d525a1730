"""What the scripts for libraries of forms have in common: input and output, Newton's iteration by
load steps, the implicit mid-point rule. A body has ndof and

    internal(u)              forces of the deformation on all unknowns
    factor(u, k, m)          a function that solves (k K(u) + m M) du = r on the free unknowns
    mass(v)                  M v
    keeps                    whether a factor outlives one solution

Everything is an array over all unknowns."""
import json
import sys

import numpy as np


class Given:
    """input.json as attributes, and the arrays of input.npz."""

    def __init__(self):
        with open("input.json") as file:
            self.__dict__.update(json.load(file))
        self.__dict__.update(np.load("input.npz"))

    def match(self, points):
        """For each node of the input the row of `points` that is there."""
        size = np.ptp(self.x, axis=0).max()
        keys = [np.floor(p[:, :self.dim] / size * 1e6 + 0.12345).astype(np.int64)
                for p in (np.asarray(points), self.x)]
        order = [np.lexsort(k.T) for k in keys]
        if len(points) != len(self.x) or (keys[0][order[0]] != keys[1][order[1]]).any():
            sys.exit("the unknowns are not at the nodes")
        out = np.empty(len(points), int)
        out[order[1]] = order[0]
        return out


def report(value):
    with open("answer.json", "w") as out:
        json.dump(value, out)


def newton(body, u, free, force, most=12):
    """The equilibrium next to u; None: none is found. Ends with a correction of 1e-6 of u."""
    u = u.copy()
    for _ in range(most):
        r = force - body.internal(u)
        du = body.factor(u, 1.0, 0.0)(r[free])
        u[free] += du
        if not np.isfinite(du).all() or abs(du).max() > 1e3 * body.size:
            return None
        if abs(du).max() <= 1e-6 * abs(u).max():
            return u
    return None


def rest(body, given, free, force, held):
    """By load steps: halved where Newton's iteration fails, then doubled again."""
    if given.linear:
        return newton(body, held, free, force, 2)
    u, at, step = np.zeros_like(force), 0.0, given.increment
    while at < 1:
        step = min(step, 1 - at)
        guess = u.copy()
        guess[held != 0] = ((at + step) * held)[held != 0]
        found = newton(body, guess, free, (at + step) * force)
        if found is None:
            step /= 2
            if step < 1e-3:
                sys.exit(f"no equilibrium beyond {at:g} of the load")
            continue
        u, at, step = found, at + step, 2 * step
    return u


def motion(body, given, free, force, v, pick):
    """The mid-point rule with a constant step; the values that `pick` takes of u. A factor is kept
    while the iteration it serves contracts by four."""
    h, u, out, solve = given.step, np.zeros_like(force), [], None
    for k in range(round(given.end / h)):
        load = force * (min((k + 0.5) * h / given.rise, 1) if given.rise else 1)
        new, before = u.copy(), np.inf
        new[free] += h * v[free]
        for turn in range(40):
            middle = 0.5 * (u + new)
            r = load - body.internal(middle) - body.mass(2 / h ** 2 * (new - u) - 2 / h * v)
            if solve is None or not body.keeps:
                solve = body.factor(middle, 0.5, 2 / h ** 2)
            du = solve(r[free])
            new[free] += du
            size = abs(du).max()
            if not np.isfinite(size) or turn == 39:
                sys.exit(f"no convergence in step {k}")
            if size <= 1e-6 * body.size:
                break
            if size > 0.25 * before:
                solve = None
            before = size
        v = 2 / h * (new - u) - v
        u = new
        out.append(pick(u))
    return out


def solve(given, body, row, stress):
    """row: of each node, its first unknown; stress(u): the stress at the point."""
    held, force = np.zeros(body.ndof), body.load()
    at = row[given.held_node] + given.held_axis
    held[at] = given.held_value
    free = np.setdiff1d(np.arange(body.ndof), at)
    body.prepare(free)
    for c in range(given.dim):
        np.add.at(force, row + c, given.force[:, c])
    probe = row[given.probe] + given.component
    if given.end:
        v = np.zeros(body.ndof)
        if given.spin:
            rate, center = given.spin
            v[row], v[row + 1] = (-rate * (given.x[:, 1] - center[1]),
                                  rate * (given.x[:, 0] - center[0]))
        values = motion(body, given, free, force, v, lambda u: float(u[probe[0]]))
        report({"max": max, "min": min}.get(given.take, lambda w: w[-1])(values))
        return
    u = rest(body, given, free, force, held)
    if given.take == "reaction":
        report(float(body.internal(u)[probe].sum()))
    else:
        report(stress(u) if given.take == "stress" else float(u[probe[0]]))

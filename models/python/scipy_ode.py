"""A column falls aside by an integrator of SciPy's, beside corot's own: `State.rhs` is all that it takes.

An explicit method has to resolve the fastest wave through the smallest tet, whatever the tolerance, and
an implicit one of SciPy's knows nothing of a second-order system: that is why corot brings its own.
"""
import numpy as np
from scipy.integrate import solve_ivp

import corot

mesh = corot.Mesh.box([0.1, 0.1, 0.6], [1, 1, 6])
rubber = corot.Material(lambda_=1e5, mu=1e4, density=1000, damping_mu=20)
model = corot.Model(mesh, rubber, fix=corot.Fix("zmin"), gravity=[2, 0, -9.81])
tip = model.dof[mesh.nearest([0.05, 0.05, 0.6])]
times = np.linspace(0, 0.5, 6)

state, n = corot.State(model), model.ndof
theirs = solve_ivp(state.rhs, (0, 0.5), np.zeros(2 * n), method="DOP853", t_eval=times, rtol=1e-6, atol=1e-9)
integrator = corot.Integrator(corot.State(model), rtol=1e-6)
ours, _ = integrator.advance(times)

for t, a, b in zip(times, theirs.y[tip].T, ours[:, tip]):
    print(f"t = {t:.1f} s: SciPy {a[0]:.6f} m, corot {b[0]:.6f} m along x")
print(f"evaluations of the force: {theirs.nfev}, {integrator.statistics.nfe}")
difference = abs(theirs.y[:n].T - ours).max()
assert difference < 1e-3 * abs(ours).max(), difference

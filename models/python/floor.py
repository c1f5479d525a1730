"""A block falls on an elastic floor, a feedback of Python: nodes below z = 0 are pushed back. The blocks
tell Newton's iteration how stiff the floor is."""
import numpy as np

import corot

mesh = corot.Mesh.box([0.1, 0.1, 0.1], [2, 2, 2], origin=[0, 0, 0.02])
model = corot.Model(mesh, corot.Material(lambda_=1e5, mu=5e4, density=1000, damping_mu=50), gravity=[0, 0, -9.81])
inputs, state = corot.Inputs(model), corot.State(model)
below, height = mesh.group("zmin").node, mesh.x[:, 2]
stiffness, damping = 500.0, 1.0  # of each node: [N/m], [N s/m]


def push(t, u, v):
    force = np.zeros_like(u)
    deep = below[height[below] + u[below, 2] < 0]
    force[deep, 2] = -stiffness * (height[deep] + u[deep, 2]) - damping * v[deep, 2]
    return force


def say_how_stiff(t, u, v, blocks):
    z = np.diag([0, 0, 1.0])
    for i in below[height[below] + u[below, 2] < 0]:
        blocks.add(int(i), int(i), K=stiffness * z, D=damping * z)


inputs.set_feedback(push, say_how_stiff, name="floor")
state.use(inputs)
integrator = corot.Integrator(state)
times = np.linspace(0, 2, 81)
u, _ = integrator.advance(times)
z = u[:, model.dof[below, 2]].mean(axis=1) + 0.02
for t, height_now in list(zip(times, z))[::8]:
    print(f"t = {t:.1f} s: the underside is at {1000 * height_now:7.3f} mm")
weight = 9.81 * model.mass.sum() / 3
print(f"at rest it would be at {-1000 * weight / (stiffness * len(below)):.3f} mm")
assert abs(z[-1] + weight / (stiffness * len(below))) < 1e-3

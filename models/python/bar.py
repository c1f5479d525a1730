"""The bar of models/bar as an array: where its corner is for forty seconds, as `corot run` has it."""
from pathlib import Path
import corot
mesh = corot.Mesh.read(Path(__file__).parent.parent / "bar" / "bar.msh")
mesh.group_plane("base", "z", 0.0), mesh.group_plane("top", "z", 0.6)
rubber = corot.Material(lambda_=1e5, mu=1e4, density=1000, damping_lambda=10, damping_mu=1)
shear = corot.Load.traction("top", [200, 0, 0], amplitude=[(0, 0), (10, 1)])
model = corot.Model(mesh, rubber, fix=corot.Fix("base"), load=shear, viscosity="corotated")
u, v = corot.Integrator(corot.State(model), rtol=1e-4).advance([t / 10 for t in range(401)])
corner = u[:, model.dof[mesh.nearest([0.1, 0.1, 0.6])]]  # [401, 3] in m
print(corner.shape, *corner[-1])

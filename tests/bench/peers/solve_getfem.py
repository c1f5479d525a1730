"""One problem by GetFEM: input.json, input.npz and body.msh of the folder to answer.json."""
import getfem as gf
import numpy as np

import forms

METHODS = {"tri": "IM_TRIANGLE(2)", "quad": "IM_GAUSS_PARALLELEPIPED(2,5)",
           "tet": "IM_TETRAHEDRON(2)", "hex": "IM_GAUSS_PARALLELEPIPED(3,5)"}
EXACT = dict(METHODS, tri="IM_TRIANGLE(4)", tet="IM_TETRAHEDRON(5)")
TENSOR = "(lame(1)*Trace({E})*Id(meshdim)+2*lame(2)*{E})"


class Body:
    keeps = False

    def __init__(self, given):
        mesh = gf.Mesh("import", "gmsh", "body.msh")
        if mesh.dim() > given.dim:
            mesh.set("transform", np.eye(3)[:given.dim])
        self.given, self.mesh, self.size = given, mesh, np.ptp(given.x, axis=0).max()
        self.fem = gf.MeshFem(mesh, given.dim)
        self.fem.set_classical_fem(2)
        self.ndof = self.fem.nbdof()
        self.points = self.fem.basic_dof_nodes()[:, ::given.dim].T
        self.methods = [gf.MeshIm(mesh, gf.Integ(m[given.kind])) for m in (METHODS, EXACT)]
        if given.linear:
            self.stress = TENSOR.format(E="Sym(Grad_u)")
            self.form = self.stress + ":Grad_Test_u"
        else:
            self.form = ("((Id(meshdim)+Grad_u)*Saint_Venant_Kirchhoff_PK2(Grad_u,lame))"
                         ":Grad_Test_u")

    def assemble(self, order, form, u, exact=False):
        return gf.asm("generic", self.methods[exact], order, form, -1, "u", 1, self.fem, u,
                      "lame", 0, np.array(self.given.lame))

    def load(self):
        if not self.given.gravity:
            return np.zeros(self.ndof)
        g = self.given.density * np.array(self.given.gravity[:self.given.dim])
        text = "[" + ",".join("%.17g" % c for c in g) + "].Test_u"
        return self.assemble(1, text, np.zeros(self.ndof), True)

    def prepare(self, free):
        self.free, self.M = free, None
        if self.given.end:
            self.M = self.assemble(2, f"{self.given.density}*u.Test_u", np.zeros(self.ndof), True)

    def mass(self, v):
        return self.M.mult(v)

    def internal(self, u):
        return self.assemble(1, self.form, u)

    def factor(self, u, k, m):
        K = self.assemble(2, self.form, u)
        if self.M is not None:
            K.scale(k)
            M = gf.Spmat("copy", self.M)
            M.scale(m)
            K = gf.Spmat("add", K, M)
        K = gf.Spmat("copy", K, self.free, self.free)
        return lambda r: np.ravel(gf.linsolve("mumps", K, r))

    def stress_at(self, u):
        """The mean over the elements at the point, of the stress on linear ones."""
        given, fem = self.given, gf.MeshFem(self.mesh, 1)
        fem.set_classical_discontinuous_fem(1)
        model = gf.Model("real")
        model.add_fem_data("u", self.fem)
        model.set_variable("u", u)
        model.add_initialized_data("lame", given.lame)
        i, j = [(1, 1), (2, 2), (3, 3), (1, 2), (2, 3), (3, 1)][given.component]
        values = model.interpolation(f"({self.stress})({i},{j})", fem)
        off = np.linalg.norm(fem.basic_dof_nodes().T - given.x[given.probe[0]], axis=1)
        return float(values[off < 1e-9 * self.size].mean())


def main():
    gf.util("trace level", 0)
    gf.util("warning level", 0)
    given = forms.Given()
    body = Body(given)
    row = given.dim * given.match(body.points)
    forms.solve(given, body, row, body.stress_at)


main()

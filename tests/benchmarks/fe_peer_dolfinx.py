# The box below a load of fe_peers_benchmark.cc by dolfinx: assembles and solves once, prints unknowns,
# iterations, processor seconds of assembly and solve, L2 errors of displacement and stress.
# Usage: fe_peer_dolfinx.py CELLS DEGREE amg|lu
import sys
import time

import dolfinx
import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

cells, degree, method = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
nu, gap = 0.3, 0.05
square = mesh.create_rectangle(
    MPI.COMM_SELF, [np.array([-0.5, -1 - gap]), np.array([0.5, -gap])], [cells, cells], mesh.CellType.quadrilateral)


def flamant(x):
    depth = -x[1]
    r2 = x[0] ** 2 + depth ** 2
    scale = (1 + nu) / np.pi
    return np.array([scale * (x[0] * depth / r2 - (1 - 2 * nu) * np.arctan2(x[0], depth)),
                     scale * ((1 - nu) * np.log(r2) + x[0] ** 2 / r2)])


def stress(u):
    lame, shear = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
    strain = ufl.sym(ufl.grad(u))
    return lame * ufl.tr(strain) * ufl.Identity(2) + 2 * shear * strain


def null_space(space):
    index = space.dofmap.index_map
    n = index.size_local
    x = space.tabulate_dof_coordinates()[:n]
    modes = [np.zeros(2 * n) for _ in range(3)]
    modes[0][0::2] = 1
    modes[1][1::2] = 1
    modes[2][0::2], modes[2][1::2] = -x[:, 1], x[:, 0]
    basis = [PETSc.Vec().createWithArray(np.ascontiguousarray(q), comm=MPI.COMM_SELF) for q in
             np.linalg.qr(np.array(modes).T)[0].T]
    return PETSc.NullSpace().create(vectors=basis, comm=MPI.COMM_SELF), basis


def solve():
    space = fem.VectorFunctionSpace(square, ("Lagrange", degree))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    a = fem.form(ufl.inner(stress(u), ufl.sym(ufl.grad(v))) * ufl.dx)
    zero = fem.Constant(square, PETSc.ScalarType((0, 0)))
    right = fem.form(ufl.inner(zero, v) * ufl.dx)
    square.topology.create_connectivity(1, 2)
    held = fem.Function(space)
    held.interpolate(flamant)
    facets = mesh.exterior_facet_indices(square.topology)
    bc = fem.dirichletbc(held, fem.locate_dofs_topological(space, 1, facets))
    start = time.process_time()
    matrix = fem.petsc.assemble_matrix(a, bcs=[bc])
    matrix.assemble()
    rhs = fem.petsc.assemble_vector(right)
    fem.petsc.apply_lifting(rhs, [a], bcs=[[bc]])
    fem.petsc.set_bc(rhs, [bc])
    assembled = time.process_time()
    solver = PETSc.KSP().create(MPI.COMM_SELF)
    if method == "lu":
        solver.setType("preonly")
        solver.getPC().setType("lu")
        solver.getPC().setFactorSolverType("mumps")
    else:
        modes, keep = null_space(space)
        matrix.setNearNullSpace(modes)
        solver.setType("cg")
        solver.getPC().setType("gamg")
        solver.setNormType(PETSc.KSP.NormType.UNPRECONDITIONED)
        solver.setTolerances(rtol=1e-10, max_it=2000)
        PETSc.Options()["mg_levels_ksp_type"] = "chebyshev"
        PETSc.Options()["mg_levels_pc_type"] = "jacobi"
        solver.setFromOptions()
    solver.setOperators(matrix)
    found = fem.Function(space)
    solver.solve(rhs, found.vector)
    solved = time.process_time()
    return space, found, solver.getIterationNumber(), assembled - start, solved - assembled


solve() if cells <= 32 else None
space, found, iterations, assembly, solution = solve()
x = ufl.SpatialCoordinate(square)
depth = -x[1]
r2 = x[0] ** 2 + depth ** 2
scale = (1 + nu) / np.pi
exact = ufl.as_vector([scale * (x[0] * depth / r2 - (1 - 2 * nu) * ufl.atan_2(x[0], depth)),
                       scale * ((1 - nu) * ufl.ln(r2) + x[0] ** 2 / r2)])
difference = found - exact
rule = {"quadrature_degree": 2 * degree + 4}
error = np.sqrt(fem.assemble_scalar(fem.form(ufl.inner(difference, difference) * ufl.dx(metadata=rule))))
# xx, yy, xy as the benchmark counts them: the shear once.
s = stress(found) - stress(exact)
stress_error = np.sqrt(fem.assemble_scalar(fem.form(
    (s[0, 0] ** 2 + s[1, 1] ** 2 + s[0, 1] ** 2) * ufl.dx(metadata=rule))))
print(space.dofmap.index_map.size_global * 2, iterations, f"{assembly:.4f} {solution:.4f} {error:.4e} {stress_error:.4e}")

# The box below a load of fe_peers_benchmark.cc by dolfinx: assembles and solves once, prints unknowns,
# iterations, processor seconds of assembly and solve, L2 errors of displacement and stress.
# Usage: fe_peer_dolfinx.py CELLS DEGREE amg|lu [2|3]   (dimension)
import sys
import time

import dolfinx
import numpy as np
import ufl
from dolfinx import fem, mesh
from mpi4py import MPI
from petsc4py import PETSc

cells, degree, method = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
dim = int(sys.argv[4]) if len(sys.argv) > 4 else 2
nu, gap = 0.3, 0.05
if dim == 2:
    box = mesh.create_rectangle(
        MPI.COMM_SELF, [np.array([-0.5, -1 - gap]), np.array([0.5, -gap])], [cells, cells], mesh.CellType.quadrilateral)
else:
    box = mesh.create_box(
        MPI.COMM_SELF, [np.array([-0.5, -0.5, -1 - gap]), np.array([0.5, 0.5, -gap])], [cells] * 3,
        mesh.CellType.hexahedron)
# As many points a direction as the other program has.
rule = {"quadrature_degree": 2 * degree + 1} if dim == 3 else {}


def flamant(x):
    depth = -x[1]
    r2 = x[0] ** 2 + depth ** 2
    scale = (1 + nu) / np.pi
    return np.array([scale * (x[0] * depth / r2 - (1 - 2 * nu) * np.arctan2(x[0], depth)),
                     scale * ((1 - nu) * np.log(r2) + x[0] ** 2 / r2)])


def boussinesq(x, sqrt):
    depth = -x[2]
    r = sqrt(x[0] ** 2 + x[1] ** 2 + depth ** 2)
    scale = (1 + nu) / (2 * np.pi)
    side = depth / r ** 3 - (1 - 2 * nu) / (r * (r + depth))
    return [scale * x[0] * side, scale * x[1] * side, -scale * (depth ** 2 / r ** 3 + 2 * (1 - nu) / r)]


def below_load(x):
    return flamant(x) if dim == 2 else np.array(boussinesq(x, np.sqrt))


def stress(u):
    lame, shear = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
    strain = ufl.sym(ufl.grad(u))
    return lame * ufl.tr(strain) * ufl.Identity(dim) + 2 * shear * strain


def null_space(space):
    index = space.dofmap.index_map
    n = index.size_local
    x = space.tabulate_dof_coordinates()[:n]
    modes = [np.zeros(dim * n) for _ in range(3 if dim == 2 else 6)]
    for d in range(dim):
        modes[d][d::dim] = 1
    for k, (a, b) in enumerate([(0, 1)] if dim == 2 else [(0, 1), (1, 2), (2, 0)]):
        modes[dim + k][a::dim], modes[dim + k][b::dim] = -x[:, b], x[:, a]
    basis = [PETSc.Vec().createWithArray(np.ascontiguousarray(q), comm=MPI.COMM_SELF) for q in
             np.linalg.qr(np.array(modes).T)[0].T]
    return PETSc.NullSpace().create(vectors=basis, comm=MPI.COMM_SELF), basis


def solve():
    space = fem.VectorFunctionSpace(box, ("Lagrange", degree))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    a = fem.form(ufl.inner(stress(u), ufl.sym(ufl.grad(v))) * ufl.dx(metadata=rule))
    zero = fem.Constant(box, PETSc.ScalarType((0,) * dim))
    right = fem.form(ufl.inner(zero, v) * ufl.dx)
    box.topology.create_connectivity(dim - 1, dim)
    held = fem.Function(space)
    held.interpolate(below_load)
    facets = mesh.exterior_facet_indices(box.topology)
    bc = fem.dirichletbc(held, fem.locate_dofs_topological(space, dim - 1, facets))
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


solve() if dim == 2 and cells <= 32 else None
space, found, iterations, assembly, solution = solve()
x = ufl.SpatialCoordinate(box)
if dim == 2:
    depth = -x[1]
    r2 = x[0] ** 2 + depth ** 2
    scale = (1 + nu) / np.pi
    exact = ufl.as_vector([scale * (x[0] * depth / r2 - (1 - 2 * nu) * ufl.atan_2(x[0], depth)),
                           scale * ((1 - nu) * ufl.ln(r2) + x[0] ** 2 / r2)])
else:
    exact = ufl.as_vector(boussinesq(x, ufl.sqrt))
difference = found - exact
rule = {"quadrature_degree": 2 * degree + 4 if dim == 2 else 2 * degree + 5}
error = np.sqrt(fem.assemble_scalar(fem.form(ufl.inner(difference, difference) * ufl.dx(metadata=rule))))
# Components as the benchmark counts them: each shear once.
s = stress(found) - stress(exact)
square = sum(s[i, j] ** 2 for i in range(dim) for j in range(i + 1))
stress_error = np.sqrt(fem.assemble_scalar(fem.form(square * ufl.dx(metadata=rule))))
print(space.dofmap.index_map.size_global * dim, iterations, f"{assembly:.4f} {solution:.4f} {error:.4e} {stress_error:.4e}")

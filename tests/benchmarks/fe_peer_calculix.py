# The box below a load of fe_peers_benchmark.cc by CalculiX (ccx): writes the input (plane-strain
# elements CPE4 or CPE8, in space C3D8 or C3D20, on the same mesh), runs it, reads the displacement
# back; prints unknowns, processor seconds of ccx alone and the L2 error of the displacement.
# Usage: fe_peer_calculix.py CELLS DEGREE FOLDER [2|3 [SOLVER]]   (dimension)
import itertools
import os
import resource
import subprocess
import sys

import numpy as np

n, degree, folder = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
dim = int(sys.argv[4]) if len(sys.argv) > 4 else 2
solver = sys.argv[5] if len(sys.argv) > 5 else ""
nu, gap = 0.3, 0.05


def below_load(*p):
    depth = -p[-1]
    if dim == 2:
        r2 = p[0] ** 2 + depth ** 2
        scale = (1 + nu) / np.pi
        return np.array([scale * (p[0] * depth / r2 - (1 - 2 * nu) * np.arctan2(p[0], depth)),
                         scale * ((1 - nu) * np.log(r2) + p[0] ** 2 / r2)])
    r = np.sqrt(p[0] ** 2 + p[1] ** 2 + depth ** 2)
    scale = (1 + nu) / (2 * np.pi)
    side = depth / r ** 3 - (1 - 2 * nu) / (r * (r + depth))
    return np.array([scale * p[0] * side, scale * p[1] * side, -scale * (depth ** 2 / r ** 3 + 2 * (1 - nu) / r)])


m = degree * n
# Nodes at [x, y(, z)] of cells cut by the degree: of degree 2 corners and middles of edges.
grid = np.array(np.meshgrid(*[np.arange(m + 1)] * dim, indexing="ij"))
used = np.ones_like(grid[0], dtype=bool) if degree == 1 else (grid % 2).sum(axis=0) <= 1
ids = -np.ones_like(grid[0])
ids[used] = np.arange(used.sum()) + 1
place = [-0.5 + g / m for g in grid[:-1]] + [-1 - gap + grid[-1] / m]
# The element's nodes in ccx' order, -1, 0, 1 along each axis: corners, then middles of edges.
around = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
corners = around if dim == 2 else [c + (z,) for z in (-1, 1) for c in around]


def middle(a, b):
    return tuple((p + q) // 2 for p, q in zip(corners[a], corners[b]))


ring = [(0, 1), (1, 2), (2, 3), (3, 0)]
edges = ring if dim == 2 else ring + [(a + 4, b + 4) for a, b in ring] + [(a, a + 4) for a in range(4)]
nodes = corners if degree == 1 else corners + [middle(a, b) for a, b in edges]
first = np.array(np.meshgrid(*[np.arange(n)] * dim, indexing="ij")).reshape(dim, -1) * degree
elements = np.array([ids[tuple(first[d] + (p[d] + 1) * degree // 2 for d in range(dim))] for p in nodes]).T
border = used & np.any((grid == 0) | (grid == m), axis=0)
exact = below_load(*place)
kind = {(2, 1): "CPE4", (2, 2): "CPE8", (3, 1): "C3D8", (3, 2): "C3D20"}[dim, degree]
job = os.path.join(folder, "box")
with open(job + ".inp", "w") as out:
    out.write("*NODE,NSET=all\n")
    for row in zip(ids[used], *[p[used] for p in place]):
        out.write(f"{row[0]}," + ",".join(f"{v:.12g}" for v in row[1:]) + (",0\n" if dim == 2 else "\n"))
    out.write(f"*ELEMENT,TYPE={kind},ELSET=box\n")
    for k, element in enumerate(elements):
        words = [str(k + 1)] + [str(i) for i in element]
        out.write(",".join(words[:16]) + (",\n" + ",".join(words[16:]) if len(words) > 16 else "") + "\n")
    out.write(f"*MATERIAL,NAME=m\n*ELASTIC\n1,{nu}\n*SOLID SECTION,ELSET=box,MATERIAL=m\n")
    out.write("1\n*BOUNDARY\n" if dim == 2 else "*BOUNDARY\n")
    for row in zip(ids[border], *[e[border] for e in exact]):
        for d in range(dim):
            out.write(f"{row[0]},{d + 1},{d + 1},{row[1 + d]:.14g}\n")
    out.write("*STEP\n*STATIC" + (f",SOLVER={solver}" if solver else "") + "\n*NODE PRINT,NSET=all\nU\n*END STEP\n")
done = subprocess.run(["ccx", "-i", "box"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
used_by_ccx = resource.getrusage(resource.RUSAGE_CHILDREN)
seconds = used_by_ccx.ru_utime + used_by_ccx.ru_stime
u = np.zeros((dim, ids.max() + 1))
with open(job + ".dat") as data:
    for line in data:
        words = line.split()
        if len(words) == 4 and words[0].isdigit():
            u[:, int(words[0])] = [float(w) for w in words[1:1 + dim]]
if not np.any(u):
    sys.exit("ccx failed: " + done.stdout[-500:])


def shape(node, at):
    if 0 in node:  # the middle of an edge along that axis
        return np.prod([1 - a * a if q == 0 else 1 + a * q for q, a in zip(node, at)]) / 2 ** (dim - 1)
    value = np.prod([1 + a * q for q, a in zip(node, at)]) / 2 ** dim
    return value if degree == 1 else value * (sum(a * q for q, a in zip(node, at)) - (dim - 1))


# L2 norm with five Gauss points each way.
points, weights = np.polynomial.legendre.leggauss(5)
total = 0.0
start = [-0.5 + f / m for f in first[:-1]] + [-1 - gap + first[-1] / m]
for choice in itertools.product(range(5), repeat=dim):
    at = points[list(choice)]
    found = sum(shape(p, at) * u[:, elements[:, k]] for k, p in enumerate(nodes))
    true = below_load(*[s + (1 + a) / 2 / n for s, a in zip(start, at)])
    total += np.prod(weights[list(choice)]) * np.sum((found - true) ** 2) / (2 * n) ** dim
print(dim * int(used.sum()), f"{seconds:.4f} {np.sqrt(total):.4e}")

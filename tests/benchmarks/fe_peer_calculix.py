# The box below a load of fe_peers_benchmark.cc by CalculiX (ccx): writes the input (CPE4 or CPE8
# plane-strain elements on the same mesh), runs it, reads the displacement back; prints unknowns,
# processor seconds of ccx alone and the L2 error of the displacement.
# Usage: fe_peer_calculix.py CELLS DEGREE FOLDER [SOLVER]
import os
import resource
import subprocess
import sys

import numpy as np

n, degree, folder = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
solver = sys.argv[4] if len(sys.argv) > 4 else ""
nu, gap = 0.3, 0.05


def flamant(x, y):
    depth = -y
    r2 = x ** 2 + depth ** 2
    scale = (1 + nu) / np.pi
    return np.array([scale * (x * depth / r2 - (1 - 2 * nu) * np.arctan2(x, depth)),
                     scale * ((1 - nu) * np.log(r2) + x ** 2 / r2)])


m = degree * n
ids = -np.ones((m + 1, m + 1), dtype=int)  # [row, column] of half cells
rows, columns = np.meshgrid(np.arange(m + 1), np.arange(m + 1), indexing="ij")
used = np.ones_like(rows, dtype=bool) if degree == 1 else ~((rows % 2 == 1) & (columns % 2 == 1))
ids[used] = np.arange(used.sum()) + 1
x, y = -0.5 + columns / m, -1 - gap + rows / m
r, c = (degree * g.ravel() for g in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
offsets = [(0, 0), (0, 1), (1, 1), (1, 0)] if degree == 1 else [
    (0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0)]
elements = np.array([ids[r + i, c + j] for i, j in offsets]).T
border = used & ((rows == 0) | (rows == m) | (columns == 0) | (columns == m))
exact = flamant(x, y)
job = os.path.join(folder, "box")
with open(job + ".inp", "w") as out:
    out.write("*NODE,NSET=all\n")
    for i, a, b in zip(ids[used], x[used], y[used]):
        out.write(f"{i},{a:.12g},{b:.12g},0\n")
    out.write(f"*ELEMENT,TYPE={'CPE4' if degree == 1 else 'CPE8'},ELSET=box\n")
    for k, nodes in enumerate(elements):
        out.write(f"{k + 1}," + ",".join(map(str, nodes)) + "\n")
    out.write(f"*MATERIAL,NAME=m\n*ELASTIC\n1,{nu}\n*SOLID SECTION,ELSET=box,MATERIAL=m\n1\n*BOUNDARY\n")
    for i, a, b in zip(ids[border], exact[0][border], exact[1][border]):
        out.write(f"{i},1,1,{a:.14g}\n{i},2,2,{b:.14g}\n")
    out.write("*STEP\n*STATIC" + (f",SOLVER={solver}" if solver else "") + "\n*NODE PRINT,NSET=all\nU\n*END STEP\n")
done = subprocess.run(["ccx", "-i", "box"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
used_by_ccx = resource.getrusage(resource.RUSAGE_CHILDREN)
seconds = used_by_ccx.ru_utime + used_by_ccx.ru_stime
u = np.zeros((2, ids.max() + 1))
with open(job + ".dat") as data:
    for line in data:
        words = line.split()
        if len(words) == 4 and words[0].isdigit():
            u[:, int(words[0])] = float(words[1]), float(words[2])
if not np.any(u):
    sys.exit("ccx failed: " + done.stdout[-500:])
# L2 norm with five Gauss points each way.
points, weights = np.polynomial.legendre.leggauss(5)
total = 0.0
place = [(j - 1, i - 1) for i, j in offsets] if degree == 2 else [(2 * j - 1, 2 * i - 1) for i, j in offsets]
x0, y0 = -0.5 + c / m, -1 - gap + r / m
for a, wa in zip(points, weights):
    for b, wb in zip(points, weights):
        if degree == 1:
            shape = [(1 + a * p) * (1 + b * q) / 4 for p, q in place]
        else:
            shape = [(1 + a * p) * (1 + b * q) * (a * p + b * q - 1) / 4 for p, q in place[:4]] + [
                (1 - a * a) * (1 + b * q) / 2 if p == 0 else (1 + a * p) * (1 - b * b) / 2 for p, q in place[4:]]
        found = sum(s * u[:, elements[:, k]] for k, s in enumerate(shape))
        true = flamant(x0 + (1 + a) / 2 / n, y0 + (1 + b) / 2 / n)
        total += wa * wb * np.sum((found - true) ** 2) / (4 * n * n)
print(2 * int(used.sum()), f"{seconds:.4f} {np.sqrt(total):.4e}")

# For average_lammps.sh: its two fields again with numpy. Usage: average_numpy.py "STEP PXX PYY ..."
import sys
import numpy as np


def csv(file):
    return np.genfromtxt(file, delimiter=",", names=True)


def dump(file):
    lines = open(file).read().split("\n")
    at = max(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS") or line.startswith("ITEM: ENTRIES"))
    names = lines[at].split()[2:]
    rows = np.array([line.split() for line in lines[at + 1:] if line], float)
    return {name: rows[:, k] for k, name in enumerate(names)}


def report(what, difference, allowed):
    print(f"{what}: largest difference / largest component {difference:.2g}")
    if not difference <= allowed:
        sys.exit(f"{what}: above {allowed:g}")


# LAMMPS' pressure is minus the mean stress; its components are xx yy zz xy xz yz: branch, force.
theirs = -np.array(sys.argv[1].split()[1:7], float)
ours = csv("cell/cell.csv")
mean = np.array([ours[f"sigma_{c}"] for c in ("xx", "yy", "zz", "yx", "zx", "zy")])
print("LAMMPS    ", theirs)
print("grainfield", mean)
report("mean stress of the cell", np.abs(mean - theirs).max() / np.abs(theirs).max(), 1e-10)

# The settled box: Lucy's kernel w, branches that go on into the walls by twice its range.
g = dump("box/grains.dump")
c = dump("box/contacts.dump")
x = np.column_stack([g["x"], g["y"], g["z"]])
row = {int(i): k for k, i in enumerate(g["id"])}
i = np.array([row[int(k)] for k in c["c_ids[1]"]])
j = np.array([row[int(k)] for k in c["c_ids[2]"]])
force = np.column_stack([c[f"c_p[{k}]"] + c[f"c_p[{k + 3}]"] for k in (1, 2, 3)])
start, end = [x[i]], [x[j]]
forces = [force]
w, reach = 0.01, 0.02
walls = {"floor": (2, 0, 1), "left": (0, 0, 1), "right": (0, 0.06, -1), "front": (1, 0, 1), "back": (1, 0.06, -1)}
for name, (axis, place, side) in walls.items():
    f = np.column_stack([g[f"f_{name}[{k}]"] for k in (2, 3, 4)])
    on = g[f"f_{name}[1]"] > 0
    far = x[on].copy()
    far[:, axis] = place - side * 2 * reach
    start.append(x[on]), end.append(far), forces.append(f[on])
start, end, forces = map(np.concatenate, (start, end, forces))
nodes, weights = np.polynomial.legendre.leggauss(40)


def lucy(r):
    a = r / reach
    return np.where(a < 1, 105 / (16 * np.pi * reach**3) * (1 + 3 * a) * (1 - a) ** 3, 0)


ours = csv("box/field.csv")
worst = top = 0
for k, point in enumerate(np.column_stack([ours["x"], ours["y"], ours["z"]])):
    sigma = np.zeros((3, 3))
    for a, b, f in zip(start, end, forces):
        length = np.linalg.norm(b - a)
        foot = (point - a) @ (b - a) / length
        d2 = (point - a) @ (point - a) - foot**2
        if d2 >= reach**2:
            continue
        half = np.sqrt(reach**2 - d2)
        ends = [max(0, foot - half), min(max(foot, 0), length), min(length, foot + half)]
        for s0, s1 in zip(ends, ends[1:]):
            if s1 > s0:
                s = (s0 + s1) / 2 + (s1 - s0) / 2 * nodes
                part = (s1 - s0) / 2 * weights @ lucy(np.sqrt(d2 + (s - foot) ** 2)) / length
                sigma += part * np.outer(f, b - a)
    seen = np.array([[ours[f"sigma_{p}{q}"][k] for q in "xyz"] for p in "xyz"])
    density = g["mass"] @ lucy(np.linalg.norm(x - point, axis=1))
    worst = max(worst, np.abs(sigma - seen).max())
    top = max(top, np.abs(seen).max())
    if abs(density - ours["density"][k]) > 1e-10 * 2500:
        sys.exit(f"density at {point}: {ours['density'][k]}, numpy {density}")
report(f"stress at {len(ours)} places of a box of {len(x)} spheres", worst / top, 1e-9)

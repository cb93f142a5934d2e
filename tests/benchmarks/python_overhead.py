"""What Python adds to the time of averages and steps (docs/python.md). Run by hand:

PYTHONPATH=build/release/python /usr/bin/python3 tests/benchmarks/python_overhead.py
"""

import time

import numpy as np

import grainfield as gf


def lattice(columns, rows, d=0.01):
    """Disks on a triangular lattice, contacts with the force of their depth."""
    row, column = (a.ravel() for a in np.divmod(np.arange(rows * columns), columns))
    x, y = d * (column + row % 2 / 2) + d / 2, d / 2 + row * d * np.sqrt(3) / 2
    ids = np.arange(rows * columns)
    right = ids[column < columns - 1]
    up = ids[(row < rows - 1) & ~((row % 2 == 1) & (column == columns - 1))]
    pairs = np.concatenate([np.stack([right, right + 1]), np.stack([up, up + columns + row[up] % 2])], axis=1)
    i, j = pairs
    bond = np.stack([x[j] - x[i], y[j] - y[i]], axis=1) / d
    forces = -bond * (y.max() - y[i] + d)[:, None]
    return gf.packing(x, y, d / 2, density=2000, walls=["floor:y=0"], friction=0.3,
                      contacts={"i": i, "j": j, "forces": forces})


start = time.perf_counter()
grains = lattice(800, 500)
print(f"packing of {len(grains)} grains and {len(grains.contacts)} contacts from arrays: "
      f"{time.perf_counter() - start:.2f} s")
for run in range(3):
    start = time.perf_counter()
    field = gf.average(grains, frame="packing", grid=(81, 31), quantities=["sigma"])
    taken = time.perf_counter() - start
    print(f"average: {taken:.3f} s, C++ {field.seconds:.3f} s, Python adds {taken / field.seconds - 1:.2%}")

material = dict(law="linear", normal_stiffness=1e6, tangential_stiffness=3e5)


def cpu_of(work):
    """s: other work on the machine does not count."""
    start = time.process_time()
    work()
    return time.process_time() - start


for columns, rows, calls in ((5, 4, 1000), (50, 40, 20)):
    engine = gf.Engine(lattice(columns, rows), material=material)
    engine.step(1000)
    places = engine.positions

    def loop():
        for _ in range(calls):
            engine.step(1000)
            places[:, 1].max()

    # By turns, so that both meet the same machine; the least of each counts.
    pairs = [(cpu_of(lambda: engine.step(1000 * calls)), cpu_of(loop)) for _ in range(7)]
    at_once, in_loop = (min(taken) for taken in zip(*pairs))
    ratios = sorted(b / a - 1 for a, b in pairs)
    print(f"{len(engine)} grains, {1000 * calls} steps: in one call {at_once:.3f} s, in calls of 1,000 "
          f"with a look at the positions {in_loop:.3f} s: {in_loop / at_once - 1:+.2%} "
          f"(pair by pair: median {ratios[3]:+.2%}, {ratios[0]:+.2%} to {ratios[-1]:+.2%})")

forces = {
    "add_force": lambda engine, every: engine.add_force(lambda t, grains: -1e-3 * grains.velocities, every=every, name="own"),
    "add_contact_force": lambda engine, every: engine.add_contact_force(lambda t, contacts: 1e-3 * contacts.normals,
                                                                        every=every, name="own"),
}
for columns, rows, steps in ((5, 4, 20000), (50, 40, 1000), (250, 200, 40)):
    for name, add in forces.items():
        for every in (1, 10):
            own, without = (gf.Engine(lattice(columns, rows), material=material) for _ in range(2))
            add(own, every)
            own.step(steps), without.step(steps)
            pairs = [(cpu_of(lambda: without.step(steps)), cpu_of(lambda: own.step(steps))) for _ in range(5)]
            ratio = sorted(b / a for a, b in pairs)[2]
            more = sorted(b - a for a, b in pairs)[2] / steps
            print(f"{len(own)} grains, {name}, every={every}: {ratio:.2f} times the time without (median of five), "
                  f"{1e6 * more:.1f} us a step more")

#!/usr/bin/env python3
"""The whole task beside LAMMPS: 10,000 disks rain into a box and come to rest.

    tests/benchmarks/against_lammps_task.py [--rounds 5] [--disks 10000] [--threads 1]

Both programs start from the same places and speeds, with the same walls, law (linear springs and
dashpots, friction with memory) and time step, and stop when the kinetic energy falls below the same
bound. Times are processor times of whole processes, reading and writing included, in turns. A round has
rain of its own: when the last grain stops rolling is chance, so steps are printed, too. Ends with medians
of the times and of their ratios, for the task and for a step.

Needs: the Debian package lammps, numpy, and the module grainfield (build/release/python).
"""
import argparse
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
RADIUS, WIDTH, DENSITY = 0.01, 2.0, 2500.0  # m, m, kg/m2
STIFFNESS, SHEAR, DASHPOT, SLIP_DASHPOT, FRICTION = 2e7, 1e7, 4000.0, 2000.0, 0.5
STEP, EVERY = 2e-5, 1000  # s; steps between looks at the energy
REST = 1e-9  # kinetic energy at rest, of the work that moves all grains up by a diameter


def rain(count, seed=1):
    """Places (x, y) and radii, m, and downward speeds, m/s, of a loose array with some disorder."""
    random = np.random.default_rng(seed)
    columns = int(WIDTH / (2.5 * RADIUS))
    number = np.arange(count)
    gap = WIDTH / columns
    x = (number % columns + 0.5) * gap + random.uniform(-1, 1, count) * 0.1 * RADIUS
    y = (number // columns + 1) * gap + random.uniform(-1, 1, count) * 0.1 * RADIUS
    return x, y, random.uniform(0.95, 1.05, count) * RADIUS, random.uniform(0, 0.5, count)


def energy_at_rest(radii):
    return REST * DENSITY * np.pi * (radii**2).sum() * 9.81 * 2 * RADIUS


OWN = """
import sys, numpy as np, grainfield as gf
x, y, radii, speeds = np.load(sys.argv[1])
packing = gf.packing(x, y, radii, density={density}, velocities=np.stack([0 * x, -speeds], 1),
                     walls=["floor:y=0", "left:x=0", "right:x={width}"], friction={friction})
engine = gf.Engine(packing, material=dict(law="linear", normal_stiffness={stiffness}, tangential_stiffness={shear},
    normal_damping={dashpot}, tangential_damping={slip}, friction={friction}, floor_friction={friction},
    wall_friction={friction}), motion=dict(time_step={step}), threads={threads})
steps = 0
while True:
    engine.step({every})
    steps += {every}
    if engine.measure()["kinetic_energy"] < {rest}:
        break
gf.write(sys.argv[2] + ".h5", engine.packing())
np.savez(sys.argv[2], places=engine.in_order(engine.positions), steps=steps)
"""

DECK = """units si
dimension 2
boundary f f p
atom_style sphere
newton off
comm_modify vel yes
read_data {folder}/rain.data
set group all density/disc {density}
pair_style gran/hooke/history {law}
pair_coeff * *
neighbor {skin} bin
neigh_modify delay 0 every 1 check yes
timestep {step}
fix move all nve/sphere disc
fix weight all gravity 9.81 vector 0 -1 0
fix plane all enforce2d
fix sides all wall/gran hooke/history {law} xplane 0 {width}
fix floor all wall/gran hooke/history {law} yplane 0 NULL
compute ke all ke
compute turning all erotate/sphere
variable energy equal c_ke+c_turning
thermo {every}
thermo_style custom step v_energy
fix rest all halt {every} v_energy < {rest} error continue
run 100000000
write_dump all custom {folder}/lammps.dump id x y modify sort id format float %.17g
"""


def write_rain(file, places):
    x, y, radii, speeds = places
    lines = [f"rain\n\n{len(x)} atoms\n1 atom types\n\n-0.01 {WIDTH + 0.01} xlo xhi\n-0.01 {y.max() + 1} ylo yhi\n"
             "-0.5 0.5 zlo zhi\n\nAtoms\n\n"]
    lines += [f"{k + 1} 1 {2 * radii[k]!r} {DENSITY} {x[k]!r} {y[k]!r} 0\n" for k in range(len(x))]
    lines += ["\nVelocities\n\n"] + [f"{k + 1} 0 {-speeds[k]!r} 0 0 0 0\n" for k in range(len(x))]
    file.write_text("".join(lines))


def processor_time(command, log):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(log, "w") as out:
        done = subprocess.run(command, stdout=out, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        sys.exit(f"{command[0]} ended with {done.returncode}: {pathlib.Path(log).read_text()[-500:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def one_round(folder, places, given):
    """Of LAMMPS and of this program: processor time (s), steps, mean height at rest (m)."""
    np.save(folder / "rain.npy", places)
    write_rain(folder / "rain.data", places)
    rest = energy_at_rest(places[2])
    own = f"import sys; sys.path.insert(0, {given.build + '/python'!r})" + OWN.format(
        density=DENSITY, width=WIDTH, friction=FRICTION, stiffness=STIFFNESS, shear=SHEAR, dashpot=DASHPOT,
        slip=SLIP_DASHPOT, step=STEP, every=EVERY, rest=rest, threads=given.threads)
    (folder / "own.py").write_text(own)
    law = f"{STIFFNESS} {SHEAR} {DASHPOT} {SLIP_DASHPOT} {FRICTION} 1"
    (folder / "in.rain").write_text(DECK.format(folder=folder, density=DENSITY, law=law, skin=0.2 * RADIUS,
                                                step=STEP, width=WIDTH, every=EVERY, rest=rest))
    lammps = processor_time(["lmp", "-log", "none", "-in", str(folder / "in.rain")], folder / "lammps.out")
    grainfield = processor_time([sys.executable, str(folder / "own.py"), str(folder / "rain.npy"),
                                 str(folder / "own")], folder / "own.out")
    thermo = [line.split() for line in (folder / "lammps.out").read_text().splitlines()]
    steps = [int(words[0]) for words in thermo if len(words) == 2 and words[0].isdigit()]
    heights = np.loadtxt(folder / "lammps.dump", skiprows=9)[:, 2]
    result = np.load(folder / "own.npz")
    return ((lammps, steps[-1], heights.mean()),
            (grainfield, int(result["steps"]), result["places"][:, 1].mean()))


def main():
    ask = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    ask.add_argument("--rounds", type=int, default=5)
    ask.add_argument("--disks", type=int, default=10000)
    ask.add_argument("--threads", type=int, default=1)
    ask.add_argument("--build", default=str(ROOT / "build/release"))
    given = ask.parse_args()
    rows = []
    for turn in range(1, given.rounds + 1):
        with tempfile.TemporaryDirectory() as name:
            rows.append(one_round(pathlib.Path(name), np.array(rain(given.disks, turn)), given))
        theirs, own = rows[-1]
        print(f"round {turn}: LAMMPS {theirs[0]:.1f} s, {theirs[1]} steps, mean height {theirs[2]:.4f} m; "
              f"grainfield {own[0]:.1f} s, {own[1]} steps, {own[2]:.4f} m", flush=True)
    times = [statistics.median(row[k][0] for row in rows) for k in (0, 1)]
    task = statistics.median(a[0] / b[0] for a, b in rows)
    step = statistics.median(a[0] / a[1] / (b[0] / b[1]) for a, b in rows)
    print(f"medians: LAMMPS {times[0]:.1f} s, grainfield {times[1]:.1f} s; LAMMPS takes {task:.2f} times as long "
          f"for the task, {step:.2f} times for a step")


if __name__ == "__main__":
    main()

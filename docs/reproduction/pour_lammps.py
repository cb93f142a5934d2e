#!/usr/bin/python3
"""Pours piles of disks in LAMMPS as study pile does from a point, and makes states of them that heaps.py measures.

    docs/reproduction/pour_lammps.py PROGRAM FOLDER [--grains 2000] [--piles 16] [--first 4101]

An independent code with the law `linear`: the same springs, dashpots and friction, a rough floor of disks side by side,
and one grain every INTERVAL, which comes near the axis with the speed of a fall from HEIGHT. LAMMPS lets no grain sleep.
A pile leaves FOLDER/disks-GRAINS-SEED.h5, by `grainfield import`, and the same as NAME.h5.xz, compacted. A pile that is
there is not poured again. Prints for each the processor time, and its figures by the program and by heaps.py. Those of
2,000 disks belong into states/lammps (then states/verify.py --write), where pours.py finds them. LAMMPS took 21 s of
processor time for 300 disks, and would take some 15 minutes for 2,000.

The same piles by grainfield are those of runs/disks.txt; --case prints the command of one:

    docs/reproduction/pour_lammps.py --case [--grains 2000]

Needs the Debian package lammps, h5py, numpy, scipy and xz.
"""
import argparse
import json
import lzma
import pathlib
import random
import resource
import shlex
import subprocess
import sys

import h5py

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE))

from heaps import AXIS, Heap  # noqa: E402

RADIUS, SPREAD = 0.00275, 0.3  # m, and share of it
DENSITY = 5000.0  # kg/m2
STIFFNESS = 1e6  # N/m: the deepest contacts of 2,000 grains overlap by about a hundredth of a diameter
TANGENTIAL = 2 / 7 * STIFFNESS
DAMPING = 1700.0  # 1/s: restitution about 0.5
FRICTION = 0.54
STEP = 2.5e-5  # s, a twentieth of the shortest collision
INTERVAL, SPEED = 0.1, 0.2  # s, m/s
ENTRY = 10  # diameters above the pile at which a grain comes in
SETTLE, DAMPED, LAST = 1.2, 0.6, 0.15  # s: free, in a viscous medium, free again
VISCOUS = 0.5  # kg/s, of the medium

INPUT = """units si
dimension 2
boundary f f p
atom_style sphere
newton off
comm_modify vel yes
read_data {name}.floor
pair_style gran/hooke/history {stiffness:.17g} {tangential:.17g} {damping:.17g} {tangential_damping:.17g} {friction} 1
pair_coeff * *
neighbor 0.002 bin
neigh_modify delay 0 every 1 check yes exclude type 2 2
timestep {step}
group grains type 1
group floor type 2
set group floor density/disc {density}
fix weight grains gravity 9.81 vector 0 -1 0
fix move grains nve/sphere disc
fix still floor freeze
thermo 1000000
thermo_modify lost ignore
variable d equal 2*{radius}*(1+{spread}*random(-1,1,{seed}))
variable x equal 0.5*{radius}*random(-1,1,{other})
variable top equal 0
variable k loop {grains}
label more
variable size equal $(v_d:%.17g)
variable y equal ${{top}}+{entry}
variable v equal sqrt({speed}^2+2*9.81*({height}-v_y))
variable place equal {fixed}+${{k}}
create_atoms 1 single $(v_x:%.17g) $(v_y:%.17g) 0 units box
group new id ${{place}}
set group new diameter ${{size}}
set group new density/disc {density}
velocity new set 0 $(-v_v:%.17g) 0 units box
group new clear
group grains type 1
run {every} post no
variable top equal $(bound(grains,ymax):%.17g)
next k
jump SELF more
run {settle}
fix damp grains viscous {viscous}
run {damped}
unfix damp
run {last}
compute ids all property/local patom1 patom2 cutoff radius
compute p all pair/local fx fy fz p1 p2 p3 cutoff radius
dump grains all custom 1 {name}.grains id type x y z radius mass vx vy vz omegaz
dump contacts all local 1 {name}.contacts index c_ids[1] c_ids[2] c_p[*]
dump_modify grains format float %.17g
dump_modify contacts format float %.17g
run 0
"""


def height_of(grains):
    """m, of the mouth: as in the cases, 0.25 for 800 grains, and as high above larger piles."""
    return round(0.15 + 0.1 * (grains / 800) ** 0.5, 3)


def floor(name, grains, seed):
    """Writes the data file of the floor, disks of the pile's sizes side by side; their number."""
    draw = random.Random(seed)
    half = 0.35 * (grains / 800) ** 0.5 + 0.05  # m: grains of small piles roll far
    x, rows = -half, []
    while x < half:
        radius = RADIUS * (1 + SPREAD * draw.uniform(-1, 1))
        rows.append(f"{len(rows) + 1} 2 {2 * radius:.17g} {DENSITY:.17g} {x + radius:.17g} 0 0")
        x += 2 * radius
    end = half + 0.1
    pathlib.Path(f"{name}.floor").write_text(
        f"floor\n\n{len(rows)} atoms\n2 atom types\n\n{-end} {end} xlo xhi\n-0.05 0.8 ylo yhi\n-0.01 0.01 zlo zhi\n\n"
        "Atoms\n\n" + "\n".join(rows) + "\n")
    return len(rows)


def pour(name, grains, seed):
    """Pours a pile in LAMMPS; its processor time in s."""
    steps = {key: round(time / STEP) for key, time in
             {"every": INTERVAL, "settle": SETTLE, "damped": DAMPED, "last": LAST}.items()}
    pathlib.Path(f"{name}.in").write_text(INPUT.format(
        name=name, stiffness=STIFFNESS, tangential=TANGENTIAL, damping=DAMPING, tangential_damping=DAMPING / 2,
        friction=FRICTION, step=STEP, radius=RADIUS, spread=SPREAD, seed=seed, other=seed + 10000, density=DENSITY,
        grains=grains, height=height_of(grains), speed=SPEED, entry=ENTRY * 2 * RADIUS, viscous=VISCOUS,
        fixed=floor(name, grains, seed), **steps))
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(["lmp", "-log", "none", "-screen", f"{name}.screen", "-in", f"{name}.in"],
                          env={"OMP_NUM_THREADS": "1", "PATH": "/usr/bin:/bin"})
    if done.returncode != 0:
        raise SystemExit(f"pour_lammps.py: {name}: " + pathlib.Path(f"{name}.screen").read_text()[-400:])
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def settings(grains):
    """The keys of case pile-point-source that pour the same."""
    return {"shape.kind": "disk", "shape.radius": RADIUS, "shape.polydispersity": SPREAD, "floor.kind": "rough",
            "source.grains": grains, "source.height": height_of(grains), "source.interval": INTERVAL,
            "source.speed": SPEED, "material.law": "linear", "material.density": DENSITY,
            "material.normal_stiffness": STIFFNESS, "material.tangential_stiffness": TANGENTIAL,
            "material.normal_damping": DAMPING, "material.tangential_damping": DAMPING / 2,
            "material.friction": FRICTION, "motion.time_step": STEP}


def run(program, words, folder):
    done = subprocess.run([program, *words], cwd=folder, capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"pour_lammps.py: {shlex.join(words)}: {done.stderr.strip()}")
    return done.stdout


def imported(program, name, folder):
    """NAME.h5 and NAME.h5.xz of the dumps."""
    run(program, ["import", "--from", "lammps", f"{name}.grains", f"{name}.contacts", "-o", f"{name}.h5", "--fixed", "type=2",
                  "--friction", str(FRICTION), "--group", "realization_000/pile", "--column", "i,j=c_ids[1..2]",
                  "--column", "fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]"], folder)
    compact = folder / f"{name}.compact.h5"
    subprocess.run([sys.executable, HERE / "states/compact.py", folder / f"{name}.h5", compact], check=True)
    (folder / f"{name}.h5.xz").write_bytes(lzma.compress(compact.read_bytes(), preset=9 | lzma.PRESET_EXTREME))
    compact.unlink()


def of_program(program, name, grains, folder):
    """dip.difference, axis.stress_ratio, repose.mean_deg by the program."""
    words = [word for key, value in settings(grains).items() for word in ("--set", f"{key}={value}")]
    run(program, ["run", str(ROOT / "cases/pile-point-source.toml"), *words, "--set", f'grains.files=["{name}.h5"]', "--set",
                  "ensemble.realizations=1", "-o", f"{name}-judged"], folder)
    return json.loads((folder / f"{name}-judged/summary.json").read_text())


def main():
    options = argparse.ArgumentParser(description="Pours piles of disks in LAMMPS.")
    options.add_argument("program", type=pathlib.Path, nargs="?")
    options.add_argument("folder", type=pathlib.Path, nargs="?")
    options.add_argument("--case", action="store_true", help="only the command by which grainfield pours the same")
    options.add_argument("--grains", type=int, default=2000)
    options.add_argument("--piles", type=int, default=16)
    options.add_argument("--first", type=int, default=4101, help="seed of the first pile")
    given = options.parse_args()
    if given.case:
        sets = [word for key, value in settings(given.grains).items() for word in ("--set", f"{key}={value}")]
        print(shlex.join(["grainfield", "run", "cases/pile-point-source.toml", *sets, "--set", "ensemble.realizations=1",
                          "--set", f"ensemble.seed={given.first}"]))
        return 0
    if given.folder is None:
        options.error("PROGRAM and FOLDER are needed")
    program, folder = given.program.resolve(), given.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for seed in range(given.first, given.first + given.piles):
        name, spent = f"disks-{given.grains}-{seed}", None
        if not (folder / f"{name}.h5.xz").exists():
            spent = pour(str(folder / name), given.grains, seed)
            imported(program, name, folder)
        figures = of_program(program, name, given.grains, folder)
        with h5py.File(folder / f"{name}.h5") as states:
            heap = Heap(states["realization_000/pile"])
        print(f"{name}: " + ("" if spent is None else f"{spent:.0f} CPU s; ") + f"slope {figures['repose.mean_deg']:.1f}, "
              f"shoulder - centre {figures['dip.difference']:.3f} by the program, {heap.dip(0):.3f} by heaps.py, "
              f"sigma_xx/sigma_yy {figures['axis.stress_ratio']:.3f}, {heap.axis_ratio(*AXIS):.3f}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())

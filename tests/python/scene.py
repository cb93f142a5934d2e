"""Packings with known stresses, and the program beside the module."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

import grainfield as gf

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("GRAINFIELD_PROGRAM", str(ROOT / "build/release/grainfield"))
SLOPE, ETA, MU, GRAIN_DENSITY = 28.0, 0.74, -0.31, 5000.0
NOISE = 0.06  # of the contact forces, uniform
RHO_G = GRAIN_DENSITY * 9.81 * np.pi / (2 * np.sqrt(3))  # of a triangular lattice, N/m2


def program(*arguments, code: int = 0) -> str:
    """Runs a command; its standard output, or of a failure what follows "grainfield: "."""
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == code, done.stderr
    return done.stdout if code == 0 else done.stderr.removeprefix("grainfield: ").rstrip("\n")


def python(code: str) -> subprocess.CompletedProcess:
    """Another interpreter."""
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)


def heap_arrays(seed: int, rows: int = 25, d: float = 0.01, at_slope: float = SLOPE, eta: float = ETA,
                mu: float = MU) -> dict:
    """A heap of disks on a triangular lattice whose contacts carry the stress of OSL but for
    noise: each has the force sigma n d/sqrt(3), sigma of its place and n along the bond."""
    rng = np.random.default_rng(seed)
    stress = gf.model("osl", phi_deg=at_slope, rho_g=RHO_G, eta=eta, mu=mu)
    lift, slope = d * np.sqrt(3) / 2, np.tan(np.radians(at_slope))
    height = d + (rows - 1) * lift
    at = {}
    for row in range(rows):
        y = d / 2 + row * lift
        reach = int(2 * height / slope / d) + 2
        for column in range(-reach, reach + 1):
            over = 1e-9 if abs(column) < 2 else 0.4 * lift
            if (column + row) % 2 == 0 and y - height + d / 2 - over <= -slope * abs(column * d / 2):
                at[row, column] = len(at)
    places = np.array([(column * d / 2, d / 2 + row * lift) for row, column in at])
    rows_of = []  # i, j, bond, point
    half = np.sqrt(3) / 2
    for (row, column), i in at.items():
        for up, aside, bond in ((0, 2, (1, 0)), (1, 1, (0.5, half)), (1, -1, (-0.5, half))):
            j = at.get((row + up, column + aside))
            if j is not None:
                rows_of.append((i, j, *bond))
        if row == 0:
            rows_of += [(i, -1, -0.5, -half), (i, -1, 0.5, -half)]
    i, j = np.array([row[:2] for row in rows_of]).T
    bonds = np.array([row[2:] for row in rows_of])
    t = stress(places[i] + d / 2 * bonds - [0, height])
    forces = np.stack([t[:, 0] * bonds[:, 0] + t[:, 2] * bonds[:, 1],
                       t[:, 2] * bonds[:, 0] + t[:, 1] * bonds[:, 1]], axis=1)
    forces *= d / np.sqrt(3) * (1 + NOISE * rng.uniform(-1, 1, (len(i), 1)))
    inside, pair = np.isfinite(forces).all(axis=1), j >= 0
    floor = {k: forces[inside & ~pair & (i == k)].sum(axis=0) for k in i[inside & ~pair]}
    good = inside & pair
    points = places[i[good]] + d / 2 * bonds[good]
    return {
        "x": places[:, 0], "y": places[:, 1], "radius": np.full(len(places), d / 2),
        "mass": np.full(len(places), GRAIN_DENSITY * np.pi * d * d / 4),
        "i": i[good], "j": j[good], "forces": forces[good], "points": points,
        "floor": np.array(list(floor)), "floor_forces": np.array(list(floor.values())),
    }


def heap(seed: int = 1, stress: dict | None = None, **options) -> gf.Packing:
    """stress: arguments of heap_arrays."""
    a = heap_arrays(seed, **(stress or {}))
    feet = np.stack([a["x"][a["floor"]], np.zeros(len(a["floor"]))], axis=1)
    return gf.packing(
        a["x"], a["y"], a["radius"], mass=a["mass"], walls="floor:y=0", friction=0.5,
        contacts={
            "i": [*a["i"], *a["floor"]],
            "j": [*a["j"], *["floor"] * len(a["floor"])],
            "forces": np.vstack([a["forces"], a["floor_forces"]]),
            "points": np.vstack([a["points"], feet]),
        },
        **options,
    )


def write_dumps(folder: Path, seed: int) -> tuple[Path, Path]:
    """The same as dumps of LAMMPS."""
    a = heap_arrays(seed)
    head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF {}\n{}\nITEM: BOX BOUNDS ff ff pp\n0 1\n0 1\n-0.5 0.5\n"
    push = dict(zip(a["floor"], a["floor_forces"]))
    grains = folder / f"grains_{seed}.dump"
    with open(grains, "w") as file:
        file.write(head.format("ATOMS", len(a["x"])) + "ITEM: ATOMS id type x y z radius mass "
                   + " ".join(f"f_floor[{k}]" for k in range(1, 8)) + "\n")
        for k, (x, y, r, m) in enumerate(zip(a["x"], a["y"], a["radius"], a["mass"])):
            on = f"1 {push[k][0]} {push[k][1]} 0 {x} 0 0" if k in push else "0 0 0 0 0 0 0"
            file.write(f"{k} 1 {x} {y} 0 {r} {m} {on}\n")
    contacts = folder / f"contacts_{seed}.dump"
    with open(contacts, "w") as file:
        file.write(head.format("ENTRIES", len(a["i"]))
                   + "ITEM: ENTRIES index c_ids[1] c_ids[2] " + " ".join(f"c_p[{k}]" for k in range(1, 7))
                   + "\n")
        for k, (i, j, f) in enumerate(zip(a["i"], a["j"], a["forces"])):
            bond = np.array([a["x"][j] - a["x"][i], a["y"][j] - a["y"][i]])
            n = bond / np.hypot(*bond)
            normal = f @ n * n
            t = f - normal
            file.write(f"{k + 1} {i} {j} {normal[0]} {normal[1]} 0 {t[0]} {t[1]} 0\n")
    return grains, contacts


def import_dumps(output: Path, files: list[tuple[Path, Path]]) -> None:
    for k, (grains, contacts) in enumerate(files):
        program("import", "--from", "lammps", grains, contacts, "--wall", "floor:y=0:fix=f_floor",
                "--column", "i,j=c_ids[1..2]", "--column", "fnx,fny,fnz=c_p[1..3]",
                "--column", "ftx,fty,ftz=c_p[4..6]", "--group", f"heap_{k}", "--add", "-o", output)


def same(a: gf.Field, b: gf.Field) -> None:
    """To the bit, where nan equals nan."""
    assert a.columns == b.columns and a.units == b.units
    np.testing.assert_array_equal(a.points, b.points)
    for name in a.columns:
        np.testing.assert_array_equal(a[name], b[name], err_msg=name)
        np.testing.assert_array_equal(a.error(name), b.error(name), err_msg=name)


def same_summary(ours: dict, theirs: dict, *left_out: str) -> None:
    """To the bit, but for times and memory and keys that begin with these."""
    assert ours.keys() == theirs.keys()
    for key, value in theirs.items():
        if key.startswith(("time.", "memory.", *left_out)):
            continue
        missing = [value is None or value != value, not isinstance(ours[key], str) and not np.isfinite(ours[key])]
        assert ours[key] == value or all(missing), f"{key}: {ours[key]}, {value}"


def error_of(call) -> str:
    """The text of a ValueError."""
    try:
        call()
    except ValueError as error:
        return str(error)
    raise AssertionError("no ValueError")

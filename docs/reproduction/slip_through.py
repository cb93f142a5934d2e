#!/usr/bin/python3
"""Finds the friction below which a grain slips through two others (Wellmann, Lillie and Wriggers, figure 13).

    PYTHONPATH=build/release/python docs/reproduction/slip_through.py [--write]

A sphere is pressed on two fixed ones; the lines of centres are inclined by ALPHA at first touch. The script bisects the
friction at which the sphere comes to lie between the others, for each inclination and load, and compares it with the
closed form: at the inclination a < ALPHA both contacts slide and bear

    F(a) = 2 k overlap (sin a + mu cos a),   overlap = 2 r (1 - cos ALPHA / cos a),

whose maximum over a is the largest load. Prints a table; --write puts slip_through.largest_miss, the largest share by
which a friction misses its closed form, into results/wellmann-box.json. Needs numpy and the Python module.
"""
import argparse
import json
import math
import pathlib

import numpy

RESULTS = pathlib.Path(__file__).resolve().parent / "results/wellmann-box.json"
RADIUS, STIFFNESS, GRAVITY = 0.01, 1e4, 1000  # m, N/m, m/s2
INCLINATIONS, LOADS = (20, 30, 40), (1.2, 2.0)  # degrees; times what the grain bears without friction
ACCURACY = 1e-4  # of the bisection


def most_load(alpha, mu):
    a = alpha * numpy.linspace(0, 1, 100_001)
    overlap = 2 * RADIUS * (1 - math.cos(alpha) / numpy.cos(a))
    return float((2 * STIFFNESS * overlap * (numpy.sin(a) + mu * numpy.cos(a))).max())


def bisected(below, high):
    """The friction up to which `below` is true."""
    low = 0.0
    while high - low > ACCURACY:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if below(middle) else (low, middle)
    return 0.5 * (low + high)


def slips_through(alpha, load, mu):
    """Whether the grain, whose weight is the load, sinks below the line of the others; drag keeps it from overshooting."""
    import grainfield as gf

    mass = load / GRAVITY
    frequency = math.sqrt(2 * STIFFNESS / mass)
    side = 2 * RADIUS * math.cos(alpha)
    packing = gf.packing([-side, 0, side], [0, 0, 0], RADIUS, z=[0, 2 * RADIUS * math.sin(alpha), 0], mass=[mass] * 3,
                         fixed=[True, False, True], gravity=(0, 0, -GRAVITY), friction=mu)
    engine = gf.Engine(packing, material=dict(law="linear", normal_stiffness=STIFFNESS, tangential_stiffness=STIFFNESS,
                                              normal_damping=0, tangential_damping=0, friction=mu),
                       time_step=0.05 / frequency)
    engine.set_damping(2 * frequency)
    for _ in range(800):
        engine.step(250)
        if engine.in_order(engine.positions)[1, 2] < 0:
            return True
    return False


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("--write", action="store_true", help="put the largest miss into results/wellmann-box.json")
    given, largest = options.parse_args(), 0.0
    print("inclination_deg,load,closed_form,found")
    for degrees in INCLINATIONS:
        alpha = math.radians(degrees)
        for more in LOADS:
            load = more * most_load(alpha, 0)
            expected = bisected(lambda mu: most_load(alpha, mu) < load, 10)
            found = bisected(lambda mu: slips_through(alpha, load, mu), 2)
            largest = max(largest, abs(found / expected - 1))
            print(f"{degrees},{more},{expected:.4f},{found:.4f}", flush=True)
    print(f"largest miss: {largest:.2g}")
    if given.write:
        stored = json.loads(RESULTS.read_text()) | {"slip_through.largest_miss": largest}
        RESULTS.write_text(json.dumps(stored, indent=1, sort_keys=True) + "\n")


if __name__ == "__main__":
    main()

#!/usr/bin/python3
"""What the scatter of the axial stress over eight RVEs depends on (Wellmann figure 8).

    docs/reproduction/rve_scatter.py box/hertz_05/snapshots.h5

Reads the states of samples between walls (study sample, one realization in each file). Prints s/sqrt(8) of
sigma_zz over its mean (equation 31; sigma by equation 29 over the convex hull of the centres), for eight
RVEs of every radius of RADII, mean over the later half of the states. The columns:

    as the study has it (rve.rRADIUS.error_bar): the centres as far apart as the spheres fit
    the same after a straight line of sigma_zz over the height is taken out
    the centres half as far apart, and the same without the line
    the centres a quarter as far apart
    mean stress of the four upper RVEs over that of the four lower ones, the centres as in the study

Needs h5py, numpy and scipy.
"""
import argparse
import itertools
import math
import pathlib

import h5py
import numpy
from scipy.spatial import ConvexHull

LENGTH = 0.001  # m
RADII = (3, 5, 7)
PARTS = ("grains/position", "contacts/i", "contacts/j", "contacts/force")
COLUMNS = ("study", "study_without_line", "half", "half_without_line", "quarter", "upper_over_lower")


class Sample:
    """The grains' places and contacts in the later half of the states, and the box of the first one."""

    def __init__(self, run):
        names = sorted(name for name in run if name.startswith("state_"))
        self.first = run[names[0]]["grains/position"][:] / LENGTH
        walls = run[names[0]]["walls"]
        point, normal = walls["point"][:] / LENGTH, walls["normal"][:]
        self.low = numpy.array([point[normal[:, a] > 0.5, a].max() for a in range(3)])
        self.high = numpy.array([point[normal[:, a] < -0.5, a].min() for a in range(3)])
        self.states = [{name: run[state][f"{name}"][:] for name in PARTS} for state in names[len(names) // 2 + 1:]]

    def stress_zz(self, state, centre, radius):
        """sigma_zz of the grains about a centre in the first state, up to a factor common to all RVEs."""
        inside = numpy.linalg.norm(self.first - centre, axis=1) < radius
        places = state["grains/position"] / LENGTH
        i, j, force = state["contacts/i"].astype(int), state["contacts/j"].astype(int), state["contacts/force"][:, 2]
        of_i, of_j = inside[i], (j >= 0) & inside[j]  # a wall's j is negative
        sum_zz = places[i, 2][of_i & ~of_j] @ force[of_i & ~of_j] - places[j, 2][~of_i & of_j] @ force[~of_i & of_j]
        return sum_zz / ConvexHull(places[inside]).volume

    def centres(self, radius, spread):
        """Eight corners: as far apart as the study has them, times SPREAD."""
        edges = self.high - self.low
        reach = spread * (edges / 2 - numpy.maximum(edges / 4, radius))
        return (self.low + self.high) / 2 + reach * numpy.array(list(itertools.product((-1, 1), repeat=3)))

    def row(self, state, radius):
        wide, near, nearer = (self.centres(radius, spread) for spread in (1, 0.5, 0.25))
        values = [numpy.array([self.stress_zz(state, c, radius) for c in cs]) for cs in (wide, near, nearer)]
        upper = wide[:, 2] > wide[:, 2].mean()
        return [bar(values[0]), without_line(values[0], wide[:, 2]), bar(values[1]),
                without_line(values[1], near[:, 2]), bar(values[2]),
                values[0][upper].mean() / values[0][~upper].mean()]


def bar(values):
    return numpy.std(values, ddof=1) / math.sqrt(len(values)) / abs(numpy.mean(values))


def without_line(values, heights):
    """The values with the straight line over the heights taken out, one degree of freedom fewer."""
    line = numpy.polyfit(heights, values, 1)
    rest = values - numpy.polyval(line, heights)
    n = len(values)
    return math.sqrt((rest**2).sum() / (n - 2) / n) / abs(numpy.mean(values))


def main():
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("states", type=pathlib.Path, nargs="+")
    samples = []
    for file in options.parse_args().states:
        with h5py.File(file) as open_file:
            samples.append(Sample(open_file["realization_000"]))
    print("radius," + ",".join(COLUMNS))
    for radius in RADII:
        rows = [numpy.mean([sample.row(state, radius) for state in sample.states], axis=0) for sample in samples]
        print(f"{radius}," + ",".join(f"{v:.3f}" for v in numpy.mean(rows, axis=0)))


if __name__ == "__main__":
    main()

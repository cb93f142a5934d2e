"""Heaps of LAMMPS to fitted models and a picture: lammps_heaps.py PICTURE GRAINS CONTACTS [...]"""
import sys

import numpy as np

import grainfield as gf


def heap(grains, contacts):
    # dump custom: id type x y z radius mass f_floor[1..7]; dump local: index, ids, forces
    ids, _, x, y, _, radius, mass, *floor = np.loadtxt(grains, skiprows=9).T
    _, i, j, *force = np.loadtxt(contacts, skiprows=9).T
    on = floor[0] != 0  # the floor bears these
    pairs = np.array(force[:3]) + force[3:]  # normal and tangential part
    forces = np.hstack([pairs[:2], np.array(floor[1:3])[:, on]]).T
    points = np.hstack([np.full((2, len(i)), np.nan), np.array(floor[4:6])[:, on]]).T
    touching = {"i": [*i, *ids[on]], "j": [*j, *["floor"] * on.sum()], "forces": forces, "points": points}
    return gf.packing(x, y, radius, ids=ids, mass=mass, contacts=touching, walls="floor:y=0")


heaps = [heap(*files) for files in zip(sys.argv[2::2], sys.argv[3::2])]
stress = gf.average(heaps, frame="heap", cuts=[0.05, 0.2])
fit = gf.fit(heaps, ["osl", "bcc"], heights=[0.2])
fit.plot().figure.savefig(sys.argv[1])

"""Writes balls.csv and contacts.csv for `grainfield import --from csv`; run it inside PFC.

Not tested with PFC: compare the stress that the import prints with that of PFC.
"""
import csv

import itasca as it

with open("balls.csv", "w", newline="") as f:
    w = csv.writer(f)
    w.writerow(["id", "x", "y", "z", "radius", "density"])
    for b in it.ball.list():
        w.writerow([b.id(), *b.pos(), b.radius(), b.density()])
with open("contacts.csv", "w", newline="") as f:
    w = csv.writer(f)
    w.writerow(["end1", "end2", "fx", "fy", "fz", "px", "py", "pz"])
    for c in it.contact.list("mechanical"):
        if c.active():
            w.writerow([c.end1().id(), c.end2().id(), *c.force_global(), *c.pos()])

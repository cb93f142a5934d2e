"""Do the checks see anything? Snapshots of runs that passed are damaged in one place, and looked at
again."""
import copy
import json
import os
import random

import numpy as np

from . import balances


def force_scaled(p, rng):
    k = rng.randrange(len(p.i))
    p.force[k] *= 1.001
    p.normal_force[k] *= 1.001
    p.tangential_force[k] *= 1.001


def contact_removed(p, rng):
    keep = np.arange(len(p.i)) != rng.randrange(len(p.i))
    for name in ("i", "j", "point", "normal", "force", "normal_force", "tangential_force", "friction",
                 "sliding", "spring", "rolling", "twisting", "image", "tangent"):
        setattr(p, name, getattr(p, name)[keep])


def friction_raised(p, rng):
    """A tangential force above the limit, along the tangent that there is."""
    k = rng.randrange(len(p.i))
    along = p.force[k] + p.normal_force[k] * p.normal[k]
    size = np.linalg.norm(along)
    if size == 0:
        return
    wanted = 1.01 * max(p.friction[k] * p.normal_force[k], size)
    p.force[k] += along * (wanted / size - 1)
    p.tangential_force[k] *= wanted / size


def point_moved(p, rng):
    k = rng.randrange(len(p.i))
    p.point[k] += 0.01 * p.radius[p.i[k]] * np.array([1.0, 0.5, 0.0])


def grain_moved(p, rng):
    """By a thousandth of a deepest overlap's usual size, a grain that something touches."""
    i = p.i[rng.randrange(len(p.i))]
    p.position[i] += 1e-4 * p.radius[i] * np.array([0.6, 0.8, 0.0])


def faster(p, rng):
    p.velocity[p.free()] += 0.1 * np.sqrt(np.abs(p.gravity).max() * p.radius.mean() + 1e-6)


def heavier(p, rng):
    p.mass = p.mass * 1.01


def not_a_number(p, rng):
    p.columns["contacts/force"][rng.randrange(len(p.i)), 0] = np.nan


DAMAGES = {f.__name__: f for f in (force_scaled, contact_removed, friction_raised, point_moved,
                                   grain_moved, faster, heavier, not_a_number)}


def seen(values, folder, groups, seed):
    """Name of the damage -> whether a check complained of the first state that rests."""
    with open(os.path.join(folder, "summary.json")) as file:
        summary = json.load(file)
    out = {}
    for name, hurt in DAMAGES.items():
        damaged = copy.deepcopy(groups)
        run = balances.Run(values, folder, damaged, summary, lambda *what: complaints.append(what))
        resting = [(r, s) for r, states in damaged.items() for s, p in states.items()
                   if run.goal(s) is not None and len(p.i) > 2]
        if not resting:
            return {}
        complaints = []
        realization, state = resting[0]
        hurt(damaged[realization][state], random.Random(f"{seed}/{name}"))
        run.check()
        out[name] = bool(complaints)
    return out

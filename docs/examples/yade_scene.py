"""The spheres of a running YADE scene as a packing: packing = packing_of(O, {"floor:z=0": [0, 1]})"""
import numpy as np

import grainfield as gf


def packing_of(scene, walls):
    # walls: the text of gf.packing for each, and the ids of its facets, walls or boxes
    name = {body: text.split(":")[0] for text, ids in walls.items() for body in ids}
    grains = [b for b in scene.bodies if b is not None and b.id not in name]
    place, velocity = (np.array([getattr(b.state, what) for b in grains]) for what in ("pos", "vel"))
    pairs, forces, points, friction = [], [], [], []
    for c in scene.interactions:
        if not c.isReal:
            continue
        force = np.array(c.phys.normalForce + c.phys.shearForce)  # on id2
        turned = c.id2 in name
        pairs.append((c.id1, name[c.id2]) if turned else (c.id2, name.get(c.id1, c.id1)))
        forces.append(-force if turned else force)
        points.append(np.array(c.geom.contactPoint))
        friction.append(c.phys.tangensOfFrictionAngle)
    return gf.packing(
        *place.T[:2], [b.shape.radius for b in grains], place[:, 2], ids=[b.id for b in grains],
        mass=[b.state.mass for b in grains], velocities=velocity,
        fixed=[not b.dynamic for b in grains], walls=list(walls), friction=0.5, time=scene.time,
        contacts={"i": [i for i, _ in pairs], "j": [j for _, j in pairs], "forces": forces, "points": points,
                  "friction": friction})

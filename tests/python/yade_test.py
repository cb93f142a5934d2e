"""A scene of YADE, where it is installed, handed over in memory: forces and stress are YADE's own."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import grainfield as gf
from scene import ROOT

SCRIPT = ROOT / "docs/examples/yade_scene.py"
SCENE = """
import json, sys
from yade import geom, pack, utils
sys.path.insert(0, {examples!r})
O.materials.append(FrictMat(young=1e7, poisson=0.3, density=2600, frictionAngle=0.5))
size = 0.02
facets = O.bodies.append(geom.facetBox((size, size, 2 * size), (size, size, 2 * size)))
cloud = pack.SpherePack()
cloud.makeCloud((0, 0, 0.005), (2 * size, 2 * size, 4 * size), rMean=0.006, rRelFuzz=0.3, num=20, seed=1)
cloud.toSimulation()
O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()]),
             InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_FrictPhys()],
                             [Law2_ScGeom_FrictPhys_CundallStrack()]),
             NewtonIntegrator(gravity=(0, 0, -9.81), damping=0.4)]
O.dt = 0.5 * PWaveTimeStep()
O.run(15000, True)
walls = {{}}
for b in facets:
    corners = [O.bodies[b].state.pos + v for v in O.bodies[b].shape.vertices]
    for axis in range(3):
        if max(c[axis] for c in corners) - min(c[axis] for c in corners) < 1e-9:
            low = corners[0][axis] < 1e-9
            place = 0 if low else 2 * size * (2 if axis == 2 else 1)
            walls.setdefault("%s%d:%s=%.17g" % ("xyz"[axis], not low, "xyz"[axis], place), []).append(b)
spheres = [b for b in O.bodies if isinstance(b.shape, Sphere)]
stress = sum((s * (4 * math.pi / 3 * b.shape.radius**3)
              for b, s in zip(O.bodies, bodyStressTensors()) if isinstance(b.shape, Sphere)), Matrix3.Zero)
from yade_scene import packing_of
import grainfield as gf
packing = packing_of(O, walls)
gf.write({file!r}, packing)
json.dump(dict(stress=[[stress[a, b] for b in range(3)] for a in range(3)], ids=[b.id for b in spheres],
               forces=[list(O.forces.f(b.id)) for b in spheres], weight=9.81 * sum(b.state.mass for b in spheres),
               time=O.time), open({told!r}, "w"))
"""


def test_the_script_is_short_and_the_page_links_to_it():
    body = SCRIPT.read_text().partition("def packing_of")[2].splitlines()
    assert len([line for line in body if line.strip()]) <= 26
    assert "](examples/yade_scene.py)" in (ROOT / "docs/python.md").read_text()


@pytest.mark.skipif(shutil.which("yade") is None, reason="needs the Debian package yade")
def test_a_scene_of_yade(tmp_path):
    file, told = tmp_path / "p.h5", tmp_path / "told.json"
    scene = tmp_path / "scene.py"
    scene.write_text(SCENE.format(examples=str(SCRIPT.parent), file=str(file), told=str(told)))
    environment = dict(os.environ, PYTHONPATH=str(Path(gf.__file__).parents[1]), OMP_NUM_THREADS="1")
    done = subprocess.run(["yade", "-n", "-x", "-j1", str(scene)], cwd=tmp_path, env=environment, capture_output=True,
                          text=True, timeout=120)
    assert told.exists(), done.stdout[-2000:] + done.stderr[-2000:]
    yade, packing = json.loads(told.read_text()), gf.read(file)
    assert packing.ids.tolist() == yade["ids"] and packing.time == yade["time"]
    contacts = packing.contacts
    i, j = contacts.pairs.T
    resultant = np.zeros((len(packing), 3))
    np.add.at(resultant, i, contacts.forces)
    np.add.at(resultant, j[j >= 0], -contacts.forces[j >= 0])
    np.testing.assert_allclose(resultant, yade["forces"], rtol=0, atol=1e-12 * np.abs(contacts.forces).max())
    # Love and Weber: of every contact the force times the branch from the centre of i, tension positive.
    arms = contacts.points - packing.positions[i]
    stress = np.einsum("ca,cb->ab", contacts.forces, arms)
    pair = j >= 0
    stress += np.einsum("ca,cb->ab", -contacts.forces[pair], contacts.points[pair] - packing.positions[j[pair]])
    np.testing.assert_allclose(stress, yade["stress"], rtol=0, atol=1e-9 * np.abs(stress).max())
    assert packing.check()["support_ratio"] == pytest.approx(1, abs=0.05)
    assert len(contacts) > 30 and (j < 0).sum() > 8

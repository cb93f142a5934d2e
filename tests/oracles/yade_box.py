# Spheres settled in a box of facets, as users of YADE build it: the facets have the lowest numbers and
# are the first body of their contacts. Prints what YADE itself says of forces and stress. In a folder
# with yade_export.py: yade -n -x yade_box.py
from yade import export, geom, pack, utils

O.materials.append(FrictMat(young=1e7, poisson=0.3, density=2600, frictionAngle=0.5))
size = 0.03
facets = O.bodies.append(geom.facetBox((size, size, 2 * size), (size, size, 2 * size)))
# The first sphere is led along z above the edge of the two facets of the floor: both bear it alike.
led = O.bodies[O.bodies.append(utils.sphere((size, size, 0.0039), 0.004))]
led.state.blockedDOFs = "xyXYZ"
cloud = pack.SpherePack()
cloud.makeCloud((0, 0, 0.01), (2 * size, 2 * size, 4 * size), rMean=0.006, rRelFuzz=0.3, num=70, seed=1)
cloud.toSimulation()
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()]),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()],
                    [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack()]),
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0.4)
]
O.dt = 0.5 * PWaveTimeStep()
O.run(40000, True)
exec(open("yade_export.py").read())
export.textExt("spheres.txt", "id_x_y_z_r_matId")  # six digits

# --wall options of the sides: every plane of the box with the numbers of its two facets.
planes = {}
for b in facets:
    corners = [O.bodies[b].state.pos + v for v in O.bodies[b].shape.vertices]
    for axis in range(3):
        if max(c[axis] for c in corners) - min(c[axis] for c in corners) < 1e-9:
            planes.setdefault(("xyz"[axis], round(corners[0][axis], 9)), []).append(b)
names = {("x", 0): "left", ("y", 0): "front", ("z", 0): "floor", ("x", 2 * size): "right", ("y", 2 * size): "back"}
for (axis, place), ids in planes.items():
    name = names.get((axis, place), "top")
    print("wall", "%s:%s=%.17g:ids=%s" % (name, axis, place, ",".join(map(str, ids))))
    force = sum((O.forces.f(b) for b in ids), Vector3.Zero)
    print("force", name, *("%.17g" % -f for f in force))  # on the spheres
spheres = [b for b in O.bodies if isinstance(b.shape, Sphere)]
# Love-Weber stress of each sphere over all of its contacts, times its volume.
stress = sum((s * (4 * math.pi / 3 * b.shape.radius**3)
              for b, s in zip(O.bodies, bodyStressTensors()) if isinstance(b.shape, Sphere)), Matrix3.Zero)
print("stress", *("%.17g" % stress[a, b] for a in range(3) for b in range(3)))
print("weight", "%.17g" % (9.81 * sum(b.state.mass for b in spheres)))
for b in spheres:
    print("body", b.id, *("%.17g" % f for f in O.forces.f(b.id)))

# Writes bodies.txt and interactions.txt for "grainfield import --from yade", with all digits.
# In a YADE script: exec(open("yade_export.py").read()), or paste it. Walls, facets and boxes are not
# grains: name them by --wall NAME:AXIS=POSITION:ids=ID,ID.
def line(*values):
    return " ".join("%.17g" % v for v in values) + "\n"

with open("bodies.txt", "w") as f:
    f.write("# id x y z vx vy vz spin_x spin_y spin r mass fixed\n")
    for b in O.bodies:
        if isinstance(b.shape, Sphere):
            f.write(line(b.id, *b.state.pos, *b.state.vel, *b.state.angVel, b.shape.radius, b.state.mass,
                         0 if b.dynamic else 1))
with open("interactions.txt", "w") as f:
    f.write("# id1 id2 px py pz nx ny nz fnx fny fnz ftx fty ftz\n")
    for i in O.interactions:
        if i.isReal:
            f.write(line(i.id1, i.id2, *i.geom.contactPoint, *i.geom.normal, *i.phys.normalForce,
                         *i.phys.shearForce))

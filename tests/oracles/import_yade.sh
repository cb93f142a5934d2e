#!/usr/bin/env bash
# The stress of an imported packing of spheres against YADE's own utils.getStress, to 1e-10.
# Usage: tests/oracles/import_yade.sh [PROGRAM]      needs the Debian package yade
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "${1:-$here/../../build/release/grainfield}")
. "$here/compare.sh"
command -v yade > /dev/null || { echo "yade not found: install the Debian package yade" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cp "$here/yade_export.py" .
# Spheres fall into a box of fixed spheres, so that every interaction is one of two spheres.
cat > spheres.py <<'PY'
import random
from yade import pack, utils
random.seed(1)
O.materials.append(FrictMat(young=1e7,poisson=0.3,density=2600,frictionAngle=0.5))
n=8; d=0.02
def fixed(x,y,z): return utils.sphere((x,y,z),0.51*d,fixed=True)
O.bodies.append([fixed(d*i,d*j,0) for i in range(n) for j in range(n)])
for k in range(1,18):
    O.bodies.append([fixed(d*i,d*j,d*k) for i in range(n) for j in range(n) if i in (0,n-1) or j in (0,n-1)])
sp=pack.SpherePack()
sp.makeCloud((d,d,d),((n-2)*d,(n-2)*d,17*d),rMean=0.008,rRelFuzz=0.3,num=300,seed=1)
sp.toSimulation()
O.engines=[ForceResetter(),InsertionSortCollider([Bo1_Sphere_Aabb()]),
 InteractionLoop([Ig2_Sphere_Sphere_ScGeom()],[Ip2_FrictMat_FrictMat_FrictPhys()],[Law2_ScGeom_FrictPhys_CundallStrack()]),
 NewtonIntegrator(gravity=(0,0,-9.81),damping=0.4)]
O.dt=0.5*PWaveTimeStep()
O.run(40000,True)
exec(open("yade_export.py").read())
s = utils.getStress(1.0)
names = [(a, b) for a in range(3) for b in range(3)]
print("stress", " ".join("xyz"[a] + "xyz"[b] + " %.17g" % s[a][b] for a, b in names))
PY
yade -n -x spheres.py > screen 2>&1 || { tail -3 screen >&2; exit 1; }
"$program" import --from yade bodies.txt interactions.txt -o packing.h5 | tee imported
same_stress imported "$(sed -n 's/^stress //p' screen)"

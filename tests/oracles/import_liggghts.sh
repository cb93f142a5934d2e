#!/usr/bin/env bash
# The stress of an imported packing of spheres against LIGGGHTS' own compute stress/atom, to 1e-10.
# Usage: tests/oracles/import_liggghts.sh [PROGRAM]      needs the Debian package liggghts
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "${1:-$here/../../build/release/grainfield}")
. "$here/compare.sh"
command -v liggghts > /dev/null || { echo "liggghts not found: install the Debian package liggghts" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
facet() { printf 'facet normal 0 0 1\nouter loop\n'; printf 'vertex %s %s 0.002\n' "$@"; printf 'endloop\nendfacet\n'; }
{ echo "solid floor"; facet 0 0 0.1 0 0.1 0.1; facet 0 0 0.1 0.1 0 0.1; echo "endsolid floor"; } > floor.stl
cat > in.spheres <<'IN'
atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
region box block 0 0.1 0 0.1 0 0.3 units box
create_box 1 box
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5e6
fix m2 all property/global poissonsRatio peratomtype 0.3
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.3
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 1e-5
fix g all gravity 9.81 vector 0 0 -1
fix floor all mesh/surface file floor.stl type 1
fix meshes all wall/gran model hertz tangential history mesh n_meshes 1 meshes floor
fix x1 all wall/gran model hertz tangential history primitive type 1 xplane 0.0
fix x2 all wall/gran model hertz tangential history primitive type 1 xplane 0.1
fix y1 all wall/gran model hertz tangential history primitive type 1 yplane 0.0
fix y2 all wall/gran model hertz tangential history primitive type 1 yplane 0.1
fix pts1 all particletemplate/sphere 15485863 atom_type 1 density constant 2500 radius constant 0.005
fix pts2 all particletemplate/sphere 15485867 atom_type 1 density constant 2500 radius constant 0.0035
fix pdd all particledistribution/discrete 32452843 2 pts1 0.5 pts2 0.5
region fill block 0.006 0.094 0.006 0.094 0.01 0.28 units box
fix ins all insert/pack seed 49979687 distributiontemplate pdd insert_every once overlapcheck yes all_in yes particles_in_region 600 region fill
fix move all nve/sphere
fix damp all viscous 0.01
# Pairs: ids of both grains, a flag, the force on the first. Meshes: contact point, grain's centre,
# ids of mesh, triangle and grain, the force on the grain. Both must stand before the first run.
compute fc all pair/gran/local id force
compute fw all wall/gran/local pos id force
compute s all stress/atom pair
compute sum all reduce sum c_s[1] c_s[2] c_s[3] c_s[4] c_s[5] c_s[6]
thermo_style custom step c_sum[1] c_sum[2] c_sum[3] c_sum[4] c_sum[5] c_sum[6]
thermo_modify format float %.17g
thermo 20000
run 60000
dump grains all custom 1 grains.dump id type x y z radius mass vx vy vz omegaz
dump contacts all local 1 contacts.dump c_fc[1] c_fc[2] c_fc[3] c_fc[4] c_fc[5] c_fc[6]
dump floor all local 1 floor.dump c_fw[1] c_fw[2] c_fw[3] c_fw[7] c_fw[9] c_fw[10] c_fw[11] c_fw[12]
dump_modify grains format "%d %d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
dump_modify contacts format "%.17g %.17g %.17g %.17g %.17g %.17g"
dump_modify floor format "%.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
run 0
IN
OMP_NUM_THREADS=1 liggghts -log none -screen screen -in in.spheres || { tail -3 screen >&2; exit 1; }
theirs=$(awk '/^ +60000 /{x = $0} END {split(x, a, " "); print "xx", a[2], "yy", a[3], "zz", a[4], "yx", a[5], "zx", a[6], "zy", a[7]}' screen)
"$program" import --from liggghts grains.dump contacts.dump floor.dump -o packing.h5 \
  --column 'i,j=c_fc[1..2]' --column 'fx,fy,fz=c_fc[4..6]' \
  --column 'px,py,pz=c_fw[1..3]' --column 'wall=c_fw[7]' --column 'i=c_fw[9]' \
  --column 'fx,fy,fz=c_fw[10..12]' --wall floor:z=0.002:ids=0 | tee imported
same_stress imported "$theirs"

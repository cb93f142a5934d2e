#!/usr/bin/env bash
# The stress of an imported packing of disks against LAMMPS' own compute stress/atom, to 1e-10.
# Usage: tests/oracles/import_lammps.sh [PROGRAM]      needs the Debian package lammps
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "${1:-$here/../../build/release/grainfield}")
. "$here/compare.sh"
command -v lmp > /dev/null || { echo "lmp not found: install the Debian package lammps" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
cat > in.disks <<'IN'
units si
dimension 2
boundary f f p
atom_style sphere
newton off
comm_modify vel yes
region box block 0 0.3 0 0.4 -0.01 0.01 units box
create_box 1 box
lattice sq 0.011
region fill block 0.006 0.294 0.006 0.2 -0.001 0.001 units box
create_atoms 1 region fill
variable d atom 0.008+0.002*((id*7919%101)/100)
set group all diameter v_d
set group all density/disc 2500
displace_atoms all random 0.001 0.001 0 4711
pair_style gran/hooke/history 1e6 NULL 100 NULL 0.5 1
pair_coeff * *
neighbor 0.002 bin
neigh_modify delay 0 every 1 check yes
timestep 1e-5
fix move all nve/sphere disc
fix weight all gravity 9.81 vector 0 -1 0
fix floor all wall/gran hooke/history 1e6 NULL 100 NULL 0.5 1 yplane 0 NULL contacts
fix left all wall/gran hooke/history 1e6 NULL 100 NULL 0.5 1 xplane 0 NULL contacts
fix right all wall/gran hooke/history 1e6 NULL 100 NULL 0.5 1 xplane NULL 0.3 contacts
fix damp all viscous 0.05
compute s all stress/atom NULL pair
# Components 1, 2, 4: xx, yy, xy (branch x, force y).
compute sum all reduce sum c_s[1] c_s[2] c_s[4]
compute ids all property/local patom1 patom2 cutoff radius
compute p all pair/local fx fy fz p1 p2 p3 cutoff radius
run 60000
thermo_style custom step c_sum[1] c_sum[2] c_sum[3]
thermo_modify format float %.17g
dump grains all custom 1 grains.dump id type x y z radius mass vx vy vz omegaz f_floor[*] f_left[*] f_right[*]
dump contacts all local 1 contacts.dump index c_ids[1] c_ids[2] c_p[*]
dump_modify grains format float %.17g
dump_modify contacts format float %.17g
run 0
IN
OMP_NUM_THREADS=1 lmp -log none -screen screen -in in.disks || { tail -3 screen >&2; exit 1; }
theirs=$(awk '/^ +60000 /{x = $0} END {split(x, a, " "); print "xx", a[2], "yy", a[3], "yx", a[4]}' screen)
"$program" import --from lammps grains.dump contacts.dump -o packing.h5 \
  --column 'i,j=c_ids[1..2]' --column 'fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]' \
  --wall floor:y=0:fix=f_floor --wall left:x=0:fix=f_left --wall right:x=0.3:fix=f_right | tee imported
same_stress imported "$theirs"

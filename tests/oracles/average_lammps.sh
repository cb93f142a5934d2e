#!/usr/bin/env bash
# Averages of packings of spheres made by LAMMPS: the mean stress of a periodic cell against LAMMPS'
# own pressure, to 1e-10; fields of a settled box against a few lines of numpy, to 1e-9; and the
# balance of forces of that box. Usage: tests/oracles/average_lammps.sh [PROGRAM]
# Needs the Debian packages lammps and python3-numpy.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "${1:-$here/../../build/release/grainfield}")
python=${PYTHON:-/usr/bin/python3}
command -v lmp > /dev/null || { echo "lmp not found: install the Debian package lammps" >&2; exit 2; }
"$python" -c 'import numpy' || { echo "numpy not found: install the Debian package python3-numpy" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

common='units si
atom_style sphere
newton off
comm_modify vel yes'
law='pair_style gran/hooke/history 1e5 NULL 50 NULL 0.5 1
pair_coeff * *
neighbor 0.002 bin
neigh_modify delay 0 every 1 check yes
timestep 2e-5
fix move all nve/sphere'
local='compute ids all property/local patom1 patom2 cutoff radius
compute p all pair/local fx fy fz p1 p2 p3 cutoff radius'
contacts='dump contacts all local 1 contacts.dump index c_ids[1] c_ids[2] c_p[*]
dump_modify contacts format float %.17g'
columns=(--column 'i,j=c_ids[1..2]' --column 'fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]')
run() { OMP_NUM_THREADS=1 lmp -log none -screen screen -in "$1" || { tail -3 screen >&2; exit 1; }; }

mkdir cell box
cd cell
cat > in.cell <<IN
$common
boundary p p p
region box block 0 0.1 0 0.1 0 0.1 units box
create_box 1 box
lattice sc 0.0125
create_atoms 1 box
variable d atom 0.009+0.002*((id*7919%101)/100)
set group all diameter v_d
set group all density 2500
displace_atoms all random 0.001 0.001 0.001 4711
$law
fix damp all viscous 0.02
fix press all deform 1 x final 0 0.073 y final 0.002 0.075 z final 0 0.073 units box
compute virial all pressure NULL virial
$local
run 15000
unfix press
run 10000
thermo_style custom step c_virial[1] c_virial[2] c_virial[3] c_virial[4] c_virial[5] c_virial[6]
thermo_modify format float %.17g
dump grains all custom 1 grains.dump id type x y z radius mass vx vy vz omegax omegay omegaz
dump_modify grains format float %.17g
$contacts
run 0
IN
run in.cell
"$program" import --from lammps grains.dump contacts.dump -o packing.h5 "${columns[@]}" --gravity 0,0,0
printf 'x,y,z\n0.0365,0.0385,0.0365\n' > middle.csv
"$program" average packing.h5 --frame packing --points middle.csv --method particle_centre \
  --kernel square --width 0.0365 --quantities sigma,grains -o cell.csv
theirs=$(awk '/^ +25000 /{x = $0} END {print x}' screen)
cd ../box
cat > in.box <<IN
$common
boundary f f f
region box block 0 0.06 0 0.06 0 0.4 units box
create_box 1 box
lattice sc 0.012
region fill block 0.005 0.055 0.005 0.055 0.005 0.18 units box
create_atoms 1 region fill
variable d atom 0.009+0.002*((id*7919%101)/100)
set group all diameter v_d
set group all density 2500
displace_atoms all random 0.0005 0.0005 0.0005 4711
$law
fix weight all gravity 9.81 vector 0 0 -1
fix floor all wall/gran hooke/history 1e5 NULL 50 NULL 0.5 1 zplane 0 NULL contacts
fix left all wall/gran hooke/history 1e5 NULL 50 NULL 0.5 1 xplane 0 NULL contacts
fix right all wall/gran hooke/history 1e5 NULL 50 NULL 0.5 1 xplane NULL 0.06 contacts
fix front all wall/gran hooke/history 1e5 NULL 50 NULL 0.5 1 yplane 0 NULL contacts
fix back all wall/gran hooke/history 1e5 NULL 50 NULL 0.5 1 yplane NULL 0.06 contacts
fix damp all viscous 0.005
$local
run 25000
fix still all viscous 0.05
run 25000
dump grains all custom 1 grains.dump id type x y z radius mass vx vy vz omegax omegay omegaz f_floor[*] f_left[*] f_right[*] f_front[*] f_back[*]
dump_modify grains format float %.17g
$contacts
run 0
IN
run in.box
"$program" import --from lammps grains.dump contacts.dump -o packing.h5 "${columns[@]}" \
  --wall floor:z=0:fix=f_floor --wall left:x=0:fix=f_left --wall right:x=0.06:fix=f_right \
  --wall front:y=0:fix=f_front --wall back:y=0.06:fix=f_back
printf 'x,y,z\n0.03,0.03,0.04\n0.001,0.03,0.02\n0.059,0.002,0.002\n0.02,0.04,0\n0.04,0.01,0.1\n0.03,0.02,0.07\n' > points.csv
"$program" average packing.h5 --frame packing --points points.csv --kernel lucy --width 0.01 \
  --quantities sigma,density,momentum --least-grains 0 -o field.csv
"$program" average packing.h5 --balance
cd ..
"$python" "$here/average_numpy.py" "$theirs"

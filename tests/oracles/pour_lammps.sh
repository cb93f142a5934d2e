#!/usr/bin/env bash
# Heaps of 2,500 disks poured in LAMMPS from a spout onto a rough floor, imported, and fitted: what a
# user does who comes with heaps of his own. Leaves heap_SEED.h5 (at rest) and flying_SEED.h5 (0.15 s
# after the last grain has left the spout, so that some are in flight).
# Usage: tests/oracles/pour_lammps.sh FOLDER [PROGRAM [HEAPS [GRAINS]]]   needs the Debian package lammps
#
# 10 minutes of one core a heap. Heaps that are there already are kept.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
[ $# -ge 1 ] || { sed -n '2,6s/^# //p' "$0" >&2; exit 2; }
mkdir -p "$1"
program=$(realpath "${2:-$here/../../build/release/grainfield}")
heaps=${3:-4}
grains=${4:-2500}
command -v lmp > /dev/null || { echo "lmp not found: install the Debian package lammps" >&2; exit 2; }
cd "$1"
cat > pour.in <<'IN'
units si
dimension 2
boundary f f p
atom_style sphere
newton off
comm_modify vel yes
variable k equal 4e5
region box block -0.6 0.6 -0.01 0.6 -0.01 0.01 units box
create_box 2 box
# Floor: a row of fixed disks. Type 1 pours, type 2 is floor.
lattice sq 0.004 origin 0 0 0
region row block -0.598 0.598 -0.001 0.001 -0.001 0.001 units box
create_atoms 2 region row
set type 2 diameter 0.005
set type 2 density/disc 2500
group floor type 2
# Springs of 4e5 N/m: the deepest contacts overlap by about one per cent of a diameter. Restitution about 0.5.
pair_style gran/hooke/history ${k} NULL 1700 NULL 0.5 1
pair_coeff * *
neighbor 0.002 bin
neigh_modify delay 0 every 1 check yes exclude type 2 2
timestep 1.5e-5
group grains type 1
fix weight grains gravity 9.81 vector 0 -1 0
fix move grains nve/sphere disc
fix still floor freeze
region spout block -0.012 0.012 0.40 0.44 -0.001 0.001 units box
# Masses of spheres of this density are near those of the disks; they are set to those below.
fix pour grains pour ${grains} 1 ${seed} region spout diam range 0.004 0.006 dens 750000 750000 vol 0.3 20 vel 0 0 -0.3
thermo 100000
thermo_modify lost ignore
variable here equal count(grains)
# Until no more come. Every insertion brings more than roll off the floor.
label more
variable before equal ${here}
run 12000 post no
set group grains density/disc 2500
if "${here} > ${before}" then "jump SELF more"
unfix pour
run 10000
compute ids all property/local patom1 patom2 cutoff radius
compute p all pair/local fx fy fz p1 p2 p3 cutoff radius
dump grains all custom 1 flying.grains id type x y z radius mass vx vy vz omegaz
dump contacts all local 1 flying.contacts index c_ids[1] c_ids[2] c_p[*]
dump_modify grains format float %.17g
dump_modify contacts format float %.17g
run 0
undump grains
undump contacts
run 80000
fix damp grains viscous 0.5
run 40000
unfix damp
run 10000
dump grains all custom 1 rest.grains id type x y z radius mass vx vy vz omegaz
dump contacts all local 1 rest.contacts index c_ids[1] c_ids[2] c_p[*]
dump_modify grains format float %.17g
dump_modify contacts format float %.17g
run 0
IN
for ((seed = 4001; seed < 4001 + heaps; ++seed)); do
  [ ! -e "heap_$seed.h5" ] || continue
  OMP_NUM_THREADS=1 lmp -log none -screen "screen_$seed" -var seed $seed -var grains "$grains" -in pour.in ||
    { tail -3 "screen_$seed" >&2; exit 1; }
  for state in flying rest; do
    "$program" import --from lammps $state.grains $state.contacts -o "$state.h5" --fixed type=2 --friction 0.5 \
      --group pile --column 'i,j=c_ids[1..2]' --column 'fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]'
    rm $state.grains $state.contacts
  done
  mv flying.h5 "flying_$seed.h5"
  mv rest.h5 "heap_$seed.h5"
done
"$program" fit heap_*.h5 -o fit

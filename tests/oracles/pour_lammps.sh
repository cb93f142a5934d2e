#!/usr/bin/env bash
# Heaps of 2,500 disks poured in LAMMPS from a spout onto a rough floor, imported, and fitted: what a
# user does who comes with heaps of his own. At rest they are fitted together and with each left out
# in turn; they are fitted, too, as they were 0.2 s after the last grain had left the spout, with three
# more in flight. judge_heaps.py says what must hold. Exit code 77: no lmp here.
# Usage: tests/oracles/pour_lammps.sh FOLDER [PROGRAM [HEAPS [GRAINS]]]   needs the Debian package lammps
#
# LAMMPS takes a minute of one core a heap, two at a time. Dumps that are there already are kept.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
[ $# -ge 1 ] || { sed -n '2,8s/^# //p' "$0" >&2; exit 2; }
mkdir -p "$1"
program=$(realpath "${2:-$here/../../build/release/grainfield}")
heaps=${3:-4}
grains=${4:-2500}
python=${PYTHON:-/usr/bin/python3}
command -v lmp > /dev/null || { echo "lmp not found: install the Debian package lammps"; exit 77; }
command -v "$python" > /dev/null || { echo "$python not found"; exit 77; }
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
timestep 2.5e-5
group grains type 1
fix weight grains gravity 9.81 vector 0 -1 0
fix move grains nve/sphere disc
fix still floor freeze
region spout block -0.024 0.024 0.40 0.44 -0.001 0.001 units box
# Masses of spheres of this density are near those of the disks; they are set to those below.
fix pour grains pour ${grains} 1 ${seed} region spout diam range 0.004 0.006 dens 750000 750000 vol 0.3 20 vel 0 0 -0.3
thermo 100000
thermo_modify lost ignore
variable here equal count(grains)
# Until no more come. Every insertion brings more than roll off the floor.
label more
variable before equal ${here}
run 7200 post no
set group grains density/disc 2500
if "${here} > ${before}" then "jump SELF more"
unfix pour
run 6000
# Three late ones, far above the heap when the first state is written.
create_atoms 1 single 0 0.36 0 units box
create_atoms 1 single 0.02 0.4 0 units box
create_atoms 1 single -0.02 0.44 0 units box
region above block -0.1 0.1 0.34 0.46 -0.01 0.01 units box
group late region above
set group late diameter 0.005
set group late density/disc 2500
group grains type 1
run 1500
compute ids all property/local patom1 patom2 cutoff radius
compute p all pair/local fx fy fz p1 p2 p3 cutoff radius
dump grains all custom 1 flying_${seed}.grains id type x y z radius mass vx vy vz omegaz
dump contacts all local 1 flying_${seed}.contacts index c_ids[1] c_ids[2] c_p[*]
dump_modify grains format float %.17g
dump_modify contacts format float %.17g
run 0
undump grains
undump contacts
run 48000
fix damp grains viscous 0.5
run 24000
unfix damp
run 6000
dump grains all custom 1 heap_${seed}.grains id type x y z radius mass vx vy vz omegaz
dump contacts all local 1 heap_${seed}.contacts index c_ids[1] c_ids[2] c_p[*]
dump_modify grains format float %.17g
dump_modify contacts format float %.17g
run 0
IN
pour() {
  [ ! -e "poured_$1" ] || return 0
  OMP_NUM_THREADS=1 nice -n 10 lmp -log none -screen "screen_$1" -var seed "$1" -var grains "$grains" -in pour.in ||
    { tail -3 "screen_$1" >&2; return 1; }
  touch "poured_$1"
}
seeds=$(seq 4001 $((4000 + heaps)))
export -f pour
export grains
# shellcheck disable=SC2086
printf '%s\n' $seeds | xargs -P 2 -I SEED bash -c 'set -eo pipefail; pour SEED'
for state in heap flying; do
  for seed in $seeds; do
    "$program" import --from lammps "${state}_$seed.grains" "${state}_$seed.contacts" -o "${state}_$seed.h5" --fixed type=2 \
      --friction 0.5 --group pile --column 'i,j=c_ids[1..2]' --column 'fnx,fny,fnz,ftx,fty,ftz=c_p[1..6]'
  done
done
# fit NAME FILES-AND-OPTIONS: leaves NAME/summary.json, NAME.said, and NAME.code.
fit() {
  local name=$1 code=0
  shift
  rm -rf "$name"
  nice "$program" fit "$@" --set fit.bootstrap=0 -o "$name" > "$name.said" 2>&1 || code=$?
  echo "$code" > "$name.code"
}
all=()
for seed in $seeds; do all+=("heap_$seed.h5"); done
fit all "${all[@]}"
for ((k = 1; k <= heaps; ++k)); do fit "without_$k" "${all[@]}" --set "fit.leave_out=[$k]"; done
fit flying "${all[@]/heap/flying}"
"$python" "$here/judge_heaps.py" "$heaps"

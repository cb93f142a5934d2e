#!/usr/bin/env bash
# Grain-steps per second on the 10,000-disk packing: this engine (1 and 2 threads) against LAMMPS
# gran/hooke/history (Debian package lammps, serial), five interleaved rounds, medians; and this
# engine's 5,000 settled heptagons, all awake, beside LAMMPS' disks; and 10,000 settled spheres of this
# engine against LAMMPS' spheres, the same packing and law, linear and Hertz-Mindlin; and 1,609 packed superellipsoids (Hertz'
# elliptic law) beside LAMMPS' disks.
# Usage: tests/benchmarks/against_lammps.sh [build/release [ROUNDS]]      needs: apt-get install lammps
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=${1:-$here/../../build/release}
program=$build/tests/benchmarks/dem_benchmark
shapes=$build/tests/benchmarks/superellipsoid_benchmark
rounds=${2:-5}
steps=2000
command -v lmp >/dev/null || { echo "lmp not found: install the Debian package lammps" >&2; exit 2; }
for p in "$program" "$shapes"; do
  [ -x "$p" ] || { echo "$p not found: build it first" >&2; exit 2; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
awk -F, '!/^#/ && !/^x/ {n++; line[n]=sprintf("%d 1 %.17g 2500 %.17g %.17g 0", n, 2*$3, $1, $2)}
  END {print "disks\n\n" n " atoms\n1 atom types\n\n-0.01 2.01 xlo xhi\n-0.01 3 ylo yhi\n-0.5 0.5 zlo zhi\n\nAtoms\n"
       for (i=1;i<=n;i++) print line[i]}' "$here/data/packing_discs_10k.csv" > "$work/disks.data"
cat > "$work/in.disks" <<IN
units si
dimension 2
boundary f f p
atom_style sphere
newton off
comm_modify vel yes
read_data $work/disks.data
set group all density/disc 2500
pair_style gran/hooke/history 2e7 1e7 4000 2000 0.5 1
pair_coeff * *
neighbor 0.002 bin
neigh_modify delay 0 every 1 check yes
timestep 1e-5
fix move all nve/sphere disc
fix weight all gravity 9.81 vector 0 -1 0
fix sides all wall/gran hooke/history 2e7 1e7 4000 2000 0.5 1 xplane 0 2
fix floor all wall/gran hooke/history 2e7 1e7 4000 2000 0.5 1 yplane 0 NULL
thermo 1000000
run 200
run $steps
IN
export GRAINFIELD_SPHERES=$work/spheres.h5  # settled once, read by every round
"$program" --benchmark_filter='spheres_10k/1/' --benchmark_min_time=0.01 > /dev/null 2>&1
export GRAINFIELD_PACKINGS=$work  # likewise
"$shapes" --benchmark_filter=superellipsoids_hertz/1/ --benchmark_min_time=0.01 > /dev/null 2>&1
spheres() { # NAME, file of grains, pair style with its numbers
  awk -F, '{n++; line[n]=sprintf("%d 1 %s %s %s %s %s", n, 2*$4, 2500, $1, $2, $3)}
    END {print "spheres\n\n" n " atoms\n1 atom types\n\n-0.01 0.21 xlo xhi\n-0.01 0.21 ylo yhi\n-0.01 0.3 zlo zhi\n\nAtoms\n"
         for (i=1;i<=n;i++) print line[i]}' CONVFMT=%.17g OFMT=%.17g "$2" > "$work/$1.data"
  cat > "$work/in.$1" <<IN
units si
boundary f f f
atom_style sphere
newton off
comm_modify vel yes
read_data $work/$1.data
pair_style gran/$3
pair_coeff * *
neighbor 0.001 bin
neigh_modify delay 0 every 1 check yes
timestep 1e-5
fix move all nve/sphere
fix weight all gravity 9.81 vector 0 0 -1
fix sides all wall/gran $3 xplane 0 0.2
fix ends all wall/gran $3 yplane 0 0.2
fix floor all wall/gran $3 zplane 0 NULL
thermo 1000000
run 200
run $steps
IN
}
spheres spheres "$work/spheres.h5.csv" "hooke/history 1e5 3e4 2000 1000 0.5 1"
# E = 10 MPa, nu = 0.3: K_n = 4/3 E*, K_t = 8 G* (tests/benchmarks/sphere_scene.h).
spheres hertz "$work/spheres.h5_hertz.csv" "hertz/history 7.326007326007326e6 9.049773755656109e6 4e6 2e6 0.5 1"
median() { sort -g | awk '{a[NR]=$1} END {print a[int((NR+1)/2)]}'; }
own() { # NAME, threads, program
  "${3:-$program}" --benchmark_filter="(^|[<:/])$1/$2/" --benchmark_min_time=2 --benchmark_format=csv 2>/dev/null |
  awk -F, -v n="$1" 'NR==1{for(i=1;i<=NF;i++){gsub(/"/,"",$i); if($i=="grain_steps") k=i}} index($0,n){print $k/1e6}'; }
theirs() { # in.NAME, a file for the figure
  (cd "$work" && OMP_NUM_THREADS=1 lmp -log none -screen "$work/out" -in "in.$1") || { tail -3 "$work/out" >&2; exit 1; }
  awk '/^Loop time/{t=$4} END{print '$steps'*10000/t/1e6}' "$work/out" >> "$work/$2"
}
for round in $(seq "$rounds"); do
  theirs disks lammps
  own disks_10k 1 >> "$work/one"; own disks_10k 2 >> "$work/two"
  own heptagons_5k 1 >> "$work/seven"; own heptagons_5k 2 >> "$work/seven_two"
  theirs spheres lammps_spheres
  own spheres_10k 1 >> "$work/spheres_one"; own spheres_10k 2 >> "$work/spheres_two"
  theirs hertz lammps_hertz
  own hertz_spheres_10k 1 >> "$work/hertz_one"; own hertz_spheres_10k 2 >> "$work/hertz_two"
  own superellipsoids_hertz 1 "$shapes" >> "$work/super_one"
  own superellipsoids_hertz 2 "$shapes" >> "$work/super_two"
  echo "round $round: LAMMPS $(tail -1 "$work/lammps"), disks 1 thread $(tail -1 "$work/one"), 2 threads $(tail -1 "$work/two"), heptagons 1 thread $(tail -1 "$work/seven"), 2 threads $(tail -1 "$work/seven_two"); LAMMPS' spheres $(tail -1 "$work/lammps_spheres"), spheres 1 thread $(tail -1 "$work/spheres_one"), 2 threads $(tail -1 "$work/spheres_two"); LAMMPS' Hertz spheres $(tail -1 "$work/lammps_hertz"), Hertz spheres 1 thread $(tail -1 "$work/hertz_one"), 2 threads $(tail -1 "$work/hertz_two"); superellipsoids 1 thread $(tail -1 "$work/super_one"), 2 threads $(tail -1 "$work/super_two") million grain-steps/s"
done
l=$(median < "$work/lammps") a=$(median < "$work/one") b=$(median < "$work/two")
awk -v l="$l" -v a="$a" -v b="$b" 'BEGIN {printf "median: LAMMPS %.2f, 1 thread %.2f, 2 threads %.2f million grain-steps/s\nratio to LAMMPS %.2f; two threads over one %.2f\n", l, a, b, a/l, b/a}'
h=$(median < "$work/seven") t=$(median < "$work/seven_two")
awk -v l="$l" -v h="$h" -v t="$t" 'BEGIN {printf "heptagons: 1 thread %.2f, 2 threads %.2f million grain-steps/s\nratio to LAMMPS\047 disks %.2f; two threads over one %.2f\n", h, t, h/l, t/h}'
l=$(median < "$work/lammps_spheres") a=$(median < "$work/spheres_one") b=$(median < "$work/spheres_two")
awk -v l="$l" -v a="$a" -v b="$b" 'BEGIN {printf "spheres: LAMMPS %.2f, 1 thread %.2f, 2 threads %.2f million grain-steps/s\nratio to LAMMPS\047 spheres %.2f; two threads over one %.2f\n", l, a, b, a/l, b/a}'
l=$(median < "$work/lammps_hertz") a=$(median < "$work/hertz_one") b=$(median < "$work/hertz_two")
awk -v l="$l" -v a="$a" -v b="$b" 'BEGIN {printf "Hertz spheres: LAMMPS %.2f, 1 thread %.2f, 2 threads %.2f million grain-steps/s\nratio to LAMMPS\047 %.2f; two threads over one %.2f\n", l, a, b, a/l, b/a}'
l=$(median < "$work/lammps") a=$(median < "$work/super_one") b=$(median < "$work/super_two")
awk -v l="$l" -v a="$a" -v b="$b" 'BEGIN {printf "superellipsoids: 1 thread %.2f, 2 threads %.2f million grain-steps/s\nratio to LAMMPS\047 disks %.3f; two threads over one %.2f\n", a, b, a/l, b/a}'

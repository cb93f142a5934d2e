#!/usr/bin/env bash
# Grain-steps per second, five interleaved rounds, medians, one and two threads:
#   disks            10,000 settled ones beside LAMMPS gran/hooke/history, the same packing and law
#   heptagons        5,000 settled ones, all awake, beside LAMMPS' disks
#   spheres, hertz   10,000 settled ones beside LAMMPS' own, linear and Hertz-Mindlin
#   superellipsoids  1,609 packed ones, Hertz' elliptic law, beside LAMMPS' disks; super_10k 10,000
# The ratios are held against those of this processor in figures/PROCESSOR.csv: one that is more than
# 10 % lower is named, and the exit code is 1. --keep writes them there instead.
# Usage: tests/benchmarks/against_lammps.sh [--keep] [build/release [ROUNDS]]
# Needs: apt-get install lammps; a machine that does nothing else.
set -euo pipefail
keep=no
if [ "${1:-}" = --keep ]; then keep=yes; shift; fi
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
"$shapes" --benchmark_filter='superellipsoids_hertz(_10k)?/1/' --benchmark_min_time=0.01 > /dev/null 2>&1
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
  own superellipsoids_hertz_10k 1 "$shapes" >> "$work/many_one"
  own superellipsoids_hertz_10k 2 "$shapes" >> "$work/many_two"
  echo "round $round: LAMMPS $(tail -1 "$work/lammps"), disks 1 thread $(tail -1 "$work/one"), 2 threads $(tail -1 "$work/two"), heptagons 1 thread $(tail -1 "$work/seven"), 2 threads $(tail -1 "$work/seven_two"); LAMMPS' spheres $(tail -1 "$work/lammps_spheres"), spheres 1 thread $(tail -1 "$work/spheres_one"), 2 threads $(tail -1 "$work/spheres_two"); LAMMPS' Hertz spheres $(tail -1 "$work/lammps_hertz"), Hertz spheres 1 thread $(tail -1 "$work/hertz_one"), 2 threads $(tail -1 "$work/hertz_two"); superellipsoids 1 thread $(tail -1 "$work/super_one"), 2 threads $(tail -1 "$work/super_two"), 10,000 of them 1 thread $(tail -1 "$work/many_one"), 2 threads $(tail -1 "$work/many_two") million grain-steps/s"
done
ratios=$work/ratios.csv
echo "scene,beside,million_grain_steps_per_s,ratio,two_threads_over_one" > "$ratios"
line() { # scene, LAMMPS' scene, files of: LAMMPS, one thread, two threads
  awk -v scene="$1" -v beside="$2" -v l="$(median < "$work/$3")" -v a="$(median < "$work/$4")" \
    -v b="$(median < "$work/$5")" 'BEGIN {printf "%s,%s,%.3f,%.3f,%.2f\n", scene, beside, a, a/l, b/a}' >> "$ratios"
}
line disks disks lammps one two
line heptagons disks lammps seven seven_two
line spheres spheres lammps_spheres spheres_one spheres_two
line hertz hertz lammps_hertz hertz_one hertz_two
line superellipsoids disks lammps super_one super_two
line super_10k disks lammps many_one many_two
column -s, -t < "$ratios" 2>/dev/null || cat "$ratios"
processor=$(awk -F': ' '/^model name/ {print $2; exit}' /proc/cpuinfo | tr -cs 'A-Za-z0-9.\n' '_')
stored=$here/figures/$processor.csv
if [ $keep = yes ]; then
  mkdir -p "$here/figures"
  cp "$ratios" "$stored"
  echo "kept: $stored"
elif [ -f "$stored" ]; then
  awk -F, 'FNR == 1 {next} NR == FNR {was[$1] = $4; next}
    $1 in was && $4 < 0.9*was[$1] {printf "slower: %s, ratio %.3f, stored %.3f\n", $1, $4, was[$1]; bad = 1}
    END {if (!bad) print "no scene is more than 10 % slower than stored"; exit bad}' "$stored" "$ratios"
else
  echo "no figures of this processor are stored yet ($stored): --keep writes them"
fi

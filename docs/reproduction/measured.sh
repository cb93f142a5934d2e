#!/usr/bin/env bash
# measured.sh PROGRAM FOLDER: makes the runs in FOLDER and measures again what measure.py has added to results/.
# An hour of processor time. The stored values are of grainfield 0.9.0 (4f4be8ee; of layers and of single piles of
# 2,000 grains 915d9e90; of line sources and of sleep 282ed2eb; of sleep where levels are asked 868ed2cb).
set -euo pipefail
program=$(realpath "$1")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$2" && cd "$2"

run() { # NAME CASE [OPTION ...]
  [ -e "$1/summary.json" ] || "$program" run "$here/../../cases/$2.toml" -o "$1" "${@:3}"
}
measure() { "$here/measure.py" "$@"; }
states() { [ -e "$1.h5" ] || { xz -dkc "$here/states/$1.h5.xz" > "$1.h5.part" && mv "$1.h5.part" "$1.h5"; }; }
set_files() { echo "grains.files=[\"$1.h5\"]"; }

for name in pile-line-source pile-point-source-2000 pile-asymmetric-line pile-rest-{300-awake,800-awake,800-sleeping}; do
  states $name
done

measure forces pile-fields-line pile-line-source.h5 --member states
measure forces pile-fields pile-point-source-2000.h5 --member grains_2000

four=ensemble.realizations=4
run gravity pile-gravity-levels --set "$(set_files pile-rest-300-awake)" --set $four --set 'change.gravity=[4.905,5.0,20.0]'
measure gravity pile-gravity-levels gravity/snapshots.h5 --member grains_300
run levels pile-gravity-levels --set "$(set_files pile-rest-300-awake)" --set $four --set 'change.gravity=[0.981,18.639]'
measure summary pile-gravity-levels levels/summary.json --member grains_300 \
  --keys change.gravity_0.981.coordination_ratio change.gravity_18.639.coordination_ratio
for g in 5 20; do
  run poured-$g pile-rest-detection --quick --set 'sweep.values=["sleeping"]' --set $four --set material.gravity=$g
done
measure poured pile-point-source poured-{5,20}/sleeping/snapshots.h5 --member grains_100

measure network pile-fields pile-point-source-2000.h5 --member grains_2000
/usr/bin/python3 - <<'END'
import h5py
with h5py.File("pile-point-source-2000.h5") as states:
    for name in states:
        with h5py.File(f"pile-{int(name[-3:])}.h5", "w") as one:
            states.copy(name, one, name="realization_000")
END
for k in {0..7}; do
  run inside-$k pile-fields --set "$(set_files pile-$k)" --set ensemble.realizations=1 --set 'change.gravity=[8.829]'
done
measure fields pile-fields inside-{0..7}/fields.h5 --member fields_2000
for k in {0..7}; do
  run narrow-$k pile-fields --set "grains.files=[\"inside-$k/snapshots.h5\"]" --set ensemble.realizations=1 \
    --set 'change.gravity=[8.829]' --set fields.rve_diameters=3
done
measure fields pile-fields narrow-{0..7}/fields.h5 --member narrow_2000
measure stiffness pile-fields narrow-{0..7}/fields.h5 --member narrow_2000
measure heap pile-point-source pile-point-source-2000.h5 --member grains_2000
measure heap pile-line-source pile-line-source.h5 --member states
measure heap pile-fields inside-{0..7}/snapshots.h5 --member fields_2000
measure roul_fit fit-cantelaube-point pile-point-source-2000.h5 --member grains_2000 --phi 28
measure roul_fit fit-cantelaube-line pile-line-source.h5 --member states --phi 26
# Piles with source.record, of a list of runs.
grown=$here/states/memory/memory-800
for k in 1 2 3 4 5 6 7 8; do
  [ ! -e "$grown-$k.h5.xz" ] || [ -e "memory-$k.h5" ] || xz -dkc "$grown-$k.h5.xz" > "memory-$k.h5"
done
[ ! -e memory-1.h5 ] || measure memory pile-point-source memory-?.h5 --member recorded_800
[ ! -e memory-8.h5 ] || {
  measure heap pile-point-source pile-rest-800-{awake,sleeping}.h5 memory-?.h5 --member grains_800
  measure roul_fit fit-cantelaube-point pile-rest-800-{awake,sleeping}.h5 memory-?.h5 --member grains_800 --phi 28
}
# What is predicted is committed before: predict.py make PROGRAM pile-point-source-2000.h5 narrow-{0..7} --name point-2000
[ ! -e "$here/predictions/point-2000.json" ] ||
  "$here/predict.py" compare pile-point-source-2000.h5 --name point-2000
topic() { # TOPIC NAME PILE ...: one topic by these piles
  local files
  files=$(printf '"inside-%s/snapshots.h5",' "${@:3}")
  run "$2" pile-fields --set "grains.files=[${files%,}]" --set ensemble.realizations=$(($# - 2)) \
    --set 'change.gravity=[8.829]' --set "fields.topics=[\"$1\"]"
}
topic forces tail {0..7}
measure summary pile-fields tail/summary.json --member fields_2000 --keys forces.tail
topic rve_size rve-all {0..7}
for k in {0..7}; do topic rve_size rve-$k $(seq 0 7 | grep -v $k); done
measure rve pile-fields rve-{all,0,1,2,3,4,5,6,7}/summary.json --member fields_2000
run equal pile-fields --quick --set shape.polydispersity=0 --set source.grains=150 --set source.height=0.15 \
  --set ensemble.realizations=3 --set 'change.gravity=[8.829]'
measure summary pile-fields equal/summary.json --member equal_150 --keys fabric.g2
run axis pile-point-source --set "$(set_files pile-point-source-2000)"
measure summary pile-point-source axis/summary.json --member grains_2000 --keys axis.stress_ratio
run line pile-line-source --quick --set shape.polydispersity=0.3 --set source.length=0.16 --set $four
measure summary pile-line-source line/summary.json --member grains_300 --keys dip.
run fit fit-asymmetric --set "$(set_files pile-asymmetric-line)" --set ensemble.realizations=8
measure summary fit-asymmetric fit/summary.json --member line --keys fit.

# What sleep hides and changes: the stored heaps of line sources are awake.
slept=(relaxation. axis.stress_ratio repose. dem.repose heap. dem.grains time.dem_cpu_s)
dip=(dip.difference dip.standard_error)
run asleep pile-line-source --set sleep.wake_levels=1000
measure summary pile-line-source asleep/summary.json --member asleep --keys "${slept[@]}" "${dip[@]}"
run asleep-fit fit-cantelaube-line --set 'grains.files=["asleep/snapshots.h5"]'
measure summary fit-cantelaube-line asleep-fit/summary.json --member asleep --keys fit.
run asleep-shifted pile-asymmetric-line --set ensemble.realizations=8 --set sleep.wake_levels=1000
measure summary pile-asymmetric-line asleep-shifted/summary.json --member asleep --keys "${slept[@]}" "${dip[@]}"
run asleep-2000 pile-point-source --set source.grains=2000 --set source.height=0.3 --set ensemble.seed=2001 \
  --set ensemble.realizations=1 --set sleep.wake_levels=1000
measure summary pile-point-source asleep-2000/summary.json --member asleep_2000 --keys "${slept[@]}"
# The same where the levels are asked.
run asked pile-line-source
measure summary pile-line-source asked/summary.json --member asked --keys "${slept[@]}" "${dip[@]}"
run asked-fit fit-cantelaube-line --set 'grains.files=["asked/snapshots.h5"]'
measure summary fit-cantelaube-line asked-fit/summary.json --member asked --keys fit.
run line-16-fit fit-cantelaube-line --set 'grains.files=["pile-line-source.h5","asked/snapshots.h5"]' \
  --set ensemble.realizations=16
measure summary fit-cantelaube-line line-16-fit/summary.json --member line_16 --keys fit. dip.
run asked-2000 pile-point-source --set source.grains=2000 --set source.height=0.3 --set ensemble.seed=2001 \
  --set ensemble.realizations=1
measure summary pile-point-source asked-2000/summary.json --member asked_2000 --keys "${slept[@]}"

# Lattice piles: the base; rows apart at the source's softness, which settle to a resultant of 1e-6 before they buckle;
# rows that touch below nearly hard disks.
run soft-piles liffman-soft-piles --set 'sweep.values=["slope_30","slope_32_6","slope_45","slope_50","slope_55"]'
for angle in 30 32_6 45 50 55; do
  measure base liffman-soft-piles soft-piles/slope_$angle/profiles.csv --member slope_$angle
done
run apart liffman-soft-piles --set 'sweep.values=["slope_60"]' --set lattice.gap=5e-4 \
  --set rest.unbalanced_force_ratio=1e-6
measure summary liffman-soft-piles apart/slope_60/summary.json --member apart_60 --keys liffman.
run touching liffman-lattice --set lattice.gap=0 --set 'sweep.values=[30,45,50,55,60]'
for angle in 30 45 50 55 60; do
  measure summary liffman-lattice touching/slope_deg_$angle/summary.json --member touch_$angle --keys liffman.
done
# Those of runs/liffman-settling.txt that are there.
for slip in 0.5 5 50; do
  record=$here/states/liffman-settling/slip-$slip.json
  [ ! -e "$record" ] || measure summary implicit-settling "$record" --member slip_${slip/./} --keys settling.
done

# Dropped piles of runs/liffman.txt and liffman-grains.txt, of those that are there.
dropped() { # NAME MEMBER: piles by implicit motion, six a run, judged as the explicit ones
  local files=("$here/states/liffman/$1"-?.h5.xz) file name names=()
  [ -e "${files[0]}" ] || return 0
  for file in "${files[@]}"; do
    name=$(basename "$file" .xz)
    xz -dkc "$file" > "$name"
    names+=("\"$name\"")
  done
  run "dropped-$2" liffman-dropped --set "grains.files=[$(IFS=,; echo "${names[*]}")]" \
    --set ensemble.realizations=$((6 * ${#files[@]})) "${@:3}"
  measure summary liffman-dropped "dropped-$2/summary.json" --member "$2" --keys dip. dem.repose_angle
}
dropped implicit implicit
states liffman-dropped
for width in 0.02 0.03 0.04 0.05 0.06 0.08 0.12 0.15; do
  run window-$width liffman-dropped --set "$(set_files liffman-dropped)" --set heap.centre=$width
  measure summary liffman-dropped window-$width/summary.json --member centre_$width \
    --keys dip.difference dip.standard_error dip.p_value
done
# Its two runs of which every pile comes to rest.
[ ! -e implicit-4.h5 ] || {
  run dropped-resting liffman-dropped --set 'grains.files=["implicit-2.h5","implicit-4.h5"]' --set ensemble.realizations=12
  measure summary liffman-dropped dropped-resting/summary.json --member implicit_resting --keys dip.
}
dropped coulomb implicit_coulomb --set material.friction=0.5
for name in equal unlike coulomb coulomb_unlike coulomb_free pentagons; do
  record=$here/states/liffman-grains/${name}_968.json
  [ ! -e "$record" ] || measure summary liffman-dropped-grains "$record" --member ${name}_968 --keys dip. dem.repose_angle
done

# The layers of runs/roul-layers.txt, by their states or tables, of the runs that are there.
layers=$here/states/roul-layers
unpack() { [ -e "$1.h5" ] || { xz -dkc "$layers/$1.h5.xz" > "$1.h5.part" && mv "$1.h5.part" "$1.h5"; }; }
layer() { # STUDY NAME MEMBER
  [ -e "$layers/$2.json" ] || return 0
  measure summary "$1" "$layers/$2.json" --member "$3" --keys response. load.
  [ ! -e "$layers/$2.profiles.csv.xz" ] || measure centre "$1" "$layers/$2.profiles.csv.xz" --member "$3"
}
strain() { # NAME MEMBER REALIZATION ...
  [ -e "$layers/$1.json" ] || return 0
  unpack "$1"
  local tables=()
  for k in "${@:3}"; do
    "$program" strain "$1.h5:realization_00$k"/{unloaded,loaded} --measure derivative --frame layer --grid 161x33 \
      -o "$1-$k.csv"
    tables+=("$1-$k.csv")
  done
  measure strain point-load-mono "${tables[@]}" --member "$2"
}
layer point-load-mono mono_0.3 force_0.3
layer point-load-mono mono_300 force_300
for force in 3 300; do layer point-load-mono mono_$force-varied varied_$force; done
for mu in 0.3 0.6 0.9; do
  layer point-load-friction friction_$mu friction_$mu
  layer point-load-friction friction_$mu-varied varied_$mu
done
for one in 0{3,8}_{3,30,100,300}; do layer point-load-load load_$one-varied varied_$one; done
layer point-load-pentagons pentagons layers_24
layer point-load-bidisperse bidisperse layers_16
layer point-load-bidisperse bidisperse_100 force_100
for floor in smooth rough; do
  [ ! -e "$layers/$floor-1.json" ] ||
    measure pieces point-load-polydisperse "$layers/$floor"-*.profiles.csv.xz --member pieces_$floor
done
unpack mono_300 && measure angles point-load-mono mono_300.h5 --member packing
unpack friction_0.3 && measure angles point-load-friction friction_0.3.h5 --member packing
strain mono_rough_3 rough_3 0
strain mono_rough_300 rough_300 0
strain mono_rough_3-varied rough_3_varied {0..7}

# Polygons and the piston: layers of runs/roul-geometry.txt.
layers=$here/states/roul-geometry
layer point-load-mono mono-piston piston_300
layer point-load-friction friction_0.6-piston-slow piston_slow_0.6
for mu in 0.3 0.6 0.9; do
  layer point-load-friction friction_$mu-piston piston_$mu
  layer point-load-friction friction_$mu-disks-piston piston_varied_$mu
done
layer point-load-mono mono-disks-piston piston_varied_300
for one in disks-loose disks-loose-piston disks-slow corners-24 corners-24-piston corners-48; do
  layer point-load-mono mono-$one $one
  layer point-load-friction friction_0.6-$one $one
done
for mu in 0.3 0.9; do
  for one in corners-24 corners-24-piston; do layer point-load-friction friction_$mu-$one ${one}_$mu; done
done

# Tails of P(n): layers of runs/tails.txt, forces by the overlap's area and linear springs.
tails() { # FILE MEMBER
  [ -e "$here/states/tails/$1.h5.xz" ] || return 0
  xz -dkc "$here/states/tails/$1.h5.xz" > "tails-$2.h5"
  measure tails point-load-polydisperse "tails-$2.h5" --member "$2"
  measure network point-load-polydisperse "tails-$2.h5" --member "$2"
}
for mu in 0 0.2 0.5 1; do
  tails "area-mu-$mu" "area_$mu"
  tails "linear-mu-$mu" "linear_$mu"
done

flamant='compare.models=["flamant"]'
run pentagons point-load-pentagons --set "$flamant" --set $four
measure angles point-load-pentagons pentagons/snapshots.h5 --member packing
run polydisperse point-load-polydisperse --set "$flamant" --set $four --set 'sweep.values=["smooth"]'
measure angles point-load-polydisperse polydisperse/floor_smooth/snapshots.h5 --member packing
run bidisperse point-load-bidisperse --set "$flamant" --set ensemble.realizations=2
measure angles point-load-bidisperse bidisperse/snapshots.h5 --member packing

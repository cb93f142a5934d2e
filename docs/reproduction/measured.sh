#!/usr/bin/env bash
# measured.sh PROGRAM FOLDER: makes the runs in FOLDER and measures again what measure.py has added to results/.
# Half an hour of processor time. The stored values are of grainfield 0.9.0 (4f4be8ee).
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

for name in pile-line-source pile-point-source-2000 pile-asymmetric-line pile-rest-300-awake; do states $name; done

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

run inside pile-fields --set "$(set_files pile-point-source-2000)" --set $four --set 'change.gravity=[8.829]'
measure fields pile-fields inside/fields.h5 --member fields_2000
run equal pile-fields --quick --set shape.polydispersity=0 --set source.grains=150 --set source.height=0.15 \
  --set ensemble.realizations=3 --set 'change.gravity=[8.829]'
measure summary pile-fields equal/summary.json --member equal_150 --keys fabric.g2
run axis pile-point-source --set "$(set_files pile-point-source-2000)"
measure summary pile-point-source axis/summary.json --member grains_2000 --keys axis.stress_ratio
run line pile-line-source --quick --set shape.polydispersity=0.3 --set source.length=0.16 --set $four
measure summary pile-line-source line/summary.json --member grains_300 --keys dip.
run fit fit-asymmetric --set "$(set_files pile-asymmetric-line)" --set ensemble.realizations=8 \
  --set 'fit.models=["cantelaube_asymmetric_zero"]' --set fit.bootstrap=0
measure summary fit-asymmetric fit/summary.json --member line \
  --keys fit.cantelaube_asymmetric_zero.rel_l2 fit.cantelaube_asymmetric_zero.chi2

flamant='compare.models=["flamant"]'
run mono point-load-mono --set "$flamant" --set 'sweep.values=[3]'
measure angles point-load-mono mono/force_3/snapshots.h5 --member packing
run friction point-load-friction --set "$flamant" --set 'sweep.values=[0.3]'
measure angles point-load-friction friction/friction_0.3/snapshots.h5 --member packing
run pentagons point-load-pentagons --set "$flamant" --set $four
measure angles point-load-pentagons pentagons/snapshots.h5 --member packing
run polydisperse point-load-polydisperse --set "$flamant" --set $four --set 'sweep.values=["smooth"]'
measure angles point-load-polydisperse polydisperse/floor_smooth/snapshots.h5 --member packing
run bidisperse point-load-bidisperse --set "$flamant" --set ensemble.realizations=2
measure angles point-load-bidisperse bidisperse/snapshots.h5 --member packing

run rough point-load-mono --set packing.floor=rough --set "$flamant" --set 'sweep.values=[3,300]'
layer=rough/force_3/snapshots.h5:realization_000
"$program" strain $layer/unloaded $layer/loaded --measure derivative --frame layer --grid 161x33 -o strain.csv
measure strain point-load-mono strain.csv --member rough_3

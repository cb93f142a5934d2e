#!/usr/bin/env bash
# One solve in plane strain or in space on one mesh by this project, dolfinx (gamg and MUMPS) and CalculiX (SPOOLES),
# one thread each, interleaved rounds, medians: processor seconds (so that other work hardly counts) and
# L2 errors of the displacement and the stress. Own: mesh, numbering, assembly, solve, stress and the error
# norms; "solve": its assembly and solve alone, in wall seconds (quiet machine!), like for like with dolfinx:
# assembly and solve; CalculiX: the whole program, which also reads, finds the stress and writes.
# Usage: tests/benchmarks/against_fe_peers.sh [build/release] [CELLS] [DEGREE] [ROUNDS] [DIMENSION] [PEERS]
# PEERS: those to run beside, of "gamg mumps ccx" (in space by a million unknowns gamg alone has the memory)
# needs: apt-get install calculix-ccx python3-dolfinx
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=${1:-$here/../../build/release} cells=${2:-128} degree=${3:-2} rounds=${4:-5} dim=${5:-2} peers=${6:-gamg mumps ccx}
program=$build/tests/benchmarks/fe_peers_benchmark
python=/usr/bin/python3
[ -x "$program" ] || { echo "$program not found: build it first" >&2; exit 2; }
command -v ccx > /dev/null || { echo "ccx not found: install the Debian package calculix-ccx" >&2; exit 2; }
"$python" -c 'import dolfinx' 2> /dev/null || { echo "dolfinx not found: install the Debian package python3-dolfinx" >&2; exit 2; }
export OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 CCX_NPROC_EQUATION_SOLVER=1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
median() { sort -g | awk '{a[NR]=$1} END {print a[int((NR+1)/2)]}'; }
# unknowns, iterations, seconds, error of displacement, of stress; own: besides, assembly and solve
own() { "$program" --benchmark_filter="dim:$dim/cells:$cells/degree:$degree/" --benchmark_format=csv 2> /dev/null |
  awk -F, '/^name/{for(i=1;i<=NF;i++){gsub(/"/,"",$i); k[$i]=i}} /fe_box/{print $k["unknowns"], $k["iterations"], $k["cpu_time"], $k["error"], $k["stress_error"], $k["assemble_s"]+$k["solve_s"]}'; }
dolfinx() { "$python" "$here/fe_peer_dolfinx.py" "$cells" "$degree" "$1" "$dim" 2> /dev/null | awk '{print $1, $2, $3+$4, $5, $6}'; }
calculix() { "$python" "$here/fe_peer_calculix.py" "$cells" "$degree" "$work" "$dim" | awk '{print $1, 1, $2, $3, "-"}'; }
# Compiles and caches dolfinx' kernels for this degree.
"$python" "$here/fe_peer_dolfinx.py" 4 "$degree" lu "$dim" > /dev/null 2>&1
for round in $(seq "$rounds"); do
  own > "$work/own"; awk '{print $1, $2, $6, $4, $5}' "$work/own" > "$work/solve"
  for p in $peers; do
    case $p in gamg) dolfinx amg ;; mumps) dolfinx lu ;; ccx) calculix ;; esac > "$work/$p"
  done
  printf 'round %d:' "$round"
  for p in own solve $peers; do awk '{print $3}' "$work/$p" >> "$work/$p.s"; printf ' %s %s s' "$p" "$(tail -1 "$work/$p.s")"; done
  echo
done
reference=$(median < "$work/own.s")
for p in own solve $peers; do
  m=$(median < "$work/$p.s")
  awk -v p="$p" -v m="$m" -v r="$reference" '{printf "%-6s %d unknowns, %d iterations, error %s, of stress %s, median %.3f s, %.2f times own\n", p, $1, $2, $4, $5, m, m/r}' "$work/$p"
done

#!/usr/bin/env bash
# One plane-strain solve on one mesh by this project, dolfinx (gamg and MUMPS) and CalculiX (SPOOLES),
# one thread each, interleaved rounds, medians: processor seconds (so that other work hardly counts) and
# L2 errors of the displacement and the stress. Own: mesh, numbering, assembly, solve, stress and the error
# norms; "solve": its assembly and solve alone, in wall seconds (quiet machine!), like for like with dolfinx:
# assembly and solve; CalculiX: the whole program, which also reads, finds the stress and writes.
# Usage: tests/benchmarks/against_fe_peers.sh [build/release] [CELLS] [DEGREE] [ROUNDS]
# needs: apt-get install calculix-ccx python3-dolfinx
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=${1:-$here/../../build/release} cells=${2:-128} degree=${3:-2} rounds=${4:-5}
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
own() { "$program" --benchmark_filter="cells:$cells/degree:$degree/" --benchmark_format=csv 2> /dev/null |
  awk -F, '/^name/{for(i=1;i<=NF;i++){gsub(/"/,"",$i); k[$i]=i}} /fe_box/{print $k["unknowns"], $k["iterations"], $k["cpu_time"], $k["error"], $k["stress_error"], $k["assemble_s"]+$k["solve_s"]}'; }
dolfinx() { "$python" "$here/fe_peer_dolfinx.py" "$cells" "$degree" "$1" 2> /dev/null | awk '{print $1, $2, $3+$4, $5, $6}'; }
calculix() { "$python" "$here/fe_peer_calculix.py" "$cells" "$degree" "$work" | awk '{print $1, 1, $2, $3, "-"}'; }
# Compiles and caches dolfinx' kernels for this degree.
"$python" "$here/fe_peer_dolfinx.py" 8 "$degree" lu > /dev/null 2>&1
for round in $(seq "$rounds"); do
  own > "$work/own"; awk '{print $1, $2, $6, $4, $5}' "$work/own" > "$work/solve"; dolfinx amg > "$work/gamg"; dolfinx lu > "$work/mumps"; calculix > "$work/ccx"
  for p in own solve gamg mumps ccx; do awk '{print $3}' "$work/$p" >> "$work/$p.s"; done
  echo "round $round: own $(tail -1 "$work/own.s") (solve $(tail -1 "$work/solve.s")), dolfinx gamg $(tail -1 "$work/gamg.s"), dolfinx MUMPS $(tail -1 "$work/mumps.s"), CalculiX $(tail -1 "$work/ccx.s") s"
done
reference=$(median < "$work/own.s")
for p in own solve gamg mumps ccx; do
  m=$(median < "$work/$p.s")
  awk -v p="$p" -v m="$m" -v r="$reference" '{printf "%-6s %d unknowns, %d iterations, error %s, of stress %s, median %.3f s, %.2f times own\n", p, $1, $2, $4, $5, m, m/r}' "$work/$p"
done

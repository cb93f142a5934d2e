#!/usr/bin/env bash
# An inline function that is compiled for wide instructions must not become that of a file for any
# processor: what the kernels of a width define for others names the width, or its namespace
# (dem/space/lanes.h).
# Usage: instructions.sh NM WIDTH OBJECT...
set -euo pipefail
nm=$1 width=$2
shift 2
case $width in 4) set=avx2 ;; 8) set=avx512 ;; *) echo "no such width: $width" >&2; exit 2 ;; esac
"$nm" -C --defined-only --extern-only "$@" | awk -v own="_of<$width[,>]" -v set="dem::$set::" '
  NF < 3 {next}
  {++n}
  $0 !~ own && index($0, set) == 0 {print "for any processor, too: " $0; bad = 1}
  END {if (n == 0) {print "no symbols"; bad = 1} else print n " symbols"; exit bad}'

#!/usr/bin/env bash
# pip.sh SOURCE FOLDER: `pip install --no-build-isolation .` of the source into a new environment FOLDER that
# sees Debian's packages, without network: what is built is taken. The program, the module, a finite-element model
# and a shipped case then run from there. Exit code 77 without venv or pip.
set -euo pipefail
source=$(realpath "$1") folder=$2
fail() { echo "pip.sh: $*"; exit 1; }
/usr/bin/python3 -c 'import venv, ensurepip, pip' 2> /dev/null || { echo "no venv or pip"; exit 77; }
rm -rf "$folder"
/usr/bin/python3 -m venv --system-site-packages "$folder"
"$folder/bin/pip" install --no-index --no-build-isolation "$source" > "$folder/pip.log" 2>&1 ||
  { cat "$folder/pip.log"; exit 1; }
cd "$folder"
unset PYTHONPATH GRAINFIELD_PREFIX GRAINFIELD_CASES
prefix=$PWD
[ "$(bin/grainfield cases | grep -c "in $prefix/")" = 1 ] || fail "the program's cases are not those of $prefix"
bin/python - "$prefix" <<'TEXT' || fail "the module"
import resource
import sys
import warnings

before = resource.getrusage(resource.RUSAGE_SELF)
import grainfield as gf

after = resource.getrusage(resource.RUSAGE_SELF)
seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
assert seconds < 0.3, f"import grainfield took {seconds} s of processor time"
prefix = sys.argv[1]
assert gf.__file__.startswith(prefix), gf.__file__
assert all(file.startswith(prefix + "/share/grainfield/cases/") for file in gf.cases().values())
assert gf.model("fe_elastic_layer", F=1, h=1, tolerance=0.05)([[0.0, -0.5]]).shape == (1, 3)
heaps = gf.read(f"{prefix}/share/grainfield/cases/samples/heaps.h5")
with warnings.catch_warnings(record=True):  # of points outside the heaps
    assert len(gf.average(list(heaps.values()), frame="heap", cuts=[0.2])) > 10
from pathlib import Path
assert (Path(gf.__file__).parent / "py.typed").exists()
TEXT
bin/pip show -f grainfield > files.txt
grep -q 'bin/grainfield$' files.txt || fail "the program is not in pip's list"
bin/pip uninstall -y grainfield > pip.log
[ -z "$(find bin share lib -path "*grainfield*" -type f)" ] || fail "pip uninstall leaves files"
cd /
rm -rf "$prefix"

#!/usr/bin/env bash
# pages.sh PROGRAM: every page that a few quick runs and commands leave, in a browser
# (console.sh); the browser must also find an error that is there. Exit code 77: no Chromium here.
set -euo pipefail
program=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd)
for name in chromium chromium-browser google-chrome; do
  if command -v "$name" > /dev/null; then found=1; break; fi
done
[ -n "${found:-}" ] || { echo "no chromium here: apt-get install chromium"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
echo '<html><body><script>nothing.at.all()</script></body></html>' > broken.html
if "$here/console.sh" broken.html; then echo "an error on the console was not seen"; exit 1; fi
"$program" samples -o samples > log 2>&1
"$program" fit samples/heaps.h5 --model osl --model bcc -o fit > log 2>&1
"$program" run pair-hertz --quick -o pair > log 2>&1
"$program" run "$here/../../cases/samples/layer.toml" --set ensemble.realizations=2 -o layer > log 2>&1
mapfile -t pages < <(find . -name '*.html' ! -name broken.html | sort)
"$here/console.sh" "${pages[@]}"

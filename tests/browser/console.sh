#!/usr/bin/env bash
# console.sh PAGE.html...: opens pages in headless Chromium and fails when one of them, or anything
# it loads, writes an error or a warning to the console, or throws. Exit code 77: no Chromium here.
set -euo pipefail
[ $# -gt 0 ] || { echo "usage: console.sh PAGE.html..." >&2; exit 2; }
browser=
for name in chromium chromium-browser google-chrome; do
  if command -v "$name" > /dev/null; then browser=$name; break; fi
done
[ -n "$browser" ] || { echo "no chromium here: apt-get install chromium"; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
bad=0 n=0
for page in "$@"; do
  n=$((n + 1))
  case $page in *://*) address=$page ;; *) address=file://$(realpath "$page") ;; esac
  if ! timeout 120 "$browser" --headless --no-sandbox --disable-gpu --disable-dev-shm-usage \
    --disable-quic --no-first-run --disable-background-networking --disable-component-update \
    --disable-sync --user-data-dir="$work/profile$n" --enable-logging=stderr --log-level=0 \
    --virtual-time-budget=20000 --dump-dom "$address" > "$work/dom" 2> "$work/log"; then
    echo "$page: the browser failed"
    tail -n 3 "$work/log"
    bad=1
  elif grep -q CONSOLE "$work/log"; then  # the browser's own messages do not carry this word
    echo "$page:"
    grep CONSOLE "$work/log"
    bad=1
  elif [ "$(wc -c < "$work/dom")" -lt 200 ]; then
    echo "$page: empty"
    bad=1
  else
    echo "$page: no message on the console ($(wc -c < "$work/dom") characters)"
  fi
done
exit $bad

#!/usr/bin/env bash
# link.sh BUILD SOURCE: installs the build tree into BUILD/installed, links the example project
# against it as a user would, and runs it.
set -euo pipefail
build=$(realpath "$1") source=$(realpath "$2")
prefix=$build/installed
rm -rf "$prefix" "$build/linked"
cmake --install "$build" --prefix "$prefix" > "$build/installed.log"
for file in bin/grainfield lib/grainfield/libgrainfield_fe.so share/grainfield/cases/samples/heaps.h5 \
  share/man/man1/grainfield-fit.1 share/bash-completion/completions/grainfield \
  share/doc/grainfield/copyright share/doc/grainfield/docs/guide.md; do
  [ -s "$prefix/$file" ] || { echo "not installed: $file"; exit 1; }
done
[ "$("$prefix/bin/grainfield" cases | grep -c "in $prefix")" = 1 ]
# Nothing that was installed for who links names a folder of the build.
if grep -rlF "$source" "$prefix/lib/cmake"; then echo "names the source folder"; exit 1; fi
cmake -S "$source/docs/examples/link" -B "$build/linked" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$prefix" > "$build/linked.log"
cmake --build "$build/linked" >> "$build/linked.log"
"$build/linked/load_on_grains"
# A component that does not exist is named.
mkdir -p "$build/linked/wrong"
printf '%s\n' 'cmake_minimum_required(VERSION 3.25)' 'project(wrong CXX)' \
  'find_package(grainfield REQUIRED COMPONENTS demm)' > "$build/linked/wrong/CMakeLists.txt"
if cmake -S "$build/linked/wrong" -B "$build/linked/wrong/b" -DCMAKE_PREFIX_PATH="$prefix" \
  > "$build/linked/wrong/log" 2>&1; then
  echo "a wrong component was accepted"
  exit 1
fi
grep -q 'component found "demm"' "$build/linked/wrong/log"
rm -rf "$prefix" "$build/linked"

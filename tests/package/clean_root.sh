#!/usr/bin/env bash
# clean_root.sh PACKAGE.deb [ROOT]: installs the package with what it depends on into a bare Debian
# 12 made by debootstrap (as root; about 2 GB) and uses it there by name: a run, the Python module,
# finite elements, the manual. ROOT, when it holds a Debian already, is used as it is. LINK=1: what
# the package suggests for it is installed too, and docs/examples/link is built and run there.
set -euo pipefail
package=$(realpath "$1")
root=${2:-$(mktemp -d)/root}
mirror=$(sed -nE 's/^(URIs: |deb )(http[^ ]*debian\/?)( .*)?$/\2/p' /etc/apt/sources.list \
  /etc/apt/sources.list.d/* 2> /dev/null | grep -v security | head -n 1 || true)
if [ ! -e "$root/etc/debian_version" ]; then
  debootstrap --variant=minbase bookworm "$root" "${mirror:-http://deb.debian.org/debian}"
fi
inside() { chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 "$@"; }
mountpoint -q "$root/proc" || { mount -t proc proc "$root/proc"; trap 'umount "$root/proc"' EXIT; }
cp "$package" "$root/tmp/grainfield.deb"
printf '#!/bin/sh\nexit 101\n' > "$root/usr/sbin/policy-rc.d"
chmod +x "$root/usr/sbin/policy-rc.d"
inside apt-get update -q
inside env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --reinstall --no-install-recommends /tmp/grainfield.deb
echo "== in the clean root"
inside grainfield --version
inside sh -c 'cd /root && grainfield run pair-hertz --quick -o pair && grep -q "image/svg" pair/report.html && ! grep -q "class=.missing" pair/report.html'
inside sh -c 'cd /root && grainfield samples -o samples && grainfield fit samples/heaps.h5 --model osl --model bcc -o fit'
inside sh -c 'cd /root && printf "x,y\n0.1,-0.5\n" > p.csv && grainfield model fe_elastic_layer --set F=1 --set h=1 --points p.csv'
inside python3 -c 'import grainfield as gf; print(gf.__version__, len(gf.read("/root/samples/heaps.h5")))'
inside sh -c 'test -s /usr/share/man/man1/grainfield-fit.1.gz && test -s /usr/share/bash-completion/completions/grainfield'
inside sh -c 'test -s /usr/lib/cmake/grainfield/grainfieldConfig.cmake && test -s /usr/include/grainfield/dem/engine/engine.h'
inside apt-get check -q
if [ "${LINK:-0}" = 1 ]; then
  tools=$(inside dpkg-query -W -f '${Suggests}' grainfield | tr -d ' ' | tr ',' '\n' | grep -v paraview | tr '\n' ' ')
  # shellcheck disable=SC2086  # a list of names
  inside env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends make $tools
  inside sh -c 'cp -r /usr/share/doc/grainfield/docs/examples/link /root/link && cd /root/link && cmake -B build . && cmake --build build && build/load_on_grains'
fi
echo "installed and used in a clean root"

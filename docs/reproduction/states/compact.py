#!/usr/bin/env python3
"""Final states of a run, small enough to be kept: compact.py SNAPSHOTS.h5 OUT.h5, then xz -9 OUT.h5.

Forces, springs and normals are rounded to 24 bits and outlines, contact points and what follows from
outlines to 38; velocities and spins, of grains at rest, become 0. Positions stay as they are. The
stress of such a state differs by less than 1e-6 of itself. Needs h5py and numpy.
"""
import sys
import zlib

import h5py
import numpy as np

BITS = {name: 24 for name in ("force", "normal", "normal_force", "spring", "tangential_force")}
BITS |= {name: 38 for name in ("outline", "point", "mass", "inertia", "volume", "radius", "angle")}
ZERO = ("velocity", "spin")


def rounded(values, bits):
    """values with mantissas of `bits` bits."""
    mantissa, exponent = np.frexp(values)
    return np.ldexp(np.rint(np.ldexp(mantissa, bits)), exponent - bits)


def main(source, target):
    with h5py.File(source) as old, h5py.File(target, "w") as new:
        new.attrs.update(old.attrs)

        def copy(name, item):
            if isinstance(item, h5py.Group):
                new.require_group(name).attrs.update(item.attrs)
                return
            last = name.rsplit("/", 1)[-1]
            values = item[...]
            if "/walls/" not in name:
                if last in ZERO:
                    values = np.zeros_like(values)
                elif last in BITS:
                    values = rounded(values, BITS[last])
            kept = new.create_dataset(name, data=values)
            kept.attrs.update(item.attrs)
            if "crc32" in item.attrs:
                kept.attrs["crc32"] = np.bytes_(f"{zlib.crc32(values.tobytes()):08x}")

        old.visititems(copy)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2])

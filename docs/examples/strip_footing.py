"""Stress and settlement below a strip footing on a layer of sand above rock: strip_footing.py"""
import numpy as np

import grainfield as gf

width, pressure, depth = 2.0, 100e3, 4.0  # m, Pa, m of sand above rock
young, poisson = 40e6, 0.3  # Pa, of a triaxial sample at the stress of the site

below = -np.linspace(0.02, depth - 0.02, 199)  # m, under the middle of the footing
places, weights = np.polynomial.legendre.leggauss(64)
across = width / 2 * places  # m, where the line loads stand
shares = pressure * width / 2 * weights  # N/m, their sizes


def stress(name, **settings):
    """Components xx, yy, xy (Pa, tension positive) at `below`, shape (n, 3): the sum over line loads."""
    unit = gf.model(name, F=1, **settings)
    return sum(f * unit(np.column_stack([np.full_like(below, -x), below])) for x, f in zip(across, shares))


half_plane = stress("flamant")
layer = stress("layer", h=depth, nu=poisson, base="rough")
strain = (1 + poisson) / young * ((1 - poisson) * layer[:, 1] - poisson * layer[:, 0])
settlement = np.trapz(strain, below)  # both fall: positive is down

for z in (1.0, 2.0, 3.0):
    k = np.argmin(abs(below + z))
    print(f"{z:.0f} m: half space {-half_plane[k, 1] / 1e3:.1f} kPa, layer {-layer[k, 1] / 1e3:.1f} kPa")
print(f"settlement {1e3 * settlement:.1f} mm")

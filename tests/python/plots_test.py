"""Pictures, with and without matplotlib."""

import numpy as np
import pytest

import grainfield as gf
from scene import ETA, MU, heap, python

pytest.importorskip("matplotlib")


def test_packings_show_grains_and_forces():
    packing = heap()
    shapes, lines = packing.plot().collections
    assert len(shapes.get_paths()) == len(packing) and len(lines.get_paths()) == len(packing.contacts)
    widths = lines.get_linewidths()
    strongest = packing.contacts.normal_forces.argmax()
    assert np.argmax(widths) == strongest and max(widths) == 4
    change = packing.plot(change=packing).collections[1]
    assert max(change.get_linewidths()) == 0


def test_fields_and_profiles_show_bands_and_models():
    heaps = [heap(seed) for seed in (1, 2)]
    cut = gf.average(heaps, frame="heap", cuts=[0.2])
    axes = cut.plot("sigma_yy")
    assert len(axes.lines) == 1 and len(axes.collections) == 1
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), -cut.sigma_yy)
    assert axes.get_xlabel() == "x/h" and axes.get_ylabel() == "-sigma_yy (N/m)"
    shear = cut.plot("sigma_xy")
    np.testing.assert_array_equal(shear.lines[0].get_ydata(), cut.sigma_xy)
    assert shear.get_ylabel() == "sigma_xy (N/m)"
    assert gf.average(heaps, frame="heap", grid=(9, 5)).plot().get_ylabel() == "y/h"
    axes = gf.compare(cut, [f"osl:eta={ETA},mu={MU}", "ife"]).plot()
    assert [line.get_label() for line in axes.lines] == ["grains", "osl", "ife"]
    # Tables of profiles have compression positive, fields tension: the label has the sign.
    assert axes.get_ylabel() == "-sigma_yy (N/m)"
    lines = dict(zip(("grains", "osl", "ife"), axes.lines))
    assert np.nanmean(lines["grains"].get_ydata()) > 0 > np.nanmean(cut.sigma_yy)
    axes = gf.fit(heaps, ["osl"], heights=[0.2]).plot()
    assert axes.get_title() == "-sigma_xx at 0.2 h" and axes.get_ylabel() == "-sigma_xx (N/m)"
    shear = gf.fit(heaps, ["osl"], heights=[0.2]).plot(profile="sigma_xy at 0.2 h")
    assert shear.get_title() == "sigma_xy at 0.2 h" and shear.get_ylabel() == "sigma_xy (N/m)"
    with pytest.raises(ValueError, match="profile: found top, allowed: "):
        gf.compare(cut, "ife").plot(profile="top")


def test_what_was_measured_is_not_called_grains(tmp_path):
    table = tmp_path / "m.csv"
    table.write_text("x (mm),component,value (Pa),error (Pa)\n"
                     + "".join(f"{x},pressure,{900 - 5 * abs(x)},20\n" for x in range(-120, 121, 10)))
    field = gf.import_field(table, height=0.08, slope=30, rho_g=15000)
    for result in (gf.compare(field, "bcc"), gf.fit(field, ["bcc"])):
        assert [line.get_label() for line in result.plot().lines] == ["measured", "bcc"]


def test_without_matplotlib_the_error_says_what_to_install():
    done = python("""
import sys
sys.modules["matplotlib"] = None
import grainfield as gf
try:
    gf.packing([0], [0], 1, mass=1).plot()
except ImportError as error:
    print(error)
""")
    assert done.stdout == "plots need matplotlib, which is not installed (Debian: python3-matplotlib)\n", done.stderr

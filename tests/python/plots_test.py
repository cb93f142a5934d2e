"""Pictures, with and without matplotlib."""

import warnings

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
    fit = gf.fit(heaps, ["osl"], heights=[0.3, 0.2])
    axes = fit.plot()  # what the floor bears, and the nearest to it
    assert axes.get_title() == "-sigma_yy at 0.2 h" and axes.get_ylabel() == "-sigma_yy (N/m)"
    across = fit.plot(profile="sigma_xx at 0.3 h")
    assert across.get_title() == "-sigma_xx at 0.3 h" and across.get_ylabel() == "-sigma_xx (N/m)"
    shear = fit.plot(profile="sigma_xy at 0.2 h")
    assert shear.get_title() == "sigma_xy at 0.2 h" and shear.get_ylabel() == "sigma_xy (N/m)"
    with pytest.raises(ValueError, match="profile: found top, allowed: "):
        gf.compare(cut, "ife").plot(profile="top")


RUNS = {
    "sample": ("sample-biaxial", {"sample.grains": 40, "sample.strain": 0.02, "sample.records": 4,
                                  "sample.strain_rate": 1, "ensemble.realizations": 2}),
    "pair": ("pair-restitution", {"pair.speeds": [1e-2], "motion.time_step_fraction": 0.2,
                                  "sweep.values": ["linear", "overlap_area"]}),
    "gas": ("hard-disks", {"gas.grains": 100, "gas.fractions": [0.1, 0.2], "gas.collisions": 10, "gas.equilibration": 3,
                           "ensemble.realizations": 2, "sweep.values": ["pressure", "weak_loss"]}),
    "settling": ("implicit-settling", {"sweep.values": ["coulomb"]}),
    "switching": ("liffman-switching", {"switch.columns": 4, "switch.rows": 3}),
    "lattice": ("liffman-lattice", {"sweep.values": [30, 45]}),
}


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of what is small
        return {name: gf.run(case, folder / name, quick=True, set=sets | {"output.report": False}, progress=False)
                for name, (case, sets) in RUNS.items()}


def labels(axes):
    return [line.get_label() for line in axes.lines]


def test_samples_have_states(ran):
    sample = ran["sample"]
    states = sample.states
    assert states.units["sigma_xx"] == states.units["sigma_xx_error"] == "N/m" and states.units["work"] == "J"
    single = sample.tables["states_of_realizations"]
    for name in ("q_over_p", "sigma_yy"):
        values = single[name].reshape(2, -1)
        np.testing.assert_allclose(states[name], values.mean(axis=0), rtol=1e-8)
        np.testing.assert_allclose(states[f"{name}_error"], np.abs(values[0] - values[1]) / 2,
                                   rtol=0, atol=1e-8 * np.abs(values).max())  # nine digits
    assert len(states.to_pandas()) == len(states["strain"]) and sample.profiles is None
    axes = sample.plot()
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), states["q_over_p"])
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), states["strain"])
    assert len(axes.collections) == 1 and axes.get_ylabel() == "q_over_p"
    stress = sample.plot(profile="sigma_yy")
    assert stress.get_ylabel() == "sigma_yy (N/m)"
    with pytest.raises(ValueError, match="profile: found porosity, allowed: state, volumetric_strain"):
        sample.plot(profile="porosity")


def test_every_study_is_drawn(ran):
    pressure, cooling = (ran["gas"].members[name].plot() for name in ("pressure", "weak_loss"))
    assert labels(pressure) == ["compressibility", "theory", "virial_series"] and len(pressure.collections) == 1
    assert labels(cooling) == ["temperature", "haff"]
    assert labels(ran["settling"].members["coulomb"].plot()) == ["normal", "normal_closed_form"]
    assert labels(ran["switching"].plot()) == ["kinetic", "elastic"]
    impacts = ran["pair"].members["linear"].plot()
    assert labels(impacts) == ["restitution_normal", "closed_form_restitution_normal"]
    assert impacts.get_xlabel() == "speed (m/s)" and (np.diff(impacts.lines[0].get_xdata()) >= 0).all()
    assert labels(ran["lattice"].members["slope_deg_30"].plot()) == ["grains", "lattice", "liffman"]


def test_sweeps_are_drawn_with_a_curve_a_member(ran):
    axes = ran["lattice"].plot()
    assert labels(axes) == ["slope_deg_30", "slope_deg_45"]
    for line, member in zip(axes.lines, ran["lattice"].members.values()):
        np.testing.assert_array_equal(line.get_ydata(), member.profiles["simulation"][member.profiles["profile"] == "base"])
    assert labels(ran["pair"].plot()) == ["linear", "overlap_area"]
    assert labels(ran["gas"].plot()) == ["pressure"]  # the other member is drawn otherwise


def test_maps_have_a_bar_as_tall_as_they_are():
    axes = gf.average(heap(), frame="heap", grid=(21, 5)).plot()
    (bar,) = axes.child_axes
    axes.figure.canvas.draw()
    drawn, beside = axes.get_window_extent(), bar.get_window_extent()
    assert (beside.y0, beside.y1) == pytest.approx((drawn.y0, drawn.y1), abs=1) and bar.get_ylabel() == "-sigma_yy (N/m)"


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

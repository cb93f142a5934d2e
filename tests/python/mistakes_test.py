"""Mistakes in calls are Python's own exceptions, and each sentence says what to do next."""

import re
import warnings

import numpy as np
import pytest

import grainfield as gf
from scene import error_of, heap

HEAP = heap()
FIELD = gf.average(HEAP, frame="heap", grid=(5, 4))
PAIR = dict(x=[0, 0.02], y=[0.01, 0.01], radius=0.01, mass=1)


@pytest.mark.parametrize("call, kind, said", [
    (lambda: gf.packing(**PAIR, contacts={"pairs": [[0, 1]]}), ValueError,
     'contacts.pairs: found an array of shape (1, 2), allowed: columns i and j, ids of the grains, and forces (n, dim); '
     'did you mean {"i": pairs[:, 0], "j": pairs[:, 1], "forces": ...}?'),
    (lambda: gf.packing(**PAIR, walls={"floor": "y=0"}), ValueError,
     "walls.floor: found 'y=0', allowed: columns name, x, y, nx, ny, ..., each (n,), or texts; did you mean "
     'walls="floor:y=0"?'),
    (lambda: gf.packing(["a"], [0], 1, mass=1), ValueError, "grains.x: found 'a' at [0], allowed: numbers"),
    (lambda: gf.packing([0, 1j], [0, 0], 1, mass=1), TypeError,
     "grains.x: found complex numbers, allowed: real ones; .real are their real parts"),
    (lambda: gf.packing([[0], [0, 1]], [0], 1, mass=1), ValueError,
     "grains.x: found rows of different lengths, allowed: as many values in each"),
    (lambda: gf.packing([0], [0], 1, density="light"), TypeError, "density: found 'light', allowed: a number, kg/m2"),
    (lambda: gf.packing([0], [0], 1, mass=1, load=3), TypeError,
     "load: found 3, allowed: (id, force), such as (12, (0, -300))"),
    (lambda: gf.average(np.zeros((3, 2))), TypeError,
     'snapshots: found an array of shape (3, 2), allowed: a packing, "FILE.h5" or "FILE.h5:GROUP", or a list of these; '
     "gf.packing makes one of arrays, gf.import_packing of files of other programs"),
    (lambda: gf.average(HEAP, grid=41), TypeError,
     "grid: found 41, allowed: how many columns and rows, such as (41, 21), in space (21, 21, 11)"),
    (lambda: gf.average(HEAP, grid=(41, 2.5)), ValueError,
     "grid: found (41, 2.5), allowed: how many columns and rows, such as (41, 21), in space (21, 21, 11); whole numbers, "
     "2 or more"),
    (lambda: gf.average(HEAP, frame=3), TypeError, "frame: found 3, allowed: a text"),
    (lambda: gf.average(HEAP, width="2 mm"), TypeError, "width: found '2 mm', allowed: a number or None"),
    (lambda: gf.average(HEAP, frame="heap", cuts=["low"]), ValueError, "cuts: found 'low' at [0], allowed: numbers"),
    (lambda: gf.structure(None), TypeError,
     'snapshot: found None, allowed: a packing, "FILE.h5" or "FILE.h5:GROUP"; gf.packing makes one of arrays, '
     "gf.import_packing of files of other programs"),
    (lambda: gf.fit(HEAP.contacts), TypeError,
     'inputs: found a Contacts, allowed: a packing, "FILE.h5" or "FILE.h5:GROUP", a field, or a list of these; '
     "gf.packing makes one of arrays, gf.import_packing of files of other programs"),
    (lambda: gf.compare(HEAP, "osl"), TypeError,
     "field: found a packing, allowed: a field; gf.average(packing, frame=...) makes one, gf.fit takes packings"),
    (lambda: gf.compare(FIELD, 3), TypeError,
     'models: found 3, allowed: "NAME", "NAME:p=v,...", (name, {p: v}), a model, or a list of these; gf.models() has the '
     "names"),
    (lambda: gf.model("layer", F=[1, 2]), TypeError, "model layer: F: found [1, 2], allowed: a number"),
    (lambda: gf.Field([[0, 0]], {"a": ["low"]}), ValueError, "a: found 'low' at [0], allowed: numbers"),
    (lambda: gf.Engine(np.zeros(3)), TypeError,
     "start: found an array of shape (3,), allowed: a packing; gf.packing makes one of arrays, gf.read one of a file"),
    (lambda: gf.write("x.h5", np.zeros(3)), TypeError,
     "x.h5: found a ndarray, allowed: a packing, a field, or several by name"),
    (lambda: gf.export(np.zeros(3), "vtu", "x"), TypeError,
     'value: found an array of shape (3,), allowed: a packing, a field, several by name, or "FILE.h5"'),
])
def test_what_was_found_and_what_to_do(call, kind, said):
    with pytest.raises(kind, match=f"^{re.escape(said)}$"):
        call()


def test_one_number_is_a_list_of_one():
    np.testing.assert_array_equal(gf.average(HEAP, frame="heap", cuts=0.2).sigma_yy,
                                  gf.average(HEAP, frame="heap", cuts=[0.2]).sigma_yy)
    assert list(gf.compare(FIELD, [("osl", {"eta": 0.74, "mu": -0.31})]).measures) == ["osl"]


@pytest.mark.parametrize("which, found", [("grains", "outlines of grains"), ("contacts", "contacts"),
                                          ("chains", "force chains")])
def test_what_is_exported_for_the_eye_is_not_imported(which, found, tmp_path):
    (file,) = [path for path in gf.export(HEAP, "vtu", tmp_path) if path.endswith(f"{which}.vtu")]
    assert error_of(lambda: gf.import_packing("vtk", file)) == (
        f"{file}: found {found} as grainfield export writes them for ParaView, allowed: points with a radius and lines "
        "with forces; FILE.h5 of the packing needs no import, and its tables, export --to csv, can be imported")


@pytest.mark.parametrize("slope", [55, 65])
def test_steep_heaps_are_fitted(slope):
    """The first constants that are tried are inside the hyperbolic range, narrow where it is steep."""
    carried = dict(rows=60, at_slope=slope, eta=0.08, mu=0.1)
    fit = gf.fit([heap(seed, carried) for seed in (1, 2)], ["osl"])
    assert fit.constants["osl"]["eta"][0] == pytest.approx(0.08, abs=0.006)
    assert fit.constants["osl"]["mu"][0] == pytest.approx(0.1, abs=0.012)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        refused = error_of(lambda: gf.fit(heap(1, carried), "osl:eta=2,mu=0"))
    assert "outside the hyperbolic range of a heap; allowed: eta above 0 and below" in refused and "choose another model" in refused

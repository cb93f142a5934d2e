"""Predictions of heaps: the windows, the comparison, and that a prediction is committed before it is compared."""
import json
import math
import sys
from pathlib import Path

import numpy
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/reproduction"))

import predict  # noqa: E402


class PlainHeap:
    """A heap of 30 degrees, 2 m high, with measured figures that are given."""

    def __init__(self, dip=0.0, axis=0.5):
        slope = math.tan(math.radians(30))
        self.left, self.right, self.height, self.pressure = (slope, 2.0), (-slope, 2.0), 2.0, 8.0
        self.half_left = self.half_right = 2 / slope
        self._dip, self._axis = dip, axis

    def dip(self, share):
        assert share == 0
        return self._dip

    def axis_ratio(self, low, high):
        assert (low, high) == predict.AXIS
        return self._axis


def test_windows_are_those_of_the_summary():
    points = predict.windows(1.5, 2)
    spans = {name: [x for one, x, _ in points if one == name] for name in ("centre", "shoulder", "axis")}
    assert min(spans["centre"]) == pytest.approx(-0.15, abs=0.01) and max(spans["centre"]) == pytest.approx(0.2, abs=0.01)
    beside = numpy.array(spans["shoulder"])
    assert beside[beside < 0].min() == pytest.approx(-0.6, abs=0.01)
    assert beside[beside > 0].min() == pytest.approx(0.3, abs=0.01)
    assert beside[beside > 0].max() == pytest.approx(0.8, abs=0.01)
    heights = [y + 1 for name, _, y in points if name == "axis"]
    assert (min(heights), max(heights)) == pytest.approx(predict.AXIS)


def test_figures_of_a_known_field():
    """sigma_yy = -|x| beside the apex's zero: a dip of the mean |x| of the windows, by their widths."""
    points = predict.windows(1, 2)
    x = numpy.array([at for _, at, _ in points])
    got = predict.figures_of(points, {"sigma_yy": -abs(x) - 1, "sigma_xx": -0.4 * (abs(x) + 1)}, 2.0, 1, 2)
    shoulder = (1 * 0.275 * 1 + 2 * 0.275 * 2) / 3
    centre = (0.1 * 0.05 + 0.2 * 0.1) / 0.3  # the mean over both sides, each as wide as its half base
    assert got["dip"] == pytest.approx((shoulder - centre) / 2, abs=1e-3)
    assert got["axis_ratio"] == pytest.approx(0.4)


@pytest.mark.parametrize("model, settings, dip", [
    ("cantelaube", {"branch": "minus"}, 1), ("cantelaube", {"branch": "plus"}, -1), ("cantelaube", {"branch": "zero"}, 0)])
def test_closed_models_by_the_program(model, settings, dip):
    import os
    program = os.environ.get("GRAINFIELD_PROGRAM")
    if not program:
        pytest.skip("GRAINFIELD_PROGRAM is not set")
    heap = PlainHeap()
    settings = settings | {"phi_deg": 30, "rho_g": 4.0}
    half = heap.half_left / heap.height
    points = predict.windows(half, half)
    stresses = predict.stresses_of(program, model, settings, [(2 * x, 2 * y) for _, x, y in points])
    found = predict.figures_of(points, stresses, heap.pressure, half, half)["dip"]
    assert numpy.sign(round(found, 3)) == dip


def test_the_miss_is_of_piles_one_by_one_and_leaves_out_what_no_model_answers():
    prediction = {"version": "a", "beta_hat_deg": 40, "piles": [
        {"layers": {"dip": 0.1, "axis_ratio": 0.5}, "core": {"dip": None, "axis_ratio": None}},
        {"layers": {"dip": 0.3, "axis_ratio": 0.5}, "core": {"dip": 0.2, "axis_ratio": 0.4}},
        {"layers": {"dip": 0.5, "axis_ratio": 0.5}, "core": {"dip": 0.2, "axis_ratio": 0.4}}]}
    got = predict.compared(prediction, [PlainHeap(0.0), PlainHeap(0.2), PlainHeap(0.4)])
    # Piles scatter by 0.2, the misses do not.
    assert got["layers.dip"] == pytest.approx(0.3) and got["measured.dip"] == pytest.approx(0.2)
    assert got["layers.dip_miss"] == pytest.approx(0.1) and got["layers.dip_miss.standard_error"] == pytest.approx(0, abs=1e-12)
    assert got["layers.dip.standard_error"] == pytest.approx(0.2 / 3**0.5)
    assert got["core.dip.piles"] == 2 and got["core.dip_miss"] == pytest.approx(-0.1)


def test_every_model_of_a_pile_has_settings_that_the_program_takes():
    found = predict.models_of(PlainHeap(), 0.2, 40, Path("map.csv"))
    assert set(found) == {"layers", "at_once", "even", "core", "zero", "minus", "plus", "bcc", "fpa"}
    assert found["layers"][1]["rho_g"] == 4.0 and found["core"][1]["beta_hat_deg"] == 40
    assert "map" not in found["even"][1] and found["even"][1]["nu"] == 0.2


def test_a_map_is_made_usable_and_says_how_much_of_it(tmp_path):
    file = tmp_path / "elastic_map.csv"
    file.write_text("# a map\nx,y,young,poisson\n0,0,1,nan\n1,0,1,-0.1\n2,0,1,0.2\n3,0,1,0.6\n4,0,1,0.3\n")
    (tmp_path / "copy").mkdir()
    copy, moved = predict.usable_map(file, tmp_path / "copy")
    assert copy.read_text() == "# a map\nx,y,young,poisson\n0,0,1,nan\n1,0,1,0.0\n2,0,1,0.2\n3,0,1,0.45\n4,0,1,0.3\n"
    assert moved == 0.5 and copy != file


def test_a_prediction_that_is_not_committed_is_refused(tmp_path, monkeypatch):
    file = predict.PREDICTIONS / "not-committed-by-a-test.json"
    monkeypatch.setattr(predict, "PREDICTIONS", tmp_path)
    with pytest.raises(SystemExit, match="commit the prediction before it is compared"):
        predict.committed(file)
    with pytest.raises(SystemExit, match="commit the prediction"):
        predict.main(["compare", "nowhere.h5", "--name", "none"])


def test_a_prediction_is_kept_where_there_was_none(tmp_path, monkeypatch):
    monkeypatch.setattr(predict, "PREDICTIONS", tmp_path / "predictions")
    monkeypatch.setattr(predict, "predict", lambda *_: {"piles": []})
    assert predict.main(["make", "program", "states.h5", "run", "--name", "first"]) == 0
    assert json.loads((tmp_path / "predictions/first.json").read_text()) == {"piles": []}


def test_stored_predictions_are_compared():
    """Every prediction has its comparison, of the commit that made it."""
    stored = json.loads(predict.STORED.read_text()) if predict.STORED.exists() else {}
    for file in (ROOT / "docs/reproduction/predictions").glob("*.json"):
        assert f"{file.stem}.commit" in stored, f"docs/reproduction/predict.py compare STATES --name {file.stem}"

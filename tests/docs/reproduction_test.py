"""docs/reproduction.md is what its script makes, and the script judges by the rules that the page states."""
import base64
import json
import lzma
import math
import re
import sys
from pathlib import Path

import pytest
from scipy import stats

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/reproduction"))

import collect  # noqa: E402
import causes  # noqa: E402
import limit  # noqa: E402
import measure  # noqa: E402
import rve_scatter as scatter  # noqa: E402
import tables  # noqa: E402
import page as maker  # noqa: E402
import verdicts  # noqa: E402
from rows import (FILES, NOT_RUN, RULES, agreement, all_rows, band, judged, members_of, of_test,  # noqa: E402
                  off_band, piles_to_inform, places, read_toml, unanswered)
from summaries import Measured, Results, holm  # noqa: E402

NAN = float("nan")
RESULTS = Results(ROOT / "docs/reproduction/results")
#: Rows without a result: "not run", "not measured" and the like. The number may only fall.
OPEN_ROWS = 0
#: Results of programs with changes that are in no commit. The set may only shrink.
UNCOMMITTED = {"pile-elliptic", "pile-fields-elliptic"}
#: Figures of the sources with no row that has a result, nor a sentence why. The number may only fall.
MISSING_FIGURES = 0
#: Figures of each source, by chapter where they are numbered so.
FIGURES = {"Roul": {1: 12, 2: 10, 3: 32, 4: 9, 5: 17}, "Wellmann": 17, "Liffman": 20}
TABLES = {"Roul": {"table 1", "table 2", "table 5.1"}, "Wellmann": {"table 1"}, "Liffman": set()}


@pytest.fixture
def made(tmp_path):
    """The page of some summaries: {case: {key: value}}."""

    def of(summaries):
        for case, summary in summaries.items():
            (tmp_path / f"{case}.json").write_text(json.dumps(summary))
        return maker.page(Results(tmp_path))

    return of


def row_of(text, what):
    """The cells of a row by its second one, without what counts as theirs and without its cause."""
    found = [line for line in text.splitlines() if line.split(" | ")[1:2] == [what]]
    assert len(found) == 1, what
    cells = [re.sub("; cause.*?(?=; slow flow|$)", "", cell.strip()) for cell in found[0].strip("|").split("|")]
    return cells[:3] + cells[4:]


def test_the_page_in_docs_is_what_the_script_makes():
    assert maker.main(["--check"]) == 0, "docs/reproduction/page.py makes it again"


def test_check_sees_another_page(tmp_path):
    other = tmp_path / "page.md"
    other.write_text((ROOT / "docs/reproduction.md").read_text().replace("28.5", "28.6", 1))
    assert maker.main(["--check", "-o", str(other)]) == 1
    assert "28.6" in other.read_text()


def test_every_row_is_whole():
    seen = set()
    for row in all_rows():
        assert (ROOT / "cases" / f"{row['study']}.toml").exists(), row
        assert row["what"] not in seen, row
        seen.add(row["what"])
        kinds = [key for key in ("range", "agrees") if key in row]
        assert len(kinds) == 1 or not kinds and "gap" in row, row
        if "range" in row:
            assert row["range"][0] <= row["range"][1], row
        if "limits" in row:
            assert len(row["words"]) == len(row["limits"]) + 1
            assert set(row["agrees"]) <= set(row["words"]), row
    assert {row["rule"] for row in all_rows() if "rule" in row} == set(RULES), "a rule that no row uses"


def test_rows_without_a_result_are_listed_and_only_become_fewer():
    open_rows = [row["what"] for row in all_rows() if judged(row, RESULTS)[1] == ""]
    assert open_rows == [row["what"] for row in all_rows() if "gap" in row]
    assert len(open_rows) == OPEN_ROWS, "fewer: lower OPEN_ROWS; more: a result was lost"


def test_results_come_from_committed_builds():
    """A version that ends with + had changes that are in no commit. Those of UNCOMMITTED are left, and none else."""
    changed = {study for study, summary in RESULTS.all.items()
               for key, value in summary.items() if key.partition(".")[0] == "version" and "+" in value}
    assert changed == UNCOMMITTED


def test_the_list_of_the_sources_figures_is_whole():
    listed = read_toml("sources")
    for source, numbers in FIGURES.items():
        every = [f"fig. {chapter}.{k + 1}" for chapter, n in numbers.items() for k in range(n)] if isinstance(
            numbers, dict) else [f"fig. {k + 1}" for k in range(numbers)]
        kinds = ("results", "sketches", "pictures", "others")
        found = [one for kind in kinds for one in listed[source][kind] if one.startswith("fig.")]
        assert sorted(found) == sorted(every), source
        tables = [one for kind in (*kinds, "parameters") for one in listed[source][kind] if not one.startswith("fig.")]
        assert len(tables) == len(set(tables)) and set(tables) == TABLES[source], source


def test_every_figure_of_the_sources_has_a_row():
    listed, rows = read_toml("sources"), {}
    for row in all_rows():
        for source, place in places(row):
            rows.setdefault(source, set()).add(place)
    assert rows.pop("Henderson") == {"1975"}
    assert rows.keys() == listed.keys()
    for source, found in rows.items():
        assert found == set(listed[source]["results"]) | set(listed[source]["text"]), source


def test_figures_without_a_result_only_become_fewer():
    assert len(unanswered(RESULTS)) == MISSING_FIGURES, "fewer: lower MISSING_FIGURES; more: a result was lost"
    sentences = [one for listed in read_toml("sources").values() for one in listed["sentences"].items()]
    assert len(sentences) <= 5
    assert not [one for one in sentences if re.search("not (run|measured)", one[1])]
    for source, listed in read_toml("sources").items():
        assert set(listed["sentences"]) <= set(listed["results"]), source
    text = (ROOT / "docs/reproduction.md").read_text()
    assert all(f"{figure}" in text.partition("Figures without a result: ")[2].partition("\n")[0]
               for figure in unanswered(RESULTS))


def test_a_figure_is_answered_by_one_of_its_rows(tmp_path):
    assert "Wellmann table 1" not in unanswered(RESULTS)
    every = unanswered(Results(tmp_path))
    assert "Wellmann table 1" in every and len(every) == sum(len(one["results"]) for one in read_toml("sources").values())


def test_what_counts_as_theirs_is_in_every_row():
    text = (ROOT / "docs/reproduction.md").read_text()
    for row in all_rows():
        line = next(line for line in text.splitlines() if line.split(" | ")[1:2] == [row["what"]])
        assert line.split(" | ")[3] == band(row)
        assert (band(row) == "") == ("range" not in row and "agrees" not in row), row


def test_bands_by_hand():
    assert band({"range": [27, 29], "unit": "deg"}) == "27 to 29 deg"
    assert band({"limits": [0.01], "words": ["few", "many"], "agrees": ["few"], "says": "{percent:g}"}) == (
        "few (at most 1 %)")
    assert band({"limits": [0.8, 1.25], "words": ["a", "b", "a"], "agrees": ["a"], "says": ""}) == (
        "a (at most 0.8 or above 1.25)")
    assert band({"rule": "hardly changes", "within": 0.1, "agrees": ["hardly changes"]}) == (
        "hardly changes (by at most 10 %)")


def test_the_first_table_counts_the_rows():
    text = (ROOT / "docs/reproduction.md").read_text()
    agree = sum(judged(row, RESULTS)[1].startswith("agrees") for row in all_rows())
    assert f"| all | {len(all_rows())} | {agree} | " in text and text.count("\n| [") == len(FILES)


def test_every_key_is_one_that_summaries_have():
    listed = re.findall(r"^\| `([^`]+)` \|", (ROOT / "docs/summary-keys.md").read_text(), flags=re.M)
    listed += [*collect.ADDED, *measure.ADDED]
    known = re.compile("|".join(re.escape(key).replace(r"\*", r"[^.]+(\.[0-9]+)?") for key in listed))
    rows = [row for row in all_rows() if "key" in row or "from" in row]
    parts = {"steeper flank": "_left_deg", "fit quality": ".chi2_per_dof", "branch": ".branch", "kink": ".kink",
             "contraction": ".contraction", "dip over all pours": ".difference", "merging": ".peaks", "turning soft": ".at_rest",
             "static friction": ".at_rest", "held": ".within_until", "flatter flank": "_right_deg",
             "nearer": ".line_normal_max_difference"}
    for row in rows:
        for key in [row["key"] + parts.get(row.get("rule"), "")] if "key" in row else [row["from"], row["to"]]:
            assert known.fullmatch(key), key


def test_peaks_on_the_base_are_told_by_the_spread_of_the_layers(made):
    """Two peaks with 0.5 ± 0.1 below the load are two (t of seven degrees: 2.36), with 0.9 ± 0.1 they may be one."""
    what = "response on the base, shifted rows of disks with radii within 0.2 %, mu = 0.9"  # one by the source

    def cells(peaks, centre, error):
        return row_of(made({"point-load-friction": {
            "ensemble.realizations.varied_0.9": 8, "response.peaks.varied_0.9": peaks,
            "response.centre_over_largest.varied_0.9": centre,
            **({} if error is None else {"response.centre_over_largest.standard_error.varied_0.9": error})}}), what)[3:5]

    assert cells(2, 0.5, 0.1) == ["more than one peak: 2, below the load 0.50 ± 0.10 of the largest", "differs"]
    assert cells(2, 0.9, 0.1) == ["between: 2, below the load 0.90 ± 0.10 of the largest", "spread too wide to tell"]
    assert cells(1, 0.9, 0.1)[1] == "spread too wide to tell" and cells(1, 0.99, 0.1)[1] == "agrees"
    assert cells(1, 0.9, None) == ["one peak: 1", "agrees"]


def test_two_peaks_merge_where_one_reaches_the_base(made):
    what = "two peaks merge into one below a given depth, shifted rows of disks, mu = 0.6"

    def cells(by_depth, base):
        return row_of(made({"point-load-friction": {"response.peaks.friction_0.6": base, **{
            f"response.depth_{depth}.peaks.friction_0.6": peaks for depth, peaks in by_depth.items()}}}), what)[3:5]

    assert cells({0.1: 1, 0.25: 2, 0.3: 3, 0.9: 1}, 1) == ["merge: one peak below 0.3 of the depth", "agrees"]
    assert cells({0.1: 1, 0.25: 2, 0.3: 3, 0.9: 1}, 2) == ["do not merge: 2 on the base", "differs"]
    assert cells({0.1: 1, 0.25: 1}, 1) == ["never two: one peak at every depth", "differs"]


def test_agreement_by_its_rule():
    row = {"unit": "deg", "range": [27, 29]}
    assert agreement(Measured(28, 0.1), row) == "agrees"
    # Outside, but the interval reaches in.
    assert agreement(Measured(30, 0.6), row) == "spread too wide to tell"
    assert agreement(Measured(30, 0.4), row) == "differs by 1 deg (2.5 standard errors)"
    assert agreement(Measured(20, 10), row) == "spread too wide to tell"
    assert agreement(Measured(28, NAN), row) == "no error, no statement"
    # Three realizations have 4.30 standard errors, two have 12.7.
    assert agreement(Measured(30, 0.3, freedom=2), row) == "spread too wide to tell"
    assert agreement(Measured(30, 0.2, freedom=2), row) == "differs by 1 deg (5.0 standard errors)"
    assert agreement(Measured(30, 0.08, freedom=1), row) == "spread too wide to tell"
    # Within a band that begins at 0, however small its middle.
    assert agreement(Measured(0.05, 0.02), {"range": [0, 0.1]}) == "agrees"
    assert agreement(Measured(0.05, 0.03), {"range": [0, 0.1]}) == "spread too wide to tell"
    # A ratio that cannot tell 1.09 from 1 says nothing, although its range holds 1.09.
    ratio = {"range": [1.08, 1.10]}
    assert agreement(Measured(1.09, 0.05), ratio) == "agrees"
    # A range without an end has no middle: the whole interval lies in it, or nothing is said.
    assert agreement(Measured(1.2, 0.05), {"range": [1, float("inf")]}) == "agrees"
    assert agreement(Measured(1.2, 0.2), {"range": [1, float("inf")]}) == "spread too wide to tell"
    assert agreement(Measured(0.1, 0.1), {"range": [float("-inf"), 0.3]}) == "agrees"
    assert agreement(Measured(0.1, 0.1), {"range": [float("-inf"), 0.15]}) == "spread too wide to tell"
    assert agreement(Measured(1.09, 0.05), ratio | {"effect": 0.09}) == "spread too wide to tell"
    assert agreement(Measured(1.085, 0.02), ratio | {"effect": 0.09}) == "agrees"


def test_differences_of_small_ensembles_have_the_freedom_of_both():
    """Welch and Satterthwaite: of equal errors the sum of both, of unequal ones that of the larger."""
    assert Measured(3, 1, freedom=2).less(Measured(1, 1, freedom=2)) == Measured(2, 2**0.5, freedom=pytest.approx(4))
    assert Measured(3, 1, freedom=2).less(Measured(1, 0, freedom=7), times=2) == Measured(1, 1, freedom=2)
    assert Measured(0, 1, freedom=1).half == pytest.approx(12.706, abs=1e-3)
    assert Measured(0, 1).half == pytest.approx(1.96, abs=1e-3)


def test_holm_by_hand():
    assert holm([0.02, NAN, 0.01, 0.9]) == pytest.approx([0.04, NAN, 0.03, 0.9], nan_ok=True)
    assert holm([0.4, 0.3]) == [0.6, 0.6]  # none below a smaller one's


def test_fits_give_the_larger_error_and_quality_in_words(made):
    text = made({
        "fit-osl-point": {
            "ensemble.realizations": 8, "fit.osl.eta": 0.72, "fit.osl.eta.error": 0.004, "fit.osl.eta.bootstrap_error": 0.02,
            "fit.osl.mu": -0.5, "fit.osl.mu.error": 0.03, "fit.osl.mu.bootstrap_error": "nan",
            "fit.osl.chi2_per_dof": 1.3, "fit.osl.chi2_chance": 1.21, "fit.osl.rel_l2": 0.08},
        "fit-asymmetric": {
            "fit.cantelaube_asymmetric.kink": -0.3, "fit.cantelaube_asymmetric.kink.error": 0.1,
            "fit.cantelaube_asymmetric.ray_deg": 4}})
    # Beside his nine piles: 0.02 and 0.03 times sqrt(1 + 8/9), and the second of two p is the smaller.
    assert row_of(text, "OSL, point source: η")[3:5] == ["0.720 ± 0.020", "agrees"]
    assert row_of(text, "OSL, point source: μ")[3:5] == [
        "-0.500 ± 0.030", "differs by 0.18 (4.4 standard errors of both, p = 0.0066 over all tested rows)"]
    assert row_of(text, "OSL, point source, η and μ free: agreement")[3:5] == [
        "beyond the errors: χ²/dof 1.30 (chance: up to 1.21), relative L2 8.0 %", "differs"]
    assert row_of(text, "asymmetric point source: kink of the pressure")[3:5] == [
        "dip: kink -0.30 ± 0.10 ρg on the ray at 4° from the vertical", "agrees"]


def test_summaries_give_numbers_with_errors_and_words(made):
    pour = {"dip.verdict": "dip", "dip.difference": 0.1, "dip.standard_error": 0.02, "dip.p_value": 0.001,
            "dip.ratio": 0.8}
    text = made({
        "pile-point-source": pour | {
            "repose.mean_deg": 28.4, "repose.mean_deg.standard_error": 0.3, "ensemble.realizations": 8,
            "density.ratio": 1.02, "density.ratio.standard_error": 0.004, "dem.grains": 6500,
            "source.interval": 0.03},
        "pile-line-source": pour | {
            "repose.mean_deg": 24, "repose.mean_deg.standard_error": 0.5, "heap.volume_fraction": 0.79},
        "pile-elliptic": {
            "dip.verdict": "undecided", "dip.difference": 0.22, "dip.standard_error": 0.2, "dip.p_value": "nan",
            "dip.ratio": 0.7}})
    assert row_of(text, "angle of repose, point source")[3:] == ["28.4 ± 0.3 deg", "agrees", "8",
                                                                "`pile-point-source`"]
    assert row_of(text, "angle of repose, line source")[3:5] == ["24.0 ± 0.5 deg",
                                                                "differs by 2 deg (4.0 standard errors)"]
    dip = ("dip: shoulder - centre = 0.100 ± 0.020 ρgh, p = 0.002 if there were none (0.004 over all pours); "
           "centre over largest 0.80")
    assert row_of(text, "base pressure, point source")[3:5] == [dip, "agrees"]
    assert row_of(text, "base pressure, line source")[3:5] == [dip, "differs"]  # the source has no dip there
    assert row_of(text, "base pressure, elliptic grains")[4] == "too few realizations to tell"
    assert "| `pile-point-source` | 8 | 0.100 ± 0.020 | 0.002 | 0.004 | dip |" in text
    assert "| `pile-elliptic` |  | 0.220 ± 0.200 | nan | nan | undecided |" in text
    # The ratio of 0.22 ± 0.2 and 0.1 ± 0.02.
    assert row_of(text, "depth of the dip, elliptic over round")[3:5] == ["2.200 ± 2.048",
                                                                         "spread too wide to tell"]
    assert row_of(text, "volume fraction, line source")[3:5] == ["0.790", "no error, no statement"]
    assert "| 1.020 ± 0.004 | differs by 0.06 (10.9 standard errors of both, p = 2.4e-05 over all tested rows) |" in text
    assert "| `pile-point-source` | 6500 | 8 | 0.03 |" in text
    assert row_of(text, "asymmetric line source, steeper flank")[3:6] == ["not run", "", ""]
    # No command is made up where none was stored.
    assert "grainfield run cases/pile-point-source.toml" not in text
    assert "run before commands were stored" in text


def test_dips_are_judged_over_all_pours(made):
    """One of three pours at p = 0.04 is what chance alone makes of three, and a study that the sources
    do not have counts too."""

    def pour(difference, p):
        return {"dip.difference": difference, "dip.standard_error": 0.02, "dip.p_value": p, "dip.ratio": 0.8}

    text = made({"pile-point-source": pour(0.05, 0.02), "pile-line-source": pour(-0.01, 0.7),
                 "another": pour(-0.3, 0.999)})
    assert "| `pile-point-source` |  | 0.050 ± 0.020 | 0.04 | 0.08 | neither |" in text
    assert "| `another` |  | -0.300 ± 0.020 | 0.002 | 0.006 | peak |" in text
    assert row_of(text, "base pressure, point source")[4] == "uninformative"


def test_a_ratio_is_judged_by_its_numerator_where_the_denominator_is_uncertain(made):
    """-0.04 ± 0.03 over 0.05 ± 0.02 against 1.5: -0.115 off with an error of 0.03 sqrt 2."""
    text = made({"pile-point-source": {"dip.difference": 0.05, "dip.standard_error": 0.02},
                 "pile-elliptic": {"dip.difference": -0.04, "dip.standard_error": 0.03}})
    assert row_of(text, "depth of the dip, elliptic over round")[3:5] == [
        "-0.800 ± 0.849", "differs by 2.3 (2.7 standard errors)"]


def test_superellipsoids_change_in_words_with_notes_on_the_run(made):
    box = {"case.command": "grainfield run cases/wellmann-box.toml --quick",
           "dem.grains.least.penalty_05": 200, "dem.grains.least.penalty_025": 200}
    for key, (value, error) in {
            "q_over_p_at_0.04.penalty_05_soft": (1.2, 0.02), "q_over_p_at_0.04.penalty_05": (1.4, 0.02),
            "q_over_p_at_0.04.penalty_025": (1, 0.02), "q_over_p_at_0.04.penalty_025_soft": (0.91, 0.02),
            "q_over_p_at_0.04.hertz_025_nu_0": (1.4, 0.002), "q_over_p_at_0.04.hertz_025_nu_045": (1.401, 0.002),
            "q_over_p_at_0.04.hertz_05": (1.4, 0.02), "q_over_p_at_0.04.hertz_025": (0.99, 0.02),
            "sample.lateral_stress_ratio.penalty_05": (0.3, 0.002), "sample.lateral_stress_ratio.hertz_05": (0.31, 0.002),
            "sample.pressure_ratio.shear_hertz_0": (1, 0.02),
            "q_over_p_at_0.04.penalty_0": (0.1, 0.01), "sample.kinetic_share.penalty_0": (15, 1),
            "rve.contraction.shear_hertz_05": (0.0002, 0.0002), "rve.dilation.shear_hertz_05": (0.001, 0.0001),
            "sample.axial_dip_strain.shear_penalty_025": (0.07, 0.003),
            "sample.pressure_ratio.shear_penalty_025": (1.3, 0.02),
            "sample.shear_over_pressure.shear_penalty_025": (0.80, 0.02),
            "sample.shear_over_pressure.shear_hertz_025": (0.81, 0.02),
            "sample.pressure_ratio.shear_hertz_025": (1.2, 0.02)}.items():
        box[key] = value
        box[".standard_error.".join(key.rsplit(".", 1))] = error
    text = made({"wellmann-box": box})

    def said(what):
        return row_of(text, what)[3:5]

    assert row_of(text, "q/p from mu = 0.25 to 0.5, penalty law")[3:] == [
        "rises: +0.400 ± 0.028", "agrees", "", "`wellmann-box` (quick, 200 grains)"]
    assert said("shear stress over the first volumetric one, from penalty to Hertz law, mu = 0.25") == [
        "undecided: +0.010 ± 0.028", "too few realizations to tell"]
    assert said("q/p from c^T/c^N = 0.25 to 1, mu = 0.5") == [
        "counts: +0.200 ± 0.028 beside +0.400, +50 ± 7 %", "differs"]
    # Above a tenth of what friction does, but not by two errors: neither.
    assert said("q/p from c^T/c^N = 0.25 to 1, mu = 0.25") == [
        "between: +0.090 ± 0.028 beside +0.400, +22 ± 7 %", "spread too wide to tell"]
    assert said("q/p from nu = 0 to 0.45, mu = 0.25") == [
        "negligible: +0.001 ± 0.003 beside +0.410, +0 ± 1 %", "agrees"]
    assert said("lateral over axial stress, from penalty to Hertz law, mu = 0.5") == [
        "hardly changes: +0.010 ± 0.003, +3 ± 1 %", "agrees"]
    assert said("q/p at a strain of 0.04 without friction, penalty law") == [
        "0.100 ± 0.010", "agrees; slow flow, not at rest: kinetic over elastic energy up to 15"]
    assert said("volume of the RVEs under shear, Hertz law, mu = 0.5") == [
        "dilation: trace/3 falls by 0.00020 ± 0.00020, then rises by 0.00100 ± 0.00010", "differs"]
    assert said("shear strain xz where the axial stress is least, penalty law, mu = 0.25") == [
        "0.070 ± 0.003", "differs by 0.0075 (2.5 standard errors)"]
    assert said("volumetric stress over its start, from penalty to Hertz law, mu = 0.25") == ["falls: -0.100 ± 0.028",
                                                                                   "differs"]


def test_a_row_counts_the_realizations_of_its_member(made):
    box = {"ensemble.realizations": 3, "ensemble.realizations.shear_hertz_05": 2, "sample.pressure_ratio.shear_hertz_05": 3,
           "sample.pressure_ratio.standard_error.shear_hertz_05": 0.05, "sample.dropped_solid_fraction.hertz_025": 0.63,
           "sample.dropped_solid_fraction.standard_error.hertz_025": 0.001,
           "sample.axial_dip_strain.shear_penalty_025": 0.035,
           "sample.axial_dip_strain.standard_error.shear_penalty_025": 0.0,
           "shear_stiffness.first.shear_hertz_025": 9, "shear_stiffness.first.standard_error.shear_hertz_025": 0.3,
           "shear_stiffness.middle.shear_hertz_025": 3, "shear_stiffness.middle.standard_error.shear_hertz_025": 0.4}
    text = made({"wellmann-box": box})
    assert row_of(text, "volumetric stress over its start, Hertz law, mu = 0.5")[3:6] == ["3.000 ± 0.050", "agrees", "2"]
    assert row_of(text, "volume fraction of 1,530 dropped grains and spheres below the lid")[5] == "3"
    # A miss of half the distance of the recorded states is none that these can tell.
    assert row_of(text, "shear strain xz where the axial stress is least, penalty law, mu = 0.25")[4] == (
        "nearer than the recorded strains can tell")
    what = "shear stiffness from a shear strain xz of 0 to 0.02 to one of 0.04 to 0.06, Hertz law, mu = 0.25"
    assert row_of(text, what)[3:5] == ["falls: -6.000 ± 0.500", "agrees"]


def test_a_figure_that_a_study_lacks_says_why(tmp_path):
    (tmp_path / "pile-elliptic.json").write_text(json.dumps({"dem.grains": 200}))
    row = {"study": "pile-elliptic", "what": "a figure", "gap": "not measured"}
    assert judged(row, Results(tmp_path)) == ("not measured", "")
    assert judged(row | {"study": "another"}, Results(tmp_path)) == (NOT_RUN, "")


TESTED = {"what": "a figure", "range": [0.06, 0.1], "piles": 9, "alternative": 0}


def test_a_tested_row_has_the_error_of_the_sources_piles_too():
    """Eight piles of a scatter s beside nine: s sqrt(1/8 + 1/9), known with 7 degrees of freedom."""
    ours = Measured(0.03, 0.01, freedom=7)
    miss, error, p = off_band(ours, TESTED)
    assert miss == pytest.approx(0.03) and error == pytest.approx(0.01 * 8**0.5 * (1 / 8 + 1 / 9) ** 0.5)
    assert p == pytest.approx(2 * stats.t.sf(miss / error, 7))
    # The same miss on either side, and none inside the band.
    assert off_band(Measured(0.13, 0.01, freedom=7), TESTED)[2] == pytest.approx(p)
    assert off_band(Measured(0.07, 0.01, freedom=7), TESTED)[0] == 0
    # Without an error, and where piles were not counted, nothing is said.
    none = Results(ROOT / "docs/reproduction/figures")  # a folder without summaries
    assert of_test(Measured(0.03, NAN), TESTED, none) == "no error, no statement"
    assert of_test(Measured(0.03, 0.01), TESTED, none) == "no error, no statement"
    # By itself: p = 0.066 inside the reach of no dip, of a dip, of both.
    assert of_test(Measured(0.03, 0.01, freedom=7), TESTED, none).startswith("uninformative: ")
    assert of_test(Measured(0.08, 0.01, freedom=7), TESTED, none) == "agrees"
    assert of_test(Measured(-0.08, 0.01, freedom=7), TESTED, none) == (
        "differs by 0.14 (10.2 standard errors of both, p = 1.9e-05 over all tested rows)")
    assert of_test(Measured(0.08, 0.1, freedom=7), TESTED, none) == (
        "uninformative: no number of piles of ours would inform beside the source's 9")
    # Without an alternative half of the value is at stake.
    wide = {key: value for key, value in TESTED.items() if key != "alternative"}
    assert of_test(Measured(0.08, 0.012, freedom=7), wide, none) == "agrees"
    assert of_test(Measured(0.08, 0.013, freedom=7), wide, none).startswith("uninformative: ")


def test_the_number_of_piles_that_would_inform_is_the_least_that_does():
    ours = Measured(0.03, 0.015, freedom=7)
    n = piles_to_inform(ours, TESTED, 0.08, 0.05)

    def reach(count):
        quantiles = stats.t.ppf(0.975, count - 1) + stats.t.ppf(0.8, count - 1)
        return quantiles * 0.015 * (8 * (1 / count + 1 / 9)) ** 0.5

    assert reach(n) <= 0.08 < reach(n - 1)
    assert piles_to_inform(ours, TESTED, 0.08, 0.001) > n
    assert piles_to_inform(ours, TESTED, 0.03, 0.05) is None  # the source's nine are too few


def test_tested_rows_are_corrected_for_one_another(made):
    """One value off at p = 0.02 differs alone and not beside a second row."""
    def said(summaries):
        return row_of(made(summaries), "sigma_xx / sigma_yy on the axis by his constants, line source")[4]

    # A miss of 0.05 with an error of both of 0.0166.
    axis = {"pile-line-source": {"ensemble.realizations": 8, "axis.stress_ratio": 0.36,
                                 "axis.stress_ratio.standard_error": 0.011}}
    assert said(axis).startswith("differs by 0.05 (3.0 standard errors of both, p = 0.021 over all")
    axis["fit-cantelaube-line"] = {"ensemble.realizations.line_16": 16, "dip.difference.line_16": -0.12,
                                   "dip.standard_error.line_16": 0.01}
    assert said(axis).startswith("differs by 0.05 (3.0 standard errors of both, p = 0.041 over all")
    axis["pile-line-source"] |= {"density.ratio": 1, "density.ratio.standard_error": 0.01}
    assert said(axis).startswith("uninformative: p = 0.021 by itself, 0.062 over all tested rows; ")


def test_axes_are_apart_collinear_or_neither(tmp_path):
    row = {"study": "pile-fields", "what": "axes", "rule": "apart", "key": "axes", "least": 1, "within": 5,
           "agrees": ["not collinear"]}

    def said(value, error):
        (tmp_path / "pile-fields.json").write_text(json.dumps(
            {"ensemble.realizations": 8, "axes": value, "axes.standard_error": error}))
        return judged(row, Results(tmp_path))

    assert said(-5.8, 0.6) == ("not collinear: -5.8 ± 0.6°", "agrees")
    assert said(0.4, 0.9) == ("collinear: +0.4 ± 0.9°", "differs")
    assert said(3, 2) == ("between: +3.0 ± 2.0°", "spread too wide to tell")


def test_a_dip_inside_is_one_below_and_none_above(tmp_path):
    row = {"study": "pile-point-source", "what": "dip", "rule": "dip inside", "member": "m", "levels": [0.1, 0.5],
           "agrees": ["up to a height"]}

    def said(low, high):
        (tmp_path / "pile-point-source.json").write_text(json.dumps({
            "ensemble.realizations.m": 8, "levels.0.1.dip.m": low, "levels.0.1.dip.standard_error.m": 0.02,
            "levels.0.5.dip.m": high, "levels.0.5.dip.standard_error.m": 0.02}))
        return judged(row, Results(tmp_path))

    assert said(0.1, 0) == ("up to a height: shoulder - centre 0.10 ± 0.02, 0.00 ± 0.02", "agrees")
    assert said(0.1, 0.1)[0].startswith("elsewhere: ") and said(0, 0.1)[1] == "differs"
    assert said(0.05, 0)[1] == "uninformative"  # 2.5 standard errors: not over two levels


def test_one_sample_decides_nothing_and_no_run_is_said_so(made):
    text = made({"wellmann-box": {"q_over_p_at_0.04.penalty_05_soft": 1.2, "q_over_p_at_0.04.penalty_05": 1.201,
                                  "q_over_p_at_0.04.penalty_025": 1.1, "sample.lateral_stress_ratio.penalty_05": 0.3,
                                  "sample.lateral_stress_ratio.hertz_05": 0.303}})
    few = "too few realizations to tell"
    assert row_of(text, "q/p from c^T/c^N = 0.25 to 1, mu = 0.5")[3:5] == ["undecided: +0.001, +1 %", few]
    assert row_of(text, "lateral over axial stress, from penalty to Hertz law, mu = 0.5")[3:5] == ["undecided: +0.003, +1 %", few]
    assert row_of(text, "angle of repose, point source")[3] == "not run"


def test_predictions_stand_beside_what_was_measured(made):
    """Misses of 4 and of 12 standard errors of four piles, corrected for one another."""
    stored = {"a.realizations": 4, "a.measured.dip": 0.05, "a.measured.dip.standard_error": 0.02,
              "a.measured.axis_ratio": 0.5, "a.measured.axis_ratio.standard_error": 0.01}
    for figure, value, miss in (("dip", 0.13, 0.08), ("axis_ratio", 0.74, 0.24)):
        stored |= {f"a.zero.{figure}": value, f"a.zero.{figure}.standard_error": 0.001, f"a.zero.{figure}.piles": 4,
                   f"a.zero.{figure}_miss": miss, f"a.zero.{figure}_miss.standard_error": 0.02}
    text = made({"pile-predictions": stored})
    assert "| a | measured | **0.050 ± 0.020** | **0.500 ± 0.010** | 4 |" in text
    # t = 4 and 12 with 3 degrees of freedom: p = 0.028 and 0.0012, the second doubled by Holm.
    assert ("| a | `cantelaube`, branch zero | 0.130 ± 0.001, differs (p = 0.028) | 0.740 ± 0.001, differs (p = 0.0025) "
            "| 4 |") in text
    assert "What continuum models predict" not in made({"pile-predictions": {}})


def test_takes_a_finished_run_in(tmp_path):
    run, results = tmp_path / "run", tmp_path / "results"
    run.mkdir()
    results.mkdir()
    (run / "summary.json").write_text(json.dumps({"case.name": "pile-elliptic", "repose.mean_deg": 31.5,
                                                  "case.command": "grainfield run pile-elliptic --set a=1"}))
    (run / "profiles.md").write_text("# Profiles\n")

    def picture(title, kind, content):
        data = base64.b64encode(content).decode()
        return f'<img width="9" height="9" alt="{title}" src="data:image/{kind};base64,{data}">'

    (run / "report.html").write_text(picture("Stress", "png", b"A") + picture("Volume fraction", "png", b"PNG") +
                                     picture("Vertical pressure on the base", "svg+xml", b"<svg/>"))
    out = tmp_path / "page.md"
    assert maker.main(["--results", str(results), "--add", str(run), "-o", str(out)]) == 0
    assert (results / "pile-elliptic.json").read_text() == (run / "summary.json").read_text()
    assert (results / "pile-elliptic.profiles.md").read_text() == "# Profiles\n"
    assert (results / "pile-elliptic.base-pressure.svg").read_text() == "<svg/>"
    assert (results / "pile-elliptic.volume-fraction.png").read_text() == "PNG"
    assert len(list(results.iterdir())) == 4
    text = out.read_text()
    assert row_of(text, "angle of repose, elliptic grains")[3] == "31.5 deg"
    assert "| `grainfield run pile-elliptic --set a=1` |" in text
    assert "(reproduction/results/pile-elliptic.profiles.md)" in text
    assert "![base-pressure](reproduction/results/" in text


@pytest.mark.parametrize("name", ["../escaped", "/tmp/escaped", "a/b", "..", ".hidden", ""])
def test_a_name_that_leads_elsewhere_is_refused(tmp_path, capsys, name):
    run, results = tmp_path / "run", tmp_path / "results"
    run.mkdir()
    results.mkdir()
    (run / "summary.json").write_text(json.dumps({"case.name": name}))
    assert maker.main(["--results", str(results), "--add", str(run), "-o", str(tmp_path / "page.md")]) == 2
    assert f'case.name: found "{name}"' in capsys.readouterr().err
    assert not list(results.iterdir()) and not (tmp_path / "page.md").exists()


def test_refuses_folders_and_files_that_are_none(tmp_path, capsys):
    out = tmp_path / "page.md"
    assert maker.main(["--results", str(tmp_path / "none"), "-o", str(out)]) == 2
    assert "none: no such folder" in capsys.readouterr().err
    assert maker.main(["--add", str(tmp_path), "-o", str(out)]) == 2
    assert "no summary.json" in capsys.readouterr().err
    for broken, complaint in {"{": "pile-elliptic.json: ", "[]": "not a JSON object",
                              '{"a": [1]}': "a: found [1]; allowed: numbers and texts"}.items():
        (tmp_path / "pile-elliptic.json").write_text(broken)
        assert maker.main(["--results", str(tmp_path), "-o", str(out)]) == 2
        assert complaint in capsys.readouterr().err
    assert not out.exists()


def heap(places, contacts):
    """The states of a heap: grains' places, and contacts as (i, j, force, point)."""
    i, j, force, point = zip(*contacts)
    force = measure.numpy.array(force, dtype=float)
    return {"grains/position": measure.numpy.array(places, dtype=float),
            "contacts": {"i": measure.numpy.array(i), "j": measure.numpy.array(j), "force": force,
                         "normal": force, "point": measure.numpy.array(point, dtype=float)}}


def test_the_law_that_makes_the_stiffness_predicts_heaps_left_out():
    generator = measure.numpy.random.default_rng(3)

    def heap_of(power):
        trace, pressure, density = generator.normal(0, 1, (3, 200))
        return measure.numpy.array([trace, pressure, density, 2 + 1.5 * trace + power * pressure])

    alone = [heap_of(0) for _ in range(4)]
    assert measure.explained(alone, [0]) == pytest.approx([1] * 4)
    assert max(measure.explained(alone, [1])) < 0.05
    both = [heap_of(1.5) for _ in range(4)]
    assert measure.explained(both, [0]) == pytest.approx([0.5] * 4, abs=0.12)
    assert measure.explained(both, [0, 1, 2]) == pytest.approx([1] * 4)
    # A heap with another law is not predicted by the others.
    odd = [*alone[:3], alone[3] * measure.numpy.array([[-1], [1], [1], [1]])]
    assert measure.explained(odd, [0])[3] < -1


def test_levels_of_one_heap_are_left_out_together(tmp_path):
    files = []
    for level in (5, 9):
        for heap in range(3):
            folder = tmp_path / f"level_{level}-{heap}"
            folder.mkdir()
            files.append(folder / "fields.h5")
            trace = measure.numpy.linspace(3, 4, 20)
            with measure.h5py.File(files[-1], "w") as file:
                for name, values in {"fabric/value/fabric_trace": trace, "fabric/value/sigma_xx": -level * trace,
                                     "fabric/value/sigma_yy": -level / trace, "density/value/volume_fraction": trace / 5,
                                     "elastic_constants/value/bulk": trace**2}.items():
                    file[name] = values
                file["elastic_constants/value/bulk"][0] = NAN
    found = measure.figures("stiffness", files, [])
    assert found["ensemble.realizations"] == 3 and found["stiffness.fabric"] == pytest.approx(1)
    assert found["stiffness.fabric_less_pressure"] == pytest.approx(1 - found["stiffness.pressure"])


def test_directions_of_forces_by_hand():
    force = [(1, 0.05, 0), (-1, 0.01, 0), (0.5, 0.866, 0), (0.866, -0.5, 0), (0, 0, 0), (0, 1, 0)]
    contacts = [(0, 1 if k < 5 else -1, one, (0, 0, 0)) for k, one in enumerate(force)]
    found = measure.angles_of({"unloaded": heap([(0, 0, 0), (1, 0, 0)], contacts)})
    assert found["angles.near_60"] == 0.75 and found["angles.near_30"] == 0.25
    strong = contacts[:4] + [(0, 1, (2, 0, 0), (0, 0, 0))]  # the mean is 1.2
    found = measure.angles_of({"unloaded": heap([(0, 0, 0), (1, 0, 0)], strong)})
    assert found["angles.strong_near_60"] == 1 and found["angles.near_60"] == 0.8
    assert measure.order(measure.numpy.full(40, 12.0)) == 1
    even = measure.numpy.random.default_rng(1).uniform(0, 360, (40, 500))
    assert abs(measure.numpy.mean([measure.order(one) for one in even])) < 1e-3  # 0.010 without Miller's term


@pytest.mark.parametrize("power", [1, 2])
def test_tails_of_known_power_are_found_at_every_depth(power):
    """Forces that grow with the depth, whose share above n > 1 is exp(-c (n^power - 1)) of the mean's."""
    numpy, generator = measure.numpy, measure.numpy.random.default_rng(power)

    def layer():
        x, y = numpy.meshgrid(numpy.arange(60.0), numpy.arange(20.0))
        depth = 19.5 - generator.uniform(0, 19, x.size)
        n = generator.exponential(size=x.size) ** (1 / power)
        contacts = {"i": numpy.zeros(x.size), "j": numpy.where(depth > 18.9, -1, 1),
                    "normal_force": n * (1 + depth), "point": numpy.stack((x.ravel(), 19.5 - depth), axis=1)}
        grains = {"position": numpy.stack((x.ravel(), y.ravel()), axis=1), "radius": numpy.full(x.size, 0.5)}
        return {"unloaded/contacts": contacts, "unloaded/grains": grains}

    layers = [measure.forces_over_mean(layer()) for _ in range(8)]
    assert measure.numpy.mean(layers[0]) == pytest.approx(1, abs=0.02) and len(layers[0]) < 1000
    found = measure.tails_of(layers)
    assert set(found) - {"ensemble.realizations"} <= {*measure.ADDED, *(f"{key}.standard_error" for key in measure.ADDED)}
    # The mean of exponential(1)^(1/2) is sqrt(pi)/2, and the tail's power does not change with the unit.
    assert abs(found["tails.exponent"] - power) < 3 * found["tails.exponent.standard_error"] < 0.5
    if power == 1:
        assert abs(found["tails.rate"] - 1) < 4 * found["tails.rate.standard_error"] < 0.2


def test_stresses_and_displacements_of_a_changed_heap_by_hand():
    """A floor's point replaces the second grain; the sign of the branch is that of the first one's force."""
    places = [(0, 1, 0), (0, 3, 0), (0, 6, 0)]

    def under(weight):
        return heap(places, [(0, -1, (weight, 2 * weight, 0), (-1, 0, 0)), (1, 0, (0, weight, 0), (9, 9, 0))])

    assert measure.stress_sums(under(1)) == pytest.approx([1, 4, 0])
    moved = [(0, 0.9, 0), (0, 3, 0), (0.3, 6, 0)]
    found = measure.gravity_of({"pile": heap(places, [(0, 1, (0, 1, 0), (0, 0, 0))]), "gravity_5": under(1),
                                "gravity_20": under(3), "gravity_4.905": {"grains/position": measure.numpy.array(moved)}})
    assert found == pytest.approx({"gravity.xx_ratio": 3, "gravity.yy_ratio": 3, "gravity.top_over_bottom": 3})


def test_forces_inside_a_heap_by_hand():
    """1 near the surface of a triangle, 3 below it, 1.5 under the apex."""
    places = [(x, y, 0) for y in range(20) for x in range(2 * y - 40, 41 - 2 * y)]

    def force(x, y):
        return 1.5 if abs(x) < 5 and y < 10 else 1 if y > 15.5 - abs(x) / 2 else 3

    contacts = heap(places, [(k, -1, (0, 1, 0), (0, 0, 0)) for k in range(len(places))])["contacts"]
    contacts["normal_force"] = measure.numpy.array([force(x, y) for x, y, _ in places])
    found = measure.forces_of({"pile/contacts": contacts, "pile/grains/position": measure.numpy.array(places, dtype=float)})
    assert found["forces.centre_over_beside"] == 0.5
    assert 2 < found["forces.middle_over_surface"] < 3


def test_forces_that_hold_a_heap_by_hand():
    """Three grains on a floor, 1 on both others; 3 hangs on 0 alone, and without it 4 has one contact."""
    state = heap([(0, 0, 0), (2, 0, 0), (1, 2, 0), (-2, 0, 0), (-4, 0, 0)],
                 [(0, -1, (0, 1, 0), (0, -1, 0)), (1, -1, (0, 1, 0), (2, -1, 0)), (2, 0, (0, 1, 0), (0, 0, 0)),
                  (2, 1, (0, 1, 0), (0, 0, 0)), (0, 1, (1, 0, 0), (1, 0, 0)), (3, 4, (1, 0, 0), (0, 0, 0)),
                  (4, 3, (0, 0, 0), (0, 0, 0)), (3, 0, (1, 0, 0), (0, 0, 0))])
    state["contacts"]["sliding"] = measure.numpy.array([0, 1, 0, 0, 0, 1, 1, 0])
    state["contacts"]["normal_force"] = measure.numpy.array([1, 1, 1, 1, 1, 1, 0, 1.0])
    state["grains/volume"] = measure.numpy.full(5, 3.0)
    state["contacts"]["friction"] = measure.numpy.full(8, 0.5)
    assert measure.network_of({"pile": state})["network.components_over_equations"] == 9 / 9
    # A layer without friction: five normal forces on three disks, which have two equations each, or pentagons with three.
    state["contacts"]["friction"] = measure.numpy.zeros(8)
    assert measure.network_of({"unloaded": state}) == {"network.components_over_equations": 5 / 6}
    state["grains/outline"] = measure.numpy.zeros(25)
    assert measure.network_of({"unloaded": state}) == {"network.components_over_equations": 5 / 9}


def test_contacts_that_grow_as_the_theory_says_have_its_g2():
    """Equal grains have 1; in rows deep enough the theory's own numbers of contacts give its g2."""
    places = [(x, y, 0) for y in range(20) for x in range(8)]
    state = heap(places, [(k, (k + 1) % 160, (0, 1, 0), (0, 0, 0)) for k in range(160)])
    state["contacts"] |= {"sliding": measure.numpy.zeros(160), "normal_force": measure.numpy.ones(160),
                          "friction": measure.numpy.ones(160)}
    state["grains/volume"] = measure.numpy.full(160, math.pi / 4)
    found = measure.network_of({"pile": state})
    assert found["network.g2"] == pytest.approx(1) and found["network.g2_over_theory"] == pytest.approx(1)
    # Two sizes and as many contacts of each: (mean area)/(mean area) is 1, the theory's is above.
    state["grains/volume"] = measure.numpy.where(measure.numpy.arange(160) % 2, 1.0, 0.5) * math.pi / 4
    found = measure.network_of({"pile": state})
    assert found["network.g2"] == pytest.approx(1) and found["network.g2_over_theory"] < 0.99


def test_a_bent_relation_of_maps_by_hand():
    places = measure.numpy.array([-1.0, 0, 1, NAN])
    bent = [1 + 2 * places + 0.5 * places**2, 3 - places, places + 0.2 * places**2]
    bend = 0.5 / 2 * measure.numpy.std([-1, 0, 1])
    found = measure.curvatures(measure.numpy.array([[places, *bent]] * 3))
    assert found["curvature.bulk"] == pytest.approx(bend) and found["curvature.bulk.standard_error"] < 1e-12
    assert found["curvature.shear"] == pytest.approx(0, abs=1e-12)
    # Three heaps whose bends are b, 3 b and 5 b: the jackknife of a mean is its standard error.
    others = [[places, 1 + 2 * places + times * 0.5 * places**2, *bent[1:]] for times in (3, 5)]
    found = measure.curvatures(measure.numpy.array([[places, *bent], *others]))
    assert found["curvature.bulk"] == pytest.approx(3 * bend)
    assert found["curvature.bulk.standard_error"] == pytest.approx(2 * bend / 3**0.5)


def test_strains_along_the_base_keep_their_signs():
    points = measure.numpy.array([(0, -1), (1, -1), (2, -1), (0, 0)], dtype=float)
    values, others = measure.numpy.array([-1.0, -2, NAN, 9]), measure.numpy.array([-2.0, -2, -5, 1])
    assert measure.along_base(points, values, others) == 0.75


def test_sizes_of_rves_without_one_heap(tmp_path):
    def run(stress, strain):
        return {"ensemble.realizations": 3, "rve_size.stress_grains": stress, "rve_size.strain_grains": strain,
                "rve_size.fabric_grains": 20}

    found = measure.sizes_of(run(150, 150), run(110, 60), run(190, None))
    assert found["rve_size.stress_grains.least"] == 110 and found["rve_size.strain_grains.most"] == math.inf
    (tmp_path / "s.json").write_text(json.dumps({f"{key}.m": value for key, value in found.items()
                                                 if value != math.inf} | {"rve_size.strain_grains.most.m": "inf"}))
    row = {"study": "s", "member": "m", "rule": "grains needed", "sizes": [100, 200], "agrees": ["within"]}
    said = {name: judged(row | {"key": f"rve_size.{name}_grains"}, Results(tmp_path)) for name in ("stress", "strain",
                                                                                                   "fabric")}
    assert said["stress"] == ("within: 150 grains, 110 to 190 without one heap", "agrees")
    assert said["strain"] == ("between: 150 grains, 60 to inf without one heap", "spread too wide to tell")
    assert said["fabric"] == ("fewer: 20 grains, 20 to 20 without one heap", "differs")


def test_one_peak_reaches_deeper_by_hand(tmp_path):
    (tmp_path / "s.json").write_text('{"k.a": 0.2, "k.b": 0.4}')
    row = {"study": "s", "rule": "deeper", "key": "k", "from": "a", "to": "b", "agrees": ["deeper"]}
    assert judged(row, Results(tmp_path)) == ("deeper: to 0.2 and to 0.4 of the depth", "agrees")
    assert judged(row | {"from": "b"}, Results(tmp_path)) == ("not deeper: to 0.4 and to 0.4 of the depth", "differs")


def test_growth_inwards_by_hand():
    """Columns of four and of three points, and one whose value is missing; a middle counts as the upper half."""
    points = measure.numpy.array([(0, 0), (0, -1), (0, -2), (0, -3), (1, -2), (1, -3), (1, -4), (2, -3), (0, -4)],
                                 dtype=float)
    values = measure.numpy.array([1, 1, 4, 4, 2, 3, 6, NAN, NAN])
    assert measure.inside(points, values) == pytest.approx((14 / 3) / (7 / 4))


def test_peaks_and_widths_of_strains_by_hand(tmp_path):
    table = tmp_path / "field.csv"

    def write(file, lines):
        file.write_text("# a field\nx,y,strain_yy\n" + "".join(
            f"{x},{y},{-value}\n" for y, values in lines.items() for x, value in zip(range(-2, 3), values)))

    write(table, {-1: [0, 0, 4, 0, 0], -2: [0, 3, 2, 2.9, 0], -3: [2, 2, 2.1, 2, 2], -4: [0, 0, 0, 0, 0]})
    assert measure.strain_of([table]) == {"ensemble.realizations": 1, "strain.peaks": 2, "strain.width_ratio": 4}
    # The dent of one layer is a hump of the other.
    write(other := tmp_path / "other.csv", {-1: [0, 0, 4, 0, 0], -2: [0, 3, 6, 3, 0], -3: [2, 2, 2.1, 2, 2],
                                            -4: [0, 0, 0, 0, 0]})
    assert measure.strain_of([table, other])["strain.peaks"] == 1
    # A layer of another height is taken at the same parts of its depth: here its dent is a hump, too.
    write(other, {-1.1: [0, 0, 4, 0, 0], -2.2: [0, 3, 6, 3, 0], -3.3: [2, 2, 2.1, 2, 2], -4.4: [0, 0, 0, 0, 0]})
    assert measure.strain_of([table, other])["strain.peaks"] == 1
    assert measure.width(measure.numpy.arange(5.0), measure.numpy.array([0, 3, 2, 3, 0.0])) == pytest.approx(3)


def layer_piece(folder, name, realizations, base):
    """A piece of an ensemble: x, pressure, error and the half plane's on a base 4 m deep; depths do not count."""
    (folder / f"{name}.json").write_text(json.dumps({"summary": {"ensemble.realizations": realizations}}))
    file = folder / f"{name}.profiles.csv.xz"
    text = "# layers\nprofile,depth_m,x_m,simulation_N/m,standard_error_N/m,flamant_N/m\ndepth_0.5,2,0,99,9,99\n" + (
        "".join(f"base,4,{x},{value},{error},{model}\n" for x, value, error, model in base))
    file.write_bytes(lzma.compress(text.encode()))
    return file


def test_an_ensemble_in_pieces_by_hand(tmp_path):
    one = layer_piece(tmp_path, "one", 3, [(-2, 1, 0, 1), (-1, 2, 0, 2), (0, 4, 0, 3), (1, 3, 0, 2), (2, 0, 0, 0)])
    two = layer_piece(tmp_path, "two", 3, [(-2, 1, 0, 1), (-1, 4, 0, 2), (0, 2, 0, 3), (1, 6, 0, 2), (2, 0, 0, 0)])
    found = measure.pieces_of([one, two])
    assert found == pytest.approx({
        "ensemble.realizations": 6, "ensemble.pieces": 2, "response.near_axis": 3.5, "response.largest": 4.5,
        "response.near_axis.standard_error": 0.5, "response.largest.standard_error": 1.5,
        "response.flamant_rel_l2": (7.25 / 39.25) ** 0.5})  # of 1, 3, 3, 4.5, 0 from 1, 2, 3, 2, 0
    with pytest.raises(ValueError, match="unlike size"):
        measure.pieces_of([one, layer_piece(tmp_path, "three", 4, [(0, 1, 0, 1)])])


def test_pieces_not_layers_give_the_freedom_of_an_error(tmp_path):
    (tmp_path / "s.json").write_text(json.dumps({
        "k.a": 1, "k.standard_error.a": 0.1, "ensemble.realizations.a": 24, "ensemble.pieces.a": 2}))
    results = Results(tmp_path)
    assert results.number("s", "k", "a").freedom == 1 and results.realizations("s", "a") == 24


def test_the_response_below_the_load_by_hand(tmp_path):
    file = layer_piece(tmp_path, "dip", 8, [(-1, 4, 0.3, 1), (0, 2, 0.2, 1), (1, 3.9, 0.3, 1)])
    assert measure.centre_of(file) == pytest.approx({
        "ensemble.realizations": 8, "response.centre_over_largest": 0.5,
        "response.centre_over_largest.standard_error": (0.2**2 + (0.5 * 0.3) ** 2) ** 0.5 / 4})
    top = layer_piece(tmp_path, "peak", 8, [(-1, 1, 0.3, 1), (0, 2, 0.2, 1), (1, 1, 0.3, 1)])
    assert measure.centre_of(top)["response.centre_over_largest"] == 1


def test_down_to_which_depth_there_is_one_peak():
    peaks = {"response.depth_0.25.peaks": 1, "response.depth_0.5.peaks": 1, "response.depth_0.75.peaks": 3}
    assert measure.one_peak_to(peaks | {"response.peaks": 1}) == {"response.one_peak_to": 0.5}
    assert measure.one_peak_to(peaks | {"response.peaks": 1, "response.depth_0.25.peaks": 2}) == {
        "response.one_peak_to": 0}
    assert measure.one_peak_to({"response.depth_0.5.peaks": 1, "response.peaks": 1}) == {"response.one_peak_to": 1}
    record = {"summary": {"response.peaks": 2, "response.depth_0.5.peaks": 1, "ensemble.realizations": 8, "load.x": 3}}
    assert measure.of_summary(record, ["response."]) == {
        "response.peaks": 2, "response.depth_0.5.peaks": 1, "ensemble.realizations": 8, "response.one_peak_to": 0.5}


def test_measured_keys_replace_their_older_ones():
    out = measure.with_keys('{\n  "a": 1,\n  "angles.order": 2\n}\n',
                            measure.summarized([{"angles.order": 1}, {"angles.order": 3}]))
    assert json.loads(out) == {"a": 1, "ensemble.realizations": 2, "angles.order": 2, "angles.order.standard_error": 1}
    found = measure.of_summary({"fit.a": 1, "fit.b": 2, "ensemble.realizations": 8}, ["fit.b"])
    assert found == {"fit.b": 2, "ensemble.realizations": 8}


def test_a_ratio_of_poured_heaps_by_hand():
    found = measure.poured([(1, 2), (3, 2)], [(8, 8), (8, 8)])
    assert found == pytest.approx({"gravity.poured_xx_ratio": 4, "gravity.poured_xx_ratio.standard_error": 2,
                                   "gravity.poured_yy_ratio": 4, "gravity.poured_yy_ratio.standard_error": 0,
                                   "ensemble.realizations": 2})


def test_collected_runs_by_hand():
    def run(member, p, stress):
        states = {name: collect.numpy.array(values) for name, values in {
            "strain": [0, 0.04, 0.08, 0.1, 0.12, 0.14, 0.2], "p": [p] * 7, "sigma_xz": [s * p for s in stress], "sigma_xy": [p / 50] * 7,
            "sigma_yz": [-p / 10] * 7}.items()}
        summary = {"sample.a": p, "sample.b": None, "case.name": "box"}
        return member, collect.figures_of(member, {"summary": summary, "cpu_seconds": 1}, states, None, None)

    straight = [0, 0.4, 0.6, 0.65, 0.7, 0.75, 0.9]
    out = collect.collect([run("shear_a", 10, straight), run("shear_a", 14, [-s for s in straight]),
                           ("filled", collect.figures_of("filled", {"summary": {"sample.a": 3}, "cpu_seconds": 2}, None,
                                                         None, 23.5))])
    assert out["sample.a.shear_a"] == 12 and out["sample.a.least.shear_a"] == 10
    assert out["sample.a.standard_error.shear_a"] == pytest.approx(2)
    assert out["lid_height.filled"] == 23.5 and "lid_height.shear_a" not in out
    assert out["sample.a.filled"] == 3 and "sample.a.standard_error.filled" not in out
    assert "sample.b.shear_a" not in out and out["ensemble.realizations.shear_a"] == 2
    assert out["other_shear_stress.shear_a"] == pytest.approx(1 / 9)
    for part, slope in {"first": 10, "middle": 2.5, "last": 2.5}.items():
        assert out[f"shear_stiffness.{part}.shear_a"] == pytest.approx(slope)
        assert out[f"shear_stiffness.{part}.standard_error.shear_a"] == pytest.approx(0, abs=1e-12)


def test_a_compression_is_read_where_a_state_is_recorded():
    states = {name: collect.numpy.array(values) for name, values in {
        "strain": [0, 0.02, 0.0402, 0.06, 0.04], "p": [0, 1, 4, 3, 2], "axial_q_over_p": [0, 1, 1.2, 1, 1],
        "kinetic_energy_J": [1, 1, 5e-4, 4e-4, 9], "elastic_energy_J": [0, 1, 1, 2, 1]}.items()}
    assert collect.compression_figures(states) == {
        "q_over_p_at_0.02": 1, "q_over_p_at_0.04": 1.2, "pressure_at_0.04": 4, "quasistatic_from": 0.0402}
    assert "pressure_at_0.04" not in collect.compression_figures({**states, "strain": states["strain"] * 0.9})
    assert "quasistatic_from" not in collect.compression_figures(
        {**states, "kinetic_energy_J": collect.numpy.array([1, 1, 1, 1, 9])})


def test_the_lid_stands_on_the_packing():
    """23.6 in the source; of three packings the walls across z are no further apart than the page's error says."""
    heights = [collect.lid_height(ROOT / f"docs/reproduction/states/wellmann/packing-{k}.h5.xz") for k in (1, 2, 3)]
    assert min(heights) == pytest.approx(RESULTS.plain("wellmann-box", "lid_height.least.packing"))
    assert all(23 < height < 24 for height in heights)


def test_a_cause_ends_a_row_that_differs_alone():
    row = {"study": "s", "key": "k", "range": [1, 2], "cause": "cause: c"}

    class One:
        def number(self, *_):
            return self.found

    one = One()
    one.found = Measured(5, 0.1)
    assert judged(row, one)[1] == "differs by 3 (30.0 standard errors); cause: c"
    one.found = Measured(1.5, 0.1)
    assert judged(row, one)[1] == "agrees"


def test_scatter_of_rves_by_hand():
    """A known line of the stress over the height is all of the scatter; corners as far apart as spheres fit."""
    heights = scatter.numpy.array([0.0, 0, 0, 0, 1, 1, 1, 1])
    values = 3 + heights
    assert scatter.bar(values) == pytest.approx((8 / 7 * 0.25) ** 0.5 / 8**0.5 / 3.5)
    assert scatter.without_line(values, heights) == pytest.approx(0, abs=1e-12)
    sample = scatter.Sample.__new__(scatter.Sample)
    sample.low, sample.high = scatter.numpy.zeros(3), scatter.numpy.array([20.0, 20, 24])
    assert scatter.numpy.ptp(sample.centres(7, 1), axis=0) == pytest.approx([6, 6, 10])
    assert scatter.numpy.ptp(sample.centres(3, 0.5), axis=0) == pytest.approx([5, 5, 6])


def test_strains_of_rves_are_read_while_the_sample_is_loaded():
    """Half of the imposed strain up to 0.02, all of it beyond; another radius and the way back do not count."""
    imposed = [0, -0.01, -0.02, -0.03, -0.04, -0.02]
    rves = {"radius": [5] * 6 + [2], "imposed_zz": [*imposed, -1], "imposed_xz": [*imposed, -1],
            "strain_zz": [0, -0.005, -0.01, -0.02, -0.03, -0.03, 7], "strain_xz": [*imposed, 7]}
    rves = {name: collect.numpy.array(values) for name, values in rves.items()}
    assert collect.strain_slopes(rves, "zz") == pytest.approx(
        {"strain_slope.early": 0.5, "strain_slope.middle": 1, "strain_slope.late": 1})
    assert collect.strain_slopes(rves, "xz") == pytest.approx(
        {"strain_slope.early": 1, "strain_slope.middle": 1, "strain_slope.late": 1})
    # Beyond 0.04 the slope of the late part alone changes.
    longer = {name: collect.numpy.array(values) for name, values in {
        "radius": [5] * 5, "imposed_zz": [0, 0.02, 0.04, 0.06, 0.08], "strain_zz": [0, 0.02, 0.04, 0.08, 0.12]}.items()}
    found = collect.strain_slopes(longer, "zz")
    assert found["strain_slope.middle"] == pytest.approx(1) and found["strain_slope.late"] > 1.5


def test_rves_at_a_strain_and_their_stiffening_by_hand():
    """A stress that is the square of the RVEs' strain has slopes of 0.75 and 1.75 times the largest strain."""
    strain = collect.numpy.linspace(0, 0.05, 401)
    rves = {"radius": collect.numpy.repeat([5, 7], 401), "imposed_zz": collect.numpy.tile(-2 * strain, 2),
            "strain_zz": collect.numpy.tile(-strain, 2), "sigma_zz": collect.numpy.tile(-strain**2, 2),
            "sigma_zz_error_bar": collect.numpy.tile(0.1 * strain**2, 2)}
    assert collect.bars_of(rves) == pytest.approx(
        {"error_bar_at_0.04.r5": 0.1, "error_bar_at_0.04.r7": 0.1, "strain_ratio_at_0.04": 0.5})
    assert collect.stiffening(rves)["rve_stiffening_late"] == pytest.approx(1.75 / 0.75, rel=0.02)
    assert collect.bars_of({**rves, "imposed_zz": 0.7 * rves["imposed_zz"] * (abs(rves["imposed_zz"]) < 0.03)}) == {}


def test_variants_of_one_packing_are_compared_packing_by_packing(tmp_path):
    """Packings scatter by 1, their difference by 0.1: it decides what independent ones leave open."""
    figures = {(name, str(k)): {"k": value} for name, values in {"a": (10, 11, 12), "b": (8, 9.1, 9.9, 70)}.items()
               for k, value in enumerate(values)}
    row = {"study": "wellmann-box", "key": "k", "from": "a", "to": "b", "rule": "rises", "agrees": ["falls"]}
    pairs = collect.pairs_of([row, {**row, "study": "box-shear"}])
    assert (("k", "a"), ("k", "b"), "k.b_{}_a", "") in pairs and (("k", "a_slow"), ("k", "b_slow"), "k.b_slow_{}_a_slow", "") in pairs
    made = collect.paired(figures, pairs)
    assert made["k.b_less_a"] == pytest.approx(-2) and made["k.standard_error.b_less_a"] == pytest.approx(0.1 / 3**0.5)
    assert made["ensemble.realizations.b_less_a"] == 3  # the fourth has no partner
    assert made["k.b_over_a"] == pytest.approx((0.8 + 9.1 / 11 + 9.9 / 12) / 3)
    together = collect.collect([(name, of) for (name, k), of in figures.items() if k != "3"])
    (tmp_path / "wellmann-box.json").write_text(json.dumps(together))
    assert judged(row, Results(tmp_path))[1].startswith("too few")
    (tmp_path / "wellmann-box.json").write_text(json.dumps(together | made))
    assert judged(row, Results(tmp_path)) == ("falls: -2.000 ± 0.058", "agrees")
    ratio = {"study": "wellmann-box", "key": "k", "from": "a", "to": "b", "rule": "ratio", "range": [0.8, 0.85]}
    assert judged(ratio, Results(tmp_path))[1] == "agrees"
    # Two keys of one member.
    within = {"study": "wellmann-box", "member": "m", "from": "f", "to": "g", "rule": "rises", "agrees": ["rises"]}
    made = collect.paired({("m", "1"): {"f": 1, "g": 3}, ("m", "2"): {"f": 2, "g": 5}}, collect.pairs_of([within]))
    assert made["g_less_f.m"] == 2.5 and made["g_less_f.standard_error.m"] == pytest.approx(0.5)


def test_a_row_says_what_was_tried(tmp_path):
    row = {"study": "wellmann-box", "key": "k", "member": "m", "range": [1, 2]}
    (tmp_path / "wellmann-box.json").write_text(json.dumps({"k.m": 5, "k.standard_error.m": 0.1}))

    def said(changes, **more):
        (tmp_path / "wellmann-box-causes.json").write_text(json.dumps(changes))
        return judged(row | more, Results(tmp_path))[1].partition("; ")[2]

    assert said({}) == "cause not found; tried: nothing yet"
    tried = {"k.m_dense": 4, "k.m_smooth": 3, "k.standard_error.m_smooth": 0.2}
    assert said(tried) == "cause not found; tried: denser packing 4.000, smooth walls 3.000 ± 0.200"
    assert said(tried, cause="cause: c").startswith("cause: c; tried: denser packing 4.000, ")
    assert said(tried, cause="cause not found; tried: d") == (
        "cause not found; tried: d; denser packing 4.000, smooth walls 3.000 ± 0.200")
    assert said({}, cause="cause: {k@m}, {k@n}") == "cause: 5.000 ± 0.100, not run"
    # A run to 0.04 says nothing of a longer one's end.
    assert said({"k.m_slow": 4}) == "cause not found; tried: nothing yet"
    assert said({"k.m": 5, "k.m_dense": 2}, study="box-shear") == ""
    (tmp_path / "wellmann-box.json").write_text(json.dumps({
        "k_at_0.04.a": 1, "k_at_0.04.standard_error.a": 0.01, "k_at_0.04.b": 2, "k_at_0.04.standard_error.b": 0.01}))
    pair = {"key": "k_at_0.04", "from": "a", "to": "b", "rule": "hardly changes", "within": 0.1, "agrees": ["hardly changes"]}
    del row["member"], row["range"]
    assert said({"k_at_0.04.a_slow": 1, "k_at_0.04.b_slow": 1.5}, **pair) == (
        "cause not found; tried: a tenth of the rate +50 %")


def test_a_sample_that_collapses_agrees_with_nothing(tmp_path):
    row = {"study": "s", "key": "k", "member": "shear_a", "range": [-0.2, 0.2]}

    def said(share, of):
        (tmp_path / "s.json").write_text(json.dumps({
            "sample.pressure_ratio.shear_a": share, "k.shear_a": 0.01, "k.standard_error.shear_a": 0.001,
            "k.shear_b": 0.02, "k.standard_error.shear_b": 0.001}))
        return judged(of, Results(tmp_path))[1]

    assert said(0.5, row) == "agrees"
    assert said(0.02, row) == "collapsed, agrees with nothing: the mean stress falls to 0.02 of its start"
    assert said(0.02, row | {"range": [1, 2]}).startswith("differs")
    pair = {"study": "s", "key": "k", "from": "shear_a", "to": "shear_b", "rule": "rises", "agrees": ["rises"]}
    assert said(0.5, pair) == "agrees" and said(0.02, pair).startswith("collapsed")
    assert maker.kind("collapsed, agrees with nothing: x") == "silent"


def test_no_row_of_wellmann_cites_fewer_grains_than_his():
    """His sample has 1,609; quick cases of 200 stay tests."""
    for row in read_toml("wellmann")["figure"]:
        assert "--quick" not in (RESULTS.text(row["study"], "case.command") or ""), row["what"]
        for member in members_of(row):
            if member != "packing" and row["study"] == "wellmann-box":
                assert RESULTS.plain(row["study"], f"dem.grains.least.{member}") >= 1609, (row["what"], member)
    for study in ("wellmann-box", "wellmann-box-causes"):
        grains = [value for key, value in RESULTS.all[study].items() if key.startswith("dem.grains.least.")]
        assert len(grains) > 5 and min(grains) >= 1609


def test_the_tables_of_causes_name_what_is_missing(tmp_path):
    (tmp_path / "wellmann-box.json").write_text(json.dumps({
        "strain_slope.early.hertz_05": 0.74, "strain_slope.early.standard_error.hertz_05": 0.003,
        "ensemble.realizations.hertz_05": 3}))
    (tmp_path / "wellmann-box-causes.json").write_text(json.dumps({
        "strain_slope.early.hertz_05_slow": 0.95, "sample.plastic_strain.hertz_0_slow": 0.02}))
    results = Results(tmp_path)
    names = {f"hertz_05_{one}" for one in ("dense", "smooth", "slow")} | {"hertz_0_slow", "hertz_0_dense"}

    def line(table, start):
        assert len({one.count("|") for one in table.splitlines()}) == 1
        return next(one for one in table.splitlines() if one.startswith(f"| {start}"))

    assert line(causes.causes(results, names), "strain of RVEs over the imposed one, up to 0.02") == (
        "| strain of RVEs over the imposed one, up to 0.02, μ = 0.5 | about 1 | 0.740 ± 0.003 |  | – |  | – |  | 0.95 |")
    # A run to 0.04 leaves another plastic strain.
    assert line(causes.causes(results, names), "plastic strain").endswith("| – |  | – |  |  |  |  |")
    assert line(causes.figures(results), "strain of RVEs of radius 5").endswith("| 0.740 ± 0.003 | 3 |")
    made = causes.steps({("hertz_05", "1"): {"q_over_p_at_0.04": 1.25}, ("hertz_05", "2"): {"q_over_p_at_0.04": 9.0}},
                        {("hertz_05_tight", "1"): {"q_over_p_at_0.04": 1.5}})
    assert line(made, "q/p at 0.04") == "| q/p at 0.04 | 1.2500 | – | – | 1.5000 |"


def test_the_tables_of_wellmanns_page_are_what_the_script_makes():
    text = (ROOT / "docs/cases/wellmann-box.md").read_text()
    assert tables.put(text, causes.tables(), "") == text, "docs/reproduction/causes.py --write makes them again"
    assert tables.put(text.replace("| 3 |", "| 4 |"), causes.tables(), "") == text


def test_the_table_of_verdicts_is_what_the_script_makes():
    text, made = verdicts.PAGE.read_text(), verdicts.made(verdicts.records())
    assert tables.put(text, made, "") == text, "docs/reproduction/verdicts.py --write makes it again"
    assert tables.put(text.replace(" n, s |", " s |"), made, "") == text


def test_a_table_without_a_place_on_its_page_is_told(capsys):
    made = tables.table("| a | b |", [["1", "2"]])
    assert tables.put("t\n\n| a | b |\n|---|---|\n| 0 | 0 |\n| 3 | 4 |\n\nu\n", [made], "p.md") == (
        "t\n\n| a | b |\n|---|---|\n| 1 | 2 |\n\nu\n")
    for text in ("t\n", "| a | b | c |\n", "x| a | b |\n", "| a | b |\n\n| a | b |\n"):
        with pytest.raises(SystemExit) as ended:
            tables.put(text, [made], "p.md")
        assert ended.value.code == 2
        assert 'p.md: found no table with the line "| a | b |", or several' in capsys.readouterr().err


def layers_under_loads(tmp_path, name, settings, profiles="", **summary):
    figures = {"ensemble.realizations": 8, "layer.depth": 0.1, "layer.depth_diameters": 10, **summary}
    (tmp_path / f"{name}.json").write_text(json.dumps({"summary": figures, "cpu_seconds": 60}))
    (tmp_path / f"{name}.profiles.csv.xz").write_bytes(lzma.compress(profiles.encode()))
    return limit.Run(tmp_path, name, settings)


def test_a_misfit_by_depth_is_told_with_its_error_or_its_bound(tmp_path):
    def misfit(squared, error, noise, right_to):
        key = "limit.by_depth_rough.base.w_depths"
        return layers_under_loads(tmp_path, "a", [], **{
            f"{key}.squared": squared, f"{key}.squared.standard_error": error, f"{key}.noise": noise,
            f"{key}.right_to": right_to}).misfit("by_depth_rough", "base")

    clear = misfit(0.01, 0.001, 0.001, 0.117)
    assert (clear.cell(), clear.right()) == ("10.0 ± 0.5", "20 %")
    within_noise = misfit(0.0001, 0.001, 0.001, 0.0431)
    assert (within_noise.cell(), within_noise.right()) == ("< 4.3", "5 %")
    assert misfit(-0.0001, 0.05, 0.001, 0.3).right() == "none"
    assert misfit(None, None, None, None).cell() == "–"


def test_a_load_that_acts_deeper_is_found_on_the_axis(tmp_path):
    """Grains that have 1 / (z - 0.005) where the model has 1 / z: half a diameter."""
    head = "profile,depth_m,x_m,simulation_N/m,standard_error_N/m,by_depth_rough_N/m\n"
    lines = [f'"depth, w = 0.01 m",{z},{x},{1 / (z - 0.005 * (x == 0))},0.001,{1 / z}\n'
             for z in (0.025, 0.05, 0.075, 0.1) for x in (0, 0.01)]
    run = layers_under_loads(tmp_path, "b", ["material.friction=0.2"], head + "".join(lines))
    for at in (0.25, 0.5, 0.75):
        assert run.shift("by_depth_rough", "w_depths", at)[0] == pytest.approx(0.5)
    assert run.excess("by_depth_rough", "w_depths") == pytest.approx((0.25, 0.001 * 0.025))
    assert limit.math.isnan(run.excess("by_depth_rough", "w_diameters")[0])
    assert run.friction == 0.2


def test_layers_that_end_at_the_centres_of_loaded_grains_are_those_of_later_runs(tmp_path):
    misfits = {"homogeneous_rough": 0.3, "homogeneous_centres": 0.1, "by_depth_rough": 0.2, "by_depth_inside": 0.15,
               "by_depth_centres": 0.12}
    figures = {f"limit.{model}.{region}.{name}": value for model, misfit in misfits.items()
               for region in ("all.w_depths", "all.w_diameters", "base.w_depths")
               for name, value in (("squared", misfit**2), ("squared.standard_error", 0.002 * misfit), ("noise", 1e-5),
                                   ("right_to", 1.1 * misfit))}
    (tmp_path / "first").mkdir()
    (tmp_path / limit.LATER).mkdir()
    chi2 = "compare.homogeneous_centres.chi2_per_dof"
    layers_under_loads(tmp_path / limit.LATER, "deep-8", [], **{
        **figures, "response.load_depth": 0.02, chi2: 2.0, "compare.homogeneous_centres.chance": 3.0,
        "compare.by_depth_centres.chi2_per_dof": 4.0, "compare.by_depth_centres.chance": 3.0})
    run, silent = (layers_under_loads(tmp_path / "first", name, []) for name in ("deep-8", "deep-9"))
    assert limit.misfits([run, silent]).splitlines()[2:] == [
        "| 10.0 | 0.5 | 30.0 ± 0.1 | 10.0 ± 0.1 | 20.0 ± 0.1 | 12.0 ± 0.1 | 20 % | 20 % | one stiffness |",
        "| 10.0 | 0.5 | – | – | – | – | – | – | – |"]
    assert limit.parts([run]).splitlines()[2] == (
        "| 10.0 | 0.5 | 2.00 | 30.0 ± 0.1 | 20.0 ± 0.1 | 10.0 ± 0.1 | – | – | 15.0 ± 0.1 | 30.0 ± 0.1 | 10.0 ± 0.1 |")
    run.summary[chi2] = 4.0
    assert limit.misfits([run]).endswith("| none |\n")


def test_larger_ensembles_take_the_place_of_smaller_ones(tmp_path):
    runs = [layers_under_loads(tmp_path, name, settings) for name, settings in (
        ("deep-8-mu-0", []), ("deep-8-mu-0-more", []), ("deep-8-grains-3", ["response.grains=3"]),
        ("deep-8-wide", ["variant.deep_8.packing.width=1"]), ("deep-8-pentagons", ["packing.shape=irregular"]),
        ("spheres-6", ['sweep.values=["spheres_6"]']))]
    assert [run.name for run in limit.usual(runs)] == ["deep-8-mu-0-more", "deep-8-pentagons", "spheres-6"]
    assert [run.shape for run in runs][-3:] == ["disks", "pentagons", "spheres"]


def test_where_linearity_ends_and_what_settles_are_told_by_the_runs_that_know(tmp_path):
    known = layers_under_loads(tmp_path, "deep-8-mu-0.2", ["material.friction=0.2"], **{
        "layer.depth_diameters": 8.0, "linearity.first_changes": 0.5, "linearity.first_changes.standard_error": 0.1,
        "linearity.first_opens": 2.0, "linearity.first_opens.standard_error": 0.3,
        "linearity.hundredth_changes": 4.0, "linearity.hundredth_changes.standard_error": 0.4,
        "response.settlement": 2.7, "response.settlement.standard_error": 0.1,
        **{f"settlement.{model}.{place}{end}": value for model in ("homogeneous_rough", "by_depth_rough")
           for place, number in (("surface", 0.9), ("axis", 1.2)) for end, value in (("", number), (".standard_error", 0.05))}})
    silent = layers_under_loads(tmp_path, "deep-8-mu-1", ["material.friction=1"])
    assert limit.ends([known, silent]).splitlines()[2:] == [
        "| 8.0 | 0.2 | 0.50 ± 0.10 | 2.00 ± 0.30 | 4.0 ± 0.4 | 0.50 ± 0.05 |"]
    assert limit.settlements([known, silent]).splitlines()[2:] == [
        "| 8.0 | 0.2 | 0.90 ± 0.05 | 0.90 ± 0.05 | – | 1.20 ± 0.05 | 1.20 ± 0.05 | – | 2.70 ± 0.10 |"]
    assert len(limit.ends([silent]).splitlines()) == 2
    # A later run of the same layers adds what the first does not have.
    (tmp_path / limit.LATER).mkdir()
    (tmp_path / limit.LATER / "deep-8-mu-1.json").write_text(json.dumps(
        {"summary": {"linearity.hundredth_changes": 5.0, "layer.depth_diameters": 99}}))
    (tmp_path / "first").mkdir()
    more = layers_under_loads(tmp_path / "first", "deep-8-mu-1", ["material.friction=1"])
    assert (more.number("linearity.hundredth_changes"), more.depth) == (5.0, 10)


def test_layers_are_named_by_the_shape_of_their_grains(tmp_path):
    def named(*settings):
        return limit.of(layers_under_loads(tmp_path, "c", [*settings, "material.friction=1"]))[0]

    assert named() == named("packing.shape=disk") == "10.0"
    assert named("packing.shape=regular") == "10.0 (regular polygons)"
    assert named("packing.shape=irregular") == "10.0 (pentagons)"
    assert named('sweep.values=["spheres_10"]') == "10.0 (spheres)"


@pytest.mark.parametrize("page", limit.TABLES, ids=lambda page: page.stem)
def test_pages_of_layers_under_loads_have_the_tables_of_their_runs(page):
    """Runs that ended after a page was written may be missing."""
    runs = limit.finished(limit.HERE / "states")
    text = page.read_text()
    for one in limit.TABLES[page]:
        made = one(runs).splitlines()
        table = text[text.index(made[0]):].partition("\n\n")[0].splitlines()
        assert len(table) > 2 and set(table) <= set(made), "docs/reproduction/limit.py --write"

"""What docs/reproduction/pours.py says of piles: numbers of piles, causes, and lists of which a part has run."""
import json
import sys
from pathlib import Path

import numpy
import pytest
from scipy import stats

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs/reproduction"))

import pours  # noqa: E402
from summaries import POUR_MEMBERS, Measured, Results  # noqa: E402

GENERATOR = numpy.random.default_rng(58)


def ensemble(count, axis=0.55, dip=0.0):
    """FIGURES of piles that scatter as piles of 800 grains do."""
    return {"axis": GENERATOR.normal(axis, 0.08, count), "dip": GENERATOR.normal(dip, 0.17, count),
            "inside": GENERATOR.normal(0, 0.18, count), "fraction": GENERATOR.normal(0.83, 0.007, count),
            "slope": GENERATOR.normal(29, 1, count)}


def test_as_many_piles_as_are_told_see_the_effect():
    """In four of five ensembles, by t; the sum of both quantiles asks for a pile or two more."""
    count = pours.piles_to_see(0.1, 0.08)
    drawn = GENERATOR.normal(0.08, 0.1, (4000, count))
    t = drawn.mean(axis=1) / (drawn.std(axis=1, ddof=1) / count**0.5)
    seen = (2 * stats.t.sf(abs(t), count - 1) < pours.LEVEL).mean()
    assert pours.POWER - 0.02 < seen < pours.POWER + 0.06
    assert pours.piles_to_see(0.1, 1e-5) is None and pours.piles_to_see(1e-6, 0.08) == 3
    assert pours.piles_for_error(0.1, 0.016) == 40  # (0.1 / 0.016)^2 = 39.06


def test_a_cause_sees_what_it_says_it_could_see():
    """At the first step of Holm's correction, in four of five ensembles of eight beside a base of forty."""
    seen, said = 0, []
    for _ in range(400):
        by, p = pours.compared(GENERATOR.normal(0.13, 0.08, 8), GENERATOR.normal(0, 0.08, 40))
        seen += p < pours.LEVEL / 11
        said.append(pours.could_see(by, 11))
    assert abs(seen / 400 - pours.POWER) < 0.15
    assert numpy.median(said) == pytest.approx(0.14, abs=0.02)
    assert pours.foresight({"axis": GENERATOR.normal(0, 0.08, 40), "dip": GENERATOR.normal(0, 0.17, 40)}, 11)["axis"] == \
        pytest.approx(0.145, abs=0.04)


def test_a_change_is_beyond_chance_and_chance_is_not():
    base = ensemble(40)
    found = {name: ensemble(8) for name in pours.WORDS}
    found["tangential_11"] = ensemble(8, axis=0.85)
    judged = pours.judged_causes(base, found)
    beyond = [(name, figure) for name, of in judged.items() for figure, (_, p, _) in of.items() if p < pours.LEVEL]
    assert ("tangential_11", "axis") in beyond and len(beyond) <= 2
    line = next(one for one in pours.causes_table(base, found).splitlines() if one.startswith("| tangential"))
    assert line.count("**") == 2


def test_causes_are_corrected_for_all_of_a_column_and_see_what_all_planned_ones_leave():
    """Each by itself is beyond chance (p = 0.02), among eleven none is; three more that are planned make them blinder."""
    spread = numpy.linspace(-1, 1, 8)
    scale = spread.std(ddof=1)
    base = {figure: numpy.tile(spread, 5) for figure in pours.FIGURES}
    shift = scale * (1 / 8 + 1 / 40) ** 0.5 * 2.9
    found = {name: {figure: spread + shift for figure in pours.FIGURES} for name in pours.WORDS}
    alone = pours.compared(found["equal"]["dip"], base["dip"])[1]
    assert 0.01 < alone < 0.05
    by, p, seen = pours.judged_causes(base, found)["equal"]["dip"]
    assert p == pytest.approx(11 * alone) and by.value == pytest.approx(shift)
    nothing = {figure: numpy.array([]) for figure in pours.FIGURES}
    more = pours.judged_causes(base, found | {f"planned_{k}": nothing for k in range(3)})["equal"]["dip"]
    assert more[1] == pytest.approx(11 * alone) and more[2] > seen


def test_causes_that_have_not_run_are_named_and_no_test_counts_them():
    base, nothing = ensemble(40), {figure: numpy.array([]) for figure in pours.FIGURES}
    found = {"equal": ensemble(8), "fall": ensemble(2), "stiff": nothing}
    assert set(pours.judged_causes(base, found)) == {"equal"}
    lines = pours.causes_table(base, found).splitlines()
    assert "too few" in lines[4] and "not run" in lines[5] and len({line.count("|") for line in lines}) == 1


def test_every_cause_of_the_list_has_words_and_changes_one_thing():
    tag, runs = pours.read_list(pours.CAUSES)
    names = {}
    for name, seed, case, settings in runs:
        cause, _, number = name.rpartition("-")
        assert case == "pile-point-source" and seed == 9000 + int(number)
        changed = [one for one in settings if one not in ("source.grains=800", "source.height=0.25")]
        assert names.setdefault(cause, changed) == changed
        assert "source.grains=800" in settings
    assert list(names) == list(pours.WORDS)
    base_tag, base = pours.read_list(pours.CAUSES.with_name("memory.txt"))
    assert tag == base_tag and {seed for _, seed, *_ in runs} <= {seed for name, seed, *_ in base if "memory" in name}


def test_small_piles_count_by_their_errors():
    def known(mean, count, scatter):
        values = GENERATOR.normal(0, 1, count)
        return {"dip": mean + scatter * (values - values.mean()) / values.std(ddof=1)}
    together, p = pours.small_piles({"point source, 300 grains": known(0.1, 16, 0.4), "point source, 800 grains": known(0.0, 16, 0.2),
                                     "point source, 6,500 grains": known(9, 16, 0.1), "layers, 6,300 grains": known(9, 16, 0.1)})
    assert together.value == pytest.approx(0.02) and together.error == pytest.approx(0.05 * 2 / 5**0.5) and together.freedom == 30
    assert p == pytest.approx(2 * stats.t.sf(0.06 / numpy.hypot(together.error, pours.DIP_ERROR), 30))


def test_pours_without_states_are_in_the_table():
    lost = {"lost": Measured(0.047, 0.022, 7)}
    lines = pours.pours_table({"layers": ensemble(8, dip=-2.0)}, lost, {"layers": 0.01, "lost": 0.2}).splitlines()
    assert "| lost | 8 |  | 0.047 ± 0.022 |" in lines[3] and "**" in lines[2] and "**" not in lines[3]
    assert "| 0.01 |" in lines[2] and "not in results/" in pours.pours_table({}, lost, {})


def test_a_pour_has_one_p_on_both_pages(tmp_path):
    """Members of studies count beside whole studies: of p = 0.02 and 0.04 the smaller is doubled."""
    (tmp_path / "liffman-dropped.json").write_text(json.dumps(
        {"dip.difference": 0.0, "dip.p_value": 0.5, "dip.difference.implicit": 0.1, "dip.p_value.implicit": 0.01}))
    results = Results(tmp_path)
    assert results.dip("liffman-dropped", "implicit").p_holm == pytest.approx(0.04)
    assert pours.corrected(results) == {"equal disks, Liffman's dynamics, 968": pytest.approx(0.04)}


def test_every_pour_is_judged_with_the_others():
    members = {name for name in [name for *_, name in pours.POURS] + [tuple(name) for _, *name in pours.RECORDED] if name[1]}
    assert members <= set(POUR_MEMBERS)


def test_measured_pours_are_written_as_results(tmp_path):
    heaps = ensemble(8, dip=0.25)
    pours.write_measured({"point source, 300 grains": heaps, "layers, 6,300 grains": heaps}, tmp_path)
    one = Results(tmp_path).number("pours", "dip.difference", "point_300")
    assert one == pours.mean_of(heaps["dip"]) and Results(tmp_path).number("pours", "dip.difference", "point_800") is None


def test_the_heaps_of_stored_states_are_found():
    found = pours.measured(("pile-rest-300-awake",))
    assert len(found["dip"]) == 24 and 0.3 < found["axis"].mean() < 0.8
    assert len(pours.measured(("no-such-pile-*",))["dip"]) == 0


def test_the_list_of_disks_pours_what_lammps_pours():
    import pour_lammps
    _, runs = pours.read_list(pours.CAUSES.with_name("disks.txt"))
    case = {"shape.radius": "0.00275", "shape.polydispersity": "0.3", "source.interval": "0.1", "source.speed": "0.2",
            "material.density": "5000", "material.friction": "0.54"}  # of pile-point-source.toml
    text = (ROOT / "cases/pile-point-source.toml").read_text()
    for key, value in case.items():
        assert f"{key.partition('.')[2]} = {value}" in text
    wanted = {key: str(value) for key, value in pour_lammps.settings(2000).items()}
    assert len(runs) == 16
    for _, _, name, settings in runs:
        given = case | dict(one.split("=", 1) for one in settings)
        assert name == "pile-point-source" and set(given) == set(wanted)
        for key, value in wanted.items():
            assert given[key] == value or float(given[key]) == float(value), key

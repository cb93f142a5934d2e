"""Models of one's own in fit and compare: those of the registry again, and mistakes that are told."""

import numpy as np
import pytest

import grainfield as gf
from scene import ETA, MU, RHO_G, SLOPE, error_of, heap

HEAPS = [heap(seed) for seed in (1, 2, 3)]
FIELD = gf.average(HEAPS, frame="heap", cuts=[0.1, 0.3])


def copied(name):
    """The registry's stress in the scale of a model of one's own."""
    def function(points, facts, **constants):
        try:
            return gf.model(name, phi_deg=facts.slope, rho_g=1, **constants)(points)
        except ValueError:  # eta and mu are impossible together
            return None

    function.__doc__ = "oriented stress linearity again"
    return function


@pytest.fixture(scope="module")
def again():
    return gf.Model(copied("osl"), parameters={"eta": (0.1, 2.0), "mu": (-1.5, 1.5, 0.0)}, subject="heap", name="again")


def test_a_copy_of_osl_has_the_stress_of_osl(again):
    where = [[-0.05, -0.1], [0.0, -0.2], [0.1, -0.21], [0.3, -0.1]]
    osl = gf.model("osl", phi_deg=SLOPE, rho_g=RHO_G, eta=ETA, mu=MU)
    mine = again(phi_deg=SLOPE, rho_g=RHO_G, h=0.22, eta=ETA, mu=MU)
    np.testing.assert_allclose(mine(where), osl(where), rtol=1e-12)
    assert np.isnan(mine(where)[3]).all()  # outside of the heap
    assert gf.models()["again"]["summary"] == "oriented stress linearity again"
    assert gf.models()["again"]["parameters"]["mu"]["default"] == 0


def test_it_is_fitted_as_osl_is(again):
    options = dict(heights=[0.15, 0.3], set={"fit.bootstrap": 10})
    calls = again.calls
    fit = gf.fit(HEAPS, ["osl", again], **options)
    assert 20 < again.calls - calls < 20000
    for name in ("eta", "mu"):
        ours, osl = fit.constants["again"][name], fit.constants["osl"][name]
        assert ours[0] == pytest.approx(osl[0], abs=0.02 * osl[1]) and ours[1] == pytest.approx(osl[1], rel=0.05)
    assert fit.fits["again"].chi2_per_dof == pytest.approx(fit.fits["osl"].chi2_per_dof, rel=1e-3)
    assert {model.name for model in fit.judgement.models} == {"osl", "again"}
    one, = fit.fits["again"].parameters[:1]
    assert one.low < one.value < one.high and np.isfinite(one.jackknife_error) and np.isfinite(one.bootstrap_error)
    half = gf.fit(HEAPS, ["again:eta=free,mu=-0.31"], **options)  # the name as any other
    assert list(half.constants["again"]) == ["eta"]


def test_a_model_made_after_a_fit_brings_constants_of_its_own():
    gf.fit(HEAPS, ["osl"], heights=[0.3], set={"fit.bootstrap": 0})
    later = gf.Model(lambda points, facts, share: np.full((len(points), 3), -share), parameters={"share": (0.1, 2.0)},
                     subject="heap", name="later")
    fit = gf.fit(HEAPS, ["osl", later], heights=[0.3], set={"fit.bootstrap": 0})
    assert list(fit.constants["later"]) == ["share"]


def test_it_is_compared_as_osl_is(again):
    measures = gf.compare(FIELD, {"osl": gf.model("osl", eta=ETA, mu=MU), "mine": again(eta=ETA, mu=MU)}).measures
    assert measures["mine"]["rel_l2"] == pytest.approx(measures["osl"]["rel_l2"], rel=1e-6)
    with pytest.raises(RuntimeError, match=r"model again: eta has no value; again\(eta=...\) gives one"):
        gf.compare(FIELD, again)
    with pytest.raises(ValueError, match="nothing to compare"):  # impossible values have no stress
        gf.compare(FIELD, again(eta=2, mu=1.5))


def test_layers_are_in_units_of_load_and_depth():
    def plane(points, facts):
        x, y = points.T
        radial = -2 * -y / np.pi / (x**2 + y**2) ** 2
        return np.stack([radial * x**2, radial * y**2, radial * x * y], axis=1)

    mine = gf.Model(plane, subject="layer", name="plane_again")
    where = [[0.01, -0.05], [0.02, -0.1], [0.0, -0.3]]
    stress = mine(F=300, h=0.2)(where)
    np.testing.assert_allclose(stress[:2], gf.model("flamant", F=300)(where[:2]), rtol=1e-12)
    assert np.isnan(stress[2]).all()  # below the base
    space = gf.Model(lambda points, facts: np.tile([1.0, 2, 3, 4, 5, 6], (len(points), 1)), subject="layer", name="even", dim=3)
    np.testing.assert_allclose(space(F=8, h=2)([[0, 0, -1]]), [2 * np.arange(1.0, 7)])
    seen = []
    cone = gf.Model(lambda points, facts: seen.append(facts) or np.zeros((len(points), 6)), name="cone_again", dim=3)
    out = cone(h=2, rho_g=10, phi_deg=45)([[0.5, 0.5, -1], [0.8, 0.8, -1]])
    assert np.isnan(out).all(axis=1).tolist() == [False, True]
    assert seen[0] == gf.Facts(h=2, slope=45, left=45, right=45, rho_g=10, F=seen[0].F)


WRONG = {
    "shape": (lambda p, f: np.zeros((len(p), 2)), r"found stresses of shape \(\d+, 2\) for \d+ points from \(.*\) on, allowed: \(\d+, 3\)"),
    "nan": (lambda p, f: np.where(p[:, :1] > 0.1, np.nan, np.zeros((len(p), 3))), r"found the stress \[nan, nan, nan\] at \(0\.1\d*, -.*\), allowed: finite"),
    "raises": (lambda p, f: 1 / 0, r"ZeroDivisionError: division by zero at \(.*, -.*\)"),
    "masked": (lambda p, f: np.ma.masked_all((len(p), 3)), r"ValueError: stresses: found \d+ masked values of \d+"),
    "complex": (lambda p, f: np.zeros((len(p), 3), complex), "ValueError: found complex stresses, allowed: real ones"),
    "words": (lambda p, f: [["a", "b", "c"]] * len(p), r"ValueError: could not convert string to float"),
}


@pytest.mark.parametrize("name", WRONG)
def test_mistakes_of_the_function_are_told(name):
    function, text = WRONG[name]
    mine = gf.Model(function, name=name)
    with pytest.raises(RuntimeError, match=f"^model {name}: {text}"):
        gf.compare(FIELD, mine)
    if name == "nan":
        with pytest.raises(RuntimeError, match=f"^model {name}: {text}"):
            gf.fit(HEAPS, ["bcc", mine], heights=[0.3])


def test_mistakes_of_the_declaration_are_refused(again):
    zero = lambda points, facts, **rest: np.zeros((len(points), 3))  # noqa: E731
    assert error_of(lambda: gf.Model(zero, name="osl")) == (
        "model: found the name 'osl', which grainfield's own model has, allowed: another")
    assert error_of(lambda: gf.Model(zero, name="a:b")) == "model: found the name 'a:b', allowed: letters, digits and _"
    assert error_of(lambda: gf.Model(zero, {"k": 3})).startswith("parameters: found 3 for k, allowed: (least, most)")
    assert error_of(lambda: gf.Model(zero, {"k": (2, 1)})).startswith("parameters: found (2, 1) for k")
    assert error_of(lambda: gf.Model(zero, {"rho_g": (0, 1)})).startswith("parameters: found the name 'rho_g'")
    assert error_of(lambda: gf.Model(zero, subject="dune")) == "subject: found 'dune', allowed: heap or layer"
    assert "allowed: 0.1 to 2" in error_of(lambda: again(eta=3, mu=0))
    layer = gf.Model(zero, subject="layer", name="flat")
    assert "it is no model of a heap of weight rho_g" in error_of(lambda: gf.fit(HEAPS, [layer], heights=[0.3]))


def test_a_name_used_again_is_the_new_model():
    first, second = (gf.Model(lambda p, f, s=s: s * np.ones((len(p), 3)), name="twice") for s in (0.0, 5.0))
    assert gf.compare(FIELD, first).measures["twice"] == gf.compare(FIELD, second).measures["twice"]
    assert first.calls == 0 and second.calls >= 2


def test_ctrl_c_in_the_function_is_ctrl_c():
    def stop(points, facts):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        gf.compare(FIELD, gf.Model(stop, name="stop"))

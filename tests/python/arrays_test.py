"""Arrays of random kinds, strides and shapes: the same values are the same packing to the bit, the others are refused."""

import warnings

import numpy as np
import pytest

import grainfield as gf

FLOATS = ["f8", ">f8", "f4", ">f4", "f2", "i8", "i4", ">i2", "u1", "g"]
IDS = ["i8", "i4", ">i8", "u4", "i2", "u1", "f8", "f4"]


def stored(rng, values, kinds):
    """The values in another array: of a kind that holds them, with other strides, perhaps a list or read only."""
    values = np.asarray(values)
    for kind in rng.permutation(kinds):
        with np.errstate(all="ignore"):
            if (values.astype(kind) == values).all():
                values = values.astype(kind)
                break
    way = rng.integers(6)
    if way == 0:
        return values.tolist()
    if way == 1:  # every second or third row, from behind
        step = -int(rng.integers(2, 4))
        wide = np.zeros((len(values) * -step, *values.shape[1:]), values.dtype)
        wide[::step] = values
        return wide[::step]
    if way == 2:
        return np.asfortranarray(values)
    if way == 3:  # columns of a wider table
        flat = values.reshape(len(values), -1)
        wide = np.zeros((len(values), 2 * flat.shape[1] + 1), values.dtype)
        wide[:, 1::2] = flat
        picked = wide[:, 1::2]
        return picked[:, 0] if values.ndim == 1 else picked
    if way == 4:
        packed = np.zeros(len(values), [("pad", "u1"), ("it", values.dtype, values.shape[1:])])  # not aligned
        packed["it"] = values
        return packed["it"]
    out = values.copy()
    out.setflags(write=False)
    return out


def scene(rng, dim):
    """Whole numbers and halves, which every kind holds or refuses as a whole."""
    n = int(rng.integers(2, 12))
    x = 2.0 * np.arange(n) + rng.integers(0, 2, n) / 2  # neighbours are 1.5 to 2.5 apart
    y, z = rng.integers(0, 2, (2, n)) / 4
    pairs = np.arange(n - 1)
    ids = rng.permutation(np.arange(100, 100 + n))
    return dict(x=x, y=y, z=z if dim == 3 else None, radius=rng.integers(3, 6, n) / 2, ids=ids, mass=rng.integers(1, 9, n) / 2,
                velocities=rng.integers(-4, 5, (n, dim)) / 2, fixed=rng.integers(0, 2, n).astype(bool),
                contacts=dict(i=ids[pairs], j=ids[pairs + 1], forces=rng.integers(-8, 9, (n - 1, dim)) / 2,
                              friction=rng.integers(0, 3, n - 1) / 2))


def made(given):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # random forces are out of balance
        return gf.packing(given.pop("x"), given.pop("y"), given.pop("radius"), gravity=[0] * given["velocities"].shape[1]
                          if isinstance(given["velocities"], np.ndarray) else [0] * len(given["velocities"][0]), **given)


@pytest.mark.parametrize("seed", range(60))
def test_the_same_values_are_the_same_packing(seed):
    rng = np.random.default_rng(seed)
    dim = int(rng.integers(2, 4))
    plain = scene(rng, dim)
    other = {name: value if value is None or name in ("contacts", "fixed") else stored(rng, value, IDS if name == "ids" else FLOATS)
             for name, value in plain.items()}
    other["fixed"] = stored(rng, plain["fixed"], ["?", "u1", "i4", "f8"])
    other["contacts"] = {name: stored(rng, value, IDS if name in "ij" else FLOATS) for name, value in plain["contacts"].items()}
    one, two = made(dict(plain)), made(other)
    for table, same in ((one, two), (one.contacts, two.contacts)):
        for name in table.units:
            np.testing.assert_array_equal(getattr(table, name), getattr(same, name), err_msg=name)
    order = np.argsort(plain["ids"])
    assert two.ids.tolist() == plain["ids"][order].tolist()
    np.testing.assert_array_equal(two.positions[:, 0], plain["x"][order])
    np.testing.assert_array_equal(two.fixed, plain["fixed"][order])


@pytest.mark.parametrize("seed", range(60))
def test_wrong_shapes_are_refused_by_name(seed):
    rng = np.random.default_rng(seed)
    dim = int(rng.integers(2, 4))
    given = scene(rng, dim)
    table = given["contacts"] if rng.integers(2) else given
    names = [name for name in table if name != "contacts" and table[name] is not None and not (name == "x")]
    name = str(rng.choice(names))
    value = np.asarray(table[name])
    wrong = [np.concatenate([value, value[:1]]), value[:-1], value[..., None], value[None], np.stack([value, value])]
    if value.ndim == 2:
        wrong += [value[:, :1], np.hstack([value, value]), value[:, 0]]
    table[name] = wrong[rng.integers(len(wrong))]
    with pytest.raises(ValueError) as error:
        made(given)
    assert name in str(error.value).replace(":", " ").replace(".", " ").replace(",", " ").split()


@pytest.mark.parametrize("seed", range(30))
def test_fields_take_any_array(seed):
    rng = np.random.default_rng(seed)
    n, dim, draws = int(rng.integers(1, 9)), int(rng.integers(2, 4)), int(rng.integers(2, 5))
    points, values, errors = rng.integers(-4, 5, (n, dim)) / 2, rng.integers(-4, 5, n) / 2, rng.integers(0, 5, n) / 2
    samples = rng.integers(-4, 5, (n, draws)) / 2
    field = gf.Field(stored(rng, points, FLOATS), {"a": stored(rng, values, FLOATS)}, errors={"a": stored(rng, errors, FLOATS)},
                     samples={"a": stored(rng, samples, FLOATS)}, realizations=draws)
    np.testing.assert_array_equal(field.points, points)
    np.testing.assert_array_equal(field.a, values)
    np.testing.assert_array_equal(field.error("a"), errors)
    np.testing.assert_array_equal(field.samples("a"), samples)
    wrong = [dict(columns={"a": np.append(values, 0)}), dict(columns={"a": values[:, None]}),
             dict(columns={"a": values}, errors={"a": np.append(errors, 0)})]
    if n > 1:
        wrong.append(dict(columns={"a": values}, samples={"a": samples[:-1]}, realizations=draws))
    for given in wrong:
        with pytest.raises(ValueError, match="a: "):
            gf.Field(points, **given)
    with pytest.raises(ValueError, match="points"):
        gf.Field(points[0], {"a": values})


def test_doubts_of_the_import_are_warnings():
    """Diameters given as radii lie deep in each other; normals of another length are told."""
    grains = dict(x=[0.0, 0.0199], y=[0.0, 0.0], mass=[1, 1])
    pair = {"i": [0], "j": [1], "forces": [[-1.0, 0.0]]}
    with pytest.warns(UserWarning, match="overlap by more than half the smaller radius"):
        gf.packing(radius=0.02, contacts=pair, **grains)
    with pytest.warns(UserWarning, match="are not of unit length"):
        gf.packing(radius=0.01, contacts=pair | {"normals": [[2.0, 0.0]]}, **grains)

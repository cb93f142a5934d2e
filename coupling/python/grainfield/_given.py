"""Arguments as the core takes them. What is of the wrong kind is a TypeError, what has a wrong value a ValueError:
both name the argument, what was found and what is allowed."""

from __future__ import annotations

import numbers as _numbers
import os
import re
from collections.abc import Mapping
from typing import Any, Callable

import numpy as np

from ._arrays import array, floats, found, number, whole  # noqa: F401  of one name for those who ask
from ._data import Packing

_PACKING = ('a packing, "FILE.h5" or "FILE.h5:GROUP"{many}; gf.packing makes one of arrays, gf.import_packing of '
            "files of other programs")
_WORDS = {"str": (str, "a text"), "int": (_numbers.Integral, "a whole number"), "float": (_numbers.Real, "a number"),
          "bool": (bool, "True or False")}


def packing(name: str, value: Any, many: str = "") -> Any:
    """A packing, or the name of one in a file, for the core."""
    if isinstance(value, Packing):
        return value._core
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    raise TypeError(f"{name}: found {found(value)}, allowed: " + _PACKING.format(many=many))


def packings(name: str, value: Any) -> list:
    """Several of these, of a collection its packings."""
    if isinstance(value, Mapping):
        value = list(value.values())
    several = value if isinstance(value, (list, tuple)) else [] if value is None else [value]
    return [packing(name, one, ", or a list of these") for one in several]


def state(name: str, value: Any) -> Any:
    """A packing in memory, for the core."""
    if not isinstance(value, Packing):
        raise TypeError(f"{name}: found {found(value)}, allowed: a packing; gf.packing makes one of arrays, gf.read one of a file")
    return value._core


def a_list(value: Any) -> list:
    """A list of one, or of several."""
    if value is None:
        return []
    return list(value) if isinstance(value, (list, tuple, np.ndarray)) else [value]


def grid(value: Any) -> str:
    """"41x21" of (41, 21)."""
    if value is None or isinstance(value, str):
        return value or ""
    allowed = "allowed: how many columns and rows, such as (41, 21), in space (21, 21, 11)"
    if not isinstance(value, (list, tuple, np.ndarray)):
        raise TypeError(f"grid: found {found(value)}, {allowed}")
    if len(value) not in (2, 3) or not all(isinstance(n, _numbers.Integral) and int(n) > 1 for n in value):
        raise ValueError(f"grid: found {found(value)}, {allowed}; whole numbers, 2 or more")
    return "x".join(str(n) for n in value)


def points(value: Any) -> Any:
    if value is None:
        return None
    values = array("points", value)
    return values.reshape(1, -1) if values.ndim == 1 else values


def call(function: Callable[..., Any], **given: Any) -> Any:
    """The core's function; an argument of another kind than it declares is told alone."""
    try:
        return function(**given)
    except TypeError as error:
        if "incompatible function arguments" not in str(error):
            raise
        for name, optional, kind in re.findall(r"(\w+): (Optional\[)?(str|int|float|bool)\b", function.__doc__ or ""):
            of, words = _WORDS[kind]
            value = given.get(name)
            if (value is None and optional) or (isinstance(value, of) and isinstance(value, bool) == (kind == "bool")):
                continue
            raise TypeError(f"{name}: found {found(value)}, allowed: {words}{' or None' if optional else ''}") from None
        raise

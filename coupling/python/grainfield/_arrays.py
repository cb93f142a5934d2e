"""Numbers and arrays of a caller. What is no number is told with its argument and its place."""

from __future__ import annotations

import numbers as _numbers
from typing import Any

import numpy as np


def found(value: Any) -> str:
    """How a message names a value: short ones as they are, the others by their kind."""
    if isinstance(value, np.ndarray):
        return f"an array of shape {value.shape}"
    if value is None or isinstance(value, (str, bytes, bool, int, float, complex, np.generic)):
        return repr(value)
    text = repr(value)
    return text if isinstance(value, (list, tuple)) and len(text) < 60 else f"a {type(value).__name__}"


def number(name: str, value: Any, unit: str = "") -> float:
    if not isinstance(value, _numbers.Real) or isinstance(value, bool):
        raise TypeError(f"{name}: found {found(value)}, allowed: a number{unit and ', ' + unit}")
    return float(value)


def whole(where: str, value: Any) -> Any:
    """The value, unless masked: a masked array holds values that are none."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.getmaskarray(value).any():
        raise ValueError(f"{where}: found {int(np.ma.getmaskarray(value).sum())} masked values of {value.size}, "
                         "allowed: none; x[~x.mask] of every column leaves their rows out")
    return value


def array(where: str, value: Any) -> np.ndarray:
    """The value as an array of real numbers. Texts that are numbers are these."""
    try:
        values = np.asarray(whole(where, value))
    except ValueError as error:
        if "masked" in str(error):
            raise
        raise ValueError(f"{where}: found rows of different lengths, allowed: as many values in each") from None
    if values.dtype.kind == "c":
        raise TypeError(f"{where}: found complex numbers, allowed: real ones; .real are their real parts")
    try:
        return values.astype(float)
    except (TypeError, ValueError):
        pass
    for row, one in enumerate(values.ravel()):
        try:
            float(one)
        except (TypeError, ValueError):
            kind = TypeError if values.dtype.kind == "O" and not isinstance(one, str) else ValueError
            raise kind(f"{where}: found {found(one)} at [{row}], allowed: numbers") from None
    raise ValueError(f"{where}: found {values.dtype}, allowed: numbers")


def floats(name: str, value: Any) -> list[float]:
    """A number or several."""
    return [] if value is None else np.ravel(array(name, value)).tolist()

"""How far a long call is: a line on a terminal, a bar in a notebook."""

from __future__ import annotations

import importlib.util
import sys
from typing import Any


def _notebook_bar() -> Any:
    """tqdm's bar where a notebook runs and tqdm is installed, else None."""
    if "ipykernel" not in sys.modules:
        return None
    try:
        if importlib.util.find_spec("ipywidgets"):
            from tqdm.notebook import tqdm
        else:
            from tqdm import tqdm
    except ImportError:
        return None
    return tqdm(total=1.0, bar_format="{l_bar}{bar}| {elapsed}", leave=False)


class Progress:
    """A line on standard error that is rewritten on a terminal, a bar in a notebook, and nothing elsewhere."""

    def __init__(self) -> None:
        self._open = False
        self._bar = _notebook_bar()

    def show(self, text: str, fraction: float) -> None:
        if self._bar is not None:
            self._bar.n = fraction
            self._bar.set_description(" ".join(text.split()))
        elif sys.stderr is not None and sys.stderr.isatty():
            sys.stderr.write("\r\x1b[K" + text)
            sys.stderr.flush()
            self._open = True

    def end(self) -> None:
        if self._bar is not None:
            self._bar.close()
        if self._open:
            sys.stderr.write("\n")
        self._open = False

"""grainfield from Python: grains in, fields out, and a verdict on the continuum models.

Every function does what the command of the same name does, through the same code: numbers agree to
the bit. A mistake in what is given is a ValueError (exit code 2 of the program), a computation that
fails a RuntimeError (3), an output that cannot be written an OSError (74), each with the program's
line. SI units; in 2D density is kg/m2, stiffness and stress N/m. Stress is tension positive.

    import grainfield as gf
    state = gf.read("pile/snapshots.h5:realization_000/pile")
    field = gf.average(state, frame="heap")
    print(gf.compare(field, ["osl:eta=0.74,mu=-0.31"]).verdict)

docs/python.md tells more.
"""

from ._cases import cases, check, keys, samples
from ._commands import (
    SetModel,
    average,
    compare,
    fit,
    import_field,
    model,
    models,
    run,
    strain,
    structure,
)
from ._core import version as __version__
from ._data import Contacts, Field, Packing, Summary, Table, Walls
from ._engine import ContactsNow, Engine, GrainsNow
from ._foreign import export, import_packing
from ._files import Collection, read, write
from ._model import Facts, Model
from ._packing import packing
from ._results import CompareResult, FitResult, Judgement, Result, Structure
from ._sweep import Sweep, sweep

__all__ = [
    "Collection",
    "CompareResult",
    "Contacts",
    "ContactsNow",
    "Engine",
    "Facts",
    "Field",
    "FitResult",
    "GrainsNow",
    "Judgement",
    "Model",
    "Packing",
    "Result",
    "SetModel",
    "Structure",
    "Summary",
    "Sweep",
    "Table",
    "Walls",
    "average",
    "cases",
    "check",
    "compare",
    "export",
    "fit",
    "import_field",
    "import_packing",
    "keys",
    "model",
    "models",
    "packing",
    "read",
    "run",
    "samples",
    "strain",
    "structure",
    "sweep",
    "write",
]

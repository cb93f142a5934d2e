"""grainfield from Python: grains in, fields out, and a verdict on the continuum models.

A heap of one's own, from arrays to pictures (help(gf.packing) has shapes and units):

    import grainfield as gf
    heap = gf.packing(x, y, radius, density=2500, walls="floor:y=0", friction=0.3,
                      contacts={"i": i, "j": j, "forces": forces, "points": points})
    heap.plot()                                                # grains and forces
    field = gf.average(heap, frame="heap", grid=(41, 13))      # or a list of heaps
    field.plot()                                               # the vertical pressure
    fit = gf.fit(heap, ["osl", "bcc"])
    fit.plot(), print(fit.verdict)

Without forces of contacts, help(gf.Engine) settles the grains. gf.import_packing reads files of LAMMPS,
LIGGGHTS, YADE, MercuryDPM, VTK and CSV. gf.read(gf.samples()["heaps.h5"]) has heaps to try.

Every function does what the command of the same name does, through the same code: numbers agree to
the bit. A wrong value is a ValueError (exit code 2 of the program), an object of another kind a
TypeError, a computation that fails a RuntimeError (3), an output that cannot be written an OSError
(74), each with a line that says what is allowed. SI units; in 2D density is kg/m2, stiffness and
stress N/m. Stress is tension positive.

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

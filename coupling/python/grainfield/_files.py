"""Reading and writing files of grainfield."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Callable, Iterator

from . import _core
from ._data import Field, Packing, Summary, Table, read_table


class Collection(Mapping):
    """What a file of several holds, by name; each is read when it is asked for.

    len(), in, iteration over the names as of a dict; collection["realization_000/pile"].
    """

    def __init__(self, path: str, names: list[str], load: Callable[[str], Any]):
        self.path = path
        self._names = [name.lstrip("/") for name in names]
        self._load = load

    def __getitem__(self, name: str) -> Any:
        if name.lstrip("/") not in self._names:
            raise KeyError(f"{self.path}: holds no {name}; there are: {', '.join(self._names)}")
        return self._load(name.lstrip("/"))

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"<Collection {self.path}: {', '.join(self._names[:4])}{', ...' * (len(self) > 4)}>"


def read_packing(file: str, group: str) -> Packing:
    return Packing(_core.read_packing(file, group))


def read_field(file: str, name: str) -> Field:
    return Field(_core.read_field(file, name), name=name)


def packings_of(path: str) -> Collection:
    return Collection(path, _core.list_packings(path), lambda name: read_packing(path, name))


def fields_of(path: str) -> Collection:
    return Collection(path, _core.list_fields(path), lambda name: read_field(path, name))


def read(path: str | os.PathLike) -> Packing | Field | Summary | Table | Collection | Any:
    """What a file holds.

    "snapshots.h5:realization_000/state_020" is a Packing, "field.h5:average" a Field. Without a
    name a file of one of them is that one, a file of several a Collection. A .json file is a
    Summary, a .csv file a Table, the folder of a run a Result. Raises ValueError with the file, what
    was found and what is there.
    """
    text = os.fspath(path)
    if os.path.isdir(text):
        from ._results import Result

        return Result(text)
    if text.endswith(".json"):
        return Summary(_core.read_summary(text))
    if text.endswith(".csv"):
        if not os.path.exists(text):
            raise ValueError(f"{text}: no such file")
        return read_table(text)
    file, colon, name = text.rpartition(":")
    if not colon or os.path.exists(text):
        packings, fields = packings_of(text), fields_of(text)
        if not packings and not fields:
            raise ValueError(f"{text}: holds no snapshot and no field of grainfield")
        found = packings or fields
        return found[next(iter(found))] if len(found) == 1 else found
    fields = fields_of(file)
    if name.lstrip("/") in fields:
        return fields[name]
    return read_packing(file, name)


def write(
    path: str | os.PathLike,
    value: Packing | Field | Mapping[str, Any],
    *,
    add: bool = False,
) -> None:
    """Writes a packing, a field, several of a kind by name, or a summary, complete or not at all.

    Packings go to "FILE.h5:GROUP" or "FILE.h5" (group "packing"), with `add` beside those that are
    there; fields to "FIELD.h5" (with FIELD.xdmf for ParaView) or, one alone, to "FIELD.csv";
    mappings of numbers and texts to "summary.json".
    """
    text = os.fspath(path)
    if text.endswith(".json"):
        _core.write_summary(text, dict(value))  # type: ignore[arg-type]  # the core refuses what is no figure
        return
    file, colon, group = text.rpartition(":")
    if not colon:
        file, group = text, "packing"
    if isinstance(value, Packing):
        value = {group: value}
    elif isinstance(value, Field):
        value = {value.name: value} | value.beside
    elif not isinstance(value, Mapping):
        raise TypeError(f"{text}: found a {type(value).__name__}, allowed: a packing, a field, or several by name")
    elif not value:
        raise ValueError(f"{text}: nothing to write")
    if all(isinstance(one, Packing) for one in value.values()):
        _core.write_packings(file, list(value), [one._core for one in value.values() if isinstance(one, Packing)], add)
    elif all(isinstance(one, Field) for one in value.values()):
        _core.write_fields(text, [(name, one._core) for name, one in value.items()])
    else:
        raise ValueError(f"{text}: found values of several kinds, allowed: packings, or fields")

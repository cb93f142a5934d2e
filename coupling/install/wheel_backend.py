"""Makes the wheel of `pip install .`: the Python module, the program, the cases and the manual.

    python3 -m venv --system-site-packages ENV
    ENV/bin/pip install --no-build-isolation .

A backend of PEP 517 on the standard library alone. It builds what is not built yet: in build/release, or in a
folder of its own where that has the module of another Python. What CMake installs goes into the wheel without
headers, static libraries and documentation.
"""
from __future__ import annotations

import base64
import hashlib
import os
import pathlib
import re
import stat
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGETS = ("grainfield", "grainfield_python", "grainfield_fe", "grainfield_manual")
MODULE = "python/grainfield/_core" + sysconfig.get_config_var("EXT_SUFFIX")
#: Below the prefix of an installation; the finite elements are the only shared library.
DATA = ("lib/grainfield/*.so*", "share/grainfield/**/*", "share/man/**/*", "share/bash-completion/**/*")


def _version() -> str:
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(grainfield\s+VERSION\s+([0-9.]+)", text)[1]


def _run(*words: str | os.PathLike) -> None:
    subprocess.run([os.fspath(word) for word in words], cwd=ROOT, check=True)


def _built() -> pathlib.Path:
    """The folder of the build, up to date."""
    folder = ROOT / "build/release"
    others = list(folder.glob("python/grainfield/_core*"))
    if others and not (folder / MODULE).exists():
        folder = ROOT / f"build/{sys.implementation.cache_tag}"
    if not (folder / "build.ninja").exists():
        _run("cmake", "--preset", "release", "-B", folder, f"-DPython_EXECUTABLE={sys.executable}",
             "-DGRAINFIELD_TESTS=OFF", "-DGRAINFIELD_BENCHMARKS=OFF")
    _run("cmake", "--build", folder, "--target", *TARGETS)
    if not (folder / MODULE).exists():
        raise RuntimeError(f"{folder} has no {MODULE}; the module needs pybind11-dev and python3-numpy")
    return folder


def _files(stage: pathlib.Path, data: str) -> dict[str, pathlib.Path]:
    """What goes into the wheel, by its name there."""
    package = next(stage.glob("lib/python*/*-packages/grainfield"))
    out = {f"grainfield/{file.name}": file for file in package.iterdir() if file.is_file()}
    out[f"{data}/scripts/grainfield"] = stage / "bin/grainfield"
    for pattern in DATA:
        for file in stage.glob(pattern):
            if file.is_file():
                out[f"{data}/data/{file.relative_to(stage)}"] = file
    return dict(sorted(out.items()))


class _Wheel:
    """A zip file with the list of its files and their hashes."""

    def __init__(self, path: pathlib.Path):
        self._zip = zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=6)
        self._record = ""

    def add(self, name: str, content: bytes, mode: int = 0o644) -> None:
        entry = zipfile.ZipInfo(name)
        entry.external_attr = (stat.S_IFREG | mode) << 16
        self._zip.writestr(entry, content, zipfile.ZIP_DEFLATED)
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        self._record += f"{name},sha256={digest},{len(content)}\n"

    def close(self, record: str) -> None:
        self._zip.writestr(zipfile.ZipInfo(record), self._record + f"{record},,\n")
        self._zip.close()


def _metadata() -> str:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    return (
        f"Metadata-Version: 2.1\nName: grainfield\nVersion: {_version()}\n"
        "Summary: discrete grains and continuum theories on the same points\n"
        "License: LGPL-2.1-or-later\nRequires-Python: >=3.9\nRequires-Dist: numpy (>=1.21)\n"
        f"Description-Content-Type: text/markdown\n\n{readme}")


def _tag() -> str:
    python = "cp{}{}".format(*sys.version_info)
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def _about() -> dict[str, bytes]:
    """The files of the wheel that tell what it is."""
    wheel = f"Wheel-Version: 1.0\nGenerator: grainfield\nRoot-Is-Purelib: false\nTag: {_tag()}\n"
    return {"METADATA": _metadata().encode(), "WHEEL": wheel.encode(), "LICENSE": (ROOT / "LICENSE").read_bytes()}


def prepare_metadata_for_build_wheel(metadata_directory: str, config_settings: dict | None = None) -> str:
    """Writes the metadata alone, without building (PEP 517)."""
    name = f"grainfield-{_version()}.dist-info"
    folder = pathlib.Path(metadata_directory) / name
    folder.mkdir()
    for file, content in _about().items():
        (folder / file).write_bytes(content)
    return name


def get_requires_for_build_wheel(config_settings: dict | None = None) -> list[str]:
    return []


def build_wheel(wheel_directory: str, config_settings: dict | None = None,
                metadata_directory: str | None = None) -> str:
    """Writes the wheel into the directory and returns its name (PEP 517)."""
    folder = _built()
    stem = f"grainfield-{_version()}"
    name = f"{stem}-{_tag()}.whl"
    info = f"{stem}.dist-info"
    wheel = _Wheel(pathlib.Path(wheel_directory) / name)
    with tempfile.TemporaryDirectory(prefix="grainfield-wheel-") as stage:
        _run("cmake", "--install", folder, "--prefix", stage, "--strip")
        for inside, file in _files(pathlib.Path(stage), f"{stem}.data").items():
            wheel.add(inside, file.read_bytes(), stat.S_IMODE(file.stat().st_mode))
    for file, content in _about().items():
        wheel.add(f"{info}/{file}", content)
    wheel.close(f"{info}/RECORD")
    return name

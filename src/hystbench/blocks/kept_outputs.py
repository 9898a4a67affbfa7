"""Outputs of simulators on disk, so that a second run need not call them again.

An output is looked up by the function's name, the sources that it is made of, the
input and the sampling interval. It is an archive of NumPy with one array of numbers;
nothing else is ever read. The folder is a cache: who deletes it loses time alone.
"""

import os
import sys
import sysconfig
import zipfile
from collections.abc import Callable, Iterator
from functools import cache
from hashlib import blake2b
from importlib import metadata
from io import BytesIO
from pathlib import Path
from types import BuiltinFunctionType, FunctionType, ModuleType

import numpy as np

from hystbench.files import update_with
from hystbench.kept_files import KeptFiles
from hystbench.record import FloatArray

BOUND = 2**29
"""Bytes of all outputs together, at most."""
SUFFIX = ".npz"


class KeptOutputs:
    """Outputs as files, in a folder for each function as its source is.

    Parameters
    ----------
    folder : Path
    say, bound
        As for :class:`hystbench.kept_files.KeptFiles`.
    """

    def __init__(
        self, folder: Path, say: Callable[[str], None], bound: int = BOUND
    ) -> None:
        self.folder = folder
        self._files = KeptFiles(folder, f"*/*{SUFFIX}", bound, say, "outputs")
        self._places: dict[str, Path] = {}

    def open(self, name: str, source: str) -> None:
        """Find the place of a function by the digest of what it is made of, first."""
        self._places[name] = self.folder / source

    def get(self, name: str, z: FloatArray, dt: float) -> FloatArray | None:
        """Give the output for an input; None where there is none to be read."""
        file = self._file(name, z, dt)
        content = self._files.read(file)
        if content is None:
            return None
        try:
            with zipfile.ZipFile(BytesIO(content)) as archive:
                stream = BytesIO(archive.read("y.npy"))
            y = np.lib.format.read_array(stream, allow_pickle=False)
        except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
            self._files.say_once(f"{file}: not read ({error}); called instead")
            return None
        if y.dtype != np.float64 or y.shape != z.shape or not np.isfinite(y).all():
            not_one = f"not an output of {len(z)} numbers"
            self._files.say_once(f"{file}: {not_one}; called instead")
            return None
        return np.ascontiguousarray(y)

    def put(self, name: str, z: FloatArray, dt: float, y: FloatArray) -> None:
        """Keep an output, if there is room and the folder can be written."""
        content = BytesIO()
        np.savez(content, y=y)
        self._files.write(self._file(name, z, dt), content.getvalue())

    def drop(self, name: str) -> None:
        """Remove what earlier runs kept of a function as its source is."""
        for file in self._places[name].glob(f"*{SUFFIX}"):
            self._files.remove(file)

    def _file(self, name: str, z: FloatArray, dt: float) -> Path:
        about = f"{len(z)} {dt!r} {z.dtype.str}\n".encode()
        key = blake2b(about + z.tobytes(), digest_size=16).hexdigest()
        return self._places[name] / f"{key}{SUFFIX}"


def folder_of_user() -> Path:
    """Give the user's own place for outputs: below $XDG_CACHE_HOME, or ~/.cache."""
    named = os.environ.get("XDG_CACHE_HOME", "")
    # The standard has a relative path ignored.
    base = Path(named) if Path(named).is_absolute() else Path.home() / ".cache"
    return base / "hystbench" / "calls"


def source_digest(name: str) -> str:
    """Digest of a function's name and of all that it may be made of.

    That is: each imported module that is the user's own or of the function's own
    package, its file; each package that these name, its version; and Python's version.
    A file that the function reads is not seen.

    Parameters
    ----------
    name : str
        ``package.module:function``, imported and best called once before.
    """
    own = dict(sorted(_own_modules(name.partition(":")[0].partition(".")[0])))
    whole = blake2b(f"{name}\n{sys.version}\n".encode(), digest_size=16)
    update_with(whole, own)
    for package in sorted(set().union(*map(_named_packages, own), {"numpy"})):
        whole.update(f"{package} {_version(package)}\n".encode())
    return whole.hexdigest()


def _own_modules(first: str) -> Iterator[tuple[str, Path]]:
    """Give imported modules that are not installed, or are of a package; with files."""
    installed = [
        Path(sysconfig.get_path(kind)).resolve()
        for kind in ("stdlib", "platstdlib", "purelib", "platlib")
    ]

    @cache  # of thousands of modules: each folder is followed to its place once
    def is_installed(folder: Path) -> bool:
        return any(folder.resolve().is_relative_to(each) for each in installed)

    for label, module in list(sys.modules.items()):
        place = getattr(module, "__file__", None)
        package = label.partition(".")[0]
        if not isinstance(place, str) or package in ("hystbench", "__main__"):
            continue
        file = Path(place)
        if file.is_symlink():
            file = file.resolve()
        if (package == first or not is_installed(file.parent)) and file.is_file():
            yield label, file


def _version(package: str) -> str:
    """Give the version of a package, empty where it tells none."""
    # Not by getattr: a module may answer to that with a warning, or by importing more.
    own = vars(sys.modules[package]) if package in sys.modules else {}
    try:
        return str(own.get("__version__") or metadata.version(package))
    except metadata.PackageNotFoundError:
        return ""


def _named_packages(label: str) -> set[str]:
    """Give the packages whose modules, classes or functions a module names."""
    found = set()
    for value in vars(sys.modules[label]).values():
        name = None
        if isinstance(value, ModuleType):
            name = value.__name__
        elif isinstance(value, type | FunctionType | BuiltinFunctionType):
            name = value.__module__
        if isinstance(name, str):
            found.add(name.partition(".")[0])
    return found

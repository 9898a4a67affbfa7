"""What all simulators of somebody's own have in common, in whatever form they come."""

from abc import abstractmethod
from hashlib import blake2b
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from hystbench.blocks.base import Block
from hystbench.blocks.calls import current
from hystbench.errors import InputError
from hystbench.record import FloatArray

STARTED = "the folder of the start and not of the model file"
"""Where names and files are looked for, for messages."""


class CallError(ValueError):
    """What a simulator did wrong: the end of a sentence that begins with its call."""


class Simulator(Block, place="base"):
    """A whole simulator as a block: called with samples, it gives as many.

    Calls are counted, bounded and kept (:mod:`hystbench.blocks.calls`). It must give
    the same output every time. Files that it names are looked for from the folder that
    the program was started in. A model file with a simulator is a program: run only
    those that you trust.

    References
    ----------
    By definition.
    """

    seen = False
    no_step = (
        "a simulator of somebody's own cannot be turned into code; expected --part "
        "before or --part behind: it runs between the two"
    )

    @property
    @abstractmethod
    def label(self) -> str:
        """What messages call it, and by which its outputs are known."""

    @abstractmethod
    def run(self, z: FloatArray, dt: float) -> ArrayLike:
        """Run the simulator once; what it gives is not checked yet.

        Parameters
        ----------
        z : ndarray, shape (n,)
        dt : float
            Sampling interval in seconds.

        Raises
        ------
        CallError
            If it fails.
        InputError
            If it cannot be run.
        """

    def call(self, z: FloatArray, dt: float) -> FloatArray:
        """Run the simulator once, and check that it gives n finite numbers.

        Raises
        ------
        InputError
            If it cannot be run, fails, or gives anything else.
        """
        try:
            return _checked(z, self.run(z, dt))
        except CallError as error:
            raise InputError(
                f"{self.label}: called with {len(z)} samples and dt = {dt:g} s, it "
                f"{error}"
            ) from error

    @abstractmethod
    def source(self) -> str:
        """Digest of all that it is made of, so far as that is known."""

    def simulate(self, z: FloatArray, u: FloatArray, dt: float) -> FloatArray:
        """Run the simulator, or give what it gave for the same samples before.

        Raises
        ------
        InputError
            As :meth:`call` does; or the calls that a user allows are used up.
        """
        return current().output(self, z, dt)


def _checked(z: FloatArray, given: ArrayLike) -> FloatArray:
    """Check what a simulator gave: as many finite real numbers as samples."""
    if np.iscomplexobj(given):  # NumPy would drop the imaginary part
        raise CallError("gave complex numbers; expected real ones")
    try:
        y = np.array(given, dtype=np.float64)
    except (TypeError, ValueError):
        told = f"gave {type(given).__name__}; expected {len(z)} numbers"
        raise CallError(told) from None
    if y.shape != z.shape:
        raise CallError(f"gave an array of shape {y.shape}; expected ({len(z)},)")
    lost = np.flatnonzero(~np.isfinite(y))
    if len(lost):
        first = lost[0]
        raise CallError(f"gave {y[first]} at sample {first}; expected finite numbers")
    return y


def digest_of(text: str, *files: Path) -> str:
    """Digest of a text and of the content of files."""
    whole = blake2b(text.encode(), digest_size=16)
    for file in files:
        content = file.read_bytes()
        whole.update(f"\n{file.name} {len(content)}\n".encode() + content)
    return whole.hexdigest()


class FileSimulator(Simulator):
    """A simulator that is a file, run by a library."""

    expected: ClassVar[str]
    """What the file is, for messages."""

    file: str
    """Its path; a subclass declares it."""

    @property
    def path(self) -> Path:
        """The file.

        Raises
        ------
        InputError
            If there is none.
        """
        path = Path(self.file)
        if not path.is_file():
            raise InputError(
                f"{self.label}: no file {self.file!r}, looked for from {Path.cwd()}, "
                f"{STARTED}; expected {self.expected}"
            )
        return path

    def source(self) -> str:
        """Digest of the file and of what it is called by."""
        return digest_of(self.label, self.path)


def same_file(path: Path) -> tuple[str, int, int]:
    """Give what tells a file from a later one of its name."""
    about = path.stat()
    return str(path.resolve()), about.st_mtime_ns, about.st_size

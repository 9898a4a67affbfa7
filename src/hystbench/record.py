"""One record: an input and the output it caused, sampled uniformly."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from hashlib import blake2b
from pathlib import Path
from typing import Literal, cast

import numpy as np
from numpy.typing import NDArray

from hystbench.errors import InputError
from hystbench.files import atomic_path
from hystbench.units import plain
from hystbench.written import check_unchanged

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Mask = NDArray[np.bool_]
Origin = Literal["twin", "plant", "measured"]
Use = Literal["fit", "hold-out"]
Hold = Literal["zero-order", "linear", "band-limited"]
"""How an input moves between two samples."""

KEPT = ("name", "dt", "input", "output", "origin", "use", "period_samples")
"""What an archive holds of a record beside its arrays."""


@dataclass(frozen=True)
class Channel:
    """What a column holds: its name and its unit."""

    name: str
    unit: str

    def __post_init__(self) -> None:
        """Keep a unit in its one spelling."""
        object.__setattr__(self, "unit", plain(self.unit))

    @property
    def label(self) -> str:
        """Axis label, such as ``displacement (um)``."""
        return f"{self.name} ({self.unit})"


def column_name(name: str, unit: str) -> str:
    """Name a column by its channel and unit, such as ``coil_current_A``."""
    return f"{name}_{unit}".replace("/", "_per_").replace(" ", "_")


@dataclass(frozen=True, repr=False)
class Record:
    """Input and output of an actuator at a uniform rate.

    Parameters
    ----------
    name : str
        Name of the signal; for a measured record the stem of its file.
    dt : float
        Sampling interval in seconds.
    u, y : ndarray, shape (n,)
        Input and output, in the units of their channels.
    input, output : Channel
        Names and units of ``u`` and ``y``.
    origin : {"twin", "plant", "measured"}
        Whether the twin, a simulated plant of the contest or a device made ``y``.
    use : {"fit", "hold-out"}
        Whether models may be fitted to the record.
    period_samples : int, optional
        Samples of a period, where the input repeats itself.
    simulated : ndarray, shape (n,), optional
        What a simulator that ran elsewhere says of ``y``.
    interpolated : ndarray of bool, shape (n,), optional
        Samples at which ``u``, ``y`` or ``simulated`` was not measured but is a
        straight line between its neighbours. Models run over them; scores leave them
        out.
    decay_s : float, optional
        Of a record that begins in the middle of a motion: the time constant, in
        seconds, with which an unknown velocity at its first sample dies out. Scores
        leave out what such a velocity does.
    start_poles : tuple of complex
        Of a record that begins in the middle of a motion: poles, in 1/s, of dynamics
        that remember for long what was before it. One of a pair stands for both. Scores
        leave out what any state of them at the first sample does.
    lead : int
        Samples at the beginning that remember what was before the record. Models run
        over them; scores leave them out.
    past : int
        How many of these were put before the record: what came just before it.
    injected : ndarray, shape (n,), optional
        What an observer adds to the input, in its unit, so that a simulated motion
        follows the measured one.
    """

    name: str
    dt: float
    u: FloatArray
    y: FloatArray
    input: Channel
    output: Channel
    origin: Origin
    use: Use = "fit"
    period_samples: int | None = None
    simulated: FloatArray | None = None
    interpolated: Mask | None = None
    decay_s: float | None = None
    start_poles: tuple[complex, ...] = ()
    lead: int = 0
    past: int = 0
    injected: FloatArray | None = None

    def __post_init__(self) -> None:
        """Freeze the arrays: a record is evidence."""
        arrays = self.u, self.y, self.simulated, self.interpolated, self.injected
        for array in arrays:
            if array is not None:
                array.setflags(write=False)

    def __len__(self) -> int:
        """Count the samples."""
        return len(self.u)

    def __repr__(self) -> str:
        """Tell name, length, rate, channels, origin and use."""
        return (
            f"Record({self.name}, {len(self)} samples at {1 / self.dt:g} Hz, "
            f"{self.input.label} to {self.output.label}, {self.origin}, {self.use})"
        )

    @property
    def time(self) -> FloatArray:
        """Time of each sample in seconds, from zero; of what came before, below it."""
        return cast(FloatArray, (np.arange(len(self)) - self.past) * self.dt)

    @property
    def as_measured(self) -> Record:
        """The record without what was put before it."""
        if not self.past:
            return self
        alone = self.cut(slice(self.past, None))
        return replace(alone, period_samples=self.period_samples)

    @property
    def driven(self) -> FloatArray:
        """What drives a model of it: the input, with what an observer adds."""
        return self.u if self.injected is None else self.u + self.injected

    @property
    def counted(self) -> Mask:
        """Samples that a score may count, shape (n,): measured, and behind the lead."""
        behind = np.arange(len(self)) >= self.lead
        return behind if self.interpolated is None else behind & ~self.interpolated

    @property
    def repeats(self) -> bool:
        """Whether it holds whole periods of its input, and nothing else."""
        return bool(self.period_samples) and len(self) % (self.period_samples or 1) == 0

    @cached_property
    def of_start(self) -> FloatArray:
        """What is not known of the first sample does, shape (n, columns).

        A velocity: the way that a mass goes on while it dies out. A state of dynamics:
        how each of their poles fades.
        """
        columns = []
        if self.decay_s is not None:
            columns.append(-self.decay_s * np.expm1(-self.time / self.decay_s))
        for pole in self.start_poles:
            fading = np.exp(pole * self.dt * np.arange(len(self)))
            columns += [fading.real, fading.imag] if pole.imag else [fading.real]
        return np.column_stack(columns) if columns else np.zeros((len(self), 0))

    @property
    def rate(self) -> float:
        """How fast the input moves: rms(du/dt) / rms(u), in 1/s; 0 where it is zero."""
        if not self.u.any():
            return 0.0
        speed = np.gradient(self.u, self.dt)
        return float(np.sqrt(np.mean(speed**2) / np.mean(self.u**2)))

    @property
    def fastest(self) -> float:
        """Largest rate of the input between two samples, in its unit a second."""
        return float(np.abs(np.diff(self.u)).max() / self.dt)

    @cached_property
    def digest(self) -> str:
        """Digest of what the record holds: two that are alike have the same."""
        about = [self.name, self.dt, *asdict(self.input).values()]
        about += [*asdict(self.output).values(), self.use, self.period_samples]
        if self.decay_s is not None:
            about.append(self.decay_s)
        if self.start_poles:
            about.append([[pole.real, pole.imag] for pole in self.start_poles])
        if self.lead:
            about.append({"lead": self.lead, "past": self.past})
        whole = blake2b(json.dumps(about).encode(), digest_size=16)
        for array in (self.u, self.y, self.simulated):
            whole.update(b"none" if array is None else array.tobytes())
        for extra in (self.interpolated, self.injected):
            if extra is not None:
                whole.update(extra.tobytes())
        return whole.hexdigest()

    def cut(self, kept: slice) -> Record:
        """Give the record of some of its samples; its period is not known then.

        Parameters
        ----------
        kept : slice
            Samples in a row, or every n-th of them.
        """
        simulated, lost, injected = self.simulated, self.interpolated, self.injected
        u = self.u[kept].copy()
        first, _, step = kept.indices(len(self))
        return replace(
            self,
            dt=self.dt * step,
            u=u,
            y=self.y[kept].copy(),
            period_samples=None,
            simulated=None if simulated is None else simulated[kept].copy(),
            interpolated=None if lost is None else lost[kept].copy(),
            injected=None if injected is None else injected[kept].copy(),
            lead=min(len(range(first, self.lead, step)), len(u)),
            past=min(len(range(first, self.past, step)), len(u)),
        )

    def save(self, path: str | Path) -> None:
        """Write the record as a NumPy archive (no pickle), all of it or nothing."""
        about = json.dumps({key: getattr(self, key) for key in KEPT}, default=asdict)
        with atomic_path(path) as temporary, temporary.open("wb") as stream:
            arrays: dict[str, FloatArray | Mask] = {"u": self.u, "y": self.y}
            if self.simulated is not None:
                arrays["simulated"] = self.simulated
            if self.interpolated is not None:
                arrays["interpolated"] = self.interpolated
            np.savez(stream, **arrays, about=np.array(about))  # type: ignore[arg-type]


def load_record(path: str | Path) -> Record:
    """Read a record that :meth:`Record.save` wrote.

    Raises
    ------
    InputError
        If the file is not such an archive, or was changed since hystbench wrote it.
    """
    check_unchanged(path)
    try:
        with np.load(path, allow_pickle=False) as archive:
            about = json.loads(str(archive["about"]))
            u, y = archive["u"], archive["y"]
            simulated = archive.get("simulated")
            interpolated = archive.get("interpolated")
    except (OSError, KeyError, ValueError) as error:
        raise InputError(f"{path}: not a record of hystbench ({error})") from error
    about |= {key: Channel(**about[key]) for key in ("input", "output")}
    return Record(u=u, y=y, simulated=simulated, interpolated=interpolated, **about)

"""Dynamics that a force sets in motion: the steps in which they are integrated."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import ceil, pi

import numpy as np
from numpy.typing import NDArray

from hystbench import kernels
from hystbench.blocks.attached import OthersOnRecords, Signals
from hystbench.blocks.curve import held_lines
from hystbench.blocks.force import Driven, Dynamics, Force, Motion
from hystbench.blocks.parameter import choice
from hystbench.blocks.starts import STARTS, path_from
from hystbench.blocks.state_space import after_interval
from hystbench.record import FloatArray

PHASE = 0.05
"""Largest angle, in radians, by which the linear part turns in one step.

Steps miss a thousandth of the motion of a mode that hardens threefold.
"""
MOST = 40
"""Steps of an interval, at most: the linear part is exact however fast it is."""
CONTACT = 10
"""Steps of an interval that a stiff contact may ask for: it is stable without."""


@dataclass(frozen=True)
class DriveLines:
    """What drives near motions: straight lines, one record behind another."""

    values: FloatArray
    """Corners of the lines, shape (motions, count), or (1, count) if all have them."""
    before: FloatArray
    """What was for ever before each record, shape (motions, records)."""
    ends: NDArray[np.int64]
    """Where each record ends."""
    fine: int
    """Lines from one sample to the next."""
    samples: tuple[int, ...]
    """Of each record, without those of what was before it."""
    step: float
    """Seconds from one corner to the next."""
    parts: int
    """Equal parts in which a line is integrated."""
    ramp: float
    """One for straight lines, zero for a staircase."""

    def move(
        self,
        drives: FloatArray,
        tables: FloatArray,
        laws: FloatArray,
        starts: FloatArray,
        shown: FloatArray,
        of_first: FloatArray,
    ) -> list[Signals]:
        """Move modes that feel each other by the forces at one place alone.

        Parameters
        ----------
        drives : ndarray, shape (motions, count) or (1, count)
        tables : ndarray
            Of :func:`tables_of`.
        laws : ndarray, shape (motions, forces, 7)
        starts : ndarray, shape (motions, records, 2 modes)
            Positions and velocities at the beginning of each record.
        shown : ndarray, shape (motions, 2 modes + 2)
            Weights of positions, velocities, forces and drive in the output of each.
        of_first : ndarray, shape (rows, 2 modes + 2)
            Those of outputs that the first motion shows in place of its own.

        Returns
        -------
        list of sequence of ndarray, shape (n,)
            By record: the outputs of the first motion, then the one of each other.
        """
        near, numbers = len(tables) - 1, tables.shape[1] + shown.shape[1]
        beside = np.zeros((numbers, kernels.padded(near)))
        beside[: tables.shape[1], :near] = tables[1:].T
        beside[tables.shape[1] :, :near] = shown[1:].T
        lengths = np.diff(self.ends, prepend=0)
        told = np.cumsum((lengths - 1) // self.fine + 1).tolist()
        found = np.empty((len(of_first) + near, told[-1]))
        kernels.call(
            "hb_structure",
            int(self.ends[-1]),
            len(self.ends),
            self.ends.ctypes.data,
            shown.shape[1] // 2 - 1,
            near,
            self.parts,
            self.step,
            self.ramp,
            self.fine,
            np.append(tables[0], shown[0]),
            beside,
            laws.shape[1],
            laws,
            drives,
            drives.shape[1] if len(drives) > 1 else 0,
            starts,
            len(of_first),
            of_first,
            found,
        )
        its = [slice(end - n, end) for end, n in zip(told, self.samples, strict=True)]
        return [tuple(own[at] for at in its) for own in found]


class ForcedDynamics(Dynamics):
    """A block whose coordinates are driven by its input and meet forces.

    The linear part is exact over a step, in which the forces count with their mean over
    the way. A band-limited input is taken as straight lines on a grid twice as fine.
    """

    start: str = choice("state before the first sample", STARTS, "rest")

    @abstractmethod
    def rates(self, contact: float, shown: float) -> tuple[float, float]:
        """Give how fast it swings in rad/s: alone, and in a contact of a stiffness.

        Alone, of several modes, the fastest that samples show: those up to a rate.
        """

    @property
    def swings(self) -> bool:
        """Whether it swings by itself, or creeps back to where it rests."""
        return True

    @abstractmethod
    def weights(self) -> FloatArray:
        """Give the weights of q and q' of all modes, of forces and drive in the output.

        Shape (2 modes + 2,).
        """

    @abstractmethod
    def _of_motion(self, forces: tuple[Force, ...]) -> FloatArray:
        """Give such weights of the fields of a :class:`Motion`, shape (4, 2 modes + 2).

        With what a spring takes over from those forces.
        """

    @abstractmethod
    def _moved(
        self,
        every: Sequence[Driven],
        drives: Sequence[Signals],
        dt: float,
        of_first: FloatArray | None = None,
    ) -> list[Signals]:
        """Move near motions through records of one interval, none of them empty.

        Records have three samples or as many. Gives the output of each motion, or those
        of the first one by such weights.
        """

    def outputs(
        self,
        signals: Signals,
        dts: Sequence[float],
        forces: tuple[Force, ...],
        others: OthersOnRecords,
        pieces: float = 1.0,
    ) -> list[Signals]:
        """Compute the output, and those of others with numbers near.

        Each step of those is the tangent of this one's: right for small differences.
        Records of one sampling interval take one call of the kernel.
        """
        every = (Driven(self, forces, pieces), *(other for other, _ in others))
        given = (signals, *(own for _, own in others))
        alike: dict[tuple[float, int], list[int]] = {}
        for k, (z, dt) in enumerate(zip(signals, dts, strict=True)):
            alike.setdefault((dt, min(len(z), 3)), []).append(k)
        found: list[dict[int, FloatArray]] = [{} for _ in every]
        for (dt, length), places in alike.items():
            drives = [[own[k] for k in places] for own in given]
            moved = self._moved(every, drives, dt) if length else drives
            for own, moves in zip(found, moved, strict=True):
                own.update(zip(places, moves, strict=True))
        return [tuple(own[k] for k in range(len(signals))) for own in found]

    def motion(
        self, z: FloatArray, dt: float, forces: tuple[Force, ...], pieces: float = 1.0
    ) -> Motion:
        """Compute how the coordinate moves in one record."""
        if not len(z):
            return Motion(*[z] * 4)
        every = [Driven(self, forces, pieces)]
        moved = self._moved(every, [(z,)], dt, self._of_motion(forces))
        return Motion(*(own for (own,) in moved))

    def lines(self, first: Driven, drives: Sequence[Signals], dt: float) -> DriveLines:
        """Give what drives near motions, the first of which says in how many steps."""
        holding = self.holding
        quick = holding == "band-limited" and first.forces and first.pieces < 1
        if quick and self.parts(dt, first.forces, first.pieces) == 1:
            holding = "linear"  # finer lines would be shorter than a step

        def begun(own: Signals) -> tuple[list[FloatArray], list[float], int]:
            paths = [path_from(z, self.start) for z in own]
            held = [held_lines(path, holding) for path, _ in paths]
            corners = [lines for lines, _ in held]
            return corners, [rested for _, rested in paths], held[0][1]

        corners, rested, fine = begun(drives[0])
        values, before = [np.concatenate(corners)], [rested]
        for own in drives[1:]:
            if all(x is z for x, z in zip(own, drives[0], strict=True)):
                values.append(values[0])
                before.append(rested)
            else:
                others, its, _ = begun(own)
                values.append(np.concatenate(others))
                before.append(its)
        alike = all(own is values[0] for own in values)
        step = dt / fine
        return DriveLines(
            np.array(values[:1] if alike else values),
            np.array(before),
            np.cumsum([len(x) for x in corners], dtype=np.int64),
            fine,
            tuple(map(len, drives[0])),
            step,
            self.parts(step, first.forces, first.pieces),
            float(holding != "zero-order"),
        )

    def parts(self, dt: float, forces: tuple[Force, ...], pieces: float = 1.0) -> int:
        """Steps of an interval: one without forces, as the linear part is exact.

        With forces they are short for the linear part and for a contact. A linear part
        that swings faster than half the sampling rate, or does not swing and dies out
        within an interval, follows what drives it: no step is shorter for that.
        """
        if not forces:
            return 1
        stiffest = max(item.stiffest for item in forces)
        linear, stiff = self.rates(stiffest, pi / dt)
        alone = linear if linear * dt <= (pi if self.swings else 1.0) else 1.0 / dt
        others = max(item.swings for item in forces)
        swings = max(alone, min(others, pi / dt))
        stiff = stiff if stiffest > 0.0 else swings
        smooth, met = (ceil(pieces * dt * rate / PHASE) for rate in (swings, stiff))
        return max(1, min(smooth, MOST), min(met, CONTACT))


@lru_cache(maxsize=256)
def step_weights(
    coordinates: tuple[tuple[float, float, float], ...], dt: float
) -> FloatArray:
    """Give weights of q, q' and of the driving force at both ends of a step.

    Of masses on springs without forces inside. They are kept, as a fit simulates many
    records with the same linear part.

    Parameters
    ----------
    coordinates : tuple of (float, float, float)
        Mass, damping and stiffness of each.
    dt : float
        The step in seconds.

    Returns
    -------
    ndarray, shape (coordinates, 2, 2, 4)
        Of a step, and of an eighth of it; not to be written to.
    """
    every = {each: k for k, each in enumerate(dict.fromkeys(coordinates))}
    mass, damping, stiffness = np.array(list(every)).T
    a, b = np.zeros((len(every), 2, 2)), np.zeros((len(every), 2))
    a[:, 0, 1], a[:, 1, 0], a[:, 1, 1] = 1.0, -stiffness / mass, -damping / mass
    b[:, 1] = 1.0 / mass
    steps = np.array([dt, dt / 8])[:, None, None]
    weights = after_interval(a * steps[..., None], b * steps)
    weights[..., 2] -= weights[..., 3]
    found = weights[:, [every[each] for each in coordinates]].swapaxes(0, 1)
    found = np.ascontiguousarray(found)
    found.setflags(write=False)
    return found


def tables_of(
    modes: Sequence[tuple[tuple[float, float, float], ...]],
    drive: FloatArray,
    joint: FloatArray,
    dt: float,
) -> FloatArray:
    """Give the tables of near motions for a part of dt: see kernels/joint.c.

    Parameters
    ----------
    modes : sequence of tuple of (float, float, float)
        Mass, damping and stiffness of all modes of each.
    drive, joint : ndarray, shape (motions, modes)
        How much of what drives them, and of the forces, each mode feels.
    dt : float

    Returns
    -------
    ndarray, shape (motions, 6 + 25 modes)
    """
    found = [joint]
    every = tuple(mode for own in modes for mode in own)
    for part in np.moveaxis(step_weights(every, dt), 1, 0):
        # Of q and v after it: of q, v, and of p at both ends.
        steps = part.reshape(len(modes), -1, 2, 4)
        after = np.empty((len(modes), 2, 5, steps.shape[1]))
        after[:, :, :2] = steps[..., :2].transpose(0, 2, 3, 1)
        driven = steps[..., 2:] * drive[:, :, None, None]
        after[:, :, 2:4] = driven.transpose(0, 2, 3, 1)
        after[:, :, 4] = (steps[..., 2:].sum(axis=3) * joint[:, :, None]).swapaxes(1, 2)
        way = after[:, 0] * joint[:, None]
        way[:, 0] -= joint
        found += [way[:, 2:].sum(axis=2), way[:, :2].reshape(len(modes), -1)]
        found.append(after.reshape(len(modes), -1))
    return np.ascontiguousarray(np.concatenate(found, axis=1))

"""Which effects a search may name, and which its user put in."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

from hystbench.device_kinds import DeviceKind, impossible_in
from hystbench.errors import InputError, nearest


@dataclass(frozen=True)
class Vocabulary:
    """What a user accepts and rejects before a search.

    Parameters
    ----------
    without : tuple of str
        Effects that the search must not name.
    fixed : tuple of str
        Effects that are in the model from the start. They are fitted, and found by
        nobody: what they close of the gap is told apart from what is found.
    kind : str, optional
        Kind of the device; what it cannot have is not named, unless it is put in.

    Raises
    ------
    InputError
        If a name is no effect, stands there twice, or in both.
    """

    without: tuple[str, ...] = ()
    fixed: tuple[str, ...] = ()
    kind: DeviceKind | None = None

    def __post_init__(self) -> None:
        """Refuse names that mean nothing."""
        from hystbench.gap.effects import effects  # late: it imports them all

        for option, names in (("--without", self.without), ("--with", self.fixed)):
            for name in names:
                if name not in effects():
                    raise InputError(
                        f"{option}: no effect {name!r}; {nearest(name, effects())}"
                    )
                if names.count(name) > 1:
                    raise InputError(f"{option}: {name!r} twice; expected it once")
        for name in self.without:
            if name in self.fixed:
                raise InputError(
                    f"--with and --without: {name!r} in both; expected it in one"
                )

    @classmethod
    def of(cls, without: Iterable[str] = (), fixed: Iterable[str] = ()) -> Vocabulary:
        """Take names in any sequence."""
        return cls(tuple(without), tuple(fixed))

    def in_device(self, kind: DeviceKind | None) -> Vocabulary:
        """Leave out what a kind of device cannot have."""
        return replace(self, kind=kind)

    @property
    def impossible(self) -> tuple[str, ...]:
        """Effects that the kind of device leaves out, which nobody named."""
        named = {*self.without, *self.fixed}
        return tuple(name for name in impossible_in(self.kind) if name not in named)

    @property
    def offered(self) -> tuple[str, ...]:
        """Effects that the search may name, in their order."""
        from hystbench.gap.effects import effects  # late: as above

        closed = {*self.without, *self.fixed, *self.impossible}
        return tuple(name for name in effects() if name not in closed)

    def words(self) -> list[str]:
        """Say what the user asked for and the device leaves out, a sentence each."""
        said = []
        if self.fixed:
            said.append(f"you put in {_listed(self.fixed)}: it is not a finding")
        if self.without:
            said.append(f"you left out {_listed(self.without)}: it was not tried")
        if self.impossible:
            said.append(
                f"the device is {self.kind}, as dataset.yaml says, and cannot have "
                f"{_listed(self.impossible)}: it was not tried"
            )
        return said

    def mapping(self) -> dict[str, Any]:
        """Give what gap.json holds under ``asked``."""
        return {
            "without": list(self.without),
            "with": list(self.fixed),
            "impossible": list(self.impossible),
            "sentence": "; ".join(self.words()),
        }


EVERYTHING = Vocabulary()
"""All effects may be named, and none is put in."""


def _listed(names: tuple[str, ...]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last

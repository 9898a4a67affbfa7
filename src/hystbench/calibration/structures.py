"""Structures and readings that are tried: what sets each apart from the base."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hystbench.calibration.objective import Objective
from hystbench.calibration.twin import BASE_UNKNOWNS, INPUT_NOISE, Unknown, make_twin
from hystbench.errors import InputError, nearest
from hystbench.model import Model
from hystbench.signals import make_signal

Chain = list[dict[str, Any]]
Edit = Callable[[Chain, dict[str, float]], Chain]


def _as_it_is(chain: Chain, values: dict[str, float]) -> Chain:
    return chain


@dataclass(frozen=True)
class Structure:
    """What sets a twin or a reading apart from the base.

    Parameters
    ----------
    name, meaning : str
    edit : callable
        The chain made of the base's chain and the values.
    more : tuple of Unknown
        What is free beside, or within other bounds than in the base.
    fixed : dict of str to float
        Unknowns of the base that are not free, and what they are.
    starts : tuple of dict of str to float
        What the starts of a search have in place of the middle of the bounds: the
        first start the first of them, and so on, over and over.
    duration_s : float, optional
        Length of the records; by default that of the settings.
    backlash : str, optional
        Where the plays of the backlash filter are; by default as in the settings.
    window_start_s : float
        Errors before it are left out.
    identified : bool
        Whether the GPO filter has the envelopes that Algorithm 1 finds on the twin.
    """

    name: str
    meaning: str
    edit: Edit = _as_it_is
    more: tuple[Unknown, ...] = ()
    fixed: dict[str, float] = field(default_factory=dict)
    starts: tuple[dict[str, float], ...] = ({},)
    duration_s: float | None = None
    backlash: str | None = None
    window_start_s: float = 0.0
    identified: bool = False

    @property
    def unknowns(self) -> tuple[Unknown, ...]:
        """What is free: the base's unknowns first, then what is free beside."""
        own = {item.name: item for item in self.more}
        free = {item.name: item for item in (*BASE_UNKNOWNS, _FROM_BELOW)} | own
        return tuple(item for name, item in free.items() if name not in self.fixed)

    @property
    def whole_record(self) -> bool:
        """Whether the errors are those of the whole record, as in the tables."""
        return self.window_start_s == 0.0

    def make(self, values: dict[str, float]) -> Model:
        """Make the twin that values of the unknowns make."""
        full = {**values, **self.fixed}
        content = make_twin(full).to_mapping()
        if self.edit is not _as_it_is:
            content = {**content, "chain": self.edit(content["chain"], full)}
            content.pop("provenance", None)
        return Model.from_mapping(content, self.name)


def _input_zero(low: float, high: float) -> Unknown:
    """Zero error of one sign: each has a valley of its own."""
    return Unknown("input zero", "A", 0.0, low, high, False, "recorded minus true")


_FROM_BELOW = _input_zero(-0.03, 0.0)
_FROM_ABOVE = _input_zero(0.0, 0.03)
CREEP_TIMES_S = (0.03, 0.3, 3.0)
"""Evenly spread in their logarithm, from a period to more than a record."""


def _diffusion(chain: Chain, values: dict[str, float]) -> Chain:
    block = {"eddy-diffusion": {"time_constant_s": values["diffusion"]}}
    return [block if "transfer-function" in item else item for item in chain]


def _creep(chain: Chain, values: dict[str, float]) -> Chain:
    own = {
        "magnitudes": [values[f"creep {time} s"] for time in CREEP_TIMES_S],
        "time_constants_s": list(CREEP_TIMES_S),
    }
    return [*chain[:-2], {"creep": own}, *chain[-2:]]


def _bias(chain: Chain, values: dict[str, float]) -> Chain:
    return [{"gain": {"value": 1.0, "offset": values["bias"]}}, *chain]


def _cube(chain: Chain, values: dict[str, float]) -> Chain:
    own = {"quadratic": values["asymmetry"], "cubic": values["cube"]}
    return [
        {"sensor-nonlinearity": own} if "asymmetry" in item else item for item in chain
    ]


def _roll_off(chain: Chain, values: dict[str, float]) -> Chain:
    pole = 2 * np.pi * values["roll-off"]
    own = {
        "numerator": [1.0],
        "denominator": [1 / pole**2, 2 * values["roll-off damping"] / pole, 1.0],
    }
    return [*chain[:-2], {"transfer-function": own}, *chain[-2:]]


_ROLL_OFF = (
    Unknown("roll-off", "Hz", 1000, 200, 5000, True, "frequency of two more poles"),
    Unknown("roll-off damping", "-", 0.7, 0.3, 1.5, True, "their damping ratio"),
)

STRUCTURES = (
    Structure("base", "the chain of calibration.md, zero error from below, 2 s"),
    Structure("zero-positive", "zero error from above", more=(_FROM_ABOVE,)),
    Structure("zero-none", "filters read the true input", fixed={"input zero": 0.0}),
    Structure(
        "eddy-diffusion",
        "diffusion into a slab instead of the lag",
        _diffusion,
        (Unknown("diffusion", "s", 0.0024, 1e-4, 0.05, True, "diffusion time"),),
        {"zero": 1000.0, "pole": 1000.0},  # not in the chain
    ),
    Structure(
        "creep",
        "three creep terms more",
        _creep,
        tuple(
            Unknown(f"creep {time} s", "-", 0.0, 0.0, 0.2, False, "share of a term")
            for time in CREEP_TIMES_S
        ),
        # 5 % in all.
        starts=({f"creep {time} s": 0.05 / 3 for time in CREEP_TIMES_S},),
    ),
    Structure(
        "bias",
        "constant current before the hysteresis",
        _bias,
        (Unknown("bias", "A", 0.0, -0.1, 0.1, False, "DC state"),),
        starts=({"bias": 0.02}, {"bias": -0.02}),
    ),
    Structure("symmetric", "without the square", fixed={"asymmetry": 0.0}),
    Structure(
        "cube",
        "a cube beside the square",
        _cube,
        (Unknown("cube", "1/um^2", 0.0, -1e-3, 1e-3, False, "cube before the lag"),),
        # At 13 um a few percent of the displacement.
        starts=({"cube": 2e-4}, {"cube": -2e-4}),
    ),
    Structure("roll-off", "two more poles", _roll_off, _ROLL_OFF),
    Structure(
        "roll-off-zero-positive",
        "two more poles, zero error from above",
        _roll_off,
        (_FROM_ABOVE, *_ROLL_OFF),
    ),
    Structure(
        "input-noise",
        "noise on the input that filters read",
        more=(INPUT_NOISE,),
    ),
    Structure(
        "identified-envelopes",
        "GPO filter with envelopes identified on the twin's 1 Hz loop",
        identified=True,
    ),
    Structure("record-1s", "records of 1 s", duration_s=1.0),
    Structure("record-4s", "records of 4 s", duration_s=4.0),
    Structure("current-input", "plays on the newest input", backlash="current-input"),
    Structure("window", "without the first 0.1 s", window_start_s=0.1),
)


def find_structure(name: str) -> Structure:
    """Give a structure by its name.

    Raises
    ------
    InputError
        If there is none.
    """
    known = {item.name: item for item in STRUCTURES}
    if name not in known:
        raise InputError(f"no structure {name!r}; {nearest(name, known)}")
    return known[name]


def asked_structures(names: Iterable[str] | None) -> tuple[Structure, ...]:
    """Give the structures of some names; all where None is given.

    Raises
    ------
    InputError
        If a name is unknown.
    """
    return STRUCTURES if names is None else tuple(map(find_structure, names))


def make_objective(structure: Structure, job: Mapping[str, Any]) -> Objective:
    """Make the objective of a structure from the settings of its trial.

    Parameters
    ----------
    structure : Structure
    job : mapping
        ``signals`` (a signal's job by name), ``loop`` (the slow signal's job, by its
        name), ``filters`` (each filter's job), ``identification`` (settings of
        Algorithm 1) and ``seed`` of the noise.
    """
    signals = {}
    for name, own in job["signals"].items():
        common = dict(own["common"])
        if structure.duration_s is not None:
            common["duration_s"] = structure.duration_s
        signals[name] = make_signal(name, own["definition"], common)
    filters = {name: dict(own) for name, own in job["filters"].items()}
    if structure.backlash is not None:
        filters["backlash"]["backlash_structure"] = structure.backlash
    loop = None
    if structure.identified:
        filters["gpo"]["envelopes"] = "identified"
        ((name, own),) = job["loop"].items()
        loop = make_signal(name, own["definition"], own["common"])
    return Objective(
        signals,
        filters,
        job["seed"],
        structure.window_start_s,
        structure.unknowns,
        structure.make,
        loop,
        job["identification"],
    )

"""What can be hidden in a machine: forces inside, and curves before and behind it.

Sizes are drawn as shares of how far, how fast and by what force the linear machine
moves on its fit records.
"""

from __future__ import annotations

import numpy as np

from hystbench.challenge.plant.kind import (
    Curve,
    Form,
    Inside,
    Kind,
    Numbers,
    Parameters,
    Range,
    Reach,
)
from hystbench.record import FloatArray


def _share(low: float, high: float, of: str, most: float, sign: bool = False) -> Range:
    """Interval of a share, which ``spread`` does not move."""
    return Range(low, high, f"of the {of}", sign, shifts=False, least=0.002, most=most)


def _coulomb(p: Parameters, r: Reach) -> Numbers:
    return {"coulomb": p["coulomb"] * r.force}


def _stribeck(p: Parameters, r: Reach) -> Numbers:
    return {
        "coulomb": p["coulomb"] * r.force,
        "surplus": p["coulomb"] * p["surplus"] * r.force,
        "stribeck_speed": p["speed"] * r.velocity,
    }


def _presliding(p: Parameters, r: Reach) -> Numbers:
    return _coulomb(p, r) | {"presliding": p["distance"] * r.position}


def _cubic(p: Parameters, r: Reach) -> Numbers:
    return {"cubic": p["share"] * r.stiffness / r.position**2}


def _quadratic(p: Parameters, r: Reach) -> Numbers:
    return {"quadratic": p["share"] * r.stiffness / r.position}


def _sinh(p: Parameters, r: Reach) -> Numbers:
    return {
        "sinh_force": p["share"] * r.stiffness * r.position,
        "sinh_reach": p["reach"] * r.position,
    }


def _wall(p: Parameters, r: Reach) -> Numbers:
    return {
        "wall_right": p["clearance"] * r.position,
        "wall_stiffness": p["stiffness"] * r.stiffness,
    }


def _walls(p: Parameters, r: Reach) -> Numbers:
    return _wall(p, r) | {"wall_left": p["clearance"] * r.position}


def _drag(p: Parameters, r: Reach) -> Numbers:
    return {"drag": p["share"] * r.force / r.velocity**2}


def _bouc_wen(p: Parameters, r: Reach) -> Numbers:
    return {
        "remembered": p["share"] * r.force,
        "yield_distance": p["distance"] * r.position,
        "sharpness": p["sharpness"],
        "unloading": p["unloading"],
    }


def _slider(p: Parameters, r: Reach) -> Numbers:
    slip = p["slip"] * r.position
    return {
        "slider_stiffness": p["stiffness"] * r.stiffness,
        "slip": slip,
        "clearance": p["clearance"] * slip,
    }


def _pendulum(p: Parameters, r: Reach) -> Numbers:
    return {"pendulum": p["share"] * r.stiffness}


def _root(p: Parameters, r: Reach) -> Numbers:
    # the exponent bends the outflow about the level that is half of the largest
    return {"exponent": p["exponent"], "about": 0.5 * r.position}


def _rim(p: Parameters, r: Reach) -> Numbers:
    return {"rim": p["level"] * r.position, "caught": p["caught"]}


def _dead_zone(u: FloatArray, p: Parameters, r: Reach) -> FloatArray:
    width = p["half_width"] * r.force
    return np.asarray(np.sign(u) * np.maximum(np.abs(u) - width, 0.0))


def _limit(u: FloatArray, p: Parameters, r: Reach) -> FloatArray:
    limit = p["limit"] * r.force
    return np.asarray(np.clip(u, -limit, limit))


def _bent(y: FloatArray, p: Parameters, r: Reach) -> FloatArray:
    z = y / r.output
    return np.asarray(y * (1.0 + p["quadratic"] * z + p["cubic"] * z**2))


def _law(
    ranges: dict[str, Range],
    size: str,
    numbers: Inside | None = None,
    curve: Curve | None = None,
    power: float = 1.0,
) -> Form:
    return Form(ranges=ranges, size=size, power=power, numbers=numbers, curve=curve)


def _kind(
    name: str, place: str, families: tuple[str, ...], forms: dict[str, Form]
) -> Kind:
    return Kind(name, place, forms=forms, families=families)


_FORCE = _share(0.04, 0.25, "force", 0.5)
_BEND = _share(0.1, 0.6, "linear spring", 6.0)
_CLEARANCE = _share(0.3, 0.7, "reach", 0.95)
_MOVED = ("mass-spring", "impedance")

EFFECTS: dict[str, Kind] = {
    kind.name: kind
    for kind in (
        _kind(
            "friction",
            "inside",
            ("mass-spring", "free-mass", "pendulum", "impedance"),
            {
                "coulomb": _law({"coulomb": _FORCE}, "coulomb", _coulomb),
                "stribeck": _law(
                    {
                        "coulomb": _FORCE,
                        "surplus": _share(0.3, 1.0, "sliding friction", 2.0),
                        "speed": _share(0.03, 0.15, "speed", 0.5),
                    },
                    "coulomb",
                    _stribeck,
                ),
                "presliding": _law(
                    {
                        "coulomb": _FORCE,
                        "distance": _share(0.005, 0.04, "reach", 0.1),
                    },
                    "coulomb",
                    _presliding,
                ),
            },
        ),
        _kind(
            "stiffness-hardening",
            "inside",
            _MOVED,
            {
                "cubic": _law({"share": _BEND}, "share", _cubic),
                "quadratic": _law(
                    {"share": _share(0.1, 0.3, "linear spring", 0.35, sign=True)},
                    "share",
                    _quadratic,
                ),
                "sinh": _law(
                    {"share": _BEND, "reach": _share(0.3, 0.6, "reach", 1.0)},
                    "share",
                    _sinh,
                ),
            },
        ),
        _kind(
            "stop",
            "inside",
            _MOVED,
            {
                form: _law(
                    {
                        "clearance": _CLEARANCE,
                        "stiffness": _share(2.0, 15.0, "linear spring", 40.0),
                    },
                    "stiffness",
                    numbers,
                )
                for form, numbers in (("one-sided", _wall), ("both-sides", _walls))
            },
        ),
        _kind(
            "slider-with-gap",
            "inside",
            _MOVED,
            {
                "slider": _law(
                    {
                        "slip": _share(0.15, 0.4, "reach", 0.6),
                        "clearance": _share(0.2, 0.6, "slip", 0.8),
                        "stiffness": _share(0.5, 3.0, "linear spring", 10.0),
                    },
                    "stiffness",
                    _slider,
                )
            },
        ),
        _kind(
            "drag",
            "inside",
            ("mass-spring", "free-mass", "pendulum", "impedance"),
            {"square": _law({"share": _share(0.1, 0.6, "force", 4.0)}, "share", _drag)},
        ),
        _kind(
            "hysteretic-force",
            "inside",
            _MOVED,
            {
                "bouc-wen": _law(
                    {
                        "share": _share(0.1, 0.4, "force", 1.0),
                        "distance": _share(0.08, 0.4, "reach", 0.6),
                        "sharpness": _share(1.0, 2.0, "exponent", 3.0),
                        "unloading": _share(0.5, 1.0, "slope", 1.0),
                    },
                    "share",
                    _bouc_wen,
                )
            },
        ),
        _kind(
            "gravity",
            "inside",
            ("pendulum",),
            {
                "sine": _law(
                    {"share": _share(0.6, 1.0, "linear spring", 1.0)},
                    "share",
                    _pendulum,
                )
            },
        ),
        _kind(
            "outflow",
            "inside",
            ("tank",),
            {
                "root": _law(
                    {"exponent": _share(0.4999, 0.5001, "exponent", 0.5)},
                    "exponent",
                    _root,
                )
            },
        ),
        _kind(
            "overflow",
            "inside",
            ("tank",),
            {
                "rim": _law(
                    {
                        "level": _share(0.55, 0.85, "largest level", 0.97),
                        "caught": _share(0.1, 1.0, "water spilt", 1.0),
                    },
                    "level",
                    _rim,
                    power=-2.0,
                )
            },
        ),
        _kind(
            "dead-zone",
            "before",
            ("mass-spring",),
            {
                "crossover": _law(
                    {"half_width": _share(0.04, 0.15, "force", 0.3)},
                    "half_width",
                    curve=_dead_zone,
                )
            },
        ),
        _kind(
            "drive-saturation",
            "before",
            ("mass-spring",),
            {
                "clip": _law(
                    {"limit": _share(0.4, 0.8, "force", 0.95)},
                    "limit",
                    curve=_limit,
                    power=-2.0,
                )
            },
        ),
        _kind(
            "sensor-nonlinearity",
            "behind",
            ("mass-spring",),
            {
                "polynomial": _law(
                    {
                        "quadratic": _share(0.05, 0.3, "output", 0.4, sign=True),
                        "cubic": _share(0.05, 0.2, "output", 0.3, sign=True),
                    },
                    "quadratic",
                    curve=_bent,
                )
            },
        ),
    )
}
MACHINES = ("mass-spring", "free-mass", "pendulum", "impedance", "tank")


def hidden_in(family: str) -> tuple[str, ...]:
    """Give the names of what can be hidden in a family of machines."""
    return tuple(name for name, kind in EFFECTS.items() if family in kind.families)


#: One or the other, never both: records tell hardly which is there.
APART = (
    {"friction", "hysteretic-force"},
    {"friction", "slider-with-gap"},
    {"hysteretic-force", "slider-with-gap"},
    {"stop", "slider-with-gap"},
    {"stop", "stiffness-hardening"},
    {"dead-zone", "friction"},
    {"dead-zone", "drive-saturation"},
    {"sensor-nonlinearity", "stiffness-hardening"},
)

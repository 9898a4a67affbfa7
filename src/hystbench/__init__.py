"""Benchmark of rate-dependent hysteresis models of smart actuators.

Records, a model file and the gap between them, from Python::

    from hystbench import find_gap, load_dataset, load_model
    gap = find_gap(load_dataset("my-data"), load_model("model.yaml"))
    y = gap.model.simulate(u, dt)
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hystbench.interface.dataset import load_dataset
    from hystbench.interface.gap import find_gap
    from hystbench.model import load_model

__all__ = ["__version__", "find_gap", "load_dataset", "load_model"]

__version__ = "0.1.0"

_PLACES = {
    "find_gap": "hystbench.interface.gap",
    "load_dataset": "hystbench.interface.dataset",
    "load_model": "hystbench.model",
}


def __getattr__(name: str) -> Any:
    """Import what is asked for when it is asked for: ``hystbench`` alone is light."""
    if name in _PLACES:
        return getattr(import_module(_PLACES[name]), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

"""Benchmark of rate-dependent hysteresis models of smart actuators.

A model file is used from Python in two lines::

    from hystbench import load_model
    y = load_model("model.yaml").simulate(u, dt)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from hystbench.model import load_model

__all__ = ["__version__", "load_model"]

__version__ = "0.1.0"


def __getattr__(name: str) -> Any:
    """Import what is asked for when it is asked for: ``hystbench`` alone is light."""
    if name == "load_model":
        from hystbench.model import load_model

        return load_model
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

"""Adaptive filters: each file beside this one adds its own to the registry."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from hystbench.filters.base import FILTERS as FILTERS
from hystbench.filters.base import MOST_CORRECTION as MOST_CORRECTION
from hystbench.filters.base import AdaptiveFilter as AdaptiveFilter
from hystbench.filters.base import Result as Result
from hystbench.filters.base import State as State
from hystbench.filters.bound import Bound as Bound
from hystbench.filters.many import run_many as run_many

for _module in iter_modules(__path__):
    import_module(f"{__name__}.{_module.name}")

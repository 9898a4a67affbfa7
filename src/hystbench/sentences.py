"""Words joined as in a sentence."""

from __future__ import annotations

from collections.abc import Sequence


def listed(names: Sequence[str]) -> str:
    """Join names with commas and a last "and"."""
    *first, last = names or ("",)
    return f"{', '.join(first)} and {last}" if first else last

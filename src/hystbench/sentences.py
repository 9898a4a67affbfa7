"""Words and numbers as they stand in a sentence."""

from collections.abc import Sequence

MAKE_MISSING = (
    "make such samples missing (an empty cell, or NaN) and write 'missing: "
    "interpolate' for the record"
)
"""What to do with samples that are none."""


def listed(names: Sequence[str]) -> str:
    """Join names with commas and a last "and"."""
    *first, last = names or ("",)
    return f"{', '.join(first)} and {last}" if first else last


def either(names: Sequence[str]) -> str:
    """Join what any of may be the one, with a last "or"."""
    *first, last = names
    apart = "; " if any(", " in name for name in names) else ", "
    return apart.join((*first, f"or {last}")) if first else last


def percent(share: float) -> str:
    """Write a share as it stands in a sentence."""
    return f"{100 * share:.0f} %"


def finely(share: float) -> str:
    """Write a share of which little may matter: to a tenth of a percent below one."""
    if share < 0.0005:
        return "less than 0.1 %" if share > 0 else "0 %"
    return f"{100 * share:.1f} %" if share < 0.01 else percent(share)


def shortly(value: float, digits: int = 3) -> str:
    """Write a number to some digits; without an exponent up to a million."""
    text = f"{value:.{digits}g}"
    plain = "e+" in text and abs(float(text)) < 1e6
    return f"{float(text):.0f}" if plain else text

"""Units as files spell them: whether two are the same one."""

from __future__ import annotations

import re

from hystbench.errors import InputError


def check_same_unit(place: str, ours: str, whose: str, theirs: str) -> None:
    """Refuse two units that are not the same one, in whatever spelling.

    Nothing is converted: a factor that is not one is told and refused.

    Parameters
    ----------
    place : str
        Where ``ours`` stands, for the message.
    ours, theirs : str
        The units.
    whose : str
        What has ``theirs``.

    Raises
    ------
    InputError
        If they are of different dimensions, one is no unit, or a factor lies between.
    """
    if ours == theirs:
        return
    import pint  # late: a fifth of a second, and rarely needed

    where = f"{place} {ours!r}, but {whose} has {theirs!r}"
    try:
        # Files write cm2 where pint wants cm**2.
        given, wanted = (
            re.sub(r"(?<=[^\W\d_])(?=\d)", "**", unit) for unit in (theirs, ours)
        )
        factor = float(pint.Quantity(1, given).to(wanted).magnitude)
    except (pint.UndefinedUnitError, pint.DimensionalityError) as error:
        raise InputError(f"{where}: {error}; expected the same unit") from None
    if abs(factor - 1) > 1e-12:
        raise InputError(
            f"{where}; nothing is converted silently: multiply the record's column by "
            f"{factor:g} and say {ours!r} in its dataset.yaml"
        )

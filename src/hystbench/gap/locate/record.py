"""The record view: which records hold the gap."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hystbench.gap.locate.forms import fit_form, narrowest_bins, p_value_of
from hystbench.gap.locate.picture import Axis, Bars, Panel, Picture, listed
from hystbench.gap.locate.samples import ViewSamples
from hystbench.gap.locate.view import View, percent
from hystbench.record import FloatArray

QUIET = 1.5
"""Of the noise's power, that a record's residual has where the gap is not."""
NAMED = 3
"""Records that are told by name; of more, how many they are."""


def record(samples: ViewSamples) -> View:
    """Share the gap's power out among the records.

    The range is the fewest neighbouring records that hold four fifths of it. For the
    rank, the record that holds most is given a gain and an offset of its own: this
    view comes first where one record is off. The p-value is that of a gain and an
    offset of each record's own.
    """
    shares = record_shares(samples)
    first, last = narrowest_bins(shares)
    share = float(np.sum(shares[first : last + 1]))
    names = [item.record.name for item in samples.compared]
    columns = np.stack([samples.simulated, np.ones_like(samples.simulated)])
    own = fit_form(samples, "gains and offsets", list(columns), by_record=True)
    there = np.zeros(columns.shape[1])
    there[samples.slices[int(np.argmax(shares))]] = 1.0
    single = fit_form(
        samples, "a gain and an offset", list(columns * there), searched=1
    )
    where = names[first] if first == last else f"{names[first]} to {names[last]}"
    taken = samples.share(own.explained, own.freedom)
    return View(
        view="record",
        axis="record",
        start=names[first],
        end=names[last],
        unit="",
        share_of_gap_power=share,
        p_value=p_value_of(samples, own),
        sentence=(
            f"{percent(share)} of the gap lies in {last - first + 1} of {len(names)} "
            f"records, {where}; a gain and an offset of each record's own would take "
            f"away {percent(taken)}.{_left_alone(samples, names)}"
        ),
        saved=single.saved,
        pictures=(_picture(names, shares),),
    )


def record_shares(samples: ViewSamples) -> FloatArray:
    """Give each record's share of the power above the floor; they add to one."""
    above = np.array(
        [
            max(float(np.sum(samples.residual[part] ** 2 - samples.noise)), 0.0)
            for part in samples.slices
        ]
    )
    total = float(np.sum(above))
    return above / total if total > 0 else np.full(len(above), 1 / len(above))


def _left_alone(samples: ViewSamples, names: Sequence[str]) -> str:
    """Name the records whose residual is the noise: what the model does right."""
    quiet = [
        name
        for name, part in zip(names, samples.slices, strict=True)
        if float(np.mean(samples.residual[part] ** 2)) <= QUIET * samples.noise
    ]
    if not quiet:
        return ""
    told = " and ".join(quiet)
    if len(quiet) > NAMED:
        told = f"{len(quiet)} records, {quiet[0]} among them,"
    return f" It leaves {told} alone."


def _picture(names: list[str], shares: FloatArray) -> Picture:
    panel = Panel(
        Axis("share of the gap's power", "%"),
        Axis("record"),
        bars=Bars(names, listed(100 * shares)),
    )
    return Picture("records", "Share of the gap's power in each fit record", (panel,))

"""The record view: which records hold the gap."""

from __future__ import annotations

import numpy as np

from hystbench.gap.locate.regression import (
    fit_by_record,
    fitted_p_value,
    narrowest_bins,
)
from hystbench.gap.locate.samples import Samples
from hystbench.gap.locate.view import View, percent
from hystbench.record import FloatArray


def record_view(samples: Samples) -> View:
    """Share the gap's power out among the records.

    The range is the fewest neighbouring records that hold four fifths of it. What is
    explained, for rank and p-value, is a gain and an offset of each record's own.
    """
    shares = record_shares(samples)
    first, last = narrowest_bins(shares)
    share = float(np.sum(shares[first : last + 1]))
    names = [item.record.name for item in samples.compared]
    form = fit_by_record(samples, [samples.simulated, np.ones_like(samples.simulated)])
    own = samples.share(form.explained, form.freedom)
    where = names[first] if first == last else f"{names[first]} to {names[last]}"
    return View(
        view="record",
        axis="record",
        start=names[first],
        end=names[last],
        unit="",
        share_of_gap_power=share,
        p_value=fitted_p_value(samples, form),
        sentence=(
            f"{percent(share)} of the gap lies in {last - first + 1} of {len(names)} "
            f"records, {where}; a gain and an offset of each record's own would take "
            f"away {percent(own)}."
        ),
        saved=form.saved,
    )


def record_shares(samples: Samples) -> FloatArray:
    """Give each record's share of the power above the floor; they add to one."""
    above = np.array(
        [
            max(float(np.sum(samples.residual[part] ** 2 - samples.noise)), 0.0)
            for part in samples.slices
        ]
    )
    total = float(np.sum(above))
    return above / total if total > 0 else np.full(len(above), 1 / len(above))

"""A black box is told beside the named effects on hold-out records."""

import numpy as np
import pytest

from hystbench.gap.holdout.scored import black_box_mapping
from hystbench.gap.holdout.shrink import shrink
from hystbench.gap.records.black_box import BlackBox
from hystbench.gap.records.floor import Floor
from hystbench.gap.records.folds import make_folds
from hystbench.metrics import rms
from tests.gap.made import compared, sine


def test_black_box_beside_the_named_effects():
    # A cubic gap; the black box sees amplitudes to 1.2, one hold-out record has 4.
    items = [
        compared(sine(f, amplitude=a), sine(f, amplitude=a) ** 3, name=f"r{f}")
        for f, a in ((1, 1), (2, 1.2), (3, 0.8), (5, 1.1))
    ]
    box = BlackBox.fit(items, make_folds([item.record for item in items]), 0.001)
    held = [
        compared(sine(2, amplitude=a), sine(2, amplitude=a) ** 3, name=name)
        for name, a in (("inside", 1.0), ("beyond", 4.0))
    ]
    records = [item.record for item in held]
    before = [item.simulated for item in held]
    floor = Floor(0.001, "declared")
    named = shrink(records, before, [item.y for item in records], floor).records
    found = black_box_mapping(box, records, before, named, floor)
    inside, beyond = found["records"]
    assert (inside["name"], inside["outside"]) == ("inside", [])
    assert beyond["outside"] == ["amplitude", "rate"]
    assert inside["explained"] > 0.95 > beyond["explained"]
    assert inside["named"] == beyond["named"] == 0
    assert found["explained_on_folds"] == box.explained_on_folds
    assert found["outside"] == {
        key: beyond[key] for key in ("before", "after", "named")
    }
    # what is left, by hand
    left = [item.residual - box.predict(item.record, item.simulated) for item in held]
    assert found["after"] == pytest.approx(rms(np.concatenate(left)))


def test_of_one_record_all_is_what_the_record_is():
    item = compared(sine(2), sine(3))
    after = item.simulated + 0.5 * item.residual
    floor = Floor(0.1, "upper-bound")
    whole, (row,), _ = shrink([item.record], [item.simulated], [after], floor)
    assert whole["explained"] == row["explained"] == pytest.approx([0.75, 0.75 / 0.98])
    assert row["before"] == pytest.approx(np.sqrt(0.5))
    assert row["after"] == pytest.approx(np.sqrt(0.5) / 2)

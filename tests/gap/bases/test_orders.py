"""Which of several linear models is taken, by its errors on records and on folds."""

import numpy as np
import pytest

from hystbench.gap.bases.orders import Judged, Orders, none_lowers_both
from hystbench.gap.records.evidence import Evidence
from hystbench.quantities import Quantities
from tests.gap.made import record


@pytest.mark.parametrize(
    ("fit", "folds", "stays"),
    [
        (0.9, 1.9, True),  # better on the records it was fitted to
        (0.9, 2.1, False),  # but worse than a constant on others
        (1.1, 1.9, False),  # worse on both
    ],
)
def test_what_does_worse_on_folds_than_a_constant_is_no_rival(fit, folds, stays):
    other = Judged(1.0, 1.0, 2.0)
    assert none_lowers_both(Judged(fit, folds, 2.0), [other]) == stays


def test_where_all_do_worse_than_a_constant_the_errors_decide():
    worse = Judged(1.0, 3.0, 2.0)
    assert none_lowers_both(Judged(0.9, 4.0, 2.0), [worse])
    assert not none_lowers_both(Judged(1.1, 4.0, 2.0), [worse])


APART = ((0.0 - 3.0) ** 2, (1.0 - 2.5) ** 2, (5.0 - 0.5) ** 2)


@pytest.mark.parametrize(
    ("gives", "squares"),
    [("level", APART), ("position", (0.0, 0.0, 0.0))],
    ids=["a level", "a sensor whose zero may be another one every time"],
)
def test_a_constant_is_judged_on_folds_as_models_are(gives, squares):
    """Three records, each constant: the mean of two is off by half their distance."""
    levels = (0.0, 1.0, 5.0)
    records = tuple(
        record(np.sin(0.1 * k * np.arange(400)), np.full(400, level), name=f"{k}")
        for k, level in enumerate(levels, start=1)
    )
    about = Quantities("voltage", gives)
    found = Orders(Evidence("made", records, (), "linear", quantities=about))
    assert found.constant == pytest.approx(np.sqrt(np.mean(squares)))

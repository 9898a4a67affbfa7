"""How sure a share of cases is."""

from __future__ import annotations

from typing import NamedTuple

CONFIDENCE = 0.95


class Share(NamedTuple):
    """A share of cases with its interval; all None where there are no cases."""

    share: float | None
    low: float | None
    high: float | None
    cases: int


def wilson(hits: int, cases: int) -> Share:
    """Compute a share and its 95 % score interval.

    Parameters
    ----------
    hits, cases : int

    References
    ----------
    .. [1] E. B. Wilson, "Probable inference, the law of succession, and statistical
       inference", Journal of the American Statistical Association 22 (1927) 209-212.
    """
    from scipy.stats import binomtest  # late: not needed to make cases

    if cases == 0:
        return Share(None, None, None, 0)
    interval = binomtest(hits, cases).proportion_ci(CONFIDENCE, method="wilson")
    return Share(hits / cases, float(interval.low), float(interval.high), cases)

"""Claims judged on some of the signals alone: on those that no fit has read."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from hystbench.compare.claims.claim import Claim, NotTestable
from hystbench.compare.evidence import ClaimEvidence


def holds(claim: Claim, evidence: ClaimEvidence) -> bool | None:
    """Tell whether a claim holds; None where it cannot be tested."""
    try:
        return claim.ours(evidence).holds
    except NotTestable:
        return None


def on_signals(evidence: ClaimEvidence, signals: Iterable[str]) -> ClaimEvidence:
    """Keep what evidence says on some signals, the published errors among it."""
    kept = set(signals)
    return replace(
        evidence,
        published=tuple(p for p in evidence.published if p.signal in kept),
        runs={cell: r for cell, r in evidence.runs.items() if cell[0] in kept},
        records={name: r for name, r in evidence.records.items() if name in kept},
        envelope_errors={
            cell: e for cell, e in evidence.envelope_errors.items() if cell[0] in kept
        },
        drawn={name: d for name, d in evidence.drawn.items() if name in kept},
    )


def about_signals(claim: Claim, restricted: ClaimEvidence) -> bool:
    """Tell whether a claim can be judged on some signals, and only with them."""
    without = replace(restricted, runs={}, records={}, envelope_errors={}, drawn={})
    return holds(claim, without) is None and holds(claim, restricted) is not None

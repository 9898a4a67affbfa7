"""Which claims are judged on twins, and what is written of them."""

from types import SimpleNamespace

import pytest

from hystbench.commands.jobs.twins import results_on_runs, write_twins
from hystbench.compare.beside import read_holdings, read_spreads
from hystbench.compare.claims import CLAIMS
from hystbench.compare.runs import ClaimEvidence
from hystbench.twins.parts import CONFIGURED, TwinExperiment, TwinOutcome
from tests.compare.made import published_runs

BY_ID = {claim.id: claim for claim in CLAIMS}
HELD_OUT = ["sine-060hz", "sine-120hz", "sine-200hz", "chirp-1-100hz"]
HELD_OUT.append("multisine-random-0-100hz")


def outcome(changes, name, family="gpi", experiment=CONFIGURED):
    """Runs as printed, but for some MSE."""
    twin = SimpleNamespace(name=name, family=family)
    return TwinOutcome(twin, experiment, ClaimEvidence(runs=published_runs(changes)))


@pytest.mark.parametrize("claim", [c.id for c in CLAIMS if c.kind == "result"])
def test_every_claim_can_be_put_to_any_signals(claim):
    evidence = outcome({}, "gma").evidence
    for signals in ([], HELD_OUT, ["sine-060hz"], ["chirp-1-100hz"]):
        found = BY_ID[claim].holds(evidence.on_signals(signals))
        assert found in (True, False, None)


def test_only_results_that_need_runs_are_judged():
    found = {claim.id for claim in results_on_runs(outcome({}, "gma").evidence)}
    assert "sines-gpo-best" in found
    # a theorem, a condition, and what no run can judge
    assert not found & {"eq7", "same-order", "rdgpi-parameters"}
    # without records there is no chirp to follow
    assert "chirp-decrease" not in found


def test_claims_are_counted_by_family_and_spreads_are_of_the_configured(tmp_path):
    chirp = ("chirp-1-100hz", "gpo")
    other = TwinExperiment(1, {}, 1.0, 1.0)
    outcomes = [
        outcome({}, "gma"),
        outcome({chirp: 9.0}, "gma", experiment=other),
        outcome({chirp: 0.001}, "gma-01"),
        outcome({chirp: 9.0}, "gma-preisach", "preisach"),
        outcome({chirp: None}, "gma-preisach", "preisach", other),
    ]
    errors, claims = tmp_path / "errors.csv", tmp_path / "claims.csv"
    write_twins(outcomes, errors, claims)
    held = {
        h.family: (h.held, h.judged) for h in read_holdings(claims)["chirp-gpo-best"]
    }
    # a filter that diverged is worse than any other
    assert held == {"gpi": (2, 3), "preisach": (0, 2)}
    low, high = read_spreads(errors)[(*chirp, "mse")]
    assert low == 0.001
    assert high == published_runs()[chirp].mse  # not 9: that was another experiment

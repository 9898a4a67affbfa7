"""An effect looked at again: what is kept of the second look."""

import pytest

from hystbench.gap import reconsider
from hystbench.gap.change import with_effect
from hystbench.gap.effects import effects
from hystbench.gap.rank import Candidate, Round
from hystbench.gap.reconsider import reconsidered
from hystbench.gap.say import silent
from tests.gap.small import block, measured, state_of

NOISE = 0.02


@pytest.fixture(scope="module")
def two():
    """A model with two effects, and the round in which the first was taken."""
    gain = block("gain", value=12.0)
    lag = block("drive-lag", time_constant_s=0.004)
    before = state_of((gain,), measured((lag, gain), NOISE))
    after = before
    values = {"drive-lag": {"time_constant_s": 0.004}, "asymmetry": {"coefficient": 0}}
    for name, own in values.items():
        variant = next(iter(effects()[name].variants(after.scene)))
        after = with_effect(after, variant, own)
    first = Candidate("drive-lag", "drive", score=-100.0, gain=90.0, state=after)
    return after, (Round(before, -10.0, (first,), True),)


@pytest.mark.parametrize("declined", [False, True])
def test_a_second_look_counts_only_where_the_effect_itself_could_be_judged(
    two, declined, monkeypatch
):
    """Its own candidate may decline there: at an end of its range, for example."""
    state, rounds = two

    def looked(short, score, known):
        (name,) = (item.name for item in known)
        if declined and name == "drive-lag":
            return (Candidate(name, "drive", declined="fits best at the end"),)
        return (Candidate(name, "drive", score=0.0, gain=1.0, state=state),)

    monkeypatch.setattr(reconsider, "rank", looked)
    kept, rankings = reconsidered(state, rounds, NOISE, silent)
    assert kept is state
    # What is not in here keeps the ranking by which the effect was taken.
    assert set(rankings) == {"asymmetry"} | (set() if declined else {"drive-lag"})
    # The model that is there scores better than what the second look came to.
    ((own,),) = (rankings["asymmetry"],)
    assert own.state is state
    assert own.score < 0.0
    assert own.score + own.gain == pytest.approx(1.0)

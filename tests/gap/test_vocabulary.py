"""An engineer rejects a name or puts one in, and searches again."""

from types import SimpleNamespace

import pytest

from hystbench.errors import InputError
from hystbench.gap.effects import effects
from hystbench.gap.fitting.model_score import make_score
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.holdout.withdraw import with_what_was_asked
from hystbench.gap.naming.put_in import with_put_in
from hystbench.gap.naming.rank import rank
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.report.words import rerun_commands, verdict_sentence, verdict_text
from hystbench.gap.vocabulary import EVERYTHING, Vocabulary
from hystbench.interface.gap import find_gap
from hystbench.model import load_model
from tests.gap.tiny import LAG_S, write_tiny


@pytest.fixture(scope="module")
def tiny(tmp_path_factory):
    return write_tiny(tmp_path_factory.mktemp("tiny"))


def test_what_is_closed_is_not_offered():
    chosen = Vocabulary.of(["creep"], ["friction"])
    assert {*effects()} - {*chosen.offered} == {"creep", "friction"}
    assert EVERYTHING.offered == tuple(effects())


@pytest.mark.parametrize(
    ("without", "put_in", "said"),
    [
        (["frction"], [], "--without: no effect 'frction'.*'friction'"),
        ([], ["creeep"], "--with: no effect 'creeep'.*'creep'"),
        (["creep", "creep"], [], "'creep' twice"),
        (["creep"], ["creep"], "'creep' in both"),
    ],
)
def test_names_that_mean_nothing_are_refused(without, put_in, said):
    with pytest.raises(InputError, match=said):
        Vocabulary.of(without, put_in)


def test_an_effect_that_is_not_offered_is_not_tried(tiny):
    data, base = tiny
    evidence = load_evidence(data)
    offered = ("creep", "sensor-lag")
    state, floor = start_state(
        evidence.fit, load_model(base), evidence.input_hold, evidence.noise_rms, offered
    )
    ranking = rank(state, make_score(state, floor), folds=False)
    assert {item.effect for item in ranking} == {*offered}


def test_what_is_put_in_is_fitted_and_is_no_finding(tiny):
    """The records' own effect is put in: nothing is left to find."""
    data, base = tiny
    gap = find_gap(data, base, with_=["drive-lag"], cache=False)
    content = gap.content
    assert content["verdict"] == "no-gap"
    assert gap.effects == ()
    assert "drive-lag" not in {row["name"] for row in content["ranking"]}
    (mine,) = content["built_in"]["effects"]
    value = mine["parameters"]["time_constant_s"]
    assert value["value"] == pytest.approx(LAG_S, rel=0.02)
    assert value["unit"] == "s"
    # What it closes is told beside what was found, and not within it.
    assert content["built_in"]["before"] > 5 * content["built_in"]["after"]
    assert content["gap"]["before"] == content["built_in"]["after"]
    assert [rung["rms"] for rung in content["ladder"][:2]] == [
        content["built_in"]["before"],
        content["built_in"]["after"],
    ]
    assert "you put in drive-lag: it is not a finding" in content["reason"]
    assert gap.sentence.startswith("With drive lag, which you put in, there is no gap")
    assert "drive-lag" in {block.name for block in gap.model.chain}


@pytest.mark.parametrize(
    ("name", "free"),
    [
        ("drive-lag", {"drive-lag.time_constant_s"}),
        ("asymmetry", {"gain.offset", "gain#2.offset"}),
    ],
)
def test_of_what_is_put_in_the_effects_own_numbers_stay_free(tiny, name, free):
    """A field bias is two plain gains, whose value is one and stays so."""
    data, base = tiny
    model, put_in = with_put_in(load_model(base), load_evidence(data), [name])
    assert {*model.free} == free
    assert put_in.names == (name,)


def test_what_is_new_in_every_record_cannot_be_put_in(tiny):
    data, base = tiny
    with pytest.raises(InputError, match="--with mains-pickup: "):
        find_gap(data, base, with_=["mains-pickup"], cache=False)


def test_the_reason_tells_what_was_left_out():
    content = {"reason": "what is left is noise"}
    told = with_what_was_asked(content, Vocabulary.of(["friction"]))
    assert told["reason"].endswith("you left out friction: it was not tried")
    assert told["asked"]["without"] == ["friction"]
    assert with_what_was_asked(content, EVERYTHING) == content


def about(**more):
    effect = {"name": "friction", "cannot_be_told_from": ["backlash"]}
    row = {"round": 1, "look": 0, "name": "creep"}
    return {
        "verdict": "named",
        "reason": "",
        "effects": [effect],
        "withdrawn": None,
        "unnamed": None,
        "ranking": [row],
        "asked": None,
        "command": {"dataset": "my rig", "model": "linear", "out": "out"},
    } | more


def test_the_page_gives_the_commands_of_an_answer():
    commands = dict(rerun_commands(about()))
    assert commands["it is not friction"] == (
        "hystbench gap 'my rig' --model linear --out out-without-friction "
        "--without friction"
    )
    assert commands["it is not friction, it is backlash"].endswith(
        "--without friction --with backlash"
    )


def test_a_further_command_keeps_what_was_asked_before():
    asked = {"without": ["creep"], "with": ["drift"], "sentence": ""}
    commands = dict(rerun_commands(about(asked=asked)))
    assert commands["it is not friction"].endswith(
        "--without creep --without friction --with drift"
    )
    sentence = verdict_sentence(about(asked=asked))
    assert sentence == "With drift, which you put in, the simulator lacks friction."


def test_without_a_command_words_stand_in_its_place():
    ((_, first), *_) = rerun_commands(about(command=None))
    assert first.startswith("hystbench gap DATASET --model MODEL --out OUT")


def test_the_command_passes_what_was_asked(tiny, tmp_path, monkeypatch):
    from click.testing import CliRunner

    from hystbench.commands import gap as module

    given = {}

    def find(dataset, model, **more):
        given.update(more)
        decision = SimpleNamespace(experiment=None, content={})
        return SimpleNamespace(
            effects=(),
            verdict="no-gap",
            content={"reason": "none is there", "withdrawn": None, "warnings": []},
            save=lambda out, report: None,
            closed=SimpleNamespace(decision=decision),
        )

    monkeypatch.setattr(module, "find_gap", find)
    data, base = tiny
    words = [str(data), "--model", str(base), "--out", str(tmp_path / "out")]
    words += ["--without", "friction", "--without", "drift", "--with", "creep"]
    result = CliRunner().invoke(module.gap, words)
    assert result.exit_code == 0, result.output
    assert (given["without"], given["with_"]) == (("friction", "drift"), ("creep",))
    assert "you put in creep" in result.output


@pytest.mark.parametrize(
    ("name", "kind", "called"),
    [
        ("eddy-diffusion", None, "diffusion-like lag"),
        (
            "eddy-diffusion",
            "piezoelectric",
            "diffusion-like lag (relaxation of polarization, or the charge amplifier)",
        ),
        (
            "drive-lag",
            "piezoelectric",
            "drive lag (the amplifier, which charges a capacitance; or the amplifier's "
            "bandwidth)",
        ),
        # The kind tells nothing here: these are all the causes there are.
        ("friction", "mechanical", "friction"),
        # Nothing causes it there; the user put it in all the same.
        ("friction", "electronic", "friction"),
    ],
)
def test_a_name_is_worded_as_it_would_be_in_the_device(name, kind, called):
    named = {"name": name, "cannot_be_told_from": []}
    device = {"kind": kind}
    told = about(effects=[named], device=device)
    assert verdict_sentence(told) == f"The simulator lacks {called}."
    assert verdict_text(told).startswith(f"**The simulator lacks {called}.**")
    short = {"sentence": "it is a curve", "sort": "curve", "structured": 0.02}
    told = about(verdict="unnamed", unnamed=short, effects=[named], device=device)
    assert f"something like {called}, but" in verdict_sentence(told)
    taken = {"names": [name], "after": 1.0}
    told = about(verdict="unnamed", withdrawn=taken, effects=[], device=device)
    assert f"{called[1:]} was withdrawn" in verdict_sentence(told)
    assert "eddy" not in verdict_sentence(told)

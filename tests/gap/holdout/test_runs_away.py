"""A model that runs away on a hold-out record: names go, the record is named.

The spring of a mode softens. Within the amplitudes of the fit records its potential is
a well; the record that is held out drives it over the brim, where no motion is bounded.
"""

import csv
import json

import numpy as np
import pytest

from hystbench.errors import InputError
from hystbench.gap.effects import effects
from hystbench.gap.fitting.edit_chain import with_effect
from hystbench.gap.fitting.on_records import compared_records, start_state
from hystbench.gap.holdout.scored import RUNS_AWAY_RATIO, bounded, reach, score_hold_out
from hystbench.gap.naming.ladder import FitResult, Rung
from hystbench.gap.records.black_box import black_box
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.report.tables import write_table
from hystbench.model import Model, load_model
from tests.gap.closing import close_gap
from tests.gap.conftest import without_rendering
from tests.gap.made import CURRENT, DISPLACEMENT, record
from tests.gap.small import block, measured

DT, COUNT = 5e-4, 2000
FREQUENCY, DAMPING, SHARE, SOFT = 40.0, 0.05, 0.4, -5e-4
"""The brim of its potential is where 1 + SOFT x^2 = 0: at 45 um."""
FORCE = 12.0


def spring(u, soft):
    """Step the mode's equation by symplectic Euler, far finer than any sample."""
    x, v, w, fine = 0.0, 0.0, 2 * np.pi * FREQUENCY, 40
    out = np.empty(len(u))
    h = DT / fine
    given = u.tolist()
    for k, now in enumerate(given):
        out[k] = (1 - SHARE) * now + SHARE * x
        then = given[min(k + 1, len(u) - 1)]
        for j in range(fine):
            z = now + (then - now) * j / fine
            v += h * (w * w * (z - x - soft * x**3) - 2 * DAMPING * w * v)
            x += h * v
    return out


def base():
    mode = {
        "frequency_hz": FREQUENCY,
        "damping_ratio": DAMPING,
        "participation": SHARE,
    }
    chain = (block("gain", value=FORCE), block("resonance", **mode))
    return Model("rig", CURRENT, DISPLACEMENT, chain)


def evidence(loud=6.0):
    """Three sweeps to fit; a fourth, held out, is so many times louder."""
    rng = np.random.default_rng(3)
    t = np.arange(COUNT) * DT
    made = []
    for name, size, low, high in (
        ("one", 0.07, 5, 60),
        ("two", 0.09, 60, 20),
        ("three", 0.08, 25, 45),
        ("near", 0.075, 10, 50),
        ("far", 0.16 * loud, 20, 50),
    ):
        held = name in ("near", "far")
        u = size * np.sin(2 * np.pi * (low + (high - low) * t / (2 * t[-1])) * t)
        # Nobody measured what runs away: a louder rig hits a stop, here a stiff spring.
        y = spring(FORCE * u, 0.0 if name == "far" else SOFT)
        y = y + 0.01 * rng.standard_normal(COUNT)
        use = "hold-out" if held else "fit"
        made.append(record(u, y, name=name, dt=DT, use=use))
    fit, held = tuple(made[:3]), tuple(made[3:])
    return Evidence("springs", fit, held, "band-limited", 0.01)


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    out = tmp_path_factory.mktemp("springs") / "out"
    with without_rendering():
        close_gap(evidence(), base(), out)
    return out, json.loads((out / "gap.json").read_text())


def test_names_are_withdrawn_whose_model_has_no_bounded_output(written):
    """It does well on one record; but nobody can use what runs away on the next."""
    out, content = written
    assert (content["verdict"], content["effects"]) == ("unnamed", [])
    taken = content["withdrawn"]
    assert (taken["verdict"], taken["names"]) == ("named", ["stiffness-hardening"])
    (effect,) = taken["effects"]
    assert effect["parameters"]["coefficient"]["value"] == pytest.approx(SOFT, rel=0.1)
    assert "far" in taken["why"]
    assert content["reason"] == taken["why"]
    assert taken["after"] is None
    near, far = taken["records"]
    assert near["after"] < 0.5 * near["before"]
    assert (far["name"], far["after"]) == ("far", None)
    # What was written is the base, which says how its input moves between samples.
    kept = load_model(out / "model.yaml")
    assert kept.chain == base().with_hold("band-limited").chain


def test_the_record_is_named_and_counts_as_nothing_closed(written):
    _, content = written
    (away,) = content["runs_away"]
    assert away["record"] == "far"
    assert 0 < away["from_s"] < COUNT * DT
    told = "rig with stiffness-hardening diverges on far from"
    assert away["sentence"].startswith(told)
    gap = content["gap"]
    assert gap["after"] == gap["before"] == content["withdrawn"]["before"]
    assert gap["explained"] == 0.0
    assert gap["before_interval"] == gap["after_interval"]
    assert content["ladder"][0]["rms"] == pytest.approx(gap["before"])
    assert content["ladder"][-1]["rms"] is None
    # The black box is bounded, and has its own figures.
    assert content["black_box"]["after"] > 0


def test_tables_and_page_tell_it(written, tmp_path):
    out, content = written
    for name in ("far", "near"):
        table = np.loadtxt(out / "holdout" / f"{name}.csv", delimiter=",", skiprows=1)
        assert np.array_equal(table[:, 2], table[:, 3])
    page = (out / "report.html").read_text()
    assert content["runs_away"][0]["sentence"] in page
    headline = page.index("Stiffness hardening was withdrawn")
    assert headline < page.index("<h2>Effects")
    write_table("summary", [content], tmp_path / "summary.csv")
    with (tmp_path / "summary.csv").open(newline="") as stream:
        (row,) = csv.DictReader(stream)
    assert (row["verdict"], row["effects"]) == ("unnamed", "none")
    assert row["withdrawn"] == "stiffness-hardening"
    assert row["before"] == row["after"]


def test_a_base_that_runs_away_on_a_hold_out_record_is_refused_before_the_search(
    tmp_path, monkeypatch
):
    """Its inputs are known: no search is paid for what cannot be shown."""
    from hystbench.gap import run

    def find(*given):
        pytest.fail("a search")

    monkeypatch.setattr(run, "search_and_judge", find)
    chain = (
        block("gain", value=FORCE),
        block(
            "stiffness-hardening",
            coefficient=SOFT,
            frequency_hz=FREQUENCY,
            damping_ratio=DAMPING,
            participation=SHARE,
        ),
    )
    soft = Model("soft", CURRENT, DISPLACEMENT, chain)
    with pytest.raises(
        InputError, match=r"^soft: the output is not finite from .* far"
    ):
        close_gap(evidence(), soft, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def narrow(u, dt):
    """A simulator of somebody's own that knows how much its rig bears."""
    if np.abs(u).max() > 1.0:
        raise ValueError("current beyond 1 A")
    return 12.0 * u


def squared(value, simulator=None):
    """A gain that an asymmetry was added to, and the base on its own."""
    chain = (simulator or block("gain", value=12.0),)
    start, floor = start_state(
        measured(chain, 0.02),
        Model("simulator", CURRENT, DISPLACEMENT, chain),
        declared=0.02,
    )
    (asymmetry, *_) = effects()["asymmetry"].variants(start.simulation)
    after = with_effect(start, asymmetry, {"coefficient": value})
    return Model("simulator", CURRENT, DISPLACEMENT, chain), start, after, floor


@pytest.mark.parametrize("size", [1e80, 1e12])
def test_what_is_beyond_any_use_runs_away_though_it_is_a_number(size):
    """An output of 1e160 or of 1e24 for an input of 1e80 or 1e12: no motion."""
    base, start, after, floor = squared(0.01)
    u = np.where(np.arange(600) < 300, 0.5, size)
    held = (record(u, 12 * u, name="far", use="hold-out"),)
    rungs = (Rung("base", start), Rung("asymmetry", after))
    box = black_box(compared_records(start), floor.rms)
    shown = score_hold_out(FitResult(base, after, floor, box, rungs), held)
    assert [item["record"] for item in shown.content["runs_away"]] == ["far"]
    assert shown.content["runs_away"][0]["from_s"] == pytest.approx(0.3)
    assert np.isnan(shown.outputs[0][1]).all()
    assert shown.content["gap"]["after"] is None


def test_a_simulator_may_refuse_what_an_effect_sends_it():
    """It takes the held-out input as it is, but not with the effect before it."""
    simulator = block("external", function="tests.gap.holdout.test_runs_away:narrow")
    base, start, after, floor = squared(0.05, simulator)
    t = np.arange(600) / 600
    held = tuple(
        record(size * np.sin(20 * t), 12 * t, name=name, use="hold-out")
        for name, size in (("near", 0.5), ("far", 1.0))
    )
    rungs = (Rung("base", start), Rung("asymmetry", after))
    box = black_box(compared_records(start), floor.rms)
    shown = score_hold_out(FitResult(base, after, floor, box, rungs), held)
    (away,) = shown.content["runs_away"]
    assert (away["record"], away["from_s"]) == ("far", 0.0)
    assert "it raised ValueError: current beyond 1 A" in away["refused"]
    assert away["sentence"] == (
        f"simulator with asymmetry cannot be run on far: {away['refused']}, and "
        "nothing of the gap counts as closed."
    )
    assert shown.content["gap"]["after"] is None
    assert np.isfinite(shown.outputs[0][1]).all()
    assert np.isnan(shown.outputs[1][1]).all()


def test_the_bound_is_some_times_as_far_as_the_base_goes():
    one = record(np.zeros(3), name="rests")
    usual = reach([np.array([0.0, -2.0, 1.0]), np.zeros(3)], 0.5)
    assert usual == 2.5
    inside = np.array([0.0, -RUNS_AWAY_RATIO * usual, RUNS_AWAY_RATIO * usual])
    assert bounded("m", [one], [inside], usual) == ([inside], [])
    kept, found = bounded("m", [one], [inside * (1 + 1e-9)], usual)
    assert kept == [None]
    (away,) = found
    assert (away["record"], away["from_s"]) == ("rests", pytest.approx(one.dt))
    assert away["refused"] is None

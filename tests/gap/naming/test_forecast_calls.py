"""A simulator that is a function: how often it is called, what a bound leaves."""

import json

import numpy as np
import pytest
import yaml

from hystbench.blocks.calls import Calls, counted
from hystbench.blocks.sensor_lag import SensorLag
from hystbench.errors import InputError
from hystbench.gap.bases.load import load_base
from hystbench.gap.fitting.on_records import start_state
from hystbench.gap.naming.forecast_calls import calls_of_a_round, foretell
from hystbench.gap.records.evidence import Evidence
from hystbench.model import Model
from tests.gap.closing import close_gap
from tests.gap.conftest import without_rendering
from tests.gap.made import CURRENT, record

RATE = 1000.0
MADE: list[int] = []
"""ViewSamples of each call that was made."""


def bent(u, dt):
    """A curve without memory."""
    MADE.append(len(u))
    return 10 * np.tanh(0.6 * u)


def drawn(u, dt):
    return bent(u, dt) + 1e-9 * np.random.default_rng().standard_normal()


KEPT = [0.0]


def goes_on(u, dt):
    """Starts where the call before ended."""
    y = bent(u, dt) + KEPT[0]
    KEPT[0] = float(y[-1])
    return y


NAME = "tests.gap.naming.test_forecast_calls:bent"


def evidence():
    """Records of the same curve behind a lag of 4 ms, with noise."""
    rng = np.random.default_rng(0)
    time = np.arange(400) / RATE
    found = []
    for name, hz, use in (("a", 5, "fit"), ("b", 31, "fit"), ("c", 17, "hold-out")):
        u = np.sin(2 * np.pi * hz * time + 0.3)
        pole = np.exp(-1 / RATE / 0.004)
        v = np.zeros_like(u)
        for k in range(1, len(u)):
            v[k] = pole * v[k - 1] + (1 - pole) * u[k - 1]
        y = 10 * np.tanh(0.6 * v) + 0.02 * rng.standard_normal(len(u))
        found.append(record(u, y, name=name, use=use, dt=1 / RATE))
    return Evidence("rig", tuple(found[:2]), tuple(found[2:]))


BOUND = 60


@pytest.fixture(scope="module")
def bounded(tmp_path_factory):
    """A search that a bound ends in its first round: its folder, and calls made."""
    folder = tmp_path_factory.mktemp("bounded")
    MADE.clear()
    said: list[str] = []
    given = evidence()
    with counted(Calls(bound=BOUND)), without_rendering():
        base, _ = load_base(NAME, given)
        close_gap(given, base, folder, place=NAME, say=said.append)
    return folder, len(MADE), said


def test_no_more_calls_are_made_than_are_allowed(bounded):
    assert 0 < bounded[1] <= BOUND


def test_a_search_that_calls_ended_says_so_everywhere(bounded):
    folder, _, said = bounded
    gap = json.loads((folder / "gap.json").read_text())
    assert gap["calls_used_up"]["bound"] == BOUND
    told = f"the {BOUND} calls of the simulator that --calls allows were used up"
    assert told in gap["calls_used_up"]["sentence"]
    assert told in gap["reason"]
    assert told in (folder / "report.html").read_text()
    assert any("the search ends here" in line for line in said)


def test_effects_that_could_not_be_judged_are_named_and_none_of_them_is_taken(bounded):
    """A lag before the curve needs calls, one behind it none."""
    gap = json.loads((bounded[0] / "gap.json").read_text())
    assert {"drive-lag", "slew-limit", "dead-zone"} <= set(gap["not_tried"])
    assert "sensor-lag" not in gap["not_tried"]
    behind = {"mechanics", "sensor", "material"}
    assert {item["place"] for item in gap["effects"]} <= behind
    tried = {x["name"] for x in gap["ranking"] if "score" in x}
    assert "sensor-lag" in tried


def test_the_model_tells_what_it_needs(bounded):
    gap = json.loads((bounded[0] / "gap.json").read_text())
    assert gap["model"] == NAME  # the user's own name
    assert gap["simulator"]["functions"] == [NAME]
    assert gap["simulator"]["runs_again"]
    model = yaml.safe_load((bounded[0] / "model.yaml").read_text())
    assert {"external": {"function": NAME}} in model["chain"]


@pytest.mark.parametrize("bound", [1, 3, 10])
def test_too_few_calls_are_refused_in_one_line(bound, tmp_path):
    MADE.clear()
    given = evidence()

    def run():
        with counted(Calls(bound=bound)):
            close_gap(given, load_base(NAME, given)[0], tmp_path / "out")

    with pytest.raises(InputError, match=r"--calls.*expected") as told:
        run()
    assert "\n" not in str(told.value)
    assert len(MADE) <= bound
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("function", ["drawn", "goes_on"])
@pytest.mark.parametrize("as_file", [False, True])
def test_a_function_that_gives_another_output_is_refused(function, as_file, tmp_path):
    name = f"tests.gap.naming.test_forecast_calls:{function}"
    if as_file:
        content = {
            "name": "rig",
            "input": {"name": CURRENT.name, "unit": CURRENT.unit},
            "output": {"name": "displacement", "unit": "um"},
            "chain": [{"gain": {"value": 1.0}}, {"external": {"function": name}}],
        }
        (tmp_path / "m.yaml").write_text(yaml.safe_dump(content))
        name = str(tmp_path / "m.yaml")
    with counted(Calls()), pytest.raises(InputError, match="gave another output"):
        load_base(name, evidence())


class Clock:
    """A clock by which every call takes the same time, in seconds."""

    def __init__(self, step):
        self.now, self.step = 0.0, step

    def __call__(self):
        self.now += self.step
        return self.now


def test_what_slow_work_will_take_is_told_before():
    said: list[str] = []
    given = evidence()
    with counted(Calls(bound=700, clock=Clock(0.1))) as calls:
        base, _ = load_base(NAME, given)
        start, _ = start_state(given.fit, base, given.input_hold)
        foretell(start, said.append)
        one = calls_of_a_round(start)
    (line,) = said
    assert line.startswith("0.1 s a call of the simulator; an estimate: about ")
    assert f"about {one:,} calls for each effect that is added" in line
    assert f"{calls.expected:,} calls" in line
    assert line.endswith("minutes at the most; --calls stops at 700")


def test_quick_work_is_not_told_of():
    said: list[str] = []
    given = evidence()
    with counted(Calls(clock=Clock(1e-4))):
        base, _ = load_base(NAME, given)
        start, _ = start_state(given.fit, base, given.input_hold)
        foretell(start, said.append)
    assert not said


def test_a_model_without_a_function_has_no_calls():
    given = evidence()
    output = given.fit[0].output
    base = Model("rig", CURRENT, output, (SensorLag(time_constant_s=0.004),))
    start, _ = start_state(given.fit, base, given.input_hold)
    assert calls_of_a_round(start) == 0

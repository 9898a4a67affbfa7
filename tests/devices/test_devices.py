"""The paper's models on devices: what is fitted, never seen, and counted."""

import json
import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from click.testing import CliRunner

from hystbench.commands.jobs.devices import devices
from hystbench.dataset import load_dataset
from hystbench.devices.errors import (
    DeviceError,
    best_fractions,
    fixed_weights,
    output,
    tracked,
)
from hystbench.devices.tables import baselines, published_order, verdict
from hystbench.filters import FILTERS, MOST_CORRECTION
from hystbench.record import Channel, Record
from tests.conftest import table
from tests.gap.tiny import write_tiny

TAPS = np.array([0.5, -0.2, 0.1, 0.7])
FRACTIONS = (0.01, 0.1, 1.0)


def made(seed, gain=1.0):
    u = gain * np.random.default_rng(seed).standard_normal(3000)
    y = np.convolve(u, TAPS)[: len(u)]
    about = (Channel("input", "V"), Channel("output", "um"), "measured")
    return Record(f"record-{seed}", 1e-3, u, y, *about)


def delayed(step=0.01):
    return FILTERS["delayed"](order=len(TAPS) - 1, step_size=step)


def test_fixed_weights_are_those_of_the_device():
    weights = fixed_weights(delayed(), [made(1), made(2)])
    assert weights == pytest.approx(TAPS, abs=1e-6)
    other = made(3)
    assert output(delayed(), other, weights) == pytest.approx(other.y, abs=1e-5)


def test_a_filter_that_diverges_has_no_error():
    record = made(1)
    assert tracked([delayed()], [record])[0][-1] == pytest.approx(0, abs=1e-6)
    assert tracked([delayed(10.0)], [record]) is None


def test_a_step_size_keeps_its_margin_on_the_inputs_held_out():
    """A burst in the input held out: the step that is best elsewhere is too long."""
    fit, calm = [made(1), made(2)], made(3)
    burst = calm.u.copy()
    burst[:4] = 8.0
    loud = replace(calm, u=burst)
    free = best_fractions(delayed(), fit, [calm], FRACTIONS)["mu"]
    held = best_fractions(delayed(), fit, [loud], FRACTIONS)["mu"]
    assert held < free

    def correction(fraction):
        item = delayed(fraction * delayed().bound(loud.u).bound)
        return item.correction(item.largest_power(loud.u))

    assert correction(held) < MOST_CORRECTION < correction(free)


def test_no_output_held_out_chooses_a_step_size():
    fit, held = [made(1)], made(3)
    other = replace(held, y=-7 * held.y[::-1].copy())
    chosen = [
        best_fractions(delayed(), fit, [item], FRACTIONS) for item in (held, other)
    ]
    assert chosen[0] == chosen[1]


def errors(dataset, how, question="tracking", **rms):
    return [
        DeviceError(dataset, name, question, how, value, value, "um")
        for name, value in rms.items()
    ]


def test_the_verdict_counts_firsts_and_pairs():
    first, second, *_ = order = published_order()
    as_printed = dict(zip(order, (1.0, 2.0, 3.0, 4.0), strict=True))
    swapped = {**as_printed, first: 2.0, second: 1.0}
    said = verdict(
        [
            *errors("here", "a tenth", **as_printed),
            *errors("there", "a tenth", **swapped),
            *errors("here", "", **{"last-output": 0.5}),
            *errors("there", "", **{"last-output": 1.5}),
            *errors("here", "fixed", "simulation", **as_printed),
            *errors("there", "fixed", "simulation", **as_printed),
        ]
    )
    assert f"the {first} filter is first on 1 of 2 devices (here), and 11 of 12" in said
    assert f"the {first} filter is first on 2 of 2 devices (here, there)" in said
    assert "On 1 of 2 devices the best filter" in said


def test_the_published_order_begins_with_the_papers_own_filter():
    assert published_order()[0] == "gpo"


def test_ten_published_baselines_of_each_set():
    rows = baselines()
    sets = {row["dataset"] for row in rows}
    assert sets == {"wiener-hammerstein", "cascaded-tanks", "emps"}
    for name in sets:
        own = [row for row in rows if row["dataset"] == name]
        assert len({row["model"] for row in own}) == len(own) == 10
        assert len({row["unit"] for row in own}) == 1
        assert all(float(row["rms"]) > 0 for row in own)


def settings():
    job = {"order": 3, "input_before": 0.0, "constant_tap": 0.0}
    job["fraction_of_bound"] = 0.1
    play = {"initial_state": "zero"}
    filters = {
        "gpo": job | play | {"operator_form": "eq12", "envelopes": "identified"},
        "backlash": job | play | {"backlash_structure": "delay-line"},
        "volterra": job,
        "delayed": job,
    }
    slow = {"tolerable_relative_error": 0.01, "order": 3, "max_iterations": 20}
    return {
        "filters": filters,
        "fractions": FRACTIONS,
        "constant_tap": 1.0,
        "identification": slow | {"starts": 1, "seed": 1},
        "rdgpi": {"starts": 1, "seed": 1},
    }


def test_the_command_writes_tables_of_both_questions(tmp_path):
    data, _ = write_tiny(tmp_path)
    (tmp_path / "gaps.csv").write_text(
        "dataset,base,verdict,effects,unit,before,after\n"
        "tiny,rig,named,drive-lag,um,0.2,0.02\n"
    )
    words = [str(data), "--settings", json.dumps(settings())]
    words += ["--gaps", str(tmp_path / "gaps.csv"), "--out", str(tmp_path / "out")]
    result = CliRunner().invoke(devices, words)
    assert result.exit_code == 0, result.output
    rows = table(tmp_path / "out" / "errors.csv")
    asked = {(row["model"], row["question"]) for row in rows}
    assert {question for _, question in asked} == {"tracking", "simulation"}
    assert ("rdgpi", "tracking") not in asked
    (held,) = [load_dataset(data).read("unseen")]
    steps = [0.0, *held.y.tolist()]
    last = math.sqrt(np.mean([(b - a) ** 2 for a, b in pairwise(steps)]))
    (told,) = [row["rms"] for row in rows if row["model"] == "last-output"]
    assert float(told) == pytest.approx(last, rel=1e-3)
    simulation = (tmp_path / "out" / "simulation.csv").read_text()
    assert simulation.splitlines()[1].endswith("rig,0.2,0.02,drive-lag")

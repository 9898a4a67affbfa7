"""What stands around a simulator of one's own, as code beside it."""

import numpy as np
import pytest

from hystbench.blocks.step import Sampling
from hystbench.commands.export import part_of
from hystbench.errors import InputError
from hystbench.export.code import loaded
from hystbench.export.described import describe
from tests.blocks.examples import EXAMPLES, twice
from tests.conftest import run_hystbench

from .test_steps import DT, INPUT, chain_of, model_of

OWN = ("external", EXAMPLES["external"])
LAG = ("sensor-lag", EXAMPLES["sensor-lag"])
LIMIT = ("drive-saturation", EXAMPLES["drive-saturation"])


def code_of(model, part):
    return loaded(describe(part_of(model, part), Sampling(DT)))


def test_the_simulator_between_its_parts_is_the_whole_model():
    model = model_of("rig", chain_of(LIMIT, OWN, LAG))
    before, behind = code_of(model, "before"), code_of(model, "behind")
    y = behind.simulate(twice(before.simulate(INPUT), DT))
    wanted = model.simulate(INPUT, DT)
    np.testing.assert_allclose(y, wanted, rtol=0, atol=1e-9 * np.ptp(wanted))


def test_a_part_says_what_enters_and_what_leaves():
    model = model_of("rig", chain_of(LIMIT, OWN, LAG))
    before, behind = part_of(model, "before"), part_of(model, "behind")
    assert (before.input, before.output.label) == (model.input, "input of external (A)")
    assert (behind.input.label, behind.output) == (
        "displacement of external (um)",
        model.output,
    )


@pytest.mark.parametrize(
    ("blocks", "part", "said"),
    [
        ((LIMIT, LAG), "behind", "--part: 0 simulators"),
        ((OWN, OWN, LAG), "behind", "--part: 2 simulators"),
        ((OWN, LAG), "before", "--part before: no block stands before external"),
        ((LIMIT, OWN), "behind", "--part behind: .* external; expected --part before$"),
        ((OWN,), "behind", "--part behind: .*; expected another model"),
    ],
)
def test_a_part_that_is_none_is_refused(blocks, part, said):
    with pytest.raises(InputError, match=f"^{said}"):
        part_of(model_of("rig", chain_of(*blocks)), part)


def test_the_command_writes_a_part_and_refuses_what_looks_past_the_simulator(tmp_path):
    file = tmp_path / "model.yaml"
    asked = ("export", file, "--to", "python", "--dt", DT, "--out", tmp_path / "code")
    model_of("rig", chain_of(OWN, LAG)).save(file)
    done = run_hystbench(*asked, "--part", "behind")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "code" / "rig_behind_external.py").is_file()
    friction = ("friction", EXAMPLES["friction"])
    model_of("rig", chain_of(OWN, friction)).save(file)
    done = run_hystbench(*asked, "--part", "behind")
    assert done.returncode == 2
    assert done.stderr == (
        "hystbench: --part behind: friction: looks at the model's input, which does "
        "not enter there; expected blocks that take the simulator's output alone\n"
    )

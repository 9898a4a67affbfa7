"""A simulator is tried on all records before a search is paid."""

import numpy as np
import pytest

from hystbench.errors import InputError
from hystbench.inspection.simulator import simulator_line
from hystbench.model import Model
from hystbench.record import Channel
from tests.conftest import run_hystbench
from tests.gap.made import CURRENT, DISPLACEMENT, record, write_folder
from tests.gap.small import block

T = np.arange(400) / 1000


@pytest.fixture
def rig(tmp_path):
    u = np.sin(2 * np.pi * 5 * T)
    made = [
        record(u, 3.0 * u + 1.0, name="a"),
        record(0.5 * u, 1.5 * u + 1.0, name="b", use="hold-out"),
    ]
    write_folder(tmp_path / "rig", made)
    return tmp_path


def saved(folder, *blocks, name="base"):
    Model(name, CURRENT, DISPLACEMENT, blocks).save(folder / f"{name}.yaml")
    return str(folder / f"{name}.yaml")


def test_it_says_what_is_left_beside_what_the_output_moves_by(rig):
    """Of a gain of two for three, and no offset: rms of ``sin + 1``."""
    model = saved(rig, block("gain", value=2.0))
    line = simulator_line(rig / "rig" / "dataset.yaml", model)
    left, moves = np.sqrt(0.5 + 1.0), 3.0 * np.sqrt(0.5)
    assert f"leaves {left:.3g} um rms" in line
    assert f"move by {moves:.3g} um rms" in line


def test_a_model_of_other_signals_is_refused(rig):
    other = Channel("voltage", "V")
    Model("other", other, DISPLACEMENT, (block("gain", value=2.0),)).save(
        rig / "other.yaml"
    )
    with pytest.raises(InputError, match=r"input: unit 'V', but .* has 'A'"):
        simulator_line(rig / "rig" / "dataset.yaml", str(rig / "other.yaml"))


def test_the_command_says_it_first(rig):
    model = saved(rig, block("gain", value=2.0))
    data = str(rig / "rig" / "dataset.yaml")
    done = run_hystbench("check", data, "--no-effects", "--model", model)
    assert done.returncode == 0, done.stderr
    assert "it runs on all records" in done.stdout.splitlines()[0]

"""``hystbench held-out``: no figure before a choice among what was tried."""

import pytest

from hystbench.commands.held_out import held_out
from hystbench.errors import InputError
from hystbench.files import write_json


def test_a_choice_that_was_not_tried_is_refused(tmp_path):
    write_json(tmp_path / "creep.json", {"name": "creep", "score": 1.0})
    (tmp_path / "choice.yaml").write_text("chosen: {name: crep}\n")
    out = tmp_path / "held-out.csv"
    arguments = [str(tmp_path / "creep.json"), "--settings", "{}", "--out", str(out)]
    arguments += ["--choice", str(tmp_path / "choice.yaml")]
    with pytest.raises(InputError, match="'crep' was not tried"):
        held_out.main(arguments, standalone_mode=False)
    assert not out.exists()

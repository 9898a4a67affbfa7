"""A command's parameters follow from its signature."""

from functools import partial

import pytest
from click.testing import CliRunner

from hystbench.options import In, Json, Out, Settings, SettingsType, command

told = []


@partial(command, also=dict.fromkeys(("left", "right_side"), (In, None)))
def made(
    first: In,
    others: tuple[In, ...] = (),
    *,
    runs: tuple[Json, ...],
    settings: Settings,
    count: int = 3,
    out: Out | None = None,
    **files: In | None,
) -> None:
    """Make something of FIRST."""
    told[:] = [first.name, len(others), *runs, settings, count, out, files]


def test_names_places_and_defaults_are_those_of_the_signature(tmp_path):
    file = tmp_path / "one.json"
    file.write_text("[1]")
    call = partial(CliRunner().invoke, made)
    words = [str(file), str(file), "--run", str(file), "--run", str(file)]
    words += ["--settings", '{"mu": 1}', "--right-side", str(file)]
    assert call(words).exit_code == 0
    files = {"left": None, "right_side": file}
    assert told == ["one.json", 1, [1], [1], {"mu": 1}, 3, None, files]
    for missing, said in ((words[1:2], "--run"), (words[2:], "FIRST")):
        assert f"{said}'" in call(missing).output
    assert "Make something of FIRST." in call(["--help"]).output


def test_settings_are_a_json_object():
    kind = SettingsType()
    assert kind.convert('{"mu": 1}', None, None) == {"mu": 1}
    for text in ["{", "[1]"]:
        with pytest.raises(Exception, match="JSON"):
            kind.convert(text, None, None)

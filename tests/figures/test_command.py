"""``hystbench job figure``, as the workflow calls it."""

import pytest
from click.testing import CliRunner

from hystbench.commands.jobs.figure import figure
from hystbench.errors import InputError

OPTIONS = {
    "records": "--record",
    "runs": "--run",
    "table": "--table",
    "identified": "--identified",
}


def words(given):
    found = []
    for key, files in given.items():
        for file in files if isinstance(files, list) else [files]:
            found += [OPTIONS[key], str(file)]
    return found


def call(*arguments):
    return CliRunner().invoke(figure, list(arguments), catch_exceptions=False)


#: One of each sort of input; all are drawn elsewhere.
SOME = ("figure-07-order", "figure-10-sum", "identification")


@pytest.mark.parametrize("name", SOME)
def test_writes_every_out_and_the_same_bytes_each_time(name, inputs, tmp_path):
    given = words(inputs.of(name))
    contents = []
    for folder in (tmp_path / "one", tmp_path / "other"):
        outs = [folder / "figure.png", folder / "figure.svg"]
        result = call(name, *given, "--out", str(outs[0]), "--out", str(outs[1]))
        assert result.exit_code == 0, result.output
        contents.append([out.read_bytes() for out in outs])
    assert contents[0] == contents[1]
    png, svg = contents[0]
    assert png.startswith(b"\x89PNG")
    assert b"<svg" in svg


def test_missing_input_is_named(inputs, tmp_path):
    given = words({"records": inputs.of("loops")["records"]})
    with pytest.raises(InputError, match=r"figure loops: expected --run"):
        call("loops", *given, "--out", str(tmp_path / "a.png"))
    assert not list(tmp_path.iterdir())


def test_input_that_is_not_used_is_refused(inputs, tmp_path):
    given = words({"table": inputs.of("errors-heat-map")["table"]})
    with pytest.raises(InputError, match="does not use --table"):
        call("figure-03-play", *given, "--out", str(tmp_path / "a.png"))


def test_unknown_figure(tmp_path):
    with pytest.raises(InputError, match="no figure 'loop'"):
        call("loop", "--out", str(tmp_path / "a.png"))

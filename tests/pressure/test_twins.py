"""Reading twins: families, readings beside them, and what is refused."""

import json

import pytest
import yaml

from hystbench.errors import InputError
from hystbench.pressure.twins import read_twin, read_twins

from .conftest import TWIN, write_twin


def test_a_twin_has_the_family_of_its_hysteresis(twin_file):
    twin = read_twin(twin_file)
    assert (twin.name, twin.family) == ("small", "gpi")
    assert twin.readings == {}


def test_readings_lie_beside_the_model(twin_file):
    readings = {"input_zero_error": 0.01, "convergence_factor": {"gpo": {"mu": 1.0}}}
    twin_file.with_suffix(".json").write_text(json.dumps(readings))
    assert read_twin(twin_file).readings == readings


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('{"input_zero_eror": 1}', "did you mean 'input_zero_error'"),
        ("[1]", "expected a JSON object"),
        ("{", "not JSON"),
    ],
)
def test_bad_readings_are_refused(twin_file, text, told):
    twin_file.with_suffix(".json").write_text(text)
    with pytest.raises(InputError, match=told):
        read_twin(twin_file)


def test_a_twin_without_hysteresis_is_refused(tmp_path):
    path = tmp_path / "linear.yaml"
    path.write_text(yaml.safe_dump(TWIN | {"chain": TWIN["chain"][1:]}))
    with pytest.raises(InputError, match="no block makes hysteresis"):
        read_twin(path)


def test_two_twins_of_one_name_are_refused(tmp_path):
    (tmp_path / "other").mkdir()
    paths = [write_twin(tmp_path / "a.yaml"), write_twin(tmp_path / "other" / "a.yaml")]
    with pytest.raises(InputError, match="a second twin of the name 'a'"):
        read_twins(paths)

"""Reading twins: families and what is refused."""

import pytest
import yaml

from hystbench.errors import InputError
from hystbench.twins.runs import read_twins

from .conftest import TWIN, write_twin


def test_a_twin_has_the_family_of_its_hysteresis(twin_file):
    (twin,) = read_twins([twin_file])
    assert (twin.name, twin.family) == ("small", "gpi")


def test_a_twin_without_hysteresis_is_refused(tmp_path):
    path = tmp_path / "linear.yaml"
    path.write_text(yaml.safe_dump(TWIN | {"chain": TWIN["chain"][1:]}))
    with pytest.raises(InputError, match="no block makes hysteresis"):
        read_twins([path])


def test_two_twins_of_one_name_are_refused(tmp_path):
    (tmp_path / "other").mkdir()
    paths = [write_twin(tmp_path / "a.yaml"), write_twin(tmp_path / "other" / "a.yaml")]
    with pytest.raises(InputError, match="a second twin of the name 'a'"):
        read_twins(paths)

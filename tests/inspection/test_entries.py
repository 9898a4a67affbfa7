"""The lines of a dataset.yaml."""

import pytest

from hystbench.inspection.entries import entry_text
from hystbench.yaml_files import parse_yaml


@pytest.mark.parametrize("name", ["1e5", "2.6e4", "rig.csv", "yes", "a: b"])
def test_a_name_is_read_back_as_it_is(name):
    """A name that looks like a number stays a name."""
    entry = {"file": name, "use": "fit"}
    assert parse_yaml(entry_text(entry), "here") == entry

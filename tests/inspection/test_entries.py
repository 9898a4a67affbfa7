"""The lines of a dataset.yaml."""

from pathlib import Path

import pytest

import hystbench
from hystbench.inspection.entries import KEY_ORDER, entry_text
from hystbench.yaml_files import load_yaml, parse_yaml


@pytest.mark.parametrize("name", ["1e5", "2.6e4", "rig.csv", "yes", "a: b"])
def test_a_name_is_read_back_as_it_is(name):
    """A name that looks like a number stays a name."""
    entry = {"file": name, "use": "fit"}
    assert parse_yaml(entry_text(entry), "here") == entry


def test_a_key_that_has_no_place_in_the_order_stands_last():
    entry = {"temperature": 20, "use": "fit", "file": "rig.csv"}
    assert entry_text(entry) == "{file: rig.csv, use: fit, temperature: 20}"


def test_every_key_of_a_record_has_its_place_in_the_order():
    schema = load_yaml(Path(hystbench.__file__).with_name("dataset.yaml"))
    assert {*KEY_ORDER} == {*schema["properties"]["records"]["items"]["properties"]}

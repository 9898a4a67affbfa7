"""The model files that the page on them shows, whole."""

import re

import numpy as np
import pytest
import yaml

from hystbench.model import Model
from tests.conftest import ROOT

PAGE = (ROOT / "docs" / "model-files.md").read_text(encoding="utf-8")
SHOWN = {
    content["name"]: content
    for text in re.findall(r"^```yaml\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    if "name" in (content := yaml.safe_load(text))
}


@pytest.mark.parametrize("name", SHOWN)
def test_a_model_file_that_is_shown_is_one(name):
    assert Model.from_mapping(SHOWN[name], "m.yaml").name == name


def test_what_the_upper_tank_spills_is_caught_by_the_lower():
    tanks = Model.from_mapping(SHOWN["two-tanks"], "m.yaml")
    level = tanks.simulate(np.full(1000, 2.0), 0.5)
    # Full to 10 cm; of what comes in beyond its outflow 0.6 goes on.
    outflow = 0.3 * np.sqrt(10.0)
    inflow = outflow + 0.6 * (0.5 * 2.0 - outflow)
    assert level[-1] == pytest.approx((inflow / 0.35) ** 2, rel=1e-4)

"""The commands that the pages of export and inverse show run as they are written."""

import re
import shlex
import shutil

import numpy as np
import pytest

from tests.conftest import ROOT, run_hystbench

TWIN = ROOT / "src" / "hystbench" / "plants" / "gma.yaml"
#: Commands of each page.
PAGES = {"export.md": 1, "inverse.md": 2}


@pytest.mark.parametrize("page", PAGES)
def test_the_commands_of_a_page_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(TWIN, "model.yaml")
    time = np.arange(1000) * 1e-4
    np.savetxt(
        "wanted.csv",
        np.column_stack([time, 7 * np.sin(2 * np.pi * 50 * time)]),
        delimiter=",",
        header="time_s,displacement_um",
        comments="",
    )
    text = (ROOT / "docs" / page).read_text()
    shown = re.findall(r"^hystbench (.*)$", text, re.MULTILINE)
    assert len(shown) == PAGES[page]
    for line in shown:
        words = shlex.split(line)
        done = run_hystbench(*words)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / words[words.index("--out") + 1]).exists()

"""From a stranger's MATLAB v7.3 file to a page, in three commands and no editing."""

import json
import shutil
from pathlib import Path

import pytest

from hystbench import cli
from tests.blocks.simulators import compiled

FILES = Path(__file__).parents[1] / "formats" / "files"
#: The drive of the rig; that the joint has play the simulator does not know.
SIMULATOR = """
#include <math.h>
#include <stdio.h>
int main(void) {
    double t, u; char header[99];
    if (!fgets(header, 99, stdin)) return 1;
    while (scanf("%lf,%lf", &t, &u) == 2) printf("%.17g\\n", 5 * tanh(u / 1.2));
    return 0;
}
"""


def test_a_strangers_file_and_a_program_of_c(tmp_path, monkeypatch, capsys):
    pytest.importorskip("h5py", reason="h5py is not installed")
    compiled(tmp_path, SIMULATOR)
    shutil.copy(FILES / "stranger.mat", tmp_path)
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        monkeypatch.setattr("sys.argv", ["hystbench", *arguments])
        assert cli.run() == 0
        return capsys.readouterr()

    run("init", "stranger.mat")
    said = run("check", "dataset.yaml", "--no-effects", "--out", "check.html").out
    assert "measured by repeats" in said
    assert "to add" not in said
    said = run(
        *("gap", "dataset.yaml", "--model", "command: ./program"),
        *("--out", "gap", "--calls", "60", "--no-keep-calls"),
    )
    assert "gap/gap.json: named: backlash" in said.out
    found = json.loads(Path("gap/gap.json").read_text())
    # The rig was made with a play of 0.15 to either side.
    (effect,) = found["effects"]
    assert effect["parameters"]["half_width"]["value"] == pytest.approx(0.15, rel=0.05)
    assert found["gap"]["floor_method"] == "repeats"
    assert "60 calls" in found["calls_used_up"]["sentence"]
    assert Path("gap/report.html").stat().st_size > 10_000
    assert Path("check.html").stat().st_size > 10_000

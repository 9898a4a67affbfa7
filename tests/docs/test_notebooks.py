"""The notebooks run from top to bottom, and are kept without what they print.

Their code cells are run here in one namespace, in this process, as a kernel would run
them: so no Jupyter is needed, and nothing but the cells takes time.
"""

import ast
import json
from pathlib import Path

import numpy as np
import pytest

FOLDER = Path(__file__).parents[2] / "docs" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))


def cells(path, kind):
    content = json.loads(path.read_text(encoding="utf-8"))
    return [cell for cell in content["cells"] if cell["cell_type"] == kind]


def run(name, monkeypatch):
    """Run a notebook from its own folder; give its names and what its cells show."""
    monkeypatch.chdir(FOLDER)
    space = {"__name__": "__main__"}
    shown = []
    for number, cell in enumerate(cells(FOLDER / name, "code")):
        tree = ast.parse("".join(cell["source"]), f"{name}, code cell {number + 1}")
        last = tree.body[-1]
        if isinstance(last, ast.Expr):
            tree.body.pop()
        exec(compile(tree, f"{name}, cell {number + 1}", "exec"), space)  # noqa: S102
        if isinstance(last, ast.Expr):
            code = compile(ast.Expression(last.value), name, "eval")
            shown.append(eval(code, space))  # noqa: S307
    return space, shown


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_is_kept_without_outputs(path):
    content = json.loads(path.read_text(encoding="utf-8"))
    assert (content["nbformat"], content["nbformat_minor"]) == (4, 5)
    names = [cell["id"] for cell in content["cells"]]
    assert len({*names}) == len(names)
    for cell in cells(path, "code"):
        assert (cell["outputs"], cell["execution_count"]) == ([], None)


def test_there_are_two_notebooks():
    assert [path.stem for path in NOTEBOOKS] == ["own-data", "paper"]


def test_your_own_data_in_ten_minutes(monkeypatch):
    before = sorted(FOLDER.iterdir())
    space, shown = run("own-data.ipynb", monkeypatch)
    assert [effect.name for effect in space["gap"].effects] == ["drive-lag"]
    assert "drive-lag" not in {effect.name for effect in space["without"].effects}
    assert space["put_in"].effects == ()
    assert space["put_in"].content["built_in"]
    # What is left of the device is its noise.
    assert shown[-1] == pytest.approx(space["noise"], rel=0.1)
    assert "gap.json" in shown[-2]
    assert sorted(FOLDER.iterdir()) == before


def test_the_paper_in_ten_minutes(monkeypatch):
    space, shown = run("paper.ipynb", monkeypatch)
    assert "Model gma" in repr(shown[0])
    table = space["table"]
    assert len(table) == len(space["signals"]) * 4
    assert np.isfinite(table["ours"]).all()
    # The twin and the step sizes are calibrated to such errors, within a factor of two.
    near = np.abs(np.log(table["ours"] / table["paper"])) < np.log(2)
    assert near[~table["held out"]].mean() > 0.8
    assert {*table["signal"][table["held out"]]} == {"chirp-1-100hz"}
    assert {*space["first"]} == {"gpo"}

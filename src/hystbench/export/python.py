"""A model as a Python module, which compiles and calls the C beside it."""

import importlib.util
from pathlib import Path
from textwrap import wrap
from typing import Any

from hystbench.errors import InputError
from hystbench.export import c
from hystbench.export.described import Described
from hystbench.export.names import filled
from hystbench.scratch import scratch_folder


def files(model: Described) -> dict[str, str]:
    """Give the text of the module and of the C that it calls, by their names."""
    return {f"{model.name}.py": module(model), **c.files(model)}


def module(model: Described) -> str:
    """Write the module: a class ``Model`` that keeps the state of the C."""
    told = [f"{model.title}: {model.about}.", *model.differences]
    lines = [_quoted(line) for said in told for line in wrap(said, c.WIDTH - 4)]
    return filled("module.txt", model=model, told=lines, states=c.states(model))


def loaded(model: Described) -> Any:
    """Give the exported ``Model``, new, as one who imports the module makes it.

    Raises
    ------
    InputError
        If there is no C compiler.
    """
    with scratch_folder("export-") as folder:
        for name, text in files(model).items():
            Path(folder, name).write_text(text, encoding="utf-8")
        place = Path(folder, f"{model.name}.py")
        found = importlib.util.spec_from_file_location(model.name, place)
        assert found is not None and found.loader is not None  # noqa: S101, PT018
        made = importlib.util.module_from_spec(found)
        try:
            found.loader.exec_module(made)
        except FileNotFoundError as error:
            raise InputError(
                f"no C compiler {error.filename!r}; expected one, or its name in CC"
            ) from error
        return made.Model()


def _quoted(line: str) -> str:
    """Write a line so that it neither ends a docstring nor escapes anything in it."""
    return line.replace("\\", "\\\\").replace('"', '\\"')

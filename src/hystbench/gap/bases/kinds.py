"""What ``--model`` may be: a model file, a word, or a simulator by its name.

Read before any work is paid; it imports no more than a model file needs.
"""

from __future__ import annotations

import ast
import os
from pathlib import Path
from typing import Literal

from hystbench.blocks.external import FORM
from hystbench.errors import InputError, nearest
from hystbench.model import load_model
from hystbench.text_files import read_text

IDENTIFIED = ("gpi", "linear")
"""Words for a base that is identified from the fit records."""
WORDS = (*IDENTIFIED, "column")
"""What may stand in the place of a model file."""

BaseKind = Literal["word", "file", "function", "command", "fmu", "onnx"]

COMMAND = "command:"
"""What stands before the command line of a simulator."""


def kind_of_base(text: str) -> BaseKind:
    """Tell what kind of base is asked for.

    Raises
    ------
    InputError
        If it is none, with what is near it.
    """
    if text in WORDS:
        return "word"
    if text.startswith(COMMAND):
        return "command"
    if text.endswith(".fmu"):
        return "fmu"
    if text.endswith(".onnx"):
        return "onnx"
    if text.endswith(".py") or ".py:" in text:
        raise InputError(_name_of_function(text))
    if Path(text).is_file() or text.endswith((".yaml", ".yml")):
        return "file"
    if FORM.fullmatch(text):
        return "function"
    if Path(text).is_dir():
        raise InputError(f"--model: {text!r} is a folder; expected a model file in it")
    files = [str(item) for item in Path(text).parent.glob("*.y*ml")]
    raise InputError(
        f"--model: {text!r} is no model file, .fmu or .onnx, none of "
        f"{', '.join(WORDS)}, no package.module:function and no 'command: ...'; "
        f"{nearest(text, [*WORDS, *files])}"
    )


def check_base(text: str) -> None:
    """Refuse what is no base, or a model file that holds no model.

    Raises
    ------
    InputError
        As :func:`kind_of_base` and :func:`hystbench.model.load_model` do.
    """
    if kind_of_base(text) == "file":
        load_model(text)


def _name_of_function(text: str) -> str:
    """Tell how to name a function where its file is named; the file is only parsed."""
    path, _, wanted = text.partition(":")
    functions: list[str] = []
    if Path(path).is_file():
        content = read_text(path, "Python code")
        try:
            found = ast.parse(content).body
        except (SyntaxError, ValueError) as error:
            return f"{path}: {error}; expected Python code"
        public = [
            item
            for item in found
            if isinstance(item, ast.FunctionDef) and not item.name.startswith("_")
        ]
        functions = [item.name for item in sorted(public, key=_takes_others)]
    place = Path(os.path.relpath(path)).with_suffix("")
    above = ".." in place.parts
    module = place.name if above else ".".join(place.parts)
    named = [wanted] if wanted in functions else functions or ["function"]
    names = " or ".join(repr(f"{module}:{name}") for name in named)
    also = f", started in the folder {str(Path(path).parent)!r}" if above else ""
    return (
        f"--model: {text!r} is a file of Python code; expected the name of a function "
        f"in it, package.module:function, here {names}{also}"
    )


def _takes_others(function: ast.FunctionDef) -> bool:
    """Tell whether a function cannot be called with u and dt alone."""
    own = function.args
    most = len(own.posonlyargs) + len(own.args)
    least = most - len(own.defaults)
    named = any(default is None for default in own.kw_defaults)
    return named or least > 2 or (most < 2 and own.vararg is None)

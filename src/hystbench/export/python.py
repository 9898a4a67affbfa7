"""A model as one Python module that needs NumPy alone."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from textwrap import indent, wrap
from types import ModuleType
from typing import Any

import numpy as np

from hystbench.export.described import Described, Language, Piece, needed
from hystbench.export.names import filled

LIBRARY = tuple(
    Path(__file__).with_name(f"{name}.py")
    for name in ("steps", "hysteresis_steps", "forces", "inside", "inverse_steps")
)
WIDTH = 88


def module(model: Described) -> str:
    """Write the module: constants, functions, and the class ``Model``."""
    chunks = _library()
    told = [f"{model.title}: {model.about}.", *model.differences]
    text = "\n".join(_quoted(line) for said in told for line in wrap(said, WIDTH - 4))
    constants = [text for piece in model.all_pieces() for text in _constants(piece)]
    constants += [
        _array(f"{name.upper()}_START", value) for name, value in model.starts.items()
    ]
    reset = [
        f"self.{name} = {name.upper()}_START.copy()"
        if name in model.starts
        else f"self.{name} = np.zeros({size})"
        for name, size in model.all_states()
    ]
    together = ""
    if any(map(_takes_together, model.all_pieces())):
        together = "from types import SimpleNamespace\n"
    steps = [
        f"remember({piece.step.constants['points']}, self.{piece.history}, y)"
        for piece in model.watching
    ]
    if model.sampling.delay:
        steps += ["call = self.calls[0]", "self.calls[0] += 1"]
    for piece in model.pieces:
        steps.append(f"y = {LANGUAGE.in_chain(piece, '1.0')}")
        if piece.wait:
            steps.append(f"if call < {piece.wait}:\n    return 0.0  # none yet")
    for piece in model.pieces:
        if piece.inner is not None:
            steps += [""]  # the methods below are part of the class
    methods = [
        _method(part)
        for piece in model.pieces
        if piece.inner is not None
        for part in piece.all_inside()
    ]
    body = filled(
        "model_class.txt",
        begins=model.begins,
        reset=indent("\n".join(reset or ["pass"]), " " * 8),
        steps=indent("\n".join(filter(None, steps)), " " * 8),
    )
    parts = [
        f'"""{text}\n"""\n\nimport math\n{together}\nimport numpy as np',
        f"DT = {model.sampling.dt!r}  # s",
        *constants,
        needed(chunks, model.functions).replace("\n\n", "\n\n\n"),
        "\n".join([body.rstrip(), *methods]),
    ]
    return "\n\n\n".join(filter(None, parts)) + "\n"


def loaded(model: Described) -> Any:
    """Give the exported ``Model``, new, as one who imports the module makes it."""
    made = ModuleType(model.name)
    exec(module(model), made.__dict__)  # noqa: S102 - our own text
    return made.Model()


def _quoted(line: str) -> str:
    """Write a line so that it neither ends a docstring nor escapes anything in it."""
    return line.replace("\\", "\\\\").replace('"', '\\"')


def _method(piece: Piece) -> str:
    """Write the method of hysteresis that is wrapped, or of what wraps it."""
    inner = piece.inner
    if inner is not None and piece.step.undoes:
        return _searched(piece, inner)
    lines = [f"return {LANGUAGE.inside(piece)}"]
    if inner is not None and piece.step.drives:
        lines = [
            f"y, inside = 0.0, {LANGUAGE.step(piece, piece.takes)}",
            "for v, growth in inside:",
            f"    y = {LANGUAGE.own(inner, inner.takes)}",
            "return y",
        ]
    opening = f"\ndef _{piece.label}(self, {', '.join(piece.takes)}):"
    return indent("\n".join([opening, *(f"    {line}" for line in lines)]), "    ")


def _searched(piece: Piece, inner: Piece) -> str:
    """Write the methods that look for the input of what is inside, and try one."""
    growth = f", self.{piece.label}_pace[3]" if inner.step.grows else ""
    states = [
        f"self.{part.label}_{state}"
        for part in inner.all_inside()
        for state in part.step.states
    ]
    output = f"_{piece.label}_output"
    lines = [
        "",
        f"def _{piece.label}(self, v):",
        f"    found = {_call(piece, [f'self.{output}', 'v'])}",
        f"    self._{inner.label}(found{growth})",
        "    return found",
        "",
        f"def {output}(self, v):",
        f"    states = [{', '.join(states)}]",
        "    kept = [state.copy() for state in states]",
        f"    y = self._{inner.label}(v{growth})",
        "    for state, before in zip(states, kept):",
        "        state[:] = before",
        "    return y",
    ]
    return indent("\n".join(lines), "    ")


def _call(piece: Piece, given: Sequence[str]) -> str:
    arguments = [
        _constant(piece, key) if isinstance(value, np.ndarray) else repr(value)
        for key, value in piece.step.constants.items()
    ]
    if _takes_together(piece):
        arguments = [piece.label.upper()]
    arguments += [f"self.{piece.label}_{state}" for state in piece.step.states]
    inside = wrap(
        ", ".join([*arguments, *given]), 76, break_long_words=False,
        break_on_hyphens=False,
    )  # fmt: skip
    return f"{piece.step.function}(\n    " + "\n    ".join(inside) + "\n)"


def _own(piece: Piece, given: Sequence[str]) -> str:
    return f"self._{piece.label}({', '.join(given)})"


LANGUAGE = Language(_call, _own)


def _takes_together(piece: Piece) -> bool:
    """Tell whether a step's function takes its constants together, as ``k``."""
    function = piece.step.function
    return _library()[function].startswith(f"def {function}(k, ")


def _constants(piece: Piece) -> Iterator[str]:
    """Write the constants of a piece: those taken together as one, else its arrays."""
    constants = piece.step.constants
    if _takes_together(piece):
        told = [
            f"{key}={_values(value) if isinstance(value, np.ndarray) else repr(value)},"
            for key, value in constants.items()
        ]
        inside = indent("\n".join(told), "    ")
        yield f"{piece.label.upper()} = SimpleNamespace(\n{inside}\n)"
        return
    for key, value in constants.items():
        if isinstance(value, np.ndarray):
            yield _array(_constant(piece, key), value)


def _constant(piece: Piece, key: str) -> str:
    return f"{piece.label}_{key}".upper()


def _array(name: str, values: Any) -> str:
    return f"{name} = {_values(values)}"


def _values(values: Any) -> str:
    numbers = ", ".join(repr(float(value)) for value in values)
    lines = wrap(numbers, 80, break_long_words=False, break_on_hyphens=False)
    return "np.array([\n    " + "\n    ".join(lines) + "\n])"


@cache
def _library() -> dict[str, str]:
    """Give the text of each function of the library by its name."""
    texts = [path.read_text(encoding="utf-8") for path in LIBRARY]
    return {
        item.name: ast.get_source_segment(text, item) or ""
        for text in texts
        for item in ast.parse(text).body
        if isinstance(item, ast.FunctionDef)
    }

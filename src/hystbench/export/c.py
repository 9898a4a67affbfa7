"""A model as C99: a header, and a source that allocates nothing."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np

from hystbench import kernels
from hystbench.export.described import Described, Piece
from hystbench.export.names import filled

#: The laws of forces are those of the compiled kernel.
LIBRARY = (
    Path(kernels.__file__).with_name("forces.c"),
    Path(__file__).with_name("steps.c"),
    Path(__file__).with_name("hysteresis_steps.c"),
    Path(__file__).with_name("inside.c"),
    Path(__file__).with_name("inverse_steps.c"),
)
WIDTH = 88
NO_STATE = ("none", 1)
"""State of a model that remembers nothing: no struct of C is empty."""


def files(model: Described) -> dict[str, str]:
    """Give the text of the header and of the source, by their names."""
    return {f"{model.name}.h": header(model), f"{model.name}.c": source(model)}


def header(model: Described) -> str:
    """Write the header: the state, and the two functions that use it."""
    states = [*model.all_states()] or [NO_STATE]
    sides = f"{model.output.label} of {model.input.label}"
    return filled(
        "model.h",
        told=_comment([f"{model.title}: {model.about}.", *model.differences]),
        name=model.name,
        NAME=model.name.upper(),
        dt=repr(model.sampling.dt),
        states="\n".join(f"    double {state}[{size}];" for state, size in states),
        begins=_comment([model.begins]),
        next=_comment([f"The next sample: {sides}."]),
    )


def source(model: Described) -> str:
    """Write the source, which includes the header."""
    return "\n\n".join(
        [
            f'#include "{model.name}.h"',
            library([model]),
            body(model),
        ]
    )


def library(models: Iterable[Described]) -> str:
    """Give what some models need of the functions of the library."""
    opening, chunks = _library()
    wanted = set().union(*(model.functions for model in models))
    return f"{opening}\n\n{_needed(chunks, wanted)}"


def _needed(chunks: dict[str, str], wanted: set[str]) -> str:
    """Give the functions that are wanted and those that they call, in their order."""
    found: set[str] = set()
    left = {f"hb_{name}" for name in wanted}
    while left:
        name = left.pop()
        found.add(name)
        words = set(re.findall(r"\w+", chunks[name]))
        left |= (words & set(chunks)) - found
    return "\n\n".join(text for name, text in chunks.items() if name in found)


def body(model: Described) -> str:
    """Write the constants of a model, and its own functions."""
    parts = [
        _array(f"{model.name}_{piece.label}_{key}", value)
        for piece in model.all_pieces()
        for key, value in piece.step.constants.items()
        if isinstance(value, np.ndarray)
    ]
    parts += [
        _array(f"{model.name}_{state}_start", value)
        for state, value in model.starts.items()
    ]
    for piece in model.pieces:
        parts += [_wrapped(model, part) for part in piece.all_inside() if piece.inner]
    lines = [
        f"    hb_remember({piece.step.constants['points']}, s->{piece.history}, input);"
        for piece in model.watching
    ]
    if model.sampling.delay:
        lines += [
            "    const double call = *s->calls;",
            f"    if (call < {model.sampling.delay}) *s->calls += 1;",
        ]
    for piece in model.pieces:
        call = _call if piece.inner is None else _own
        given = ["y"] + ["1"] * piece.step.grows
        lines.append(f"    y = {call(model, piece, given)};")
        if piece.wait:
            lines.append(f"    if (call < {piece.wait}) return 0; /* none yet */")
    used = [] if any(model.all_states()) else ["    (void)s;"]
    name = model.name
    begun = [
        f"    memcpy(s->{state}, {name}_{state}_start, sizeof s->{state});"
        for state in model.starts
    ]
    parts += [
        "\n".join(
            [
                f"void {name}_init({name}_state *s)",
                "{",
                "    memset(s, 0, sizeof *s);",
                *begun,
                "}",
            ]
        ),
        "\n".join(
            [
                f"double {name}_step({name}_state *s, double input)",
                "{",
                "    double y = input;",
                *used,
                *lines,
                "    return y;",
                "}",
            ]
        ),
    ]
    return "\n\n".join(parts) + "\n"


def _wrapped(model: Described, piece: Piece) -> str:
    """Write the function of hysteresis that is wrapped, or of what wraps it."""
    inner = piece.inner
    if inner is not None and piece.step.undoes:
        return _searched(model, piece, inner)
    declared = ", ".join(f"double {name}" for name in piece.takes)
    name = f"{model.name}_{piece.label}"
    opening = f"static double {name}({model.name}_state *s, {declared})"
    step = _call(model, piece, piece.takes)
    if inner is not None:  # what is inside is called once
        step = f"{_own(model, inner, inner.takes)} + {step}"
    lines = [f"    return {step};"]
    if inner is not None and piece.step.drives:
        each = _own(model, inner, [f"{name}s[i]" for name in inner.takes])
        call = _call(model, piece, [*piece.takes, "vs", "growths"])
        lines = [
            f"    double vs[{piece.step.drives}], growths[{piece.step.drives}], y = 0;",
            f"    const int count = {call};",
            f"    for (int i = 0; i < count; i++) y = {each};",
            "    return y;",
        ]
    return "\n".join([opening, "{", *lines, "}"])


def _searched(model: Described, piece: Piece, inner: Piece) -> str:
    """Write the function that looks for the input of what is inside.

    Another tries an input, and puts back all that is remembered inside.
    """
    name, output = f"{model.name}_{piece.label}", f"{model.name}_{piece.label}_output"
    growth = f", s->{piece.label}_pace[3]" if inner.step.grows else ""
    inside = f"{model.name}_{inner.label}"
    states = [
        f"{part.label}_{state}"
        for part in inner.all_inside()
        for state in part.step.states
    ]
    call = _call(model, piece, [output, "s", "v"])
    return "\n".join(
        [
            f"static double {output}(void *model, double v)",
            "{",
            f"    {model.name}_state *s = model;",
            *(f"    double {key}[sizeof s->{key} / sizeof(double)];" for key in states),
            *(f"    memcpy({key}, s->{key}, sizeof s->{key});" for key in states),
            f"    const double y = {inside}(s, v{growth});",
            *(f"    memcpy(s->{key}, {key}, sizeof s->{key});" for key in states),
            "    return y;",
            "}",
            "",
            f"static double {name}({model.name}_state *s, double v)",
            "{",
            f"    const double found = {call};",
            f"    {inside}(s, found{growth});",
            "    return found;",
            "}",
        ]
    )


def _own(model: Described, piece: Piece, given: Sequence[str]) -> str:
    """Call the function that the model has for a piece: it takes the state first."""
    return f"{model.name}_{piece.label}({', '.join(['s', *given])})"


def _call(model: Described, piece: Piece, given: Sequence[str]) -> str:
    """Call the library's function of a piece's step."""
    arguments = [
        f"{model.name}_{piece.label}_{key}"
        if isinstance(value, np.ndarray)
        else _number(value)
        for key, value in piece.step.constants.items()
    ]
    arguments += [f"s->{piece.label}_{state}" for state in piece.step.states]
    text = ", ".join([*arguments, *given])
    lines = wrap(text, WIDTH - 8, break_long_words=False, break_on_hyphens=False)
    inside = "\n        ".join(lines)
    opening = "" if len(lines) == 1 else "\n        "
    return f"hb_{piece.step.function}({opening}{inside})"


def _array(name: str, values: Any) -> str:
    numbers = ", ".join(_number(value) for value in values)
    lines = wrap(numbers, WIDTH - 4, break_long_words=False, break_on_hyphens=False)
    inside = "\n    ".join(lines)
    return f"static const double {name}[{len(values)}] = {{\n    {inside}\n}};"


def _number(value: float) -> str:
    """Write a number so that reading it gives the same one."""
    return str(int(value)) if isinstance(value, int) else repr(float(value))


def _comment(sentences: Sequence[str]) -> str:
    """Write a comment that nothing in the sentences ends."""
    lines = [
        # A backslash at its end would splice a line with the next.
        line.rstrip("\\ ")
        for said in sentences
        for line in wrap(_harmless(said), WIDTH - 6)
    ]
    end = " */" if len(lines) == 1 else "\n */"
    return "/* " + "\n * ".join(lines) + end


def _harmless(text: str) -> str:
    """Part the signs that begin or end a comment, and those of trigraphs."""
    text = text.replace("*/", "* /").replace("/*", "/ *")
    return re.sub(r"\?(?=\?)", "? ", text)


@cache
def _library() -> tuple[str, dict[str, str]]:
    """Divide the library into what stands before its functions, and the functions."""
    openings, found = "", {}
    for path in LIBRARY:
        text = path.read_text(encoding="utf-8").strip()
        opening, *chunks = re.split(r"\n\n(?=/\*|static )", text)
        openings += opening.partition("*/")[2]
        for chunk in chunks:
            name = re.search(r"^static \w+ (hb_\w+)\(", chunk, re.MULTILINE)
            if name is not None:
                found[name[1]] = chunk
    return openings.strip(), found

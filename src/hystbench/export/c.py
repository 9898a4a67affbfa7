"""A model as C99: a header, and a source that allocates nothing."""

import re
from collections.abc import Iterable, Sequence
from functools import cache, partial
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
#: Letters of a line of code.
WIDTH = 88
NO_STATE = ("none", 1)
"""State of a model that remembers nothing: no struct of C is empty."""


def files(model: Described) -> dict[str, str]:
    """Give the text of the header and of the source, by their names."""
    return {f"{model.name}.h": header(model), f"{model.name}.c": source(model)}


def header(model: Described) -> str:
    """Write the header: the state, and the two functions that use it."""
    return filled("model.h", model=model, states=states(model), comment=_comment)


def states(model: Described) -> list[tuple[str, int]]:
    """Give the name and length of every state, of which C wants one."""
    return [*model.all_states()] or [NO_STATE]


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
    arrays = {
        f"{piece.label}_{key}": value
        for piece in model.all_pieces()
        for key, value in piece.step.constants.items()
        if isinstance(value, np.ndarray)
    }
    arrays |= {f"{state}_start": value for state, value in model.starts.items()}
    return filled(
        "model.c",
        model=model,
        arrays={f"{model.name}_{name}": values for name, values in arrays.items()},
        array=_array,
        call=partial(_call, model),
        own_call=partial(_own, model),
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

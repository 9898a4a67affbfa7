"""A model as code: C99 that allocates nothing, a Python module around it, an FMU."""

import hashlib
import importlib.util
import re
import uuid
import zipfile
from collections.abc import Iterable, Sequence
from functools import cache, partial
from pathlib import Path
from textwrap import wrap
from typing import Any, Literal
from xml.sax.saxutils import quoteattr

import numpy as np

from hystbench import __version__, kernels
from hystbench.errors import InputError
from hystbench.export.described import Described, Piece
from hystbench.scratch import scratch_folder

Version = Literal["2", "3"]
"""The major version of FMI."""
#: The laws of forces are those of the compiled kernel.
LIBRARY = (
    Path(kernels.__file__).with_name("forces.c"),
    Path(kernels.__file__).with_name("joint.c"),
    Path(__file__).with_name("steps.c"),
    Path(__file__).with_name("hysteresis_steps.c"),
    Path(__file__).with_name("inside.c"),
    Path(__file__).with_name("inverse_steps.c"),
)
#: Letters of a line of code.
WIDTH = 88
#: The files of an archive have no time of their own: the same model, the same bytes.
NO_TIME = (1980, 1, 1, 0, 0, 0)


def c_files(model: Described) -> dict[str, str]:
    """Give the text of the header and of the source, by their names."""
    return {f"{model.name}.h": header(model), f"{model.name}.c": source(model)}


def header(model: Described) -> str:
    """Write the header: the state, and the two functions that use it."""
    return filled("model.h", model=model, states=states(model), comment=_comment)


def states(model: Described) -> list[tuple[str, int]]:
    """Give the name and length of every state; C has no empty struct."""
    return [*model.all_states()] or [("none", 1)]


def source(model: Described) -> str:
    """Write the source, which includes the header."""
    include = f'#include "{model.name}.h"'
    return "\n\n".join([include, library([model]), body(model)])


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
            name = re.search(r"^static (?:inline )?\w+ (hb_\w+)\(", chunk, re.MULTILINE)
            if name is not None:
                found[name[1]] = chunk
    return openings.strip(), found


def python_files(model: Described) -> dict[str, str]:
    """Give the text of the module and of the C that it calls, by their names."""
    return {f"{model.name}.py": module(model), **c_files(model)}


def module(model: Described) -> str:
    """Write the module: a class ``Model`` that keeps the state of the C."""
    told = [f"{model.title}: {model.about}.", *model.differences]
    lines = [_quoted(line) for said in told for line in wrap(said, WIDTH - 4)]
    return filled("module.txt", model=model, told=lines, states=states(model))


def loaded(model: Described) -> Any:
    """Give the exported ``Model``, new, as one who imports the module makes it.

    Raises
    ------
    InputError
        If there is no C compiler.
    """
    with scratch_folder("export-") as folder:
        for name, text in python_files(model).items():
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


def write_fmu(model: Described, path: Path, fmi: Version = "3") -> None:
    """Write the archive.

    Its output is known after a step that begins where its input is set: an importer
    sees it one interval later, as of any discrete system.
    """
    files = fmu_files(model, fmi)
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, text in files.items():
            entry = zipfile.ZipInfo(name, NO_TIME)
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, text)


def fmu_files(model: Described, fmi: Version = "3") -> dict[str, str]:
    """Give the text of each file in the archive, by its path there."""
    text, opening = source(model), header(model)
    token = str(uuid.UUID(hashlib.sha256((opening + text).encode()).hexdigest()[:32]))
    names = [model.input.name, model.output.name]
    if len({"time", *names}) < 3:
        names = [f"input {names[0]}", f"output {names[1]}"]
    given = {
        "model": model,
        "fmi": fmi,
        "token": token,
        "names": names,
        "about": " ".join([f"{model.about}.", *model.differences]),
        "tool": f"hystbench {__version__}",
    }
    return {
        "modelDescription.xml": filled(f"fmi{fmi}.xml", **given),
        # Later releases of FMI 2.0 have this file of FMI 3.0 too.
        "sources/buildDescription.xml": filled("buildDescription.xml", **given),
        f"sources/{model.name}.h": opening,
        f"sources/{model.name}.c": text,
        **{
            f"sources/{file}": filled(file, **given)
            for file in ("hb_unit.h", f"fmi{fmi}.c")
        },
    }


def filled(file: str, **words: Any) -> str:
    """Fill a template beside this module: ``@name@`` is an expression of Jinja."""
    text: str = _templates().get_template(file).render(words)
    return text


@cache
def _templates() -> Any:
    from jinja2 import Environment, PackageLoader, StrictUndefined

    made = Environment(
        loader=PackageLoader(__package__, ""),
        undefined=StrictUndefined,
        variable_start_string="@",
        variable_end_string="@",
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,  # noqa: S701 - it makes code
    )
    made.filters["quoted"] = lambda value: quoteattr(str(value))
    return made

"""YAML: read as plain data alone, each key once, bounded in depth and size; written."""

from __future__ import annotations

import re
from collections.abc import Hashable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hystbench.command_files import reads
from hystbench.errors import InputError
from hystbench.text_files import read_text

if TYPE_CHECKING:
    from yaml import Node

DEEPEST = 50
"""Levels of lists and mappings; no file of the program has more than eight."""
LARGEST = 10_000_000
"""Bytes of a file. A file of data that is named by mistake is larger."""
MOST_REPEATED = 100_000
"""Items that aliases (``*name``) may add to what is written."""

FLOAT = re.compile(
    r"[-+]?(?:\.[0-9]+|[0-9]+\.[0-9]*|[0-9]+(?=[eE]))(?:[eE][-+]?[0-9]+)?$"
)
"""Floats of YAML 1.2's core schema. PyYAML follows YAML 1.1, to which 1e-5 and 2.6e4
are text."""

_QUOTES = "{sign} begins no text; expected {instead}"
_HINTS = {
    "found character '\\t' that cannot start any token": _QUOTES,
    "found character that cannot start any token": _QUOTES,
    "did not find expected ',' or": (
        "expected ',' or a closing bracket; a name with [ ] { } , or : needs quotes: "
        "{column: 'time [s]', unit: s}"
    ),
    "mapping values are not allowed in this context": (
        "a second ':' in one line; expected one key a line, or text in quotes"
    ),
    "could not determine a constructor for the tag": (
        "a tag; expected plain text, numbers, lists and mappings"
    ),
}


def load_yaml(path: str | Path, expected: str = "a YAML file") -> Any:
    """Read a YAML file as plain data; nothing in it is executed.

    Parameters
    ----------
    path : str or Path
    expected : str
        What the file should be, for messages.

    Raises
    ------
    InputError
        If there is no such file, it is not YAML, a key stands twice, it is nested
        deeper than ``DEEPEST``, or it is larger than ``LARGEST`` bytes or, by aliases,
        ``MOST_REPEATED`` items more than written.
    """
    path = Path(path)
    reads(path)
    if path.is_file() and path.stat().st_size > LARGEST:
        raise InputError(
            f"{path}: {path.stat().st_size / 1e6:.3g} MB; expected a YAML file of at "
            f"most {LARGEST / 1e6:g} MB"
        )
    return parse_yaml(read_text(path, expected), str(path))


@cache
def table_of(module: str) -> Any:
    """Read, once, the table that stands beside a module's file under its name."""
    return load_yaml(Path(module).with_suffix(".yaml"))


def parse_yaml(text: str, place: str) -> Any:
    """Read YAML from a text, as :func:`load_yaml` reads it from a file.

    Parameters
    ----------
    text : str
    place : str
        Name of the file, for messages.
    """
    import yaml  # late: kept out of jobs that read no YAML

    kind = _loader()
    try:
        _check_bounds(yaml.parse(text, kind), place)
        loader = kind(text)
        try:
            node = loader.get_single_node()
            if node is None:
                return None
            _check_keys(loader, node, place)
            return loader.construct_document(node)
        finally:
            loader.dispose()
    except InputError:
        raise
    except ValueError as error:  # a date such as 2024-13-45, or too many digits
        raise InputError(
            f"{place}: a date or number that is none ({error}); expected text in quotes"
        ) from error
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f"line {mark.line + 1}: " if mark else ""
        problem = getattr(error, "problem", None) or "not YAML"
        for known, hint in _HINTS.items():
            if problem.startswith(known):
                problem = hint
        if problem is _QUOTES:
            problem = problem.format(**_sign_at(text, mark))
        raise InputError(f"{place}: {where}{problem}") from error


def _sign_at(text: str, mark: Any) -> dict[str, str]:
    """Tell which sign begins no text, and what may stand there."""
    line = text.splitlines()[mark.line]
    sign = line[mark.column : mark.column + 1]
    if sign == "\t":
        return {"sign": "a tab", "instead": "spaces"}
    begun = line[mark.column :].split(" #")[0].rstrip(" ,]}")
    return {"sign": repr(sign), "instead": f"text in quotes: '{begun}'"}


def yaml_text(content: Any, width: int = 88, flow: bool | None = None) -> str:
    """Write plain data as YAML, which :func:`parse_yaml` reads back as it is.

    Parameters
    ----------
    content : mapping, list, number or text
    width : int
        Characters after which a line is broken.
    flow : bool, optional
        Whether lists and mappings stand in brackets; the innermost alone unless given.
    """
    import yaml  # late: kept out of jobs that write no YAML

    text: str = yaml.dump(
        content,
        Dumper=_dumper(),
        sort_keys=False,
        allow_unicode=True,
        width=width,
        default_flow_style=flow,
    )
    return text


UNUSUAL_ENDS = frozenset("\x85\u2028\u2029")
"""Characters that end a line in YAML 1.1."""


@cache
def _loader() -> Any:
    """Give the loader: of plain data, with floats as YAML 1.2 has them."""
    import yaml

    # The same in C, where PyYAML was built with it, takes a tenth of the time.
    safe: Any = yaml.CSafeLoader if yaml.__with_libyaml__ else yaml.SafeLoader
    return _with_floats(type("Loader", (safe,), {}))


@cache
def _dumper() -> Any:
    """Give the dumper.

    It quotes text that the loader would take for a float, and escapes what YAML takes
    for the end of a line where Python does not.
    """
    import yaml

    kind: Any = _with_floats(type("Dumper", (yaml.SafeDumper,), {}))

    def text(dumper: Any, value: str) -> Any:
        style = '"' if UNUSUAL_ENDS.intersection(value) else None
        return dumper.represent_scalar("tag:yaml.org,2002:str", value, style=style)

    kind.add_representer(str, text)
    return kind


def _with_floats(kind: Any) -> Any:
    kind.add_implicit_resolver("tag:yaml.org,2002:float", FLOAT, "-+.0123456789")
    return kind


def _check_bounds(events: Any, place: str) -> None:
    """Refuse what is too deep, or grows too much where aliases are followed."""
    import yaml

    written = whole = 0
    sizes: dict[str, int | None] = {}  # None while the anchor's own content is read
    opened: list[tuple[str | None, int]] = []
    for event in events:
        line = event.start_mark.line + 1
        if isinstance(event, yaml.CollectionEndEvent):
            anchor, before = opened.pop()
            if anchor:
                sizes[anchor] = whole - before
            continue
        if not isinstance(event, yaml.NodeEvent):
            continue
        added, begins = 1, isinstance(event, yaml.CollectionStartEvent)
        if isinstance(event, yaml.AliasEvent):
            size = sizes.get(str(event.anchor), 1)
            if size is None:
                raise InputError(
                    f"{place}: line {line}: '*{event.anchor}' inside of what it names; "
                    "expected no circle"
                )
            added = size
        elif event.anchor:
            sizes[event.anchor] = None if begins else 1
        if begins:
            opened.append((event.anchor, whole))
            if len(opened) > DEEPEST:
                raise InputError(
                    f"{place}: line {line}: more than {DEEPEST} levels of lists and "
                    f"mappings; expected at most {DEEPEST}"
                )
        written += 1
        whole += added
        if whole > written + MOST_REPEATED:
            raise InputError(
                f"{place}: line {line}: aliases (*name) repeat more than "
                f"{MOST_REPEATED:,} items; expected the content written out"
            )


def _check_keys(loader: Any, root: Node, place: str) -> None:
    """Refuse a key that stands twice in a mapping: the later one would win unseen."""
    import yaml

    waiting, seen = [root], set()
    while waiting:
        node = waiting.pop()
        if id(node) in seen or isinstance(node, yaml.ScalarNode):
            continue
        seen.add(id(node))
        if isinstance(node, yaml.SequenceNode):
            waiting += node.value
            continue
        lines: dict[Hashable, int] = {}
        for key, value in node.value:
            line = key.start_mark.line + 1
            if not isinstance(key, yaml.ScalarNode):
                raise InputError(
                    f"{place}: line {line}: a list or mapping as a key; expected a word"
                )
            merge = key.tag == "tag:yaml.org,2002:merge"
            name = "<<" if merge else loader.construct_object(key)
            if name in lines:
                raise InputError(
                    f"{place}: line {line}: the key {name!r} stands in line "
                    f"{lines[name]} already; expected it once"
                )
            lines[name] = line
            waiting.append(value)

"""The vocabulary of blocks, for docs/model-files.md and docs/blocks.md."""

import inspect
import re
from dataclasses import MISSING, fields

from hystbench import files
from hystbench.blocks import own
from hystbench.blocks.parameter import HUGE, Parameter

COLUMNS = ("block", "place", "parameter", "unit", "values", "meaning")


def markdown_table() -> str:
    """Write hystbench's own blocks as a Markdown table, one parameter a row."""
    rows = []
    for name, block in own().items():
        first = [f"`{name}`", str(block.place)]
        default = {field.name: field.default for field in fields(block)}
        for key, about in block.parameters().items():
            values = _values(about) + _default(default[key])
            rows.append((*first, f"`{key}`", about.unit, values, about.meaning))
            first = ["", ""]
    return files.markdown_table(COLUMNS, rows) + "\n"


def laws() -> str:
    """Write what each of hystbench's own blocks computes, as its docstring says it."""
    parts = (f"### {name}\n\n{_law(block)}\n" for name, block in own().items())
    return "\n".join(parts)


def _law(block: type) -> str:
    """Give a docstring as Markdown: its text, and the references as a list."""
    doc = inspect.getdoc(block) or ""
    doc, _, references = doc.partition("\nReferences\n----------\n")
    text = re.split(r"\n\w+\n-{4,}\n", doc)[0]
    text, references = (
        re.sub(r"``(.*?)``", r"`\1`", part, flags=re.DOTALL)
        for part in (re.sub(r":\w+:`(.*?)`", r"`\1`", text), references)
    )
    text = re.sub(r"\[(\d)\]_", r"[\1]", text).strip()
    listed = re.sub(r"\.\. \[(\d)\] ", r"- [\1] ", references)
    listed = re.sub(r"\n {3,}", "\n  ", listed).strip()
    return f"{text}\n\n{listed}" if listed else text


def _values(about: Parameter) -> str:
    if about.kind == "choice":
        return ", ".join(f"`{option}`" for option in about.options)
    if about.kind == "text":
        return "text"
    bounds = _bounds(about)
    if about.kind == "number":
        return bounds
    if about.names:
        return f"`{about.names[0]}` to `{about.names[-1]}`, each {bounds}"
    return f"list, each {bounds}" + (", or none" if about.may_be_empty else "")


def _bounds(about: Parameter) -> str:
    if about.high < HUGE:
        return f"{about.low:g} to {about.high:g}"
    if about.low <= -HUGE:
        return "any number"
    return "more than 0" if about.low > 0 else "0 or more"


def _default(value: object) -> str:
    """Say what a parameter is that a file leaves out, if it may."""
    if value is MISSING:
        return ""
    if isinstance(value, str):
        return f"; default `{value}`" if value else "; may be left out"
    if isinstance(value, float) and abs(value) < HUGE:
        return f"; default {value:g}"
    return "; may be left out"

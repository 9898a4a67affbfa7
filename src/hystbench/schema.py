"""Checking YAML against a JSON Schema, with errors of one line."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hystbench.errors import InputError, nearest


def load_yaml(path: str | Path) -> Any:
    """Read a YAML file safely.

    Raises
    ------
    InputError
        If there is no such file or it is not YAML.
    """
    import yaml  # late: kept out of jobs that read no YAML

    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}; expected a YAML file") from error
    try:
        return yaml.safe_load(text)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f"line {mark.line + 1}: " if mark else ""
        problem = getattr(error, "problem", None) or "not YAML"
        raise InputError(f"{path}: {where}{problem}") from error


def check_against_schema(content: Any, schema: Mapping[str, Any], place: str) -> None:
    """Check content against a JSON Schema (draft 2020-12).

    Parameters
    ----------
    content : object
        What was read.
    schema : mapping
        The JSON Schema.
    place : str
        File name for the message.

    Raises
    ------
    InputError
        With the most telling of the errors: the key, what was expected and the
        nearest valid name.
    """
    from jsonschema import Draft202012Validator
    from jsonschema.exceptions import best_match

    errors = list(Draft202012Validator(schema).iter_errors(content))
    # A misspelt key is also a missing one: the misspelling tells more.
    misspelt = [item for item in errors if item.validator == "additionalProperties"]
    error = best_match(misspelt or errors)
    if error is None:
        return
    path = [f"{item}" for item in error.absolute_path]
    where = ": ".join([place, *path])
    if error.validator == "additionalProperties":
        known = list(error.schema["properties"])
        unknown = next(key for key in error.instance if key not in known)
        raise InputError(f"{where}: unknown key {unknown!r}; {nearest(unknown, known)}")
    if error.validator == "enum":
        near = nearest(error.instance, error.validator_value)
        raise InputError(f"{where}: {error.instance!r} is unknown; {near}")
    if error.validator == "type":
        raise InputError(
            f"{where}: {error.instance!r} is no {error.validator_value}; "
            f"expected {_expected(error.schema, error.validator_value)}"
        )
    raise InputError(f"{where}: {error.message}")


def _expected(schema: Mapping[str, Any], kind: Any) -> str:
    article = {
        "array": "a list",
        "object": "a mapping of keys",
        "integer": "a whole number",
    }
    kinds = kind if isinstance(kind, list) else [kind]
    words = " or ".join(article.get(item, f"a {item}") for item in kinds)
    about = schema.get("description")
    return f"{words} ({about})" if about else words

"""Checking YAML against a JSON Schema, with errors of one line."""

import math
from collections.abc import Mapping
from typing import Any

from hystbench.errors import InputError, nearest, short


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
    from jsonschema.validators import extend

    # JSON takes 30.0 for an integer and NaN for a number; an order is neither.
    types = Draft202012Validator.TYPE_CHECKER.redefine_many(
        {"integer": lambda _, value: type(value) is int, "number": _is_finite_number}
    )
    validator = extend(Draft202012Validator, type_checker=types)(schema)  # type: ignore[no-untyped-call]
    errors = list(validator.iter_errors(content))
    # A misspelt key is also a missing one: the misspelling tells more.
    misspelt = [item for item in errors if item.validator == "additionalProperties"]
    error = best_match(misspelt or errors)
    if error is None:
        return
    where = ": ".join([place, *map(str, error.absolute_path)])
    rule, value = error.validator, error.instance
    if rule == "additionalProperties":
        known = list(error.schema["properties"])
        unknown = next(key for key in value if key not in known)
        told = nearest(unknown, known)
        if error.absolute_path and unknown in schema.get("properties", {}):
            told = f"it is a key of the file, not of {error.absolute_path[0]!r}"
        raise InputError(f"{where}: unknown key {unknown!r}; {told}")
    if rule == "enum":
        near = nearest(value, error.validator_value)
        also = error.schema.get("description")
        if also and not near.endswith("?"):  # with a near name nothing else is meant
            near = f"{near}; {also}"
        raise InputError(f"{where}: {short(value)} is unknown; {near}")
    if rule == "required":
        missing = next(key for key in error.validator_value if key not in value)
        raise InputError(f"{where}: expected the key {missing!r}")
    if rule == "type":
        one = error.validator_value
        types = [one] if isinstance(one, str) else one
        expected = " or ".join(_TYPES.get(each, each) for each in types)
    elif rule in _EXPECTED:
        expected = _EXPECTED[rule].format(error.validator_value)
    else:
        expected = error.message  # quotes the value, which may hold braces
    raise InputError(f"{where}: {short(value)}; expected {expected}{_hint(value)}")


_TYPES = {
    "array": "a list",
    "object": "a mapping of keys",
    "integer": "a whole number",
    "number": "a finite number",
    "string": "a word",
}

_EXPECTED = {
    "exclusiveMinimum": "a number above {}",
    "minimum": "a number of {} or more",
    "exclusiveMaximum": "a number below {}",
    "maximum": "a number of {} or less",
    "minItems": "at least {} in the list",
    "minLength": "a word",
    "minProperties": "at least {} key",
    "maxProperties": "{} key",
    "uniqueItems": "each item once",
    "pattern": "a name of the form {}",
}


def _is_finite_number(_: object, value: object) -> bool:
    return type(value) in (int, float) and math.isfinite(value)  # type: ignore[arg-type]


def _hint(value: object) -> str:
    """Explain why a number was read as a word."""
    if not isinstance(value, str):
        return ""
    try:
        float(value)
    except ValueError:
        return ""
    if "e" in value.lower():
        # Snakemake reads YAML 1.1, to which these are text.
        return " without quotes; in config.yaml 1.0e-2 for 1e-2, 1.0e+2 for 1e2"
    return " without quotes"

"""The schema of config.yaml: what all configs have, and the keys of each filter."""

from collections.abc import Mapping
from dataclasses import MISSING
from pathlib import Path
from typing import Any

from hystbench.errors import InputError
from hystbench.filters import AdaptiveFilter, registry
from hystbench.filters.keys import keys_of
from hystbench.published import FILTERS
from hystbench.yaml_files import load_yaml


def config_schema(config: Mapping[str, Any], schema_file: str | Path) -> dict[str, Any]:
    """Build the JSON Schema that a config is checked against.

    A filter's own keys and step sizes stand under ``filters`` and ``filters:
    convergence_factor``. Those of the paper's filters are always there. Those of
    another one must be there if ``models`` lists it, but for keys with a default.

    Parameters
    ----------
    config : mapping
        Its ``models`` say which of the other filters are to run.
    schema_file : str or Path
        The JSON Schema of what all configs have, as YAML.

    Raises
    ------
    InputError
        If two filters mean different things by one key, or an installed package
        offers what is no filter.
    """
    schema: dict[str, Any] = load_yaml(schema_file)
    known = registry()
    sections = schema["properties"]
    sections["models"]["items"] = {"enum": [*known, "rdgpi"]}
    filters = sections["filters"]
    common = set(filters["properties"])
    factors = filters["properties"]["convergence_factor"]
    asked = config.get("models")
    listed = asked if isinstance(asked, list) else []
    meant: dict[str, str] = {}
    for name, chosen in known.items():
        always = name in FILTERS
        factors["properties"][name] = _steps(chosen)
        if always or name in listed:
            factors["required"].append(name)
        for key, about in keys_of(chosen).items():
            own = about.schema
            if key in common or filters["properties"].setdefault(key, own) != own:
                other = meant.get(key, "all filters")
                raise InputError(
                    f"filter {name!r}: key {key!r} is one of {other} with another "
                    "meaning; expected another name"
                )
            meant.setdefault(key, repr(name))
            if always or (name in listed and about.default is MISSING):
                filters["required"].append(key)
    return schema


def _steps(chosen: type[AdaptiveFilter]) -> dict[str, Any]:
    """Give the schema of a filter's step sizes."""
    names = list(chosen.step_sizes)
    return {
        "type": "object",
        "additionalProperties": False,
        "required": names,
        "properties": {name: {"$ref": "#/$defs/positive"} for name in names},
    }

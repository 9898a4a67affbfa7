"""config.yaml checked as a whole, before anything runs."""

from collections.abc import Iterable, Mapping
from dataclasses import MISSING
from pathlib import Path
from typing import Any

import numpy as np

from hystbench.dataset import Dataset, load_dataset
from hystbench.doubts import doubts
from hystbench.envelope import fewest_samples
from hystbench.errors import InputError, nearest, refuse_unknown
from hystbench.filters import AdaptiveFilter, registry
from hystbench.filters.keys import keys_of
from hystbench.plants import model_files, packaged_models
from hystbench.published import FILTERS, load_errors
from hystbench.record import Record
from hystbench.schema import check_against_schema
from hystbench.signals import Signal, make_signal
from hystbench.units import plain
from hystbench.yaml_files import load_yaml


def checked(
    config: Mapping[str, Any], schema_file: str | Path, place: str
) -> tuple[Dataset | None, tuple[str, ...]]:
    """Check a config as a whole.

    Parameters
    ----------
    config, schema_file, place
        As for :func:`hystbench.settings.read_settings`.

    Returns
    -------
    dataset : Dataset or None
        The measured dataset, or None where the twin is the source.
    warnings : tuple of str
        What of its records is hardly meant, one line each.

    Raises
    ------
    InputError
        With the first mistake found.
    """
    check_against_schema(config, config_schema(config, schema_file), place)
    # To make all signals costs less than to find out later that one cannot be made.
    excitations = {
        name: make_signal(name, definition, config["excitation"], place)
        for name, definition in config["excitations"].items()
    }
    named = [
        *(("signals", name) for name in config["signals"]),
        ("identification: signal", config["identification"]["signal"]),
        ("order_sweep: signal", config["order_sweep"]["signal"]),
        ("random_sum: signal", config["random_sum"]["signal"]),
        *(("rdgpi: fit_signals", name) for name in config["rdgpi"]["fit_signals"]),
    ]
    _check_limits(place, config)
    if config["source"] == "twin":
        _check_names(place, named, excitations)
        # The calibration and the comparison take all signals of the tables.
        for pair in load_errors():
            _check_names(place, [("excitations", pair.signal)], excitations)
        _check_names(place, _gap_signals(place, config), excitations)
        _check_lengths(place, config, excitations)
        _check_model(place, "twin: model", config["twin"]["model"])
        _check_twin(place, config)
        for key in ("pressure", "constants"):
            for name in config[key]["twins"]:
                _check_model(place, f"{key}: twins", name)
        return None, ()
    if not Path(config["source"]).exists():
        raise InputError(
            f"{place}: source: no file {config['source']!r}; "
            f"{nearest(config['source'], ['twin', 'path/to/dataset.yaml'])}"
        )
    dataset = load_dataset(config["source"])
    known = [*dataset.record_files, *excitations]
    _check_names(place, named[: len(config["signals"])], known)
    records = [dataset.read(name) for name in dataset.record_files]
    for record in records:
        _check_length(
            str(dataset.record_files[record.name]),
            len(record),
            config["filters"]["order"],
        )
        _check_moves(str(dataset.record_files[record.name]), record)
    return dataset, doubts(dataset, records)


def _gap_signals(place: str, config: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Name the signals of the gap's worked example; none may be in both roles."""
    roles = {role: config["gap"]["twin"][role] for role in ("fit", "hold_out")}
    for name in roles["hold_out"]:
        if name in roles["fit"]:
            raise InputError(
                f"{place}: gap: twin: {name!r} is in fit and in hold_out; "
                "expected it in one of them"
            )
    return [(f"gap: twin: {role}", name) for role in roles for name in roles[role]]


def _check_limits(place: str, config: Mapping[str, Any]) -> None:
    """Refuse limits of a next experiment between which nothing lies."""
    about = config["gap"]
    given = {f"datasets: {item['dataset']}": item for item in about["datasets"]}
    for key, item in {"twin": about["twin"], **given}.items():
        limits = item.get("limits", {})
        low, high = limits.get("low"), limits.get("high")
        if low is not None and high is not None and low >= high:
            raise InputError(
                f"{place}: gap: {key}: limits: low {low:g} and high {high:g}; "
                "expected low < high"
            )


def _check_model(place: str, key: str, name: str) -> None:
    files = model_files(name)
    if not files:
        raise InputError(f"{place}: {key}: no model file in the folder {name!r}")
    if not Path(files[0]).is_file():
        raise InputError(
            f"{place}: {key}: no model or file {name!r}; "
            f"{nearest(name, packaged_models())}"
        )


def _check_names(
    place: str, named: Iterable[tuple[str, str]], known: Iterable[str]
) -> None:
    known = list(known)
    for key, name in named:
        refuse_unknown(name, known, f"{place}: {key}: no signal {name!r}")


def _check_twin(place: str, config: Mapping[str, Any]) -> None:
    """Read the twin's model file and hold its input against the signals' unit."""
    from hystbench.model import load_model  # late: a measured dataset has no twin

    for file in model_files(config["twin"]["model"]):
        unit = load_model(file).input.unit
        if unit != plain(config["excitation"]["unit"]):
            raise InputError(
                f"{place}: excitation: unit: {config['excitation']['unit']!r}; "
                f"expected {unit!r}, the input of {file}"
            )


def _check_lengths(
    place: str, config: Mapping[str, Any], signals: Mapping[str, Signal]
) -> None:
    used = dict.fromkeys(config["signals"], config["filters"]["order"])
    sweep = config["order_sweep"]
    used[sweep["signal"]] = max([*sweep["orders"], used.get(sweep["signal"], 1)])
    used[config["identification"]["signal"]] = config["filters"]["order"]
    for name, order in used.items():
        _check_length(f"{place}: excitations: {name}", len(signals[name].u), order)


def _check_length(place: str, samples: int, order: int) -> None:
    """Refuse a record that no filter or identification of an order can use."""
    expected = fewest_samples(order)
    if samples < expected:
        raise InputError(
            f"{place}: {samples} samples are too few for filters of order {order}; "
            f"expected at least {expected}"
        )


def _check_moves(place: str, record: Record) -> None:
    """Refuse a record with a channel that is constant, which the gap alone may use."""
    for channel, values in ((record.input, record.u), (record.output, record.y)):
        if np.ptp(values) == 0:
            raise InputError(
                f"{place}: record {record.name}: {channel.name} is constant "
                f"({values[0]:g} {channel.unit}); expected a signal that moves, as "
                "filters are compared on it"
            )


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

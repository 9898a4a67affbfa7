"""Writing a proposed dataset.yaml."""

from collections.abc import Mapping
from typing import Any

HEAD = (
    "# Proposed by hystbench init. Change what is wrong; the tutorial has all keys.\n"
)
ORDER = (
    *("file", "group", "rows", "name", "use", "period_samples", "missing"),
    *("sampling_frequency_hz", "stands_still", "meant", "sha256"),
)


def yaml_text(about: Mapping[str, Any]) -> str:
    """Write a dataset.yaml, one line a key and one a record."""
    lines = [HEAD]
    for key, value in about.items():
        if key != "records":
            lines.append(f"{key}: {_flow(value)}\n")
    lines.append("records:\n")
    lines += [f"  - {entry_text(entry)}\n" for entry in about["records"]]
    return "".join(lines)


def entry_text(entry: Mapping[str, Any]) -> str:
    """Write a record's entry in one line."""
    ordered = {key: entry[key] for key in ORDER if key in entry}
    return _flow(ordered)


def _flow(value: Any) -> str:
    import yaml  # late: as everywhere

    text: str = yaml.safe_dump(
        value, default_flow_style=True, width=10**6, allow_unicode=True, sort_keys=False
    )
    return text.removesuffix("...\n").strip()

"""What a reader of a check should know, in the words of findings.yaml."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from hystbench.yaml_files import table_of


@dataclass(frozen=True)
class Finding:
    """One thing that a reader should know."""

    kind: str
    """``wrong``: ``hystbench gap`` refuses it; ``record``: a record looks wrong;
    ``model``: the given model does; ``missing``: dataset.yaml lacks it; or ``note``."""
    text: str
    paste: tuple[str, ...] = ()
    """Lines for dataset.yaml, or for the model file, that mend it."""
    topic: str = ""
    """Findings of one topic say the same of several records."""
    record: str = ""
    """Whom it concerns; empty where that is no single record."""


KIND_ORDER = ("wrong", "record", "model", "missing", "note")


def finding(topic: str, paste: Sequence[str] = (), **told: Any) -> Finding:
    """Give a finding in the words of findings.yaml, filled with what is told."""
    about = table_of(__file__)[topic]
    lines = tuple(paste or about.get("paste", ()))
    text = about["text"].format(**told)
    return Finding(about["kind"], text, lines, topic, told.get("name", ""))

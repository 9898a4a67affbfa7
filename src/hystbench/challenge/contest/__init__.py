"""The contest: which cases are held, and how answers to them are judged.

What is table and no code stands in ``contest.yaml``.
"""

from functools import cache
from pathlib import Path
from typing import Any

from hystbench.yaml_files import load_yaml


@cache
def table(name: str) -> Any:
    """Give a table of ``contest.yaml``."""
    return load_yaml(Path(__file__).with_name("contest.yaml"))[name]

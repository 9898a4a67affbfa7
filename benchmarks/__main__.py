"""``python -m benchmarks``: all parts, or the named ones."""

from __future__ import annotations

import argparse
import importlib
import subprocess
import sys

#: Parts in the order in which they run; each is a module with a function ``main``.
PARTS = (
    "kernels",
    "orders",
    "samples",
    "batch",
    "identification",
    "imports",
    "pipeline",
    "gap",
    "rerun",
    "graph",
    "reach",
    "pictures",
)


def main() -> None:
    """Run the parts."""
    parser = argparse.ArgumentParser(prog="benchmarks", description=__doc__)
    parser.add_argument("parts", nargs="+", choices=(*PARTS, "all"))
    asked = parser.parse_args().parts
    if asked == ["all"]:
        asked = list(PARTS)
    if len(asked) == 1:
        print(f"== {asked[0]}", flush=True)
        importlib.import_module(f"benchmarks.{asked[0]}").main()
        return
    for part in asked:  # each in a process of its own, which no other has filled
        subprocess.run([sys.executable, "-m", "benchmarks", part], check=True)


if __name__ == "__main__":
    main()

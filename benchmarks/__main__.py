"""``python -m benchmarks``: all parts, or the named ones."""

from __future__ import annotations

import argparse
import importlib

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
    "graph",
    "reach",
    "pictures",
)


def main() -> None:
    """Run the parts."""
    parser = argparse.ArgumentParser(prog="benchmarks", description=__doc__)
    parser.add_argument("parts", nargs="+", choices=(*PARTS, "all"))
    asked = parser.parse_args().parts
    for part in PARTS if "all" in asked else asked:
        print(f"== {part}", flush=True)
        importlib.import_module(f"benchmarks.{part}").main()


if __name__ == "__main__":
    main()

"""Whether two folders, or two files, hold the same results: same.py ONE OTHER.

Every file but logs and lists of digests must be there in both and have the same bytes.
Of JSON and CSV the times that a solver took are left out: the keys, columns and figures
of TIMES.
"""

import csv
import json
import sys
from pathlib import Path
from typing import Any

TIMES = {"seconds", "cpu_seconds", "seconds_per_case", "clock_seconds_per_case"}


def told(path: Path) -> Any:
    """Give the content of a file without the times in it."""
    if path.suffix == ".json":
        return timeless(json.loads(path.read_text(encoding="utf-8")))
    if path.suffix == ".csv":
        with path.open(encoding="utf-8", newline="") as stream:
            return [timeless(row) for row in csv.DictReader(stream) if not of_time(row)]
    return path.read_bytes()


def timeless(content: Any) -> Any:
    """Leave out what is a time, at any depth."""
    if isinstance(content, dict):
        kept = content.keys() - TIMES
        return {key: timeless(each) for key, each in content.items() if key in kept}
    if isinstance(content, list):
        return [timeless(each) for each in content if not of_time(each)]
    return content


def of_time(content: Any) -> bool:
    """Tell whether a row is a figure that is a time."""
    return isinstance(content, dict) and content.get("figure") in TIMES


def files(folder: Path) -> set[Path]:
    """Files of a folder, by their place in it, or the one file.

    Without logs, and without the digests that hystbench keeps of what it wrote.
    """
    if folder.is_file():
        return {Path()}
    found = (file.relative_to(folder) for file in folder.rglob("*") if file.is_file())
    return {file for file in found if not {"logs", ".hystbench"} & {*file.parts}}


def main() -> None:
    """Compare; end with a line for each file that differs."""
    one, other = map(Path, sys.argv[1:])
    both = files(one) & files(other)
    differing = files(one) ^ files(other)
    differing |= {file for file in both if told(one / file) != told(other / file)}
    if differing or not both:
        sys.exit("\n".join(f"{file}: not the same" for file in sorted(differing)))
    print(f"{len(both)} files, the same in both")


if __name__ == "__main__":
    main()

"""The random namer: any effect of the vocabulary, or none. What luck alone scores."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np

from hystbench.entrants.task import Named, read, write
from hystbench.refit import effects


def solve(dataset: Path, model: Path, out: Path) -> None:
    """Draw a name, or no-gap, from the bytes of the model file: the same each time.

    Parameters
    ----------
    dataset, model, out : Path
        As every solver's.
    """
    given = read(dataset, model)
    seed = int.from_bytes(hashlib.sha256(model.read_bytes()).digest()[:8], "big")
    random = np.random.default_rng(seed)
    names = [*effects(), None]
    chosen = names[int(random.integers(len(names)))]
    if chosen is None:
        write(given, [], "no-gap", "Drawn.", given.base, out)
    else:
        named = [Named(chosen, 1.0 / len(names))]
        write(given, named, "named", "Drawn.", given.base, out)

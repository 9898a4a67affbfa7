"""The random namer: any effect of the vocabulary, or none. What luck alone scores."""

import hashlib

import numpy as np

from hystbench.entrants.task import Answer, Given, NamedEffect
from hystbench.plain_fits import effects


def answer(given: Given) -> Answer:
    """Draw a name, or no-gap, from the bytes of the model file: the same each time."""
    content = given.model_file.read_bytes()
    seed = int.from_bytes(hashlib.sha256(content).digest()[:8], "big")
    random = np.random.default_rng(seed)
    names = [*effects(), None]
    chosen = names[int(random.integers(len(names)))]
    if chosen is None:
        return Answer(given.base, "no-gap", "Drawn.")
    named = [NamedEffect(chosen, 1.0 / len(names))]
    return Answer(given.base, "named", "Drawn.", named)

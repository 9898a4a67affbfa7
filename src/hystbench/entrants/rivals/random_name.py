"""``random``: a name that is drawn, which is what luck alone scores."""

from __future__ import annotations

import hashlib

import numpy as np

from hystbench.entrants.rivals.base import Answer, Given, NamedEffect, PythonSolver
from hystbench.plain_fits import effects


class RandomName(PythonSolver):
    """Draws a name, or no-gap, from the bytes of the model file: the same each time."""

    name = "random"

    def answer(self, given: Given) -> Answer:
        """Draw."""
        content = given.model_file.read_bytes()
        seed = int.from_bytes(hashlib.sha256(content).digest()[:8], "big")
        random = np.random.default_rng(seed)
        names = [*effects(), None]
        chosen = names[int(random.integers(len(names)))]
        if chosen is None:
            return Answer(given.base, "no-gap", "Drawn.")
        named = [NamedEffect(chosen, 1.0 / len(names))]
        return Answer(given.base, "named", "Drawn.", named)

"""Identification of envelopes, thresholds and weights (Algorithm 1)."""

from hystbench.identification.algorithm import fit_weights, identify
from hystbench.identification.result import Identification
from hystbench.identification.search import Progress
from hystbench.identification.weights import Start

__all__ = ["Identification", "Progress", "Start", "fit_weights", "identify"]

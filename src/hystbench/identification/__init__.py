"""Identification of envelopes, thresholds and weights (Algorithm 1)."""

from hystbench.identification.algorithm import fit_weights, identify
from hystbench.identification.result import Identification

__all__ = ["Identification", "fit_weights", "identify"]

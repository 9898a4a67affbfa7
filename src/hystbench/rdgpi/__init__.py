"""Rate-dependent generalized Prandtl-Ishlinskii model, and its fit to records."""

from hystbench.rdgpi.fit import RateDependentFit, identify_rdgpi
from hystbench.rdgpi.model import PAPER_SYMBOLS, PUBLISHED_RDGPI, RateDependentGPI

__all__ = [
    "PAPER_SYMBOLS",
    "PUBLISHED_RDGPI",
    "RateDependentFit",
    "RateDependentGPI",
    "identify_rdgpi",
]

"""Rate-dependent generalized Prandtl-Ishlinskii model, and its fit to records."""

from hystbench.rdgpi.fit import identify_rdgpi
from hystbench.rdgpi.model import PUBLISHED_RDGPI, RateDependentGPI

__all__ = ["PUBLISHED_RDGPI", "RateDependentGPI", "identify_rdgpi"]

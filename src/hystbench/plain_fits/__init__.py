"""Plain fits of single effects to records: bounded least squares, and nothing more.

For each effect of the vocabulary one block at one place in the chain, fitted to all
records at once by the squared error from a few starts. No reshaping of the base, no
folds, no joint fits. It is what the naive rival goes by, and the judge's own way to
see whether an effect fits data within their noise.
"""

from hystbench.plain_fits.fit import effects, fit, within_noise
from hystbench.plain_fits.task import EffectFit, Task

__all__ = ["EffectFit", "Task", "effects", "fit", "within_noise"]

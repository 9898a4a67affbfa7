"""``hystbench job measure``: simulate a model on a signal and record it."""

from hystbench import measurement
from hystbench.model import load_model
from hystbench.signals import load_signal
from hystbench.signature import In, Out, Settings, command


@command
def measure(signal: In, *, model: In, settings: Settings, out: Out) -> None:
    """Simulate a MODEL on SIGNAL and write the record."""
    plant = load_model(model)
    measurement.measure(load_signal(signal), plant, settings, str(model)).save(out)

"""``hystbench job measure``: simulate a model on a signal and record it."""

from hystbench.model import load_model
from hystbench.options import In, Out, Settings, command
from hystbench.signals import load_signal
from hystbench.twin_record import record_of_twin


@command
def measure(signal: In, *, model: In, settings: Settings, out: Out) -> None:
    """Simulate a MODEL on SIGNAL and write the record."""
    plant = load_model(model)
    record_of_twin(load_signal(signal), plant, settings, str(model)).save(out)

"""``hystbench job rdgpi``: simulate the RDGPI model on one record."""

from hystbench.options import In, Json, Out, Settings, command
from hystbench.rdgpi import RateDependentGPI
from hystbench.record import load_record
from hystbench.results import run_result, save_run


@command
def rdgpi(
    record: In, *, identified: Json, settings: Settings, out: Out, arrays: Out
) -> None:
    """Simulate the identified RDGPI model freely on RECORD."""
    evidence = load_record(record)
    model = RateDependentGPI(**identified["parameters"])
    output = model.simulate(evidence.u, evidence.dt)
    error = evidence.y - output
    result = run_result(evidence, "rdgpi", error, "free-run simulation", **settings)
    result |= {
        "order": model.order,
        "taps": None,
        "step_size": {},
        "bound": {},
        "eigenvalues": None,
        "weights": [],
    }
    save_run(out, arrays, result, output, error)

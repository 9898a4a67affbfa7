"""Whether a simulator runs on all records of a dataset, and what it leaves of them."""

from pathlib import Path

from hystbench.gap.bases.load import load_base
from hystbench.gap.fitting.on_records import run_base
from hystbench.gap.records.evidence import load_evidence
from hystbench.metrics import rms


def simulator_line(dataset: str | Path, simulator: str) -> str:
    """Run a simulator on all records, and say what it leaves of the fit records.

    Parameters
    ----------
    dataset : str or Path
        Path of its dataset.yaml.
    simulator : str
        As of ``hystbench gap --model``.

    Returns
    -------
    str
        One sentence: where the simulator comes from, and the rms of what it leaves of
        the fit records beside that of their outputs without a mean.

    Raises
    ------
    InputError
        If it is no model of these records, or does not stay bounded on one.
    """
    evidence = load_evidence(dataset)
    base, note = load_base(simulator, evidence)
    hold = evidence.input_hold
    run_base(base, evidence.hold_out, hold)
    outputs = run_base(base, evidence.fit, hold)
    pairs = list(zip(evidence.fit, outputs, strict=True))
    left = rms(*((record.y - y)[record.counted] for record, y in pairs))
    whole = rms(*((x.y - x.y.mean())[x.counted] for x in evidence.fit))
    unit = evidence.output.unit
    return (
        f"{note}; it runs on all records, and leaves {left:.3g} {unit} rms of the fit "
        f"records, whose outputs move by {whole:.3g} {unit} rms"
    )

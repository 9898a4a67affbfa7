"""``hystbench job gap-show``: compare with the hold-out records, write gap.json."""

from hystbench import options
from hystbench.gap.bases.load import checked_base
from hystbench.gap.computing_time import write_took
from hystbench.gap.records.evidence import load_evidence
from hystbench.gap.stages import show_in
from hystbench.model import load_model
from hystbench.options import DatasetFile, In, Out, OutFolder, command


@command
@options.kept_calls
def gap_show(
    dataset: DatasetFile, *, base: In, out: OutFolder, took: Out | None = None
) -> None:
    """Show on the hold-out records of DATASET how far the gap shrinks.

    Reads what hystbench job gap-decide wrote to OUT; writes gap.json, model.yaml and
    holdout/ there. A model that is worse there than the base is taken back.
    Writes to TOOK, if given, how long that computed.
    """
    evidence = load_evidence(dataset)
    model = checked_base(load_model(base), str(base), evidence)
    show_in(out, evidence, model)
    if took is not None:
        write_took(evidence.name, took)

"""``hystbench job compare``: tables and claims, ours beside the published."""

from functools import partial

from hystbench.compare import comparison
from hystbench.compare.runs import FILES, read_evidence
from hystbench.files import whole_folder
from hystbench.options import In, OutFolder, Settings, command


@partial(command, also=dict.fromkeys(FILES, (In, None)))
def compare(
    *,
    runs: tuple[In, ...] = (),
    records: tuple[In, ...] = (),
    settings: Settings,
    out: OutFolder,
    **files: In | None,
) -> None:
    """Compare runs with the paper: cells, claims, audit, summary and tables."""
    held_out = comparison.held_out_signals(settings["calibrated"])
    with whole_folder(out, comparison.WRITTEN) as fresh:
        evidence = read_evidence(runs, records, **files)
        comparison.Comparison(evidence, held_out).write(fresh)

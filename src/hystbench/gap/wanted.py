"""The next experiment as a signal file, if one is wanted."""

from __future__ import annotations

from pathlib import Path

from hystbench.gap.decision import Finding
from hystbench.gap.experiment.excitations import write_experiment
from hystbench.record import Channel


def write_wanted(finding: Finding, channel: Channel, path: Path) -> str:
    """Write the excitation that tells likely effects apart, or tell why there is none.

    Parameters
    ----------
    finding : Finding
    channel : Channel
        The input's.
    path : Path
        A CSV file, or an archive by its suffix ``.npz``.

    Returns
    -------
    str
        A line that tells what was done.
    """
    if finding.experiment is None:
        needless = "no effects that were tried need to be told apart"
        why = finding.content.get("no_experiment", needless)
        return f"{path}: not written: {why}"
    write_experiment(finding.experiment.excitation, channel, path)
    return f"{path}: {finding.experiment.sentence}"

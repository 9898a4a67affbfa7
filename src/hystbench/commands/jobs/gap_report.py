"""``hystbench job gap-report``: the page of one dataset, and its part of others."""

from hystbench.gap.report.page import write_report
from hystbench.gap.report.tables import write_gallery
from hystbench.options import Folder, command


@command
def gap_report(folder: Folder) -> None:
    """Write report.html from what is in FOLDER.

    Beside it verdict.md, host.csv (the numbers of what has effects inside), and model
    and residual as pictures (SVG, PNG).
    """
    write_report(folder)
    write_gallery(folder)

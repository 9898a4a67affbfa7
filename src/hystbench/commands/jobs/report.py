"""``hystbench job report``: the front page of the results."""

from hystbench.files import write_text
from hystbench.options import Folder, In, Out, Settings, command
from hystbench.report.reproduction.page import page
from hystbench.report.reproduction.read import Results


@command
def report(
    compare: Folder,
    *,
    figures: tuple[In, ...] = (),
    tables: tuple[In, ...] = (),
    captions: Folder,
    settings: Settings,
    out: Out,
) -> None:
    """Write one page on what a comparison left in the folder COMPARE.

    Figures are SVG files, tables CSV files; CAPTIONS is a folder.
    """
    results = Results(out.parent, compare, figures, tables, captions, settings)
    write_text(out, page(results))

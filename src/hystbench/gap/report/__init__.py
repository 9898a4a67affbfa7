"""One page that an engineer reads: the verdict first, then the evidence."""

from __future__ import annotations

from pathlib import Path

from hystbench.files import write_text


def write_report(folder: str | Path) -> Path:
    """Write report.html from what the gap workflow left in a folder.

    The page stands alone: pictures are inside, there is no script, and nothing is
    fetched. It reads gap.json, model.yaml, the tables in holdout/ and curves.json; what
    is not there is said to be missing.

    Parameters
    ----------
    folder : str or Path

    Returns
    -------
    Path
        The page.

    Raises
    ------
    InputError
        If gap.json is missing or not as its schema says, or another file cannot be
        read.
    """
    from hystbench.gap.report.page import page
    from hystbench.gap.report.read import read_content

    path = Path(folder) / "report.html"
    write_text(path, page(read_content(Path(folder))))
    return path

"""Tables 1-4 with ours beside the paper's, as CSV, Markdown and LaTeX."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from tabulate import tabulate

from hystbench.compare.cells import NOT_RUN, ComparedCell
from hystbench.files import write_text
from hystbench.published import METRICS, Metric, in_order

ONE_STEP_WORDS = "one-step a priori errors with running weights"
FREE_RUN_WORDS = "errors of a free-run simulation"
#: Of a printed pair of MSE and RE, by whether it can be true.
MARKS = {"yes": "", "no": "†", "undecided": "‡"}
LEGEND = (
    "† this printed pair of MSE and RE cannot be true beside the others of its "
    "signal; ‡ one of several such pairs must be wrong, which one is unknown"
)
TITLES = {
    1: "sines",
    2: "chirp",
    3: "sums of sines",
    4: "RDGPI model and GPO-based filter",
}
METRIC_NAMES: dict[Metric, str] = {"mse": "MSE (um^2)", "re": "RE"}


def grid(lines: Iterable[Iterable[str]], headers: Iterable[str], style: str) -> str:
    """Write a table of text in one of the styles of tabulate."""
    return tabulate(lines, [*headers], tablefmt=style, disable_numparse=True)


@dataclass(frozen=True)
class PrintedTable:
    """A table with its caption and what its marks mean."""

    name: str
    """Stem of its files."""
    caption: str
    """What it holds; names the kind of error and where the data are from."""
    legend: str
    """What the marks in its cells mean; empty where there are none."""
    frame: pd.DataFrame
    """Its cells as text."""

    def text(self, style: str) -> tuple[str, str, str]:
        """Give caption, cells and legend as text, the cells in a style of tabulate."""
        cells = grid(self.frame.to_numpy(), self.frame.columns, style)
        return self.caption, cells, self.legend

    def csv(self) -> str:
        """Give the table as CSV, with the caption in a column of its own."""
        caption = f"{self.caption} {self.legend}".strip()
        return str(self.frame.assign(note=caption).to_csv(index=False))

    def markdown(self) -> str:
        """Give the table as Markdown."""
        body = self.frame.to_markdown(
            index=False, disable_numparse=True, stralign="right"
        )
        legend = f"\n{self.legend}\n" if self.legend else ""
        return f"**{self.caption}**\n\n{body}\n{legend}"

    def latex(self) -> str:
        """Give the table as a LaTeX float for the package booktabs."""
        text = self.frame.rename(columns=_escape).map(_escape)
        made = text.to_latex(
            index=False,
            escape=False,
            column_format="ll" + "r" * (len(text.columns) - 2),
            caption=_escape(self.caption),
            label=f"tab:{self.name}",
        )
        legend = rf"\par\small {_escape(self.legend)}" + "\n" if self.legend else ""
        body, end, _ = made.rpartition(r"\end{table}")
        return f"{body}{legend}{end}\n"

    def write(self, folder: str | Path) -> None:
        """Write the table in all three formats."""
        texts = {"csv": self.csv(), "md": self.markdown(), "tex": self.latex()}
        for suffix, text in texts.items():
            write_text(Path(folder) / f"{self.name}.{suffix}", text)


_LATEX = str.maketrans(
    {
        "\\": r"\textbackslash{}",
        "&": r"\&",
        "%": r"\%",
        "$": r"\$",
        "#": r"\#",
        "_": r"\_",
        "{": r"\{",
        "}": r"\}",
        "~": r"\textasciitilde{}",
        "†": r"$^\dagger$",
        "‡": r"$^\ddagger$",
        "<": r"$<$",
        ">": r"$>$",
        "^": r"\textasciicircum{}",
    }
)


def _escape(text: str) -> str:
    """Write text for LaTeX."""
    parts = (part.translate(_LATEX) for part in text.split("um^2"))
    return r"\textmu m$^2$".join(parts)


def _number(value: float) -> str:
    """Write an error as the paper does, with four decimals, where they suffice."""
    if 0.001 <= value < 1000:
        return f"{value:.4f}"
    return f"{value:.2g}" if value < 1 else f"{value:.4g}"


def _ours(cell: ComparedCell) -> str:
    if cell.ours is not None:
        return _number(cell.ours)
    return "diverged" if cell.ran else NOT_RUN


def error_kind(models: Iterable[str]) -> str:
    """Say in words what the errors of these models are."""
    listed = list(models)
    if "rdgpi" not in listed:
        return ONE_STEP_WORDS[0].upper() + ONE_STEP_WORDS[1:]
    if len(listed) == 1:
        return FREE_RUN_WORDS[0].upper() + FREE_RUN_WORDS[1:]
    others = ", ".join(model for model in listed if model != "rdgpi")
    return f"{others}: {ONE_STEP_WORDS}; rdgpi: {FREE_RUN_WORDS}"


def paper_table(
    number: int, cells: Sequence[ComparedCell], draws: Mapping[str, int]
) -> PrintedTable:
    """Set ours beside one table of the paper; Table 4 repeats the GPO filter.

    ``draws`` tells how often a signal was drawn.
    """
    own = [cell for cell in cells if cell.table == number]
    rows = list(dict.fromkeys(cell.signal for cell in own))
    models = {cell.model for cell in own} | ({"gpo"} if number == 4 else set())
    columns = in_order(models)
    by_key = {(c.signal, c.model, c.metric): c for c in cells}
    content = []
    for signal in rows:
        for metric in METRICS:
            line = {"signal": signal, "error": METRIC_NAMES[metric]}
            for model in columns:
                cell = by_key[signal, model, metric]
                mark = MARKS[cell.published_consistent]
                line[f"{model} paper"] = cell.published + mark
                line[f"{model} ours"] = _ours(cell)
            content.append(line)
    return PrintedTable(
        name=f"table-{number}",
        caption=(
            f"Table {number} of the paper ({TITLES[number]}) with ours beside it. "
            f"{error_kind(columns)}. The paper's are of a measured actuator, ours of "
            "its twin, a simulation."
        ),
        legend="; ".join(
            [
                LEGEND,
                *(
                    f"ours on {signal} are medians over {count} draws of its phases"
                    for signal, count in draws.items()
                    if signal in rows
                ),
                *dict.fromkeys(
                    f"{c.signal}, {c.model}: {c.status}"
                    for c in own
                    if c.ran and c.ours is None
                ),
            ]
        ),
        frame=pd.DataFrame(content, dtype=str),
    )

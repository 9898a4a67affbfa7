"""``find_gap``: what ``hystbench gap`` does, from Python."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from hystbench.cores import on_cores
from hystbench.dataset import Dataset
from hystbench.errors import refuse_unknown
from hystbench.gap.asked import Asked
from hystbench.gap.progress import Say, silent
from hystbench.gap.records.evidence import Evidence, load_evidence
from hystbench.gap.run import Closed, closed_gap
from hystbench.gap.thresholds import UNNAMED_SHARE
from hystbench.gap.vocabulary import Vocabulary, in_words
from hystbench.model import Model

if TYPE_CHECKING:
    import pandas as pd

    from hystbench.gap.experiment.tell_apart import Experiment
    from hystbench.interface.picture import Picture

Table = Literal["records", "effects", "ranking"]
TABLES: tuple[Table, ...] = ("records", "effects", "ranking")


@dataclass(frozen=True, repr=False)
class ShownEffect:
    """An effect that the search named.

    Parameters
    ----------
    name, place : str
    confidence : float
        From 0 to 1, among the effects that were tried.
    parameters : mapping
        By name: ``value``, ``standard_error`` and ``unit``.
    cannot_be_told_from : tuple of str
    causes : tuple of str
        What usually causes it: in such a device, where its kind is known.
    """

    name: str
    place: str
    confidence: float
    parameters: Mapping[str, Mapping[str, Any]]
    cannot_be_told_from: tuple[str, ...]
    causes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        """Tell the name, how sure it is, and its numbers."""
        said = ", ".join(_number(*item) for item in self.parameters.items())
        rivals = (
            "; not to be told from "
            f"{', '.join(map(in_words, self.cannot_be_told_from))}"
            if self.cannot_be_told_from
            else ""
        )
        return (
            f"{in_words(self.name)} ({self.place}), confidence "
            f"{100 * self.confidence:.0f} %: {said}{rivals}"
        )


@dataclass(frozen=True, repr=False)
class Gap:
    """A gap between a simulator and measurements, and what closes it.

    Parameters
    ----------
    closed : Closed
        The decision and what the hold-out records showed.
    note : str
        Where the simulator comes from.
    places : mapping
        ``dataset`` and ``model`` as a command line would name them.
    """

    closed: Closed
    note: str
    places: Mapping[str, str]

    @property
    def content(self) -> Mapping[str, Any]:
        """What gap.json holds."""
        return self.closed.outcome.content

    @property
    def verdict(self) -> str:
        """``named``, ``parameters``, ``no-gap`` or ``unnamed``."""
        return str(self.content["verdict"])

    @property
    def sentence(self) -> str:
        """The verdict as the page says it."""
        from hystbench.gap.report.page import with_optional
        from hystbench.gap.report.words import verdict_sentence

        return verdict_sentence(with_optional(self.content))

    @property
    def effects(self) -> tuple[ShownEffect, ...]:
        """What was named; what a user put in is none of it."""
        return tuple(
            ShownEffect(
                item["name"],
                item["place"],
                item["confidence"],
                item["parameters"],
                tuple(item["cannot_be_told_from"]),
                tuple(item["causes"]),
            )
            for item in self.content["effects"]
        )

    @property
    def model(self) -> Model:
        """The simulator with its effects: ``gap.model.simulate(u, dt)``."""
        return self.closed.outcome.model

    @property
    def experiment(self) -> Experiment | None:
        """The excitation that would tell likely effects apart, if one is needed."""
        return self.closed.decision.experiment

    def __repr__(self) -> str:
        """Tell the verdict, the residual before and after, and the effects."""
        size, unit = self.content["gap"], self.content["unit"]
        after = "unbounded" if size["after"] is None else f"{size['after']:.3g}"
        lines = [
            f"Gap of {self.content['dataset']} against {self.content['model']}: "
            f"{self.sentence}",
            f"  on hold-out records {size['before']:.3g} to {after} {unit} rms, noise "
            f"floor {size['noise_floor']:.3g} {unit}",
            *(f"  {effect!r}" for effect in self.effects),
        ]
        if self.content.get("built_in"):
            lines.append(f"  {self.content['built_in']['sentence']}")
        return "\n".join(lines)

    def to_frame(self, table: Table = "records") -> pd.DataFrame:
        """Give a table of the result.

        Parameters
        ----------
        table : {"records", "effects", "ranking"}
            A row a hold-out record, with its RMS residual before and after in the unit
            of the output; a row a number of an effect; or a row an effect that was
            tried.

        Raises
        ------
        InputError
            If there is no such table.
        """
        import pandas as pd  # late: it takes half a second

        refuse_unknown(table, TABLES, f"to_frame: no table {table!r}")
        if table == "ranking":
            return pd.DataFrame(self.content["ranking"], columns=list(RANKED))
        if table == "effects":
            numbers = [
                {"effect": effect.name, "parameter": name, **item}
                for effect in self.effects
                for name, item in effect.parameters.items()
            ]
            return pd.DataFrame(numbers, columns=list(NUMBERS))
        unit, records = self.content["unit"], pd.DataFrame(self.content["records"])
        titles = {key: f"{key} ({unit})" for key in ("before", "after")}
        found = records.rename(columns={"name": "record", **titles})
        return found[["record", *titles.values()]]

    def plot(self) -> Picture:
        """Draw the hold-out records: loops and residuals, before and after.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from hystbench.interface.dataset import DRAWN
        from hystbench.interface.picture import drawn, gap  # late: it draws

        records = self.closed.evidence.hold_out[:DRAWN]
        outputs = self.closed.outcome.outputs[:DRAWN]
        floor = self.content["gap"]["noise_floor"]
        return drawn(
            lambda axes: gap(axes, records, outputs, floor), len(records), 2, 2.2
        )

    def save(self, folder: str | Path, report: bool = True) -> Path:
        """Write the folder that ``hystbench gap --out`` writes.

        Parameters
        ----------
        folder : str or Path
            Gets gap.json, model.yaml, curves.json, holdout/ and report.html. Files
            that hystbench did not write are never replaced.
        report : bool
            Whether to write the page. It shows how to run the search again with other
            effects.

        Returns
        -------
        Path
            The folder.

        Raises
        ------
        InputError
            If a file that hystbench did not write stands in the way.
        """
        outcome = self.closed.outcome
        command = {**self.places, "out": str(folder)}
        told = replace(outcome, content={**outcome.content, "command": command})
        replace(self.closed, outcome=told).write(Path(folder), report)
        return Path(folder)


RANKED = ("round", "name", "place", "form", "gain", "score", "taken", "declined")
"""Columns of the table of what was tried."""
NUMBERS = ("effect", "parameter", "value", "standard_error", "unit")
"""Columns of the table of the effects' numbers."""


def find_gap(
    dataset: str | Path | Dataset,
    model: str | Path | Model,
    *,
    without: Sequence[str] = (),
    with_: Sequence[str] = (),
    limits: Mapping[str, float] | None = None,
    unnamed_share: float = UNNAMED_SHARE,
    calls: int | None = None,
    keep_calls: bool = True,
    cache: bool = True,
    cores: int = 1,
    say: Say = silent,
    evidence: Evidence | None = None,
) -> Gap:
    """Find what a simulator lacks beside measurements, add it, show the gap shrink.

    Parameters
    ----------
    dataset : str, Path or Dataset
        A dataset.yaml, its folder, or what :func:`load_dataset` gave.
    model : str, Path or Model
        A model file; ``gpi`` or ``linear`` to identify one from the fit records;
        ``column`` for the simulated output beside them; ``package.module:function``;
        or a model itself.
    without : sequence of str
        Effects that the search must not name.
    with_ : sequence of str
        Effects that are in the model from the start: they are fitted, and are no
        finding.
    limits : mapping of str to float, optional
        What the next experiment may ask of the actuator: ``low``, ``high``, ``rate``.
    unnamed_share : float
        Share of the gap's power that may stay unnamed beside a name.
    calls : int, optional
        Calls of a function that are made at most; the search then ends.
    keep_calls : bool
        Whether outputs of a slow function are kept in the user's cache folder.
    cache : bool
        Whether what the search computes is kept there, so that another search on the
        same records need not compute it again.
    cores : int
        Cores that the search may use, on Linux. It finds the same on any number. A
        function of your own is called on one alone.
    say : callable
        Told a line of progress at a time.
    evidence : Evidence, optional
        The dataset's records, where they were read and checked already.

    Returns
    -------
    Gap

    Raises
    ------
    InputError
        If a file, a unit or a name is wrong, or the model does not run.
    """
    asked = Asked(
        limits=limits,
        unnamed_share=unnamed_share,
        vocabulary=Vocabulary.of(without, with_),
        say=say,
    )
    if evidence is None:
        evidence = _evidence(dataset)
    place = str(dataset.path if isinstance(dataset, Dataset) else dataset)
    with _kept(calls, keep_calls, cache, say), on_cores(cores):
        from hystbench.gap.bases.load import load_base  # late: what it needs depends

        base, note = load_base(
            str(model) if isinstance(model, Path) else model, evidence
        )
        say(note)
        called = model.name if isinstance(model, Model) else str(model)
        closed = closed_gap(evidence, base, asked, called)
    places = {
        "dataset": place,
        "model": "MODEL.yaml" if isinstance(model, Model) else str(model),
    }
    return Gap(closed, note, places)


def _evidence(dataset: str | Path | Dataset) -> Evidence:
    evidence = load_evidence(
        dataset.path if isinstance(dataset, Dataset) else Path(dataset)
    )
    for line in evidence.warnings:
        warnings.warn(line, stacklevel=3)
    return evidence


@contextmanager
def _kept(calls: int | None, keep_calls: bool, cache: bool, say: Say) -> Iterator[None]:
    """Let what is computed within the block be kept, as far as that is wanted."""
    from hystbench.gap.cache import Remembered, folder, remembering
    from hystbench.options import counted_calls

    store = Remembered(folder(), say) if cache else None
    with counted_calls(calls, keep_calls, say), remembering(store):
        yield


def _number(name: str, item: Mapping[str, Any]) -> str:
    value, error = item["value"], item["standard_error"]
    if isinstance(value, list):
        return f"{name} of {len(value)} numbers"
    if isinstance(value, str):
        return f"{name} {value}"
    unit = "" if item["unit"] in ("", "-") else f" {item['unit']}"
    sure = f" ± {error:.2g}" if isinstance(error, float) else ""
    return f"{name} {value:.4g}{sure}{unit}"

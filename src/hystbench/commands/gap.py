"""``hystbench gap``: find what a simulator lacks, add it, show the gap shrink."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench.gap.bases import load_base
from hystbench.gap.evidence import Evidence, load_evidence
from hystbench.gap.excitations import write_experiment as save
from hystbench.gap.finding import Finding
from hystbench.gap.run import close_gap


@click.command()
@click.argument("dataset", type=click.Path(path_type=Path))
@click.option(
    "--model",
    required=True,
    help="Model file, gpi, linear, column, or package.module:function.",
)
@click.option("--out", type=click.Path(path_type=Path), required=True)
@click.option(
    "--write-experiment",
    type=click.Path(dir_okay=False, path_type=Path),
    help="Write the excitation that would tell likely effects apart as a CSV signal.",
)
@click.option("--limit-low", type=float, help="Lowest input of the next experiment.")
@click.option("--limit-high", type=float, help="Highest input of the next experiment.")
@click.option(
    "--limit-rate",
    type=float,
    help="Largest rate of its input, per second. What is not given is the records'.",
)
@click.option("--report/--no-report", default=True, help="Whether to write the page.")
def gap(
    dataset: Path,
    model: str,
    out: Path,
    write_experiment: Path | None,
    limit_low: float | None,
    limit_high: float | None,
    limit_rate: float | None,
    report: bool,
) -> None:
    """Find what MODEL lacks beside the measurements in DATASET.

    Writes OUT/gap.json, model.yaml, holdout/ and report.html.
    """
    evidence = load_evidence(dataset)
    base, note = load_base(model, evidence)
    if note:
        click.echo(note)
    limits = {"low": limit_low, "high": limit_high, "rate": limit_rate}
    finding = close_gap(
        evidence,
        base,
        out,
        place=model,
        limits={key: value for key, value in limits.items() if value is not None},
        report=report,
        say=lambda line: click.echo(line, err=True),
    )
    if write_experiment is not None:
        _write_experiment(finding, evidence, write_experiment)
    effects = [item["name"] for item in finding.content["effects"]]
    named = f": {', '.join(effects)}" if effects else ""
    click.echo(f"{out / 'gap.json'}: {finding.content['verdict']}{named}")


def _write_experiment(finding: Finding, evidence: Evidence, path: Path) -> None:
    if finding.experiment is None:
        why = finding.content.get("no_experiment", "no effects need to be told apart")
        click.echo(f"{path}: not written: {why}")
        return
    save(finding.experiment.excitation, evidence.input, path)
    click.echo(f"{path}: {finding.experiment.sentence}")

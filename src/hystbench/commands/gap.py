"""``hystbench gap``: find what a simulator lacks, add it, show the gap shrink."""

from __future__ import annotations

from pathlib import Path

import click

from hystbench import options
from hystbench.gap.asked import check_base
from hystbench.gap.bases import load_base
from hystbench.gap.evidence import load_evidence
from hystbench.gap.limits import Limits
from hystbench.gap.run import close_gap
from hystbench.gap.wanted import write_wanted


@click.command()
@click.argument("dataset", type=options.DATASET)
@click.option(
    "--model",
    required=True,
    help="Model file, gpi, linear, column, or package.module:function.",
)
@options.out_folder
@options.write_experiment
@options.limits
@options.unnamed_share
@options.calls
@click.option("--report/--no-report", default=True, help="Whether to write the page.")
def gap(
    dataset: Path,
    model: str,
    out: Path,
    write_experiment: Path | None,
    limit_low: float | None,
    limit_high: float | None,
    limit_rate: float | None,
    unnamed_share: float,
    calls: int | None,
    keep_calls: bool,
    report: bool,
) -> None:
    """Find what MODEL lacks beside the measurements in DATASET.

    Writes OUT/gap.json, model.yaml, holdout/ and report.html.
    """

    def say(line: str) -> None:
        click.echo(line, err=True)

    asked = options.asked_limits(limit_low, limit_high, limit_rate)
    check_base(model)
    evidence = load_evidence(dataset)
    options.warn(evidence.warnings)
    Limits.within(evidence.fit, asked)  # refuses, before work is paid
    with options.counted_calls(calls, keep_calls, say):
        base, note = load_base(model, evidence)
        if note:
            click.echo(note)
        finding = close_gap(
            evidence,
            base,
            out,
            place=model,
            limits=asked,
            unnamed_share=unnamed_share,
            report=report,
            say=say,
        )
    if write_experiment is not None:
        click.echo(write_wanted(finding, evidence.input, write_experiment))
    effects = [item["name"] for item in finding.content["effects"]]
    named = f": {', '.join(effects)}" if effects else ""
    click.echo(f"{out / 'gap.json'}: {finding.content['verdict']}{named}")

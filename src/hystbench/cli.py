"""The command line: one small file a command in :mod:`hystbench.commands`.

Commands are imported when they are called, so that a job pays for what it uses
and ``hystbench --help`` for nothing.
"""

from __future__ import annotations

import importlib
import os
import sys

import click

from hystbench import __version__
from hystbench.errors import InputError, nearest

#: Each command and the line that ``--help`` shows for it.
COMMANDS = {
    "signal": "Make an excitation signal.",
    "measure": "Simulate a model on a signal and record it.",
    "simulate": "Run a model on one record.",
    "load": "Read and check one record of a measured dataset.",
    "identify": "Identify the envelope functions (Algorithm 1).",
    "filter": "Run one LMS filter on one record.",
    "envelopes": "Run the GPO filter with identified and published envelopes.",
    "order-sweep": "Run the filters over a range of orders (Figure 7).",
    "random-sum": "Run all models on many draws of the random sum.",
    "step-sweep": "Find how far each step size can go (Eq. 19).",
    "constants": "Rank the filters with other constants.",
    "hypotheses": "Try what could explain errors that stay far off.",
    "calibrate": "Fit the twin and the step sizes to the published tables.",
    "tried": "Write what the calibration tried and found as tables.",
    "structure": "Try one structure on the calibration signals.",
    "structures": "Write a table of the structures that were tried.",
    "held-out": "Judge the structures that were tried on the held-out signals.",
    "families": "Fit twins with other hysteresis.",
    "rdgpi-identify": "Identify the rate-dependent GPI model.",
    "rdgpi": "Simulate the rate-dependent GPI model on one record.",
    "rdgpi-published": "Simulate it with the eleven published values.",
    "compare": "Write tables and claims, ours beside the published.",
    "compare-measured": "Write the errors on a measured dataset.",
    "twin-fits": "Fit what no step size changes on several twins.",
    "twin-runs": "Run one filter on several twins.",
    "twins": "Judge the claims on several twins as configured.",
    "pressure": "Judge the claims on many twins, step sizes and seeds.",
    "contest": "Give each filter its own best step size.",
    "gap": "Find what a simulator lacks, add it, show the gap shrink.",
    "gap-check": "Check all records of a gap before it is searched.",
    "gap-start": "Run the base of a gap on the fit records.",
    "gap-candidate": "Try one effect beside a model.",
    "gap-choose": "Take the best effect of a round, if it pays.",
    "gap-decide": "Give the verdict on a gap, from the fit records alone.",
    "gap-show": "Show on hold-out records how far a gap shrinks.",
    "gap-report": "Write the page of a gap.",
    "gap-summary": "Write the verdicts on several datasets as tables.",
    "gap-twin": "Write the worked example of the gap as a dataset.",
    "hide": "Make records in which a plant hides effects.",
    "blind-make": "Make the cases of a chunk of the blind contest.",
    "blind-solve": "Run a solver on a chunk of the blind contest.",
    "blind-judge": "Judge the answers to a chunk of the blind contest.",
    "blind-summary": "Sum up the blind contest.",
    "rival": "Run a rival of the gap's solver on a dataset.",
    "show": "Print the tables of a comparison.",
    "figure": "Draw one figure.",
    "docs": "Fill the tables of README.md and docs from results.",
}


class LazyGroup(click.Group):
    """A group that imports a command when it is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Name the commands in the order of the workflow."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import a command; an unknown name gets the nearest one."""
        if cmd_name not in COMMANDS:
            raise InputError(f"no command {cmd_name!r}; {nearest(cmd_name, COMMANDS)}")
        module = cmd_name.replace("-", "_")
        command: click.Command = getattr(
            importlib.import_module(f"hystbench.commands.{module}"), module
        )
        return command

    def format_commands(
        self, ctx: click.Context, formatter: click.HelpFormatter
    ) -> None:
        """List the commands without importing them."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))


@click.group(cls=LazyGroup)
@click.version_option(__version__)
def cli() -> None:
    """Benchmark rate-dependent hysteresis models of smart actuators."""


def main() -> None:
    """Run the command line; a user's mistake is one line and exit status 2."""
    # Products of matrices are small here: threads of BLAS would cost more than they
    # give, and the last bits would depend on their number.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    try:
        cli(prog_name="hystbench")
    except InputError as error:
        print(f"hystbench: {error}", file=sys.stderr)
        sys.exit(2)
    except OSError as error:
        if error.filename is None:
            raise
        print(f"hystbench: {error.filename}: {error.strerror}", file=sys.stderr)
        sys.exit(2)

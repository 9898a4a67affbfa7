"""The command line: one small file a command in :mod:`hystbench.commands`.

What only the rules of the workflow call is in :mod:`hystbench.commands.jobs`, as
``hystbench job NAME``, and not listed.

Commands are imported when they are called, so that a job pays for what it uses
and ``hystbench --help`` for nothing. So is all else that takes time to import: a
Ctrl-C is to be one line from the first moment on.
"""

import contextlib
import errno
import os
import sys
from collections.abc import Callable

from hystbench import interrupt

#: Each command of a user's and the line that ``--help`` shows for it.
COMMANDS = {
    "init": "Propose a dataset.yaml for files of measurements.",
    "check": "Say what records are like and which effects they can reveal.",
    "gap": "Find what a simulator lacks, add it, show the gap shrink.",
    "simulate": "Run a model on one record.",
    "load": "Read and check one record of a measured dataset.",
    "export": "Write a model as C, a Python module or an FMU.",
    "invert": "Find the input that makes a model's output follow a reference.",
    "hide": "Make records in which a plant hides effects.",
    "rival": "Run a rival of the gap's solver on a dataset.",
    "crate": "Pack results as an RO-Crate, for an archive.",
    "docs": "Fill the tables of README.md and docs from results.",
    "clean": "Remove what hystbench wrote, and nothing else.",
}

#: Errors of a full disk, told in one line though they name no file.
FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def main() -> None:
    """Run the command line; a user's mistake is one line and exit status 2.

    So is a full disk. Ctrl-C is one line and exit status 130.
    """
    try:
        interrupt.listen()
        status = run()
        interrupt.end_at_once()
    except interrupt.Interrupted as ended:
        interrupt.end_at_once()
        _tell(interrupt.TOLD)
        status = ended.status
    sys.exit(status)


def run() -> int:
    """Run the command that the arguments name.

    Returns
    -------
    int
        Exit status.
    """
    # Products of matrices are small here: threads of BLAS would cost more than they
    # give, and the last bits would depend on their number.
    os.environ["OPENBLAS_NUM_THREADS"] = "1"
    from hystbench.errors import InputError
    from hystbench.group import group

    try:
        status = _called(group(COMMANDS))
    except (InputError, ChildProcessError) as error:
        _tell(f"hystbench: {error}")
        return 2
    except OSError as error:
        if error.filename is not None:
            _tell(f"hystbench: {error.filename}: {error.strerror}")
        elif error.errno in FULL:
            # Files of results are named; what is left is what was printed, mostly.
            _drop_what_was_printed()
            _tell(f"hystbench: standard output or a temporary file: {error.strerror}")
        else:
            raise
        return 2
    return status


def _called(command: Callable[..., object]) -> int:
    """Call the group and give its exit status, all that it printed being out."""
    status = 0
    try:
        command(prog_name="hystbench")
    except SystemExit as ended:
        status = ended.code if isinstance(ended.code, int) else int(bool(ended.code))
    try:
        sys.stdout.flush()
    except OSError as error:
        _drop_what_was_printed()
        if isinstance(error, BrokenPipeError):
            return status or 1
        raise OSError(error.errno, error.strerror, "standard output") from None
    return status


def _drop_what_was_printed() -> None:
    """Let the rest of the text go nowhere, or Python would try again at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def _tell(line: str) -> None:
    with contextlib.suppress(OSError):  # the log may be on the disk that is full
        print(line, file=sys.stderr, flush=True)

"""Block ``command``: a simulator that is a program of its own, in any language."""

import os
import re
import shlex
import shutil
import signal
import subprocess
from contextlib import suppress
from pathlib import Path

import numpy as np

from hystbench.blocks.parameter import number, text
from hystbench.blocks.simulator import STARTED, CallError, Simulator, digest_of
from hystbench.errors import InputError, short
from hystbench.record import FloatArray
from hystbench.scratch import scratch_folder

INPUT, OUTPUT, STEP = "{input}", "{output}", "{dt}"
"""What stands in a command line for the files that it reads and writes, and for dt."""
HEADER = "time_s,u"
APART = re.compile(r",*[;\s][;,\s]*")
DECIMAL_COMMA = re.compile(r"(^|,)[+-]?\d*,\d+([eE][+-]?\d+)?$")


class Command(Simulator, name="command"):
    """A command line that reads u and writes y: ``y = program(u)``.

    It gets a CSV table with the columns time_s and u and a row a sample, on its
    standard input or as the file that ``{input}`` stands for. It writes a row a sample,
    the last cell of which is y, to its standard output or to the file ``{output}``; a
    header is passed over. Numbers have a decimal point; cells end at a comma, a
    semicolon, a tab or a blank. ``{dt}`` stands for the sampling interval in seconds.
    It is started from the folder that hystbench was started in, without a shell.

    References
    ----------
    By definition.
    """

    command: str = text("command line of a program that reads u and writes y")
    timeout_s: float = number("s", "longest run", 1e-3, 1e6, 600.0)

    def check(self) -> None:
        """Refuse what is no command line."""
        try:
            words = shlex.split(self.command)
        except ValueError as error:
            raise InputError(
                f"command: {short(self.command)}: {error}; expected a command line"
            ) from None
        if not words:
            raise InputError("command: expected a command line, got nothing")

    @property
    def label(self) -> str:
        """The command line."""
        return self.command

    def source(self) -> str:
        """Digest of the line, of the program and of all files that are named in it."""
        words = shlex.split(self.command)
        program = shutil.which(words[0])
        files = [Path(word) for word in words[1:] if Path(word).is_file()]
        if program is not None:
            files.insert(0, Path(program))
        return digest_of(self.command, *files)

    def run(self, z: FloatArray, dt: float) -> list[float]:
        """Start the program once."""
        time = np.arange(len(z)) * dt
        rows = zip(time.tolist(), z.tolist(), strict=True)
        table = "\n".join([HEADER, *(f"{t!r},{u!r}" for t, u in rows)]) + "\n"
        with scratch_folder("command-") as folder:
            given, gives = Path(folder, "input.csv"), Path(folder, "output.csv")
            by_file = INPUT in self.command
            if by_file:
                given.write_text(table)
            stands = {INPUT: str(given), OUTPUT: str(gives), STEP: repr(dt)}
            words = [_filled(word, stands) for word in shlex.split(self.command)]
            said = self._run(words, "" if by_file else table)
            if OUTPUT in self.command:
                if not gives.is_file():
                    raise CallError(f"wrote no file {OUTPUT}")
                said = gives.read_text(errors="replace")
        return _numbers(said, dt, len(z))

    def _run(self, words: list[str], table: str) -> str:
        """Run a program to its end and give what it wrote to its standard output."""
        try:
            # Never through a shell; the line stands in the user's own model file.
            process = subprocess.Popen(  # noqa: S603
                words,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                errors="replace",
                start_new_session=True,
            )
        except OSError as error:
            raise InputError(
                f"{self.command}: cannot start {words[0]!r} ({error.strerror}); "
                f"expected a program, looked for from {Path.cwd()}, {STARTED}"
            ) from error
        with process:
            try:
                said, wrong = process.communicate(table, timeout=self.timeout_s)
            except subprocess.TimeoutExpired:
                _end(process)
                told = f"ran for more than {self.timeout_s:g} s (timeout_s)"
                raise CallError(told) from None
            except BaseException:
                _end(process)
                raise
        if process.returncode:
            last = (wrong.strip().splitlines() or ["no message"])[-1]
            raise CallError(f"ended with status {process.returncode}: {short(last)}")
        return said


def _end(process: subprocess.Popen[str]) -> None:
    """End a program and all that it started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()


def _filled(word: str, stands: dict[str, str]) -> str:
    for mark, value in stands.items():
        word = word.replace(mark, value)
    return word


def _numbers(said: str, dt: float, count: int) -> list[float]:
    """Read the last cell of each row; one header is passed over."""
    rows = [line.strip() for line in said.splitlines() if line.strip()]
    header = ""
    if len(rows) == count + 1 and not _is_number(_last(rows[0])):
        header, *rows = rows
    if len(rows) != count:
        first = f", the first {short(rows[0])}" if rows else ""
        raise CallError(
            f"wrote {len(rows)} rows{first}; expected {count}, one a sample"
        )
    for k, row in enumerate(rows, start=1):
        if not _is_number(_last(row)):
            raise CallError(f"wrote {short(row)} as row {k}; expected y")
    _refuse_decimal_commas(header, rows, dt)
    return [float(_last(row)) for row in rows]


def _refuse_decimal_commas(header: str, rows: list[str], dt: float) -> None:
    """Refuse rows whose last comma may be a decimal one.

    It is none where commas alone part the cells and a number of the table has a point,
    the header has as many commas, or the time of the sample stands before it.

    Raises
    ------
    CallError
        If nothing tells.
    """
    unclear = [k for k, row in enumerate(rows) if DECIMAL_COMMA.search(_cells(row)[-1])]
    if not unclear:
        return
    row = rows[unclear[0]]
    if not any(APART.search(row) for row in rows):
        if any("." in row for row in rows):
            return
        if header and {row.count(",") for row in rows} == {header.count(",")}:
            return
        if all(_is_timed(row, k * dt, dt) for k, row in enumerate(rows)):
            return
    raise CallError(
        f"wrote {short(row)} as row {unclear[0] + 1}, whose comma may be a decimal "
        f"one; expected y with a decimal point, or a header such as {HEADER}"
    )


def _is_timed(row: str, time: float, dt: float) -> bool:
    """Tell whether a row is ``time,y``."""
    before, comma, after = row.partition(",")
    if not comma or "," in after or not _is_number(before):
        return False
    return abs(float(before) - time) <= 1e-6 * (dt + abs(time))


def _cells(row: str) -> list[str]:
    """Cut a row at semicolons, tabs and blanks; commas beside one belong to it."""
    return APART.split(row.strip())


def _last(row: str) -> str:
    return _cells(row)[-1].split(",")[-1]


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True

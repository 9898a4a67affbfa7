"""TDMS files of LabVIEW, by nptdms: each group is a record, each channel a column."""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from hystbench.formats.table import Filling, Table, told
from hystbench.libraries import library

UNITS = ("unit_string", "NI_UnitDescription", "unit", "Unit")


def read(path: Path) -> Table:
    """Read all channels, as ``group/channel``, with unit and sampling frequency."""
    nptdms = library("nptdms", path, "formats")
    found = Filling(path)
    with told(path, "TDMS file"), _heard(found.notes):
        content = nptdms.TdmsFile.read(path)
        for group in content.groups():
            for channel in group.channels():
                name = f"{group.name}/{channel.name}"
                units = filter(None, map(channel.properties.get, UNITS))
                unit = next(map(str, units), None)
                step = channel.properties.get("wf_increment")
                frequency = 1.0 / float(step) if step and float(step) > 0 else None
                if len(channel):
                    found.add(name, channel[:], unit, frequency)
    return found.table()


class _Listener(logging.Handler):
    def __init__(self, notes: list[str]) -> None:
        super().__init__(logging.WARNING)
        self.notes = notes

    def emit(self, record: logging.LogRecord) -> None:
        self.notes.append(f"nptdms says: {record.getMessage()}")


@contextmanager
def _heard(notes: list[str]) -> Iterator[None]:
    """Note what the library would print, such as that a file ends too early."""
    parent = logging.getLogger("nptdms")
    # Each of its modules has a logger and a handler of its own.
    own = [
        logging.getLogger(name)
        for name in list(logging.root.manager.loggerDict)
        if name.startswith("nptdms.")
    ]
    before = [(logger, logger.handlers) for logger in (parent, *own)]
    for logger in own:
        logger.handlers = []
    parent.handlers = [_Listener(notes)]
    try:
        yield
    finally:
        for logger, handlers in before:
            logger.handlers = handlers

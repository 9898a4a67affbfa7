"""Work that is shared among cores gives what one core gives."""

import os
import time

import pytest

from hystbench import cli, cores
from hystbench.cores import each, on_cores


@pytest.fixture
def two(monkeypatch):
    """Two cores, and work that is always worth sharing."""
    monkeypatch.setattr(cores, "available", lambda: 2)
    monkeypatch.setattr(cores, "WORTH_S", -1.0)
    with on_cores(2):
        yield


def process_of(item):
    time.sleep(0.05)
    return item, os.getpid()


def test_two_processes_work_and_results_stay_in_order(two):
    found = each(process_of, list(range(6)), "work")
    assert [item for item, _ in found] == list(range(6))
    processes = {process for _, process in found}
    assert len(processes) == 2
    assert os.getpid() in processes


def test_one_core_makes_no_copy(two):
    with on_cores(1):
        found = each(process_of, [1, 2], "work")
    assert {process for _, process in found} == {os.getpid()}


def test_work_within_shared_work_is_not_shared_again(two):
    def inner(item):
        return {process for _, process in each(process_of, [1, 2], "inner")}

    assert all(len(own) == 1 for own in each(inner, [1, 2], "outer"))


def test_short_work_is_shared_once_it_was_seen_to_be_long(monkeypatch):
    monkeypatch.setattr(cores, "available", lambda: 2)
    monkeypatch.setattr(cores, "WORTH_S", 0.02)
    with on_cores(2):
        first, again = (each(process_of, [1, 2], "work") for _ in range(2))
        other = each(process_of, [1, 2], "work", effort=1e-6)
    told = [len({process for _, process in own}) for own in (first, again, other)]
    assert told == [1, 2, 1]


def test_what_pickle_cannot_hold_is_written_and_read(two):
    found = each(
        lambda item: lambda: item,
        [3, 4],
        "work",
        write=lambda result: result(),
        read=lambda content, item: (content, item),
    )
    assert found == [(3, 3), (4, 4)]


def test_the_error_of_the_first_item_that_fails_is_raised(two):
    def fails(item):
        time.sleep(0.02)
        if item:
            raise ValueError(f"item {item}")
        return item

    with pytest.raises(ValueError, match="item 1"):
        each(fails, [0, 1, 2, 3], "work")


def test_a_copy_that_ends_by_itself_is_told(two):
    here = os.getpid()

    def ends(item):
        if os.getpid() != here:
            os._exit(3)
        time.sleep(0.05)

    with pytest.raises(ChildProcessError, match="a copy of the process ended"):
        each(ends, [1, 2, 3], "work")


def test_no_copy_is_left_where_the_work_is_interrupted(two, monkeypatch):
    here, copies, fork = os.getpid(), [], os.fork

    def forked():
        copies.append(fork())
        return copies[-1]

    def interrupted(item):
        if os.getpid() == here:
            raise KeyboardInterrupt
        time.sleep(60)

    monkeypatch.setattr(os, "fork", forked)
    with pytest.raises(KeyboardInterrupt):
        each(interrupted, [1, 2, 3, 4], "work")
    (copy,) = copies
    with pytest.raises(ProcessLookupError):
        os.kill(copy, 0)


def test_a_copy_that_ends_is_one_line_to_a_user(monkeypatch, capsys):
    def ends(command):
        raise ChildProcessError("a copy of the process ended")

    monkeypatch.setattr(cli, "_called", ends)
    assert cli.run() == 2
    assert capsys.readouterr().err == "hystbench: a copy of the process ended\n"

"""Calls of a simulator of somebody's own: kept, bounded, told of."""

import importlib
import os
import sys

import numpy as np
import pytest

from hystbench.blocks import external
from hystbench.blocks.calls import Calls, CallsUsedUp, counted, current
from hystbench.blocks.external import External
from hystbench.blocks.kept_outputs import KeptOutputs, folder_of_user, source_digest
from hystbench.errors import InputError

U = np.linspace(-1.0, 1.0, 200)
DT = 0.01

SIMULATOR = """
import numpy as np
from pathlib import Path
from {part} import GAIN

calls = []

def scaled(u, dt):
    calls.append(len(u))
    file = Path(__file__).with_suffix(".txt")
    return GAIN * u + (float(file.read_text()) if file.is_file() else 0.0)
"""


@pytest.fixture
def rig(tmp_path, monkeypatch):
    """A simulator in a file, a part beside it, and a cache folder."""
    own = f"simulator_{os.urandom(4).hex()}"
    folder = tmp_path / "rig"
    folder.mkdir()
    monkeypatch.syspath_prepend(folder)
    (folder / f"{own}_part.py").write_text("GAIN = 2.0\n")
    (folder / f"{own}.py").write_text(SIMULATOR.format(part=f"{own}_part"))

    class Rig:
        name = f"{own}:scaled"
        cache = tmp_path / "cache"
        said: list[str] = []  # noqa: RUF012

        def restart(self):
            """As a new process would, import all again."""
            for label in (own, f"{own}_part"):
                sys.modules.pop(label, None)
            importlib.invalidate_caches()
            external.imported.cache_clear()

        def run(self, inputs=(U,), dt=DT, **more):
            """Simulate in a process of its own; give outputs and calls made."""
            self.restart()
            self.said = []
            kept = KeptOutputs(self.cache, self.said.append, **more)
            with counted(Calls(kept=kept, say=self.said.append, worth=0.0)):
                block = External(function=self.name)
                outputs = [block.simulate(u, u, dt) for u in inputs]
            return outputs, len(sys.modules[own].calls)

        def write(self, suffix, text):
            (folder / f"{own}{suffix}").write_text(text)

    yield Rig()
    Rig().restart()


def files(folder):
    return sorted(item for item in folder.rglob("*") if item.is_file())


def test_an_input_that_is_asked_again_costs_no_call(rig):
    outputs, made = rig.run((U, 2 * U, U, 2 * U))
    assert made == 2
    np.testing.assert_array_equal(outputs[2], 2 * U)


def test_what_is_given_may_be_changed_without_harm(rig):
    with counted(Calls()):
        block = External(function=rig.name)
        block.simulate(U, U, DT)[:] = 0
        np.testing.assert_array_equal(block.simulate(U, U, DT), 2 * U)


def test_a_second_run_calls_once_to_see_that_nothing_changed(rig):
    inputs = [k * U for k in range(1, 6)]
    assert rig.run(inputs)[1] == 5
    outputs, made = rig.run(inputs)
    assert made == 1
    assert not rig.said
    for k, y in enumerate(outputs, start=1):
        np.testing.assert_array_equal(y, 2 * k * U)


def test_another_sampling_interval_is_another_input(rig):
    rig.run((U, 2 * U))
    assert rig.run((U, 2 * U), dt=2 * DT)[1] == 2


@pytest.mark.parametrize("suffix", [".py", "_part.py"])
def test_other_source_is_another_function(rig, suffix):
    """What a module imports counts as much as the module itself."""
    rig.run((U, 2 * U))
    part = f"{rig.name.partition(':')[0]}_part"
    if suffix == ".py":
        rig.write(suffix, SIMULATOR.format(part=part).replace("GAIN *", "30 *"))
    else:
        rig.write(suffix, "GAIN = 30\n")
    outputs, made = rig.run((U, 2 * U))
    assert made == 2
    np.testing.assert_array_equal(outputs[1], 60 * U)


def test_a_function_that_reads_another_file_now_is_seen_to(rig):
    """The source is the same; the first call is held against what was kept."""
    rig.run((U, 2 * U))
    rig.write(".txt", "7.0")
    outputs, made = rig.run((U, 2 * U))
    assert made == 2
    np.testing.assert_array_equal(outputs[1], 4 * U + 7)
    (line,) = rig.said
    assert "another output than an earlier run kept" in line
    assert rig.run((U, 2 * U))[1] == 1  # and the new ones are kept in their place


def pickled(path):
    np.savez(path, y=np.array([{"a": 1}] * len(U), dtype=object))


def shorter(path):
    np.savez(path, y=U[:-1])


def infinite(path):
    np.savez(path, y=np.full(len(U), np.inf))


def flipped(path):
    """One bit of a number is another: the archive's own check sum tells."""
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(bytes(content))


@pytest.mark.parametrize(
    "spoil",
    [
        lambda path: path.write_bytes(b""),
        lambda path: path.write_bytes(path.read_bytes()[:300]),
        lambda path: path.write_text("no archive"),
        flipped,
        pickled,
        shorter,
        infinite,
    ],
)
def test_a_file_that_cannot_be_read_is_called_instead_and_said(rig, spoil):
    inputs = (U, 2 * U, 3 * U)
    rig.run(inputs)
    for file in files(rig.cache):
        spoil(file)
    outputs, made = rig.run(inputs)
    assert made == 3
    np.testing.assert_array_equal(outputs[2], 6 * U)
    assert 1 <= len(rig.said) <= 2
    assert all("called instead" in line for line in rig.said)
    assert rig.run(inputs)[1] == 1


def test_the_cache_is_bounded_and_the_oldest_make_room(rig):
    rig.run([U])
    (one,) = files(rig.cache)
    room = {"bound": 6 * one.stat().st_size}
    first = [k * U for k in range(1, 7)]
    rig.run(first, **room)
    assert len(files(rig.cache)) == 6
    # A run that asks for more than there is room for keeps what it began with: the
    # next one asks in the same order.
    many = [k * U for k in range(1, 21)]
    rig.run(many, **room)
    assert len(files(rig.cache)) <= 6
    assert rig.run(many, **room)[1] == 15
    assert any("full" in line for line in rig.said)


def test_nothing_but_outputs_is_ever_removed(rig):
    rig.run((U, 2 * U))
    place = files(rig.cache)[0].parent
    (place / "notes.txt").write_text("mine")
    rig.write(".txt", "7.0")
    rig.run((U, 2 * U), bound=0)
    assert (place / "notes.txt").read_text() == "mine"


def test_a_folder_that_cannot_be_written_is_said_once(rig):
    rig.cache.write_text("a file where the folder should be")
    outputs, made = rig.run((U, 2 * U, 3 * U))
    assert made == len(outputs) == 3
    assert len(rig.said) == 1
    assert "outputs are not kept" in rig.said[0]


def test_a_quick_call_is_not_worth_a_file(rig):
    clock = iter(np.arange(100) * 0.001)
    kept = KeptOutputs(rig.cache, rig.said.append)
    with counted(Calls(kept=kept, clock=lambda: next(clock))):
        External(function=rig.name).simulate(U, U, DT)
    assert not files(rig.cache)


@pytest.mark.parametrize(
    ("named", "expected"),
    [
        ("/some/place", "/some/place/hystbench/calls"),
        ("", None),
        ("not/absolute", None),
    ],
)
def test_the_folder_is_where_caches_of_a_user_are(
    monkeypatch, tmp_path, named, expected
):
    monkeypatch.setenv("XDG_CACHE_HOME", named)
    monkeypatch.setenv("HOME", str(tmp_path))
    expected = expected or f"{tmp_path}/.cache/hystbench/calls"
    assert str(folder_of_user()) == expected


def test_the_digest_knows_the_function(rig):
    External(function=rig.name).simulate(U, U, DT)
    module = rig.name.partition(":")[0]
    assert source_digest(rig.name) == source_digest(rig.name)
    assert source_digest(rig.name) != source_digest(f"{module}:calls")


def test_the_digest_asks_nothing_for_what_it_may_not_have(rig):
    """An object may fail, and a package may warn, when it is asked for a name."""
    rig.write(
        "_part.py",
        "import click\nGAIN = 2.0\n\n\nclass Odd:\n"
        "    def __getattr__(self, name):\n        raise RuntimeError(name)\n\n\n"
        "ODD = Odd()\n",
    )
    assert rig.run((U, 2 * U))[1] == 2
    assert rig.run((U, 2 * U))[1] == 1


def test_a_bound_is_kept_and_told_in_one_line(rig):
    rig.restart()
    with counted(Calls(bound=3)) as calls:
        block = External(function=rig.name)
        for k in (1, 2, 3, 1, 2):
            block.simulate(k * U, U, DT)
        assert not calls.refused()
        with pytest.raises(CallsUsedUp, match="used up: 3; expected a larger") as told:
            block.simulate(4 * U, U, DT)
        block.simulate(U, U, DT)  # what is known is given all the same
        assert calls.refused()
    assert isinstance(told.value, InputError)
    assert len(sys.modules[rig.name.partition(":")[0]].calls) == 3


def test_calls_that_are_kept_back_are_there_in_the_end(rig):
    rig.restart()
    with counted(Calls(bound=3, reserve=1)) as calls:
        block = External(function=rig.name)
        block.simulate(U, U, DT)
        block.simulate(2 * U, U, DT)
        with pytest.raises(CallsUsedUp):
            block.simulate(3 * U, U, DT)
        calls.reserve = 0
        block.simulate(3 * U, U, DT)
    assert calls.made == 3


@pytest.mark.parametrize(
    ("bound", "rest"),
    [(None, "200 in all, 3 minutes left"), (150, "150 in all, 2 minutes left")],
)
def test_progress_is_told_now_and_then_where_calls_are_slow(rig, bound, rest):
    """A call takes a second by this clock: a line every five, no more."""
    rig.restart()
    said = []
    now = iter(np.repeat(np.arange(1000.0), 2)[1:])  # 0, 1, 1, 2, 2, ...
    asked = Calls(bound, say=said.append, clock=lambda: next(now))
    with counted(asked) as calls:
        calls.expected = 200
        block = External(function=rig.name)
        for k in range(41):
            block.simulate(k * U, U, DT)
    assert len(said) == 8
    assert said[-1] == f"41 calls made; at most about {rest}"


def test_quick_work_says_nothing(rig):
    rig.restart()
    said = []
    now = iter(np.arange(1000) * 1e-3)
    with counted(Calls(say=said.append, clock=lambda: next(now))) as calls:
        calls.expected = 200
        block = External(function=rig.name)
        for k in range(41):
            block.simulate(k * U, U, DT)
    assert not said


def test_the_first_call_which_imports_is_no_measure_of_the_others(rig):
    rig.restart()
    now = iter([0.0, 8.0, 8.0, 8.5, 8.5, 9.0])  # eight seconds, then half a second each
    with counted(Calls(clock=lambda: next(now))) as calls:
        block = External(function=rig.name)
        told = []
        for k in range(3):
            block.simulate((1 + k) * U, U, DT)
            told.append(calls.mean_seconds)
    assert told == [8.0, 0.5, 0.5]


def test_calls_go_back_to_where_they_were():
    before = current()
    with pytest.raises(InputError), counted(Calls()):
        raise InputError("no")
    assert current() is before

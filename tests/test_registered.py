"""What every filter, waveform and solver owes, over all that are registered."""

import importlib.metadata
import math
import re
import sys
from dataclasses import MISSING, FrozenInstanceError, replace

import numpy as np
import pytest

from hystbench import filters, waveforms
from hystbench.adaptive import make_filter
from hystbench.entrants import rivals
from hystbench.entrants.rivals.base import read, write
from hystbench.errors import InputError
from hystbench.figures import style
from hystbench.files import read_json
from hystbench.filters.keys import keys_of
from hystbench.gap.cache import code_digest
from hystbench.gap.schema import SCHEMA
from hystbench.record import Channel, Record
from hystbench.registered import with_installed
from hystbench.schema import check_against_schema
from hystbench.signals import make_signal
from tests.figures.palette import PALETTE
from tests.gap.tiny import write_tiny

#: A name of a file and of a key.
NAME = re.compile(r"[a-z0-9][a-z0-9-]*")
COMMON = {
    "unit": "A",
    "sampling_frequency_hz": 10_000,
    "duration_s": 2.0,
    "amplitude": 0.632,
    "gain": 1.264,
}


@pytest.fixture(scope="module")
def record():
    """Two tones, and a plant with memory and a bend."""
    k = np.arange(600)
    u = 0.4 * np.sin(0.05 * k) + 0.2 * np.sin(0.31 * k + 1)
    memory = np.convolve(u, 0.7 ** np.arange(40))[: len(u)]
    y = memory + 0.5 * memory**2 + 0.05
    return Record(
        "bench", 1e-3, u, y, Channel("current", "A"), Channel("way", "um"), "measured"
    )


@pytest.fixture(params=list(filters.registry()))
def filter_class(request):
    return filters.registry()[request.param]


def usual(key):
    """A value that a key may have: its default, a word, or a number within bounds."""
    if key.default is not MISSING:
        return key.default
    if key.words:
        return key.words[0]
    low, high = max(key.least, -1.0), min(key.most, 1.0)
    return 0.5 * (low + high) if low <= high else key.least


def job(filter_class, **more):
    """Settings of a job, as those of a measured dataset."""
    own = {name: usual(key) for name, key in keys_of(filter_class).items()}
    return {
        "order": 6,
        "input_before": 0.0,
        "constant_tap": 0.0,
        "envelopes": "published",
        "fraction_of_bound": 0.05,
        **own,
        **more,
    }


@pytest.fixture
def adaptive(filter_class, record):
    return make_filter(filter_class.name, job(filter_class), record)


def test_a_filter_has_a_name_a_label_and_a_look_of_its_own(filter_class):
    assert NAME.fullmatch(filter_class.name)
    assert filter_class.label.strip() == filter_class.label != ""
    looks = style.looks()
    mine = looks[filter_class.name]
    assert mine.label == filter_class.label
    assert mine.color in PALETTE
    others = [look for name, look in looks.items() if name != filter_class.name]
    assert mine.label not in {look.label for look in others}
    assert (mine.color, mine.marker) not in {(x.color, x.marker) for x in others}


@pytest.mark.parametrize("constant_tap", [0.0, 0.3])
def test_a_filter_is_the_lms_of_its_regressor(filter_class, record, constant_tap):
    """Eqs. 13 and 18 written out, on the regressors that it says it has."""
    settings = job(filter_class, constant_tap=constant_tap)
    adaptive = make_filter(filter_class.name, settings, record)
    result = adaptive.run(record.u, record.y)
    rows = np.vstack(list(adaptive.rows(record.u)))
    assert rows.shape == (len(record.u), adaptive.size)
    weights, output = np.zeros(adaptive.size), []
    for h, d in zip(rows, record.y, strict=True):
        output.append(weights @ h)
        weights = weights + 2 * adaptive.steps * (d - output[-1]) * h
    assert result.diverged_at is None
    scale = np.abs(output).max()
    np.testing.assert_allclose(result.output, output, rtol=0, atol=1e-9 * scale)


def test_a_filter_goes_on_from_where_it_was(adaptive, record):
    """Chunk after chunk gives what the whole record gives."""
    whole = adaptive.run(record.u, record.y)
    first = adaptive.run(record.u[:217], record.y[:217])
    second = adaptive.run(record.u[217:], record.y[217:], first.state)
    both = np.concatenate((first.output, second.output))
    scale = np.abs(whole.output).max()
    np.testing.assert_allclose(both, whole.output, rtol=0, atol=1e-12 * scale)


def test_a_filter_reads_no_later_sample(adaptive, record):
    later = record.u.copy()
    later[300:] += 0.1
    before = adaptive.run(record.u, record.y).output[:300]
    after = adaptive.run(later, record.y).output[:300]
    np.testing.assert_array_equal(before, after)


def test_a_filter_is_frozen_and_bounds_each_step_size(adaptive, record):
    with pytest.raises(FrozenInstanceError):
        adaptive.order = 3
    bounds = adaptive.step_bounds(record.u)
    assert set(bounds) == set(adaptive.step_sizes)
    assert all(0 < bound < math.inf for bound in bounds.values())


def test_a_filters_keys_have_a_meaning_and_refuse_what_they_must(filter_class, record):
    for name, key in keys_of(filter_class).items():
        assert key.meaning
        assert re.fullmatch(r"[a-z][a-z0-9_]*", name)
        wrong = ["no such word" if key.words else "1.0"]
        wrong += [key.most + 1] if math.isfinite(key.most) else []
        wrong += [key.least - 1] if math.isfinite(key.least) else []
        for value in wrong:
            settings = job(filter_class, **{name: value})
            with pytest.raises(InputError, match=f"^{key.field}: ") as told:
                make_filter(filter_class.name, settings, record)
            assert "\n" not in str(told.value)


@pytest.mark.parametrize("name", list(waveforms.registry()))
def test_a_waveform_makes_its_example(name):
    waveform = waveforms.registry()[name]
    assert NAME.fullmatch(waveform.name)
    definition = {name: dict(waveform.example)}
    made = make_signal("example", definition, COMMON)
    assert len(made.u) == 20_000
    assert np.isfinite(made.u).all()
    again = make_signal("example", definition, COMMON)
    np.testing.assert_array_equal(made.u, again.u)
    for key in waveform.example:
        without = {name: {k: v for k, v in waveform.example.items() if k != key}}
        with pytest.raises(InputError, match=f"misses the key '{key}'"):
            make_signal("example", without, COMMON)


@pytest.fixture(scope="module")
def smallest(tmp_path_factory):
    """A dataset of some seconds, and its model file."""
    return write_tiny(tmp_path_factory.mktemp("smallest"))


@pytest.mark.parametrize("name", list(rivals.registry()))
def test_a_solver_writes_a_gap_json_that_keeps_the_schema(name, smallest, tmp_path):
    solver = rivals.registry()[name]
    assert NAME.fullmatch(solver.name)
    given = read(*smallest)
    answer = solver().answer(given)
    write(given, answer, tmp_path)
    gap = read_json(tmp_path / "gap.json")
    check_against_schema(gap, SCHEMA, "gap.json")
    assert (gap["dataset"], gap["model"]) == ("tiny", "tiny-base")
    assert gap["verdict"] == answer.verdict
    assert [x["name"] for x in gap["effects"]] == [x.name for x in answer.named]
    # Measured outputs of the hold-out records decide nothing.
    blind = [replace(record, y=0.0 * record.y) for record in given.hold_out]
    again = solver().answer(replace(given, hold_out=tuple(blind)))
    assert [*again.named] == [*answer.named]


class Point:
    """An entry point of an installed package."""

    def __init__(self, name, item):
        self.name, self.value, self.item = name, "package:thing", item

    def load(self):
        if isinstance(self.item, Exception):
            raise self.item
        return self.item


class Other(filters.AdaptiveFilter):
    name = "other"
    label = "other filter"

    def regressor(self, line, operators):
        return self.windows(line), operators


class Unfinished(filters.AdaptiveFilter):
    name = "other"


class Taken(Other):
    name = "gpo"


@pytest.mark.parametrize(
    ("point", "said"),
    [
        (
            Point("other", ImportError("no\nmodule")),
            "cannot be imported: ImportError: no",
        ),
        (Point("other", Unfinished), "expected a class derived from AdaptiveFilter"),
        (Point("other", print), "expected a class derived from AdaptiveFilter"),
        (Point("another", Other), "its class is named 'other'"),
        (Point("gpo", Taken), "the name is taken"),
    ],
)
def test_an_entry_point_that_is_wrong_is_one_line(monkeypatch, point, said):
    monkeypatch.setattr(importlib.metadata, "entry_points", lambda group: [point])
    with pytest.raises(InputError, match=said) as told:
        with_installed(filters.FILTERS, "group", filters.AdaptiveFilter)
    assert "\n" not in str(told.value)
    assert f"entry point {point.name!r} of group (package:thing)" in str(told.value)


def test_results_are_kept_for_what_is_installed(monkeypatch, tmp_path):
    """Another version of a package, or of a file that its effect imports, is other."""
    package = tmp_path / "added"
    package.mkdir()
    for name in ("__init__.py", "effect.py", "helper.py"):
        (package / name).write_text("")
    point = importlib.metadata.EntryPoint("x", "added.effect:X", "hystbench.effects")
    points = importlib.metadata.EntryPoints([])
    monkeypatch.setattr(importlib.metadata, "entry_points", lambda: points)
    monkeypatch.syspath_prepend(tmp_path)
    digest = code_digest.__wrapped__
    without = digest()
    points = importlib.metadata.EntryPoints([point])
    before = digest()
    (package / "helper.py").write_text("GAIN = 2.0\n")
    assert len({without, before, digest()}) == 3
    assert "added" not in sys.modules


def test_what_is_installed_is_found_beside_what_is_here(monkeypatch):
    points = [Point("other", Other)]
    monkeypatch.setattr(importlib.metadata, "entry_points", lambda group: points)
    found = with_installed(filters.FILTERS, "group", filters.AdaptiveFilter)
    assert found == {**filters.FILTERS, "other": Other}

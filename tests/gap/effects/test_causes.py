"""An effect may say its causes itself; what it cannot say is refused in one line."""

from typing import ClassVar

import pytest

from hystbench.errors import InputError
from hystbench.gap import effects as package
from hystbench.gap.effects.effect import InsideEffect
from hystbench.gap.vocabulary import EVERYTHING, with_device
from hystbench.quantities import Quantities


class Leak(InsideEffect):
    name = "leak"
    shows = "level"
    causes: ClassVar = {
        "a worn seal": ["hydraulic"],
        "a crack": ["hydraulic", "mechanical"],
    }


class Unexplained(InsideEffect):
    name = "unexplained"
    shows = "level"


@pytest.fixture
def offered(monkeypatch):
    two = {item.name: item for item in (Leak(), Unexplained())}
    monkeypatch.setattr(package, "effects", lambda: two)


@pytest.mark.usefixtures("offered")
def test_an_effect_is_left_out_of_a_device_that_has_none_of_its_causes():
    assert EVERYTHING.in_device("electronic").impossible == ("leak",)
    assert EVERYTHING.in_device("electronic").offered == ("unexplained",)
    assert EVERYTHING.in_device("mechanical").offered == ("leak", "unexplained")


@pytest.mark.usefixtures("offered")
@pytest.mark.parametrize(
    ("kind", "causes"),
    [(None, ["a worn seal", "a crack"]), ("mechanical", ["a crack"])],
)
def test_its_causes_are_told(kind, causes):
    found = {"effects": [{"name": "leak"}, {"name": "unexplained"}]}
    leak, unexplained = with_device(found, kind, Quantities())["effects"]
    assert leak["causes"] == causes
    assert unexplained["causes"] == []


@pytest.mark.parametrize(
    ("said", "refused"),
    [
        ({"place": "sensors"}, "place: 'sensors'.*'sensor'"),
        ({"shows": "amplitud"}, "shows: 'amplitud'.*'amplitude'"),
        ({"causes": {"a seal": ["hydraulics"]}}, "causes: 'hydraulics'.*'hydraulic'"),
    ],
)
def test_a_word_that_nobody_would_find_is_refused(said, refused):
    with pytest.raises(InputError, match=f"^Odd: {refused}") as told:
        type("Odd", (InsideEffect,), {"name": "odd", **said})
    assert "\n" not in str(told.value)

"""The tables of effects in the docs are the registry's."""

from hystbench.blocks import registry
from hystbench.device_kinds import DEVICE_KINDS
from hystbench.files import markdown_table
from hystbench.gap.effects import own
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Passed
from tests.conftest import ROOT


def places(effect):
    """Give where an effect is tried: in a chain; before, inside or behind a host."""
    inside = any(
        getattr(effect, name) is not getattr(Effect, name)
        for name in ("in_mechanism", "stored")
    )
    around = [law.place for law in effect().around(Passed(1.0, 1.0, 1e-3, 1e-3))]
    found = [effect.place, *(["inside"] if inside else []), *around]
    return ", ".join(dict.fromkeys(found))


def table_of_effects():
    """Give each effect with where it is tried, what it is, and its blocks."""
    rows = []
    for name, effect in own().items():
        known = [x for x in dict.fromkeys((name, *effect.laws)) if x in registry()]
        blocks = ", ".join(f"`{block}`" for block in known)
        said = effect.__doc__.splitlines()[0].rstrip(".")
        rows.append([f"`{name}`", places(effect), said, blocks])
    return markdown_table(["effect", "places", "what is tried", "blocks"], rows)


def table_of_kinds():
    """Give each kind of device with the effects that it cannot have."""
    rows = []
    for kind in DEVICE_KINDS:
        names = [
            name for name, effect in own().items() if not effect().possible_in(kind)
        ]
        rows.append([f"`{kind}`", ", ".join(f"`{name}`" for name in names) or "none"])
    return markdown_table(["kind", "effects that are left out"], rows)


def test_the_page_on_own_data_holds_the_table_of_kinds():
    # Written as the table of effects is, by table_of_kinds().
    page = (ROOT / "docs" / "own-data.md").read_text(encoding="utf-8")
    table = table_of_kinds().rstrip()
    assert f"<!-- kinds -->\n\n{table}\n\n<!-- end of kinds -->" in page


def test_the_page_on_the_gap_holds_the_table():
    # To write it: python -c 'from tests.gap.effects.test_table import *;
    # print(table_of_effects())' and paste it between the two comments.
    page = (ROOT / "docs" / "gap.md").read_text(encoding="utf-8")
    table = table_of_effects().rstrip()
    assert f"<!-- effects -->\n\n{table}\n\n<!-- end of effects -->" in page

"""The tables of effects in the docs are the registry's."""

from hystbench.blocks import registry
from hystbench.blocks.wrapping import WrappingBlock
from hystbench.device_kinds import DEVICE_KINDS
from hystbench.files import markdown_table
from hystbench.gap.effects import own
from hystbench.gap.effects.effect import Effect
from hystbench.gap.effects.law import Moved, Passed
from hystbench.gap.naming.beside_forces import NOT_OF_THE_INPUT
from tests.conftest import ROOT

PASSED = Passed(1.0, 1.0, 1e-3, 1e-3)
GIVEN = PASSED._replace(shortest=0.0)
"""The same of a model that was given."""
MOVED = Moved(1.0, 1.0, 1.0, turns="rad", stiffness=1.0, loose=True, known=True)
PLACES = ("before", "inside", "behind", "around", "beside")
CURVES = {
    "square and cube": ("asymmetry", "stiffness-hardening", "sensor-nonlinearity"),
    "exponential": ("exponential-curve", "exponential-stiffness"),
    "two slopes": ("two-slopes",),
    "limit, or levels off": (
        *("drive-saturation", "drive-limits", "saturation"),
        *("saturating-stiffness", "transverse-springs"),
    ),
    "magnitude": ("unsigned-sensor",),
    "dead zone, or contact": ("dead-zone", "dead-band", "stop"),
    "play, or friction behind a clearance": ("backlash", "slider-with-gap"),
    "dry friction": ("friction",),
    "drag": ("drag",),
    "loop": ("hysteresis", "hysteretic-force", "butterfly"),
    "loop of another shape, or that depends on the rate": (
        *("hysteresis-shape", "rate-dependent-hysteresis"),
    ),
    "limit of a rate": ("slew-limit",),
    "weight by the angle": ("gravity",),
    "outflow and overflow": ("outflow", "overflow"),
    "lag, delay, diffusion": (
        *("input-delay", "drive-lag", "eddy-diffusion", "sensor-lag"),
    ),
    "mode": ("resonance",),
    "slow motion": ("creep", "thermal-drift", "drift"),
    "gain and offset": ("calibration-error",),
    "tone": ("mains-pickup",),
}
"""Sorts of laws: by block where an effect has several, else by effect."""

INSIDE_A_MODE = ("stiffness-hardening",)
"""Blocks that stand for a mode of the chain, with the effect inside it."""


def places(effect):
    """Give where an effect is tried: in a chain; before, inside or behind a host."""
    inside = any(
        getattr(effect, name) is not getattr(Effect, name)
        for name in ("in_mechanism", "stored")
    )
    around = [law.place for law in effect().around(PASSED)]
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


def sort_of(effect, block):
    """Tell which sort of law a block of an effect is."""
    sorts = {name: sort for sort, names in CURVES.items() for name in names}
    special = block in sorts and block not in own()
    return sorts[block if special else effect]


def offered_beside_a_host(effect):
    """Give the places and blocks of an effect where a host has effects inside."""
    laws = [x for passed in (PASSED, GIVEN) for x in effect().around(passed)]
    laws += effect().in_mechanism(MOVED)
    found = {(law.place, law.block.name) for law in laws}
    if effect.stored is not Effect.stored:
        found.add(("inside", "store"))
    if effect.name in NOT_OF_THE_INPUT:
        found.add(("beside", effect.name))
    return found


def offered_in_a_chain(effect):
    """Give the places and blocks of an effect in a chain of blocks."""
    if effect.place == "inside":
        return set()
    if effect.describe is not Effect.describe:
        return {("beside", effect.name)}
    found = set()
    for name in dict.fromkeys((effect.name, *effect.laws)):
        block = registry().get(name)
        if block is None or block.place == "inside":
            continue
        if issubclass(block, WrappingBlock):
            places = ("around",)
        elif "drive" in (effect.place, block.place):
            places = ("before",)
        elif name in INSIDE_A_MODE:
            places = ("inside",)
        else:
            both = effect.place == "material"
            places = ("before", "behind") if both else ("behind",)
        found |= {(place, name) for place in places}
    return found


def table_of_places():
    """Give each sort of law with what it is called at each place."""
    cells = {(sort, place): [] for sort in CURVES for place in PLACES}
    for name, effect in own().items():
        host = {(sort_of(name, x), place) for place, x in offered_beside_a_host(effect)}
        chain = {(sort_of(name, x), place) for place, x in offered_in_a_chain(effect)}
        for key in host | chain:
            cells[key].append(f"`{name}`" + " (chain)" * (key not in host))
    rows = [
        [sort, *(", ".join(cells[sort, place]) for place in PLACES)] for sort in CURVES
    ]
    return markdown_table(["law", *PLACES], rows)


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


def test_the_page_on_the_method_holds_the_table_of_places():
    # Written as the table of effects is, by table_of_places().
    page = (ROOT / "docs" / "gap-method.md").read_text(encoding="utf-8")
    table = table_of_places().rstrip()
    assert f"<!-- laws -->\n\n{table}\n\n<!-- end of laws -->" in page

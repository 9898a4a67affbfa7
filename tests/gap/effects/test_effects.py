"""What every effect owes the search, checked over all effects and their variants."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from scipy.optimize import least_squares

from hystbench.blocks import registry
from hystbench.blocks.base import Block
from hystbench.gap.effects import effects, own
from hystbench.gap.effects.effect import Declined
from hystbench.gap.effects.sensor import FORMS, WINDING, path
from hystbench.gap.effects.variant import logarithmic
from hystbench.gap.fitting.edit_chain import removable, with_effect, without_effect
from hystbench.gap.fitting.model_score import score_of
from hystbench.gap.fitting.state import Free
from hystbench.gap.fitting.variant_search import Attempt
from hystbench.gap.naming.rank import rank
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT, record, sine
from tests.gap.small import (
    MODE,
    block,
    chains,
    hysteresis,
    measured,
    plain_score,
    records,
    state_of,
)

# As printed in the vocabulary that users and figures share, by place.
#: Of stores: their own numbers are other ones, so that the block is the store.
STORED = ("outflow", "overflow")
VOCABULARY = {
    "inside": [
        *("drag", "gravity", "hysteretic-force", "slider-with-gap", "stop"),
        *STORED,
    ],
    "drive": (
        *("input-delay", "drive-lag", "eddy-diffusion", "drive-saturation"),
        *("slew-limit", "dead-zone"),
    ),
    "material": (
        *("hysteresis", "hysteresis-shape", "asymmetry", "saturation"),
        "rate-dependent-hysteresis",
    ),
    "mechanics": (
        *("resonance", "stiffness-hardening", "friction", "backlash", "creep"),
        "thermal-drift",
    ),
    "sensor": (
        *("sensor-lag", "sensor-nonlinearity", "mains-pickup", "drift"),
        "calibration-error",
    ),
}
BASES = ("gpi", "gain", "transfer-function", "rdgpi")


def offered():
    """Every variant of every effect, on each of the chains that take it."""
    for name, chain in chains().items():
        simulation = Simulation(chain, records())
        for effect in effects().values():
            try:
                variants = list(effect.variants(simulation))
            except Declined:
                continue
            for variant in variants:
                yield name, variant


ALL = list(offered())


def every_variant(holds=lambda variant: True):
    """Check all variants of an effect in one test; one that fails is told."""
    by_effect = {}
    for chain, variant in ALL:
        if holds(variant):
            by_effect.setdefault(variant.effect, []).append((chain, variant))

    def as_test(check):
        @pytest.mark.parametrize("effect", by_effect)
        def test(effect):
            for chain, variant in by_effect[effect]:
                try:
                    check(chain, variant)
                except BaseException as error:
                    error.add_note(f"{variant.form} on {chain}")
                    raise

        return test

    return as_test


def values_of(variant):
    """Ends and middle of the grids, with what is solved for at its small step."""
    axes = [
        (axis[0], axis[len(axis) // 2], axis[-1]) for axis in variant.grids.values()
    ]
    for point in product(*axes):
        yield {
            **dict(zip(variant.grids, map(float, point), strict=True)),
            **variant.unit,
        }


def test_every_word_of_the_vocabulary_can_be_named():
    found = {(item.place, name) for name, item in own().items()}
    assert found == {
        (place, name) for place in VOCABULARY for name in VOCABULARY[place]
    }
    assert all(item.name == name for name, item in effects().items())


@pytest.mark.parametrize("name", sorted({*BASES, "store", *effects()} - {*STORED}))
def test_every_word_of_the_vocabulary_is_a_block(name):
    assert issubclass(registry()[name], Block)


def test_every_effect_is_tried_on_some_chain():
    """Otherwise the contract below would leave one out."""
    chained = {name for name, item in effects().items() if item.place != "inside"}
    assert {variant.effect for _, variant in ALL} == chained


@pytest.mark.parametrize("name", VOCABULARY["inside"])
def test_a_force_has_no_place_in_a_chain_in_series(name):
    with pytest.raises(Declined, match="inside the dynamics"):
        list(
            effects()[name].variants(
                Simulation(next(iter(chains().values())), records())
            )
        )


@every_variant()
def test_a_variant_builds_a_model_that_runs(chain, variant):
    before = chains()[chain]
    effect = effects()[variant.effect]
    assert variant.place == effect.place
    assert 0 <= variant.start <= len(before)
    for axis in variant.grids.values():
        assert (np.diff(axis) > 0).all()
    mildest = variant.grids["coefficient"][-1] if "coefficient" in variant.grids else 0
    for values in values_of(variant):
        built = variant.build(values)
        if variant.beside is not None:
            for one in records():
                shapes = variant.beside.columns(one, values, variant.beside.order)
                assert shapes.shape[0] == len(one)
                assert np.isfinite(shapes).all()
            continue
        own = [built[k] for k in variant.positions]
        # A field bias is made of two plain gains; all else has a block of its name or
        # of another law of it, behind what is left where it was taken out of another.
        names = {item.name for item in own}
        assert names & {variant.effect, *effect.laws} or names == {"gain"}
        rest = [item for k, item in enumerate(built) if k not in variant.positions]
        assert rest == list(before[variant.start + variant.replaces :])
        model = Model(
            "built", CURRENT, DISPLACEMENT, (*before[: variant.start], *built)
        )
        # A spring much softer has no force left to hold the mode: not a candidate.
        held = not variant.form.endswith("softer") or values["coefficient"] == mildest
        for one in records():
            assert np.isfinite(model.simulate(one.u, one.dt)).all() or not held
        again = Model.from_mapping(model.to_mapping(), "again")
        assert again == model


@every_variant(lambda variant: not variant.beside)
def test_a_form_pays_for_every_number_that_it_leaves_free(chain, variant):
    """Otherwise a law of many numbers would stand before one of few."""
    built = variant.build(next(values_of(variant)))
    own = [(built[k], key) for k in variant.positions for key in variant.free]
    free = sum(
        np.size(getattr(one, key)) for one, key in own if key in one.parameters()
    )
    assert variant.freedom >= free


@every_variant(lambda variant: variant.unit)
def test_a_neutral_variant_changes_nothing_where_all_is_zero(chain, variant):
    simulation = Simulation(chains()[chain], records())
    size = simulation.largest(len(simulation.chain))
    for values in values_of(variant):
        zero = {**values, **dict.fromkeys(variant.unit, 0.0)}
        one = simulation.tail(variant.start, variant.build(values))
        none = simulation.tail(variant.start, variant.build(zero))
        changes = [
            np.abs(a - b).max() for a, b in zip(none, simulation.output, strict=True)
        ]
        if variant.neutral:
            assert max(changes) < 1e-9 * size
        moved = [np.abs(a - b).max() for a, b in zip(one, none, strict=True)]
        assert max(moved) > 0


# What an effect is where there is none of it. Left out: rate-dependent-hysteresis. It
# is NOT the chain at a coefficient of zero: with a band-limited input it computes the
# hysteresis on a finer grid, and what that gains is named where nothing is hidden.
NOTHING = {
    "input-delay": {"delay_s": 0.0},
    "drive-lag": {"time_constant_s": 1e-7, "damping_ratio": 0.7},
    "eddy-diffusion": {"time_constant_s": 1e-12},
    "drive-saturation": {
        "limit": 1e6,
        "level": 1e6,
        "sharpness": 4.0,
        "upper": 1e6,
        "lower": -1e6,
    },
    "slew-limit": {"rate": 1e8, "falling": 1e8, "time_constant_s": 0.0},
    "dead-zone": {"half_width": 0.0, "rounding": 1.0, "upper": 1e-9, "lower": -1e-9},
    "saturation": {"level": 1e8, "sharpness": 2.0},
    "backlash": {"half_width": 0.0},
    "sensor-lag": {"time_constant_s": 1e-7, "damping_ratio": 0.7},
}


@every_variant(lambda variant: variant.effect in NOTHING)
def test_nothing_of_an_effect_is_the_chain(chain, variant):
    """Otherwise how it is computed would be taken for what it is."""
    simulation = Simulation(chains()[chain], records())
    there = {key: NOTHING[variant.effect][key] for key in variant.grids}
    there |= dict.fromkeys(variant.unit, 0.0)
    outputs = simulation.tail(variant.start, variant.build(there))
    size = simulation.largest(len(simulation.chain))
    for one, other in zip(outputs, simulation.output, strict=True):
        # A lag starts from rest, beside an offset with a jump at the first sample.
        assert np.abs(one - other)[1:].max() < 1e-3 * size


def state_with_free(name):
    """A state in which every number of the first and last block is free already."""
    chain = chains()[name]
    free = [
        Free(k, key, element)
        for k in dict.fromkeys((0, len(chain) - 1))
        for key, value in vars(chain[k]).items()
        if not isinstance(value, str)
        for element in (range(len(value)) if isinstance(value, tuple) else (None,))
    ]
    return state_of(chain, free=tuple(free))


def numbers(state):
    """Free numbers with the values they have, however the blocks are numbered."""
    return [
        (state.chain[f.block].name, f.parameter, f.element, state.value(f))
        for f in state.free
    ]


@every_variant()
def test_what_is_added_can_be_taken_out_again(chain, variant):
    before = state_with_free(chain)
    for values in list(values_of(variant))[:2]:
        after = with_effect(before, variant, values)
        (added,) = after.added
        assert (added.effect, added.place) == (variant.effect, variant.place)
        assert after.freedom == variant.freedom
        assert [after.chain[k].name for k in added.blocks] == [
            variant.build(values)[k].name for k in variant.positions
        ]
        kept = [n for n in numbers(after) if n in numbers(before)]
        if not variant.replaces:
            assert kept[: len(before.free)] == numbers(before)
        own = [f for f in after.free if f.block in added.blocks]
        if variant.beside is None:
            assert {f.parameter for f in own} == set(variant.free)
        for free in own:
            assert free.low <= after.value(free) <= free.high
        again = without_effect(after, 0)
        assert again.chain == before.chain
        assert again.added == ()
        assert again.beside == ()
        assert again.freedom == 0
        if not variant.replaces:
            assert again.free == before.free


@pytest.mark.parametrize("base", ["hysteresis and mode", "wrapped"])
def test_of_several_effects_each_can_be_taken_out(base):
    """Whatever lies before, behind, around or beside: the others stay as they are."""
    before = state_with_free(base)
    used = ("drive-lag", "asymmetry", "backlash", "mains-pickup", "drift", "creep")
    after = before
    alone = {}
    for name in used:
        if name in {block.name for block in before.chain}:
            continue
        variant = list(effects()[name].variants(after.simulation))[-1]
        after = with_effect(after, variant, next(iter(values_of(variant))))
        (item,) = [item for item in after.added if item.effect == name]
        alone[name] = [after.chain[k] for k in item.blocks]
    for number, gone in enumerate(after.added):
        short = without_effect(after, number)
        names = [item.effect for item in short.added]
        assert names == [n for n in alone if n != gone.effect]
        for item in short.added:
            assert [short.chain[k] for k in item.blocks] == alone[item.effect]
        assert len(short.chain) == len(after.chain) - len(gone.blocks)
        beside = [x.effect for x, _ in after.beside if x.effect != gone.effect]
        assert [x.effect for x, _ in short.beside] == beside
        left = numbers(after)
        for taken in [
            (after.chain[f.block].name, f.parameter, f.element, after.value(f))
            for f in after.free
            if f.block in gone.blocks
        ]:
            left.remove(taken)
        assert numbers(short) == left
        assert short.freedom == after.freedom - gone.charge
    for _ in after.added:
        after = without_effect(after, 0)
    assert after.chain == before.chain
    assert after.free == before.free


def with_effects(base, *names):
    """Add effects one after the other, each in its first form."""
    after = state_with_free(base)
    for name in names:
        variant = next(iter(effects()[name].variants(after.simulation)))
        after = with_effect(after, variant, next(iter(values_of(variant))))
    return after


def test_what_others_stand_on_cannot_be_taken_out():
    """A wrapped hysteresis has to stay, and a block that was replaced is gone."""
    wrapped = with_effects("gain", "hysteresis", "rate-dependent-hysteresis", "drift")
    assert [removable(wrapped, k) for k in range(3)] == [False, True, True]
    assert removable(with_effects("gain", "hysteresis", "creep"), 0)
    replaced = with_effects("gain", "resonance", "stiffness-hardening", "mains-pickup")
    assert [removable(replaced, k) for k in range(3)] == [False, True, True]


@every_variant(lambda variant: not variant.unit and variant.beside is None)
def test_a_trial_scores_as_the_model_that_it_stands_for(chain, variant):
    """Nothing is solved for: then what a trial says holds to rounding."""
    rng = np.random.default_rng(0)
    noisy = tuple(
        record(one.u, rng.standard_normal(len(one)), name=one.name, dt=one.dt)
        for one in records()
    )
    state = state_of(chains()[chain], noisy)
    score = plain_score(state)
    for values in values_of(variant):
        trial = Attempt(state, variant, score).at(tuple(values.values()))
        model = with_effect(state, variant, values)
        if variant.zero is not None:
            # Only what differs from the effect's own zero counts: the rest is how
            # finely it steps through the hysteresis.
            nothing = with_effect(state, variant, {**values, **variant.zero})
            own = state.sample.take(nothing.simulation.output)
            chain_s = state.sample.take(state.simulation.output)
            model = replace(model, correction=state.correction + chain_s - own)
        assert trial.score == pytest.approx(score_of(model, score), rel=1e-9)


@pytest.mark.parametrize(
    ("name", "chain", "why"),
    [
        ("hysteresis", "hysteresis", "has a hysteresis already"),
        ("hysteresis-shape", "gain", "no hysteresis"),
        ("rate-dependent-hysteresis", "gain", "no hysteresis"),
        ("stiffness-hardening", "hysteresis", "no mode"),
    ],
)
def test_what_makes_no_sense_in_a_chain_is_declined_with_a_reason(name, chain, why):
    with pytest.raises(Declined, match=why):
        list(effects()[name].variants(Simulation(chains()[chain], records())))


PLACES = (
    # A limit commutes with nothing, a lag with a lag, a delay with all.
    (("slew-limit",), "eddy-diffusion", {0, 1}),
    (("slew-limit",), "drive-saturation", {0, 1}),
    (("slew-limit",), "input-delay", {0}),
    (("drive-lag",), "eddy-diffusion", {0}),
    (("drive-lag",), "slew-limit", {0, 1}),
    (("input-delay", "drive-saturation", "drive-lag"), "dead-zone", {0, 2, 3}),
    # What moves is before what is read, the material before the mechanics.
    (("gpi", "sensor-lag"), "friction", {1}),
    (("gpi", "sensor-lag"), "backlash", {1}),
    (("gpi", "sensor-lag"), "thermal-drift", {1}),
    (("gpi", "asymmetry"), "resonance", {2}),
    (("gpi", "asymmetry", "resonance"), "creep", {2}),
    (("gpi", "sensor-lag"), "sensor-nonlinearity", {1, 2}),
    (("gpi", "sensor-nonlinearity"), "sensor-lag", {1, 2}),
    (("gpi", "sensor-lag"), "sensor-lag", {2}),
)
GIVEN = {
    "slew-limit": {"rate": 5.0},
    "drive-lag": {"time_constant_s": 1e-3},
    "sensor-lag": {"time_constant_s": 1e-3},
    "input-delay": {"delay_s": 1e-3},
    "drive-saturation": {"limit": 0.5},
    "asymmetry": {"coefficient": 1e-3},
    "sensor-nonlinearity": {"quadratic": 1e-3, "cubic": 0.0},
    "resonance": {"frequency_hz": 60.0, "damping_ratio": 0.05, "participation": 0.1},
}


@pytest.mark.parametrize(("names", "added", "expected"), PLACES)
def test_an_effect_is_offered_wherever_it_does_another_thing(names, added, expected):
    chain = [hysteresis() if x == "gpi" else block(x, **GIVEN[x]) for x in names]
    if "gpi" not in names:
        chain.append(hysteresis())
    simulation = Simulation(tuple(chain), records())
    found = {
        item.start + item.positions[0] for item in effects()[added].variants(simulation)
    }
    assert found == expected


SLOWER, LARGER = 2.5, 40.0
SCALES = {
    "time_constant_s": SLOWER,
    "second_time_constant_s": SLOWER,
    "first_time_s": SLOWER,
    "last_time_s": SLOWER,
    "delay_s": SLOWER,
    "frequency_hz": 1 / SLOWER,
    "damping_ratio": 1.0,
    "half_width": LARGER,
    "yield_distance": LARGER,
    "sharing": 1.0,
    "limit": LARGER,
    "upper": LARGER,
    "lower": LARGER,
    "curvature": 1 / LARGER,
    "level": LARGER,
    "sharpness": 1.0,
    "rate": LARGER / SLOWER,
    "falling": LARGER / SLOWER,
    "velocity_scale": LARGER / SLOWER,
}
UNITS = {"-": 1.0, "s": SLOWER, "Hz": 1 / SLOWER, "U": LARGER, "Y": LARGER}


def scale_of(effect, key):
    """How much such records move a range; of another package's effect by its unit."""
    if key in SCALES:
        return SCALES[key]
    return UNITS[registry()[effect].parameters()[key].unit]


@pytest.mark.parametrize("name", sorted(set(effects()) - {"mains-pickup"}))
def test_bounds_come_from_the_records_alone(name):
    """Slower and larger records move every range by just that: none is built in.

    The mains have the frequency that they have.
    """
    gain = (block("gain", value=12.0),)
    moved = tuple(
        replace(item, u=LARGER * item.u, y=LARGER * item.y, dt=SLOWER * item.dt)
        for item in records()
    )
    try:
        before = list(effects()[name].variants(Simulation(gain, records())))
    except Declined:
        with pytest.raises(Declined):
            list(effects()[name].variants(Simulation(gain, moved)))
        return
    after = list(effects()[name].variants(Simulation(gain, moved)))
    assert [item.form for item in after] == [item.form for item in before]
    for one, other in zip(before, after, strict=True):
        for key, axis in one.grids.items():
            scale = scale_of(name, key)
            assert other.grids[key] == pytest.approx(scale * axis, rel=1e-9)
            ends = np.array(one.ends(key))
            assert other.ends(key) == pytest.approx(scale * ends, rel=1e-9)


def test_the_range_of_a_spring_is_that_of_what_moves_it():
    """Its cube weighs by the square of the displacement, on slower records too."""
    chain = (block("gain", value=12.0), block("resonance", **MODE))
    moved = tuple(
        replace(item, u=LARGER * item.u, dt=SLOWER * item.dt) for item in records()
    )
    before, after = (
        list(effects()["stiffness-hardening"].variants(Simulation(chain, given)))
        for given in (records(), moved)
    )
    assert len(before) == len(after) == 3
    for one, other in zip(before, after, strict=True):
        ranges = {**one.grids, **one.unit}
        there = {**other.grids, **other.unit}
        assert ranges.keys() == there.keys() == {"coefficient"}
        expected = ranges["coefficient"] / LARGER**2
        assert there["coefficient"] == pytest.approx(expected, rel=1e-9)


def test_the_range_of_a_rate_is_that_of_the_records():
    chain = (hysteresis(),)
    effect = effects()["rate-dependent-hysteresis"]
    slow = tuple(replace(item, dt=SLOWER * item.dt) for item in records())
    before = list(effect.variants(Simulation(chain, records())))
    for one, other in zip(
        before, effect.variants(Simulation(chain, slow)), strict=True
    ):
        share = float(one.form.rpartition(" ")[2])
        exponent = 1.0 if "logarithm" in one.form else share
        axis = one.grids["coefficient"] * SLOWER**exponent
        assert other.grids["coefficient"] == pytest.approx(axis, rel=1e-9)


def test_a_mode_is_taken_out_of_a_transfer_function_and_hardens_there():
    chain = chains()["mode inside"]
    simulation = Simulation(chain, records())
    variant, *searched = effects()["stiffness-hardening"].variants(simulation)
    assert [item.form for item in searched] == ["60 Hz stiffer", "60 Hz softer"]
    before, mode = variant.build({"coefficient": 2e-3})
    assert before.denominator == pytest.approx([5e-3, 1.0])
    assert (mode.frequency_hz, mode.damping_ratio) == pytest.approx((60.0, 0.05))
    assert mode.participation == 1.0
    hard = measured((before, mode), 0.01)
    ranking = rank(state_of(chain, hard), plain_score(state_of(chain, hard), 1e-4))
    assert ranking[0].effect == "stiffness-hardening"
    found = ranking[0].state.chain[-1]
    assert found.coefficient == pytest.approx(2e-3, rel=0.05)


@pytest.mark.parametrize("strong", [0.02, 0.3, -0.03])
def test_a_mode_that_moves_by_more_than_its_width_is_found(strong):
    """The slope at a linear spring tells nothing of it: such springs are searched."""
    mode = {"frequency_hz": 60.0, "damping_ratio": 0.02, "participation": 0.5}
    base = (block("resonance", **mode),)
    plant = (block("stiffness-hardening", coefficient=strong, **mode),)
    given = tuple(replace(one, u=2 * one.u) for one in records())
    state = state_of(base, measured(plant, 0.01, given=given))
    ranking = rank(state, plain_score(state, 1e-4))
    assert ranking[0].effect == "stiffness-hardening"
    found = ranking[0].state.chain[0]
    assert found.coefficient == pytest.approx(strong, rel=0.05)


@pytest.mark.parametrize(
    "changed",
    [{"start": "settled"}, {"numerator": [1e-3, 1e-2, 12.0]}],
    ids=["settled", "degree"],
)
def test_a_mode_that_cannot_be_taken_out_is_none(changed):
    (block,) = chains()["mode inside"]
    simulation = Simulation((replace(block, **changed),), records())
    with pytest.raises(Declined, match="no mode"):
        list(effects()["stiffness-hardening"].variants(simulation))


def test_beside_another_shape_a_gain_is_no_error_of_the_sensor():
    (shape,) = effects()["hysteresis-shape"].variants(
        Simulation((hysteresis(),), records())
    )
    values = dict.fromkeys(shape.unit, 1e-3)
    chain = shape.build(values)
    with pytest.raises(Declined, match="gain of its own"):
        list(effects()["calibration-error"].variants(Simulation(chain, records())))


@pytest.mark.parametrize("name", ["creep", "mains-pickup"])
def test_records_too_short_for_an_effect_are_a_reason(name):
    t = np.arange(60) / 2000
    short = (record(np.sin(2 * np.pi * 80 * t), name="short", dt=1 / 2000),)
    with pytest.raises(Declined, match="too short"):
        list(effects()[name].variants(Simulation(chains()["gain"], short)))


def test_a_logarithmic_grid_has_its_ends_and_even_steps():
    axis = logarithmic(2e-4, 0.3, 4)
    assert (axis[0], axis[-1]) == (pytest.approx(2e-4), pytest.approx(0.3))
    ratios = axis[1:] / axis[:-1]
    assert ratios == pytest.approx(ratios[0])
    assert ratios[0] <= 10 ** (1 / 4) * (1 + 1e-9)


def offered(name, *records):
    simulation = Simulation((block("gain", value=1.0),), records)
    return {item.form for item in effects()[name].variants(simulation)}


def test_a_path_is_offered_only_where_something_comes_twice_or_rests():
    """Within one loop a path of its own could be any error of the loop."""
    one_loop = record(sine(1.0, count=1000), name="loop")
    two_loops = record(sine(2.0, count=1000), name="loops")
    hold = record(np.repeat([0.0, 1.0], [100, 900]), name="hold")
    assert offered("drift", one_loop) == {"one slope"}
    assert offered("drift", one_loop, two_loops) == {"one slope", "ramp", "path"}
    assert offered("drift", hold) == {"one slope", "ramp", "path"}
    many_loops = record(sine(9.0, count=1000), name="many")
    more = {"one slope", "ramp", "path", "winding path"}
    assert offered("drift", one_loop, many_loops) == more


@pytest.mark.parametrize(("loops", "highest"), [(1, 1), (3, 3), (9, 9), (40, 10)])
def test_a_path_goes_to_and_fro_at_most_half_as_often_as_the_input(loops, highest):
    made = record(sine(loops, count=1000, phase=0.5), name="loops")
    columns = path(made, {}, FORMS[WINDING])
    (shown,) = np.nonzero(columns.any(axis=0))
    rest = columns[:, shown]
    assert np.linalg.matrix_rank(rest) == highest + 1
    line = np.vander(np.linspace(-1, 1, 1000), highest + 1)
    inside = line @ np.linalg.lstsq(line, rest, rcond=None)[0]
    assert inside == pytest.approx(rest, abs=1e-9)


def test_a_tone_beyond_half_the_sampling_rate_stands_for_nothing():
    """A record of 4 Hz would show 50 Hz as something slow."""
    fast = record(sine(3.0, count=4000), name="fast")
    slow = record(sine(0.01, count=400, dt=0.25), name="slow", dt=0.25)
    simulation = Simulation((block("gain", value=1.0),), (fast, slow))
    (beside,) = {
        x.beside
        for x in effects()["mains-pickup"].variants(simulation)
        if x.form == "fundamental"
    }
    assert np.abs(beside.columns(fast, {"frequency_hz": 50.0}, 1)).max() > 0.9
    assert not beside.columns(slow, {"frequency_hz": 50.0}, 1).any()


def test_a_light_mode_between_the_points_of_the_grid_is_looked_for():
    """A mode as wide as a fiftieth of its frequency, beside a base that has no lag."""
    noise = np.random.default_rng(0).normal(size=2000)
    wide = (record(noise, name="wide", dt=1e-3),)
    grid = logarithmic(1.0, 450.0, 6)
    hertz = float(np.sqrt(grid[10] * grid[11]))
    light = block(
        "resonance", frequency_hz=hertz, damping_ratio=0.01, participation=0.1
    )
    lag, gain = block("drive-lag", time_constant_s=1e-4), block("gain", value=12.0)
    state = state_of((gain,), measured((lag, gain, light), 0.01, given=wide))
    (variant,) = effects()["resonance"].variants(state.simulation)
    near = np.abs(np.log(variant.grids["frequency_hz"] / hertz))
    assert near.min() < 0.02


@pytest.mark.parametrize("share", [0.03, 0.1, 0.3, 0.6, 0.84, 0.97])
def test_some_rate_of_the_grid_explains_half_of_any_slew_limit(share):
    """Of the gap's power: else an effect that fits worse is searched further."""
    t = np.arange(1000) / 1000
    u = np.sin(2 * np.pi * 9 * t)
    one = record(u, y=u, dt=1e-3)
    state = state_of((block("gain", value=1.0),), (one,))
    variant, *_ = effects()["slew-limit"].variants(state.simulation)

    def limited(rate):
        return block("slew-limit", rate=rate).simulate(u, u, 1e-3)

    real = limited(share * state.simulation.fastest())
    left = [np.mean((real - limited(x)) ** 2) for x in variant.grids["rate"]]
    assert min(left) < 0.5 * np.mean((real - u) ** 2)


def slew_limit_beside_steps():
    """The variant of a slew limit for two steps of 4, half a second each."""
    u = np.repeat([0.0, 4.0, 0.0, -4.0], 250)
    state = state_of((block("gain", value=1.0),), (record(u, y=u, dt=1e-3),))
    variant, *_ = effects()["slew-limit"].variants(state.simulation)
    return variant


def test_a_slew_limit_moves_the_middle_of_a_step_by_a_sample():
    """By less it would be a moment between two samples: two intervals more are one."""
    interval, size = 1e-3, 4.0
    _, fastest = slew_limit_beside_steps().ends("rate")
    assert fastest < size / (3 * interval)
    assert fastest > size / (4 * interval)


@pytest.mark.parametrize("samples", [6.3, 4.5, 3.0])
def test_a_fast_tone_is_no_step(samples):
    """Of the same size from sample to sample, or nearly: all rates are offered."""
    u = np.sin(2 * np.pi * np.arange(1000) / samples + 0.3)
    state = state_of((block("gain", value=1.0),), (record(u, y=u, dt=1e-3),))
    variant, *_ = effects()["slew-limit"].variants(state.simulation)
    _, fastest = variant.ends("rate")
    assert fastest == pytest.approx(0.98 * np.abs(np.diff(u)).max() / 1e-3)


def test_a_slew_limit_may_be_as_slow_as_the_record():
    """What a step within a sample is divided by says nothing of the drive."""
    slowest, _ = slew_limit_beside_steps().ends("rate")
    assert slowest <= 8.0 / 1.0


@pytest.mark.parametrize("largest", [0.5, 2.0, 8.0])
def test_the_algebraic_law_follows_langevins(largest):
    """So it needs no form of its own: a thousandth of what it bends would be named."""
    z = np.linspace(-largest, largest, 1000)
    langevin = 1 / np.tanh(3 * z) - 1 / (3 * z)

    def left(numbers):
        level, sharpness, gain = numbers
        curve = block("saturation", level=level, sharpness=sharpness)
        return gain * curve.simulate(z, z, 1.0) - langevin

    found = least_squares(left, [1.0, 2.0, 1.0], bounds=([0.1, 1, 0.5], [4, 20, 2]))
    bent = langevin - z * (langevin @ z) / (z @ z)
    assert np.mean(found.fun**2) < 1e-3 * np.mean(bent**2)

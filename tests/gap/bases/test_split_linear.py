"""A linear base whose halves have a static curve between them."""

from dataclasses import replace

import numpy as np
import pytest

from hystbench.gap import gap_search
from hystbench.gap.bases import split_linear
from hystbench.gap.bases.load import checked_base, load_base
from hystbench.gap.bases.output_error import OutputError
from hystbench.gap.bases.spectral import Rational, Spectra, fit_ratio
from hystbench.gap.bases.wiener_hammerstein import Halves, HalvesError
from hystbench.gap.effects import effects
from hystbench.gap.effects.places import BETWEEN_HALVES
from hystbench.gap.records.evidence import Evidence
from hystbench.gap.simulation.simulation import Simulation
from hystbench.model import Model, load_model
from hystbench.quantities import Quantities
from tests.gap.made import CURRENT, DISPLACEMENT, multisine, record, steady
from tests.gap.searched import among, search
from tests.gap.small import block


def mode(frequency_hz, damping):
    w = 2 * np.pi * frequency_hz
    return lambda s: 1 / (1 + 2 * damping * s / w + (s / w) ** 2)


CURVES = among(
    *("saturation", "asymmetry", "drive-saturation", "sensor-nonlinearity"),
)
FRONT, BACK = mode(30.0, 0.5), mode(55.0, 0.35)
COUNT, DT = 1000, 1e-3


def behind(y, response):
    """What a linear system makes of a signal that repeats: no transient."""
    f = np.fft.rfftfreq(len(y), DT)
    return np.fft.irfft(np.fft.rfft(y) * response(2j * np.pi * f), len(y))


def measured(
    curve, *, noise=0.01, front=FRONT, back=BACK, count=COUNT, sizes=(1, 1, 1, 1)
):
    """Records of front, curve and back in steady state, and one held out."""
    rng = np.random.default_rng(3)
    records = []
    for seed, size in enumerate(sizes):
        sines = multisine(seed, highest_hz=90.0, lines=60, count=count, dt=DT)
        u = size * steady(sines, count=count, dt=DT) / 6
        w = size * steady(sines, front, count=count, dt=DT) / 6
        y = behind(curve(w), back) + noise * rng.standard_normal(count)
        use = "hold-out" if seed == 3 else "fit"
        records.append(record(u, 2 * y + 0.3, name=f"r{seed}", dt=DT, use=use))
    return Evidence("made", tuple(records[:3]), (records[3],))


def clipped(w):
    """One side runs into a corner, as of a diode."""
    return np.minimum(w, 0.3)


def poles(half):
    return np.sort_complex(np.roots(half.denominator))


def of_mode(frequency_hz, damping):
    w = 2 * np.pi * frequency_hz
    return w * (-damping + 1j * np.sqrt(1 - damping**2))


@pytest.fixture(scope="module")
def clipped_records():
    return measured(clipped)


@pytest.fixture(scope="module")
def split(clipped_records):
    return load_base("linear", clipped_records)


def test_the_halves_are_those_of_the_system(split):
    model, note = split
    assert "two in series" in note
    front, between, back, end = model.chain
    assert [front.name, between.name] == ["transfer-function", "gain"]
    assert [back.name, end.name] == ["transfer-function", "gain"]
    for half, wanted in ((front, of_mode(30, 0.5)), (back, of_mode(55, 0.35))):
        near = np.abs(poles(half) - wanted).min()
        assert near < 0.1 * abs(wanted)


def test_halves_that_have_grown_too_long_are_left_for_shorter_ones(
    clipped_records, monkeypatch
):
    """More poles and zeros fit the records better, and other records worse."""
    grown = []

    def longer(task, halves):
        far = np.array([5.0, 1.0])
        a = np.convolve(np.append(halves.front.a, 1.0), far)[:-1]
        long = replace(halves, front=Rational(a, 5.0 * halves.front.b))
        grown.append(replace(long, curve=3.0 * halves.curve, cost=0.5 * halves.cost))
        return grown[-1]

    monkeypatch.setattr(split_linear, "_grown", longer)
    monkeypatch.setattr(split_linear, "FOLD_ROUNDS", 0)
    base, note = load_base("linear", clipped_records)
    assert grown
    assert "written as two in series, of order 2 and" in note
    assert len(base.chain[0].denominator) == 3 < len(grown[0].front.a) + 1


def test_the_base_stays_linear(split, clipped_records):
    model = split[0].with_hold("band-limited")
    u = clipped_records.fit[0].u
    zero, once, twice = (model.simulate(k * u, DT) for k in (0.0, 1.0, 2.0))
    assert twice - zero == pytest.approx(2 * (once - zero), abs=1e-9)


def test_the_base_is_no_worse_than_one_block(split, clipped_records):
    records = clipped_records.fit
    spectra = Spectra.of(records, "band-limited")
    whole = tuple(np.arange(COUNT) >= COUNT // 10 for _ in records)
    task = OutputError(records, "band-limited", spectra.scale, "rest")
    one = task.refined(fit_ratio(spectra, 4, 3), whole, 20)
    model = split[0].with_hold("band-limited")
    left = sum(
        np.sum((item.y - model.simulate(item.u, DT))[mask] ** 2)
        for item, mask in zip(records, whole, strict=True)
    )
    assert left < 1.05 * one.cost


def test_without_a_curve_inside_the_base_is_one_block():
    """The curve is before all that moves; where there is none, see the given base."""
    records = measured(clipped, front=lambda s: 1 + 0 * s, count=COUNT)
    model, note = load_base("linear", records)
    assert "series" not in note
    assert [block.name for block in model.chain] == ["transfer-function", "gain"]


def test_a_gain_that_falls_with_the_level_is_the_curve():
    """One linear model fits both levels better than two with a gain between them."""
    records = measured(lambda w: np.minimum(w, 0.5), sizes=(1, 0.5, 1, 1))
    model, note = load_base("linear", replace(records, fit=records.fit[:2]))
    assert "two in series" in note
    model = model.with_hold("band-limited")
    found = search("made", records.fit[:2], model, vocabulary=CURVES)
    first = found.content["effects"][0]
    assert (first["name"], first["place"]) == ("saturation", BETWEEN_HALVES)


@pytest.fixture(scope="module")
def found(split, clipped_records):
    """What is named, and in how many bases forces were looked for."""
    looked, look = [], gap_search.named_inside

    def spied(*given, **more):
        looked.append(given)
        return look(*given, **more)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gap_search, "named_inside", spied)
        answer = search(
            *("made", clipped_records.fit, split[0].with_hold("band-limited")),
            quantities=Quantities("force", "position"),
            vocabulary=CURVES,
        )
    return answer, len(looked)


def test_the_curve_is_named_in_its_place(found, split, clipped_records):
    answer, _ = found
    assert answer.content["verdict"] == "named"
    first = answer.content["effects"][0]
    assert (first["name"], first["place"]) == ("saturation", BETWEEN_HALVES)
    names = [block.name for block in answer.model.chain]
    assert names[:4] == ["transfer-function", "gain", "saturation", "transfer-function"]
    (held,) = clipped_records.hold_out
    before, after = (
        np.std(held.y - each.with_hold("band-limited").simulate(held.u, DT))
        for each in (split[0], answer.model)
    )
    assert after < 0.3 * before


def test_no_force_is_looked_for_where_the_curve_leaves_nothing(found):
    answer, looked = found
    assert answer.content["effects"][0]["name"] == "saturation"
    assert looked == 0


@pytest.mark.parametrize("name", ["saturation", "asymmetry", "dead-zone"])
def test_static_effects_are_offered_between_the_halves(name, split, clipped_records):
    simulation = Simulation(split[0].chain, clipped_records.fit)
    places = {item.place: item.start for item in effects()[name].variants(simulation)}
    assert places[BETWEEN_HALVES] == 2
    alone = Simulation(split[0].chain[:1], clipped_records.fit)
    assert BETWEEN_HALVES not in {
        item.place for item in effects()[name].variants(alone)
    }


def halves():
    return Halves(
        Rational(np.array([1.3, 0.9]), np.array([1.1, 0.2])),
        Rational(np.array([0.8, 1.2]), np.array([0.7])),
        np.array([1.0, -0.2, 0.1, 0.05, -0.02]),
        0.4,
    )


@pytest.mark.parametrize("start", ["rest", "settled"])
def test_derivatives_are_those_of_the_simulation(start, clipped_records):
    records = clipped_records.fit[:1]
    masks = (np.ones(COUNT, dtype=bool),)
    (way,) = HalvesError(records, masks, "band-limited", 200.0, start).ways
    now, given = halves(), way.derivatives(halves(), way.sent(halves()))
    for k in range(now.count):
        step = np.zeros(now.count)
        step[k] = 1e-5
        up, down = (way.sent(now.moved(sign * step)).output for sign in (1, -1))
        wanted = (up - down) / 2e-5
        if start == "rest":
            assert given[:, k] == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())


def test_halves_simulate_what_their_blocks_simulate(clipped_records):
    """From rest; by state space and by lines of the spectrum."""
    u = clipped_records.fit[0].u * np.minimum(1.0, np.arange(COUNT) / 250)
    made = replace(clipped_records.fit[0], u=u)
    masks = (np.ones(COUNT, dtype=bool),)
    (way,) = HalvesError((made,), masks, "linear", 200.0, "rest").ways
    straight = replace(halves(), curve=np.eye(5)[0])
    found = way.sent(straight).output
    front, back = (
        half.block(200.0, "linear", "rest") for half in (straight.front, straight.back)
    )
    w = front.simulate(u, u, DT)
    assert found == pytest.approx(back.simulate(w, u, DT) + 0.4, abs=5e-3)


def given(behind=(), **about):
    """One transfer function as a user brings it: the product of both halves."""
    down = np.ones(1)
    for frequency_hz, damping in ((30.0, 0.5), (55.0, 0.35)):
        w = 2 * np.pi * frequency_hz
        down = np.polymul(down, [1 / w**2, 2 * damping / w, 1.0])
    one = block("transfer-function", numerator=[1.7], denominator=down.tolist())
    return Model("rig", CURRENT, DISPLACEMENT, (one, *behind), **about)


def test_a_given_transfer_function_is_split_and_does_what_it_did(
    tmp_path, clipped_records
):
    behind = (block("gain", value=1.0, offset=0.1),)
    free = ("transfer-function.denominator", "gain.offset")
    model = given(behind, free=free, tolerances={"gain.offset": 0.2})
    model.save(tmp_path / "rig.yaml")
    found, note = load_base(str(tmp_path / "rig.yaml"), clipped_records)
    assert "two in series" in note
    names = [item.name for item in found.chain]
    assert names.count("transfer-function") == 2
    front = next(item for item in found.chain if item.name == "transfer-function")
    assert poles(front)[0].real == pytest.approx(of_mode(30, 0.5).real, rel=1e-6)
    for one in clipped_records.fit:
        old, new = (
            item.with_hold("band-limited").simulate(one.u, DT)
            for item in (model, found)
        )
        assert new == pytest.approx(old, abs=1e-3 * np.ptp(old))
    assert set(found.free) >= {
        "transfer-function.denominator",
        "transfer-function#2.denominator",
    }
    # The user's own gain is the last one, whatever it is called now.
    (gain,) = (name for name in found.free if name.startswith("gain"))
    assert found.value(gain) == 0.1
    assert found.tolerances == {gain: 0.2}


def test_a_given_base_stays_where_there_is_no_curve(tmp_path):
    given().save(tmp_path / "rig.yaml")
    found, note = load_base(str(tmp_path / "rig.yaml"), measured(lambda w: w))
    assert found.chain == given().chain
    assert "series" not in note


def test_the_base_of_a_round_is_taken_as_it_is_written(tmp_path, clipped_records):
    given().save(tmp_path / "rig.yaml")
    found = checked_base(load_model(tmp_path / "rig.yaml"), "rig.yaml", clipped_records)
    assert found.chain == given().chain
    split, _ = load_base(str(tmp_path / "rig.yaml"), clipped_records)
    assert len(split.chain) > len(found.chain)


def test_a_given_base_that_lets_no_constant_through_is_looked_at_too(tmp_path):
    """A velocity, or what stands behind a capacitor: a zero at the origin."""
    (whole,) = given().chain
    blocked = replace(whole, numerator=(0.01, 0.0))
    model = replace(given(), chain=(blocked,))
    model.save(tmp_path / "rig.yaml")

    def rate(s):
        return BACK(s) * 0.01 * s

    found, note = load_base(str(tmp_path / "rig.yaml"), measured(clipped, back=rate))
    assert "two in series" in note
    halves = [item for item in found.chain if item.name == "transfer-function"]
    assert [item.numerator[-1] == 0.0 for item in halves] == [False, True]
    straight = measured(lambda w: w, back=rate)
    assert load_base(str(tmp_path / "rig.yaml"), straight)[0].chain == model.chain


def test_beyond_what_it_was_fitted_to_a_curve_stays_as_it_is():
    one = Rational(np.zeros(0), np.ones(1))
    line = Halves(one, one, curve=np.array([2.0, 0.0, 0.0, 0.0, 0.0]))
    held = replace(line, limits=(-1.0, 3.0))
    np.testing.assert_allclose(held.bend(np.array([-5.0, 2.0, 9.0])), [-2.0, 4.0, 6.0])
    assert not held.send_as(line)


def test_a_deep_limit_between_the_halves_is_seen_where_one_record_is_loudest():
    """What fits soft records runs away on the loud one that was left out."""
    evidence = measured(lambda w: 0.4 * np.tanh(w / 0.4), sizes=(0.4, 1.2, 0.6, 1))
    _, note = load_base("linear", evidence)
    assert "written as two in series" in note

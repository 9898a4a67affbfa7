"""Code that may be late: it knows samples to come, and is nearer to the simulation."""

import shutil

import numpy as np
import pytest

from hystbench.blocks.step import Sampling
from hystbench.errors import InputError
from hystbench.export.described import describe, exact_delay
from tests.blocks.examples import EXAMPLES
from tests.conftest import run_hystbench

from .compiled import Compiled
from .test_steps import CHAINS, DT, INPUT, ROUND, TIME, chain_of, model_of

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler here")

DELAYS = (1, 4)
MODELS = {name: model_of(name, chain) for name, chain in CHAINS.items()}


def late(model, delay):
    return describe(model, Sampling(DT, duration_s=TIME[-1], delay=delay))


@pytest.fixture(scope="module")
def gaining():
    """Give the models that have something to gain, by name and delay."""
    found = {}
    for name, model in MODELS.items():
        plain = describe(model, Sampling(DT, duration_s=TIME[-1]))
        for delay in DELAYS:
            try:
                found[name, delay] = late(model, delay)
            except InputError:
                assert delay > exact_delay(plain)
    assert {name.split()[0] for name, _ in found} >= {
        "friction", "rdgpi", "rate-dependent-hysteresis", "resonance", "drive-lag",
        "stiffness-hardening", "transfer-function",
    }  # fmt: skip
    return found


#: Rates of what is inside hysteresis that depends on the rate: no delay reaches there.
NESTED = {"growth inside growth"}
NOISY = INPUT + 0.05 * np.random.default_rng(8).standard_normal(len(INPUT))


@pytest.fixture(scope="module")
def exact(tmp_path_factory):
    """Give code with the delay that it asks for, that delay, and what it makes."""
    found = {}
    for name, model in MODELS.items():
        delay = exact_delay(describe(model, Sampling(DT, duration_s=TIME[-1])))
        if delay:
            found[name] = (late(model, delay), delay)
    codes = [code for code, _ in found.values()]
    run = Compiled(codes, tmp_path_factory.mktemp("c")).outputs(NOISY)
    return {name: (code, d, run[code.name]) for name, (code, d) in found.items()}


@pytest.mark.parametrize("delay", DELAYS)
def test_late_by_what_was_asked_it_is_the_simulation(gaining, delay, tmp_path):
    models = {name: model for (name, d), model in gaining.items() if d == delay}
    run = Compiled(list(models.values()), tmp_path).outputs(INPUT)
    for name, model in models.items():
        y, wanted = run[model.name], MODELS[name].simulate(INPUT, DT)[:-delay]
        np.testing.assert_array_equal(y[:delay], 0.0)
        # The first sample has no neighbour before it; hysteresis remembers its rate
        # until the input has passed its range.
        remembers = any(x.name == "rate-dependent-hysteresis" for x in CHAINS[name])
        first = ROUND if remembers else 8
        off = np.abs(y[delay:] - wanted)[first:].max() / np.ptp(wanted)
        assert off <= 2e-6, f"{name}: {off:.2g} of the range"
        told = " ".join(model.differences)
        assert f"late by {delay} sample" in told


@pytest.mark.parametrize("name", ["friction 0 ", "friction 1 ", "rdgpi 1 "])
def test_a_rate_is_exact_from_the_first_sample_on(gaining, name, tmp_path):
    (found,) = [n for n, d in gaining if n.startswith(name) and d == 1]
    model = gaining[found, 1]
    y = Compiled([model], tmp_path).outputs(INPUT)[model.name][1:]
    wanted = MODELS[found].simulate(INPUT, DT)[:-1]
    assert np.abs(y - wanted).max() <= 1e-9 * np.ptp(wanted)
    assert "foretells" not in " ".join(model.differences)


LINEAR = ("drive-lag", {"time_constant_s": 2e-3, "hold": "linear"})
SMOOTH = ("drive-lag", {"time_constant_s": 2e-3, "hold": "band-limited"})
FRICTION = ("friction", {"coulomb": 2.0, "velocity_scale": 30.0})
HEAT = ("thermal-drift", {"coefficient": 3.0, "time_constant_s": 0.01})


@pytest.mark.parametrize(
    "blocks",
    [
        (FRICTION,),
        (LINEAR, FRICTION),
        (FRICTION, LINEAR),
        (LINEAR, FRICTION, HEAT),
        (HEAT, FRICTION, LINEAR),
    ],
)
def test_what_looks_at_the_input_stays_in_step_with_what_enters(blocks, tmp_path):
    """All of these are exact once the next sample is known."""
    model = model_of("mixed", chain_of(*blocks))
    noisy = np.random.default_rng(0).standard_normal(300)
    assert exact_delay(describe(model, Sampling(DT))) == 1
    run = Compiled([late(model, 1)], tmp_path)
    y, wanted = run.outputs(noisy)["mixed"], model.simulate(noisy, DT)
    np.testing.assert_allclose(y[1:], wanted[:-1], rtol=0, atol=1e-9 * np.ptp(wanted))


@pytest.mark.parametrize(("hold", "needed"), [("linear", 2), ("band-limited", 17)])
def test_an_input_that_is_stamped_late_is_foretold_or_waited_for(
    hold, needed, tmp_path
):
    """By a sample and a half: two samples to come, and those that a curve takes."""
    block = ("input-delay", {"delay_s": 0.0, "lead_s": 1.5 * DT, "hold": hold})
    model = model_of("early", chain_of(block))
    plain = describe(model, Sampling(DT))
    assert "foretells its input 2 samples to come" in " ".join(plain.differences)
    assert exact_delay(plain) == needed
    wanted = model.simulate(INPUT, DT)
    soon = Compiled([plain], tmp_path).outputs(INPUT)["early"]
    assert np.abs(soon - wanted)[2:-2].max() < 0.01 * np.ptp(wanted)
    y = Compiled([late(model, needed)], tmp_path).outputs(INPUT)["early"][needed:]
    inner = slice(40, -40)
    np.testing.assert_allclose(y[inner], wanted[:-needed][inner], rtol=0, atol=1e-9)


def test_a_measured_input_is_nearer_with_samples_on_both_sides(tmp_path):
    rng = np.random.default_rng(1)
    noisy = INPUT + 1e-3 * rng.standard_normal(len(INPUT))
    model = model_of("noisy", chain_of(SMOOTH, FRICTION))
    wanted, off = model.simulate(noisy, DT), {}
    for delay in (0, 1):
        run = Compiled([late(model, delay)], tmp_path).outputs(noisy)["noisy"]
        rest = (run[delay:] - wanted[: len(wanted) - delay])[100:]
        off[delay] = np.sqrt(np.mean(rest**2))
    assert off[1] < 0.02 * off[0]


@pytest.mark.parametrize(
    ("sampling", "said"),
    [
        (Sampling(DT, delay=16), "--delay: 16; expected at most 15, with which"),
        (Sampling(DT, delay=-1), "--delay: -1; expected 0 or more samples"),
    ],
)
def test_a_delay_that_no_curve_can_use_is_refused(sampling, said):
    with pytest.raises(InputError, match=said):
        describe(model_of("any", chain_of(SMOOTH)), sampling)


def test_a_rate_gets_the_first_sample_of_a_delay():
    """A curve is a little nearer with it, a rate exact: it makes noise no larger."""
    model = model_of("felt", chain_of(SMOOTH, ("impedance", EXAMPLES["impedance"])))
    lag, force = late(model, 1).pieces
    assert (lag.step.constants["ahead"], force.step.constants["ahead"]) == (0, 1)


def test_a_force_of_a_motion_is_exact_once_the_next_four_samples_are_known(tmp_path):
    """Of a measured motion, with noise: foretold it is wrong by much, and says so."""
    noisy = INPUT + 1e-3 * np.random.default_rng(2).standard_normal(len(INPUT))
    model = model_of("felt", chain_of(("impedance", EXAMPLES["impedance"])))
    wanted = model.simulate(noisy, DT)
    y = Compiled([late(model, 4)], tmp_path).outputs(noisy)["felt"][4:]
    assert np.abs(y - wanted[:-4]).max() <= 1e-9 * np.ptp(wanted)
    (told,) = describe(model, Sampling(DT)).differences
    assert "times as large as with --delay 4" in told


def test_modes_stay_in_step_with_the_mechanism_beside_them(tmp_path):
    """One of them takes straight lines: it gains nothing, and waits for the other."""
    model = model_of(
        "both",
        chain_of(
            ("mechanism", EXAMPLES["mechanism"] | {"hold": "linear"}),
            ("friction-force", EXAMPLES["friction-force"]),
            ("other-modes", EXAMPLES["other-modes"] | {"hold": "band-limited"}),
        ),
    )
    wanted = model.simulate(INPUT, DT)[:-6]
    y = Compiled([late(model, 6)], tmp_path).outputs(INPUT)["both"][6:]
    assert np.abs(y - wanted).max() <= 1e-9 * np.ptp(wanted)


def test_late_enough_code_is_the_simulation(exact):
    """Of noise up to half the sampling rate, and up to the record's end."""
    for name, (model, delay, y) in exact.items():
        wanted = MODELS[name].simulate(NOISY, DT)[:-delay]
        off = np.abs(y[delay:] - wanted).max() / np.ptp(wanted)
        told = " ".join(model.differences)
        if name in NESTED:
            assert "foretells" in told
            continue
        assert off <= 1e-9, f"{name}: {off:.2g} of the range"
        assert "polynomial" not in told, name


def test_the_command_finds_the_delay(tmp_path):
    file = tmp_path / "model.yaml"
    model_of("lags", chain_of(SMOOTH, LINEAR, FRICTION, SMOOTH)).save(file)
    asked = ("export", file, "--to", "c", "--dt", DT, "--out", tmp_path / "c")
    done = run_hystbench(*asked, "--delay", "exact")
    assert done.returncode == 0, done.stderr
    assert "late by 30 samples" in done.stdout
    for wrong, said in (("later", "'later'; expected a number"), ("-1", "expected a")):
        refused = run_hystbench(*asked, "--delay", wrong)
        assert refused.returncode == 2
        assert said in refused.stderr
        assert refused.stderr.count("\n") == 1
    turned = run_hystbench(*asked, "--delay", "exact", "--inverse", "--limit-low", 0,
                           "--limit-high", 1)  # fmt: skip
    assert turned.returncode == 2
    assert "expected a number with --inverse" in turned.stderr


def test_a_delay_that_gains_nothing_is_refused():
    with pytest.raises(InputError, match="--delay: 1; expected none"):
        late(model_of("any", chain_of(LINEAR)), 1)

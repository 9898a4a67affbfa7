"""Every block of the vocabulary exports, and its code gives what `simulate` gives."""

import shutil
import subprocess

import numpy as np
import pytest

from hystbench.blocks import registry
from hystbench.blocks.force import Force
from hystbench.blocks.held import HOLDS
from hystbench.blocks.step import Sampling
from hystbench.blocks.superposed import BesideBlock
from hystbench.blocks.wrapping import WrappingBlock
from hystbench.errors import InputError
from hystbench.export.code import header, source
from hystbench.export.described import describe
from hystbench.model import Model
from hystbench.record import Channel
from tests.blocks.examples import EXAMPLES

from .compiled import STRICT, Compiled

pytestmark = pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler here")

DT, COUNT = 1e-4, 1001
TIME = np.arange(COUNT) * DT
#: Whole periods: the band-limited curve of the record is these sines and nothing else.
INPUT = 0.5 * np.sin(2 * np.pi * 40 * TIME) + 0.12 * np.sin(2 * np.pi * 70 * TIME)
#: A simulator of somebody's own, in whatever form, is no description of one.
REFUSED = {"command", "external", "fmu", "onnx", "simulated-column"}
FORCES = [name for name, block in registry().items() if issubclass(block, Force)]
SAMPLING = Sampling(DT, duration_s=TIME[-1])
#: Samples until the polynomial goes through as many as it may; and until the input has
#: been through its range: at first no rate is known, and hysteresis remembers.
FIRST, ROUND = SAMPLING.points, 1000 // 4


def variants():
    """Give chains: each block's example, and draws of its parameters and holds."""
    random = np.random.default_rng(7)
    chains = {}
    for name, block in registry().items():
        if name in REFUSED:
            continue
        choices = {
            key: about.options
            for key, about in block.parameters().items()
            if about.kind == "choice" and key not in ("hold", "start")
        }
        for draw in range(3 if choices else 2):
            values = {"cells": 12} if name == "preisach" else {}
            values = {**EXAMPLES[name], **values}
            if draw:
                values |= {
                    key: drawn(about, values.get(key), random)
                    for key, about in block.parameters().items()
                    if about.kind != "choice" and key in EXAMPLES[name]
                }
            for key, options in choices.items():
                values[key] = options[(draw + 2) % len(options)]
            holds = HOLDS if "hold" in block.parameters() else ("",)
            for hold in holds:
                own = block.from_mapping(values | ({"hold": hold} if hold else {}))
                before = [own]
                if isinstance(own, WrappingBlock):
                    inner = ("gpi", "prandtl-ishlinskii")[draw % 2]
                    before = [registry()[inner].from_mapping(EXAMPLES[inner]), own]
                if isinstance(own, BesideBlock):
                    host = registry()["mechanism"]
                    before = [host.from_mapping(EXAMPLES["mechanism"]), own]
                if isinstance(own, Force):
                    host = ("mechanism", "impedance", "structure")[draw % 3]
                    before = [registry()[host].from_mapping(EXAMPLES[host]), own]
                chains[f"{name} {draw} {hold}"] = before
    return chains


def drawn(about, value, random):
    """Draw a value near another, within its bounds."""

    def near(number):
        moved = number * np.exp(random.uniform(-0.5, 0.5))
        return float(np.clip(moved, about.low, about.high))

    return [near(item) for item in value] if isinstance(value, list) else near(value)


def chain_of(*blocks):
    return [registry()[name].from_mapping(values) for name, values in blocks]


def mixed():
    """Give chains of several blocks: wrapped twice, driven by one another, longer."""
    gpi = ("gpi", EXAMPLES["gpi"])
    rate, shape = EXAMPLES["rate-dependent-hysteresis"], EXAMPLES["hysteresis-shape"]

    def faster(form, hold):
        return ("rate-dependent-hysteresis", {**rate, "form": form, "hold": hold})

    return {
        "shape inside growth": chain_of(
            gpi, ("hysteresis-shape", shape), faster("growing-thresholds", "linear")
        ),
        "growth by a logarithm": chain_of(
            gpi,
            (
                "rate-dependent-hysteresis",
                {"coefficient": 0.02, "exponent": 1.0, "knee": 5.0, "hold": "linear"},
            ),
        ),
        "growth inside growth": chain_of(
            gpi,
            faster("growing-thresholds", "default"),
            ("butterfly", EXAMPLES["butterfly"]),
            faster("growing-thresholds", "band-limited"),
        ),
        "field around relays": chain_of(
            ("preisach", EXAMPLES["preisach"] | {"cells": 10}),
            faster("acting-field", "band-limited"),
        ),
        "field around a loop that yields": chain_of(
            ("bouc-wen", EXAMPLES["bouc-wen"]),
            faster("acting-field", "linear"),
        ),
        "field around domains": chain_of(
            ("jiles-atherton", EXAMPLES["jiles-atherton"]),
            faster("excess-field", "linear"),
        ),
        "two of a kind": chain_of(
            ("gain", EXAMPLES["gain"]),
            ("drive-lag", EXAMPLES["drive-lag"]),
            gpi,
            ("thermal-drift", EXAMPLES["thermal-drift"]),
            ("resonance", EXAMPLES["resonance"]),
            ("gain", {"value": -0.5}),
        ),
        "an amplifier's limit of the rate": chain_of(
            ("slew-limit", {"rate": 100.0, "time_constant_s": 2.5 * DT}),
        ),
        "a servo's limit of the rate": chain_of(
            (
                "slew-limit",
                {"rate": 100.0, "time_constant_s": 2.5 * DT, "form": "sharp"},
            ),
        ),
        "limits of the rate up and down": chain_of(
            ("slew-limit", {"rate": 100.0, "falling": 60.0}),
            (
                "slew-limit",
                {"rate": 90.0, "time_constant_s": 2.5 * DT, "falling": 140.0},
            ),
        ),
        "two low-passes of heat": chain_of(
            ("thermal-drift",
             {**EXAMPLES["thermal-drift"], "second_time_constant_s": 0.01}),
        ),
        "a rod": chain_of(
            ("eddy-diffusion", {"time_constant_s": 0.02, "geometry": "rod"})
        ),
        "settled dynamics": chain_of(
            ("gain", {"value": 1.0, "offset": 3.0}),
            ("transfer-function",
             {**EXAMPLES["transfer-function"], "start": "settled"}),
        ),
        "forces together": chain_of(
            ("gain", {"value": 0.4}),
            ("mechanism", EXAMPLES["mechanism"] | {"output": "acceleration"}),
            *((name, EXAMPLES[name]) for name in FORCES),
            ("impedance", EXAMPLES["impedance"] | {"mass": 0.0, "damping": 0.0}),
            ("slider-with-gap", EXAMPLES["slider-with-gap"]),
            ("hysteretic-force", EXAMPLES["hysteretic-force"]),
            ("hysteretic-force", EXAMPLES["hysteretic-force"] | {"exponent": 2.0}),
        ),
        "a smooth drive of forces": chain_of(
            ("mechanism",
             {**EXAMPLES["mechanism"], "hold": "band-limited", "blend": 0.01,
              "gain": 2.0, "bias": 0.1, "start_position": 1e-3,
              "start_velocity": 0.5}),
            ("stiffness", EXAMPLES["stiffness"]),
            ("stop", EXAMPLES["stop"] | {"sides": "lower"}),
        ),
        "friction in one of three modes": chain_of(
            ("mechanism", EXAMPLES["mechanism"] | {"output": "velocity"}),
            ("friction-force", EXAMPLES["friction-force"]),
            ("stiffness", EXAMPLES["stiffness"]),
            ("other-modes", EXAMPLES["other-modes"]),
            ("other-modes",
             {**EXAMPLES["other-modes"], "numerator": [2.0], "start": "settled"}),
            ("gain", {"value": -0.5}),
        ),
        "friction in two of three modes": chain_of(
            ("mechanism", EXAMPLES["mechanism"] | {"output": "acceleration"}),
            ("friction-force", EXAMPLES["friction-force"]),
            ("other-mechanism",
             EXAMPLES["other-mechanism"] | {"output": "acceleration", "blend": 2.0}),
            ("friction-force", EXAMPLES["friction-force"]),
            ("stiffness", EXAMPLES["stiffness"]),
            ("other-modes", EXAMPLES["other-modes"]),
        ),
        "friction at a flexible shaft": chain_of(
            ("mechanism", EXAMPLES["mechanism"] | {"output": "velocity"}),
            ("friction-force", EXAMPLES["friction-force"]),
            ("attached-mass", EXAMPLES["attached-mass"]),
            ("stiffness", EXAMPLES["stiffness"]),
            ("attached-mass", EXAMPLES["attached-mass"] | {"mass": 0.3}),
        ),
        "a settled coordinate": chain_of(
            ("gain", {"value": 1.0, "offset": 3.0}),
            ("mechanism", {**EXAMPLES["mechanism"], "start": "settled"}),
        ),
        "a settled coordinate with forces": chain_of(
            ("gain", {"value": 1.0, "offset": 3.0}),
            ("mechanism", {**EXAMPLES["mechanism"], "start": "settled"}),
            *((name, EXAMPLES[name]) for name in FORCES),
        ),
        "a settled coordinate against a stop": chain_of(
            ("gain", {"value": 1.0, "offset": 3.0}),
            ("mechanism",
             {**EXAMPLES["mechanism"], "start": "settled", "start_position": 1e-3}),
            ("exponential-stiffness", EXAMPLES["exponential-stiffness"]),
            ("stop", EXAMPLES["stop"] | {"sides": "upper"}),
        ),
        "a settled sensor": chain_of(
            ("gain", {"value": 1.0, "offset": 3.0}),
            ("sensor-lag", {**EXAMPLES["sensor-lag"], "start": "settled"}),
        ),
        "a store that overflows": chain_of(
            ("store", {**EXAMPLES["store"], "gain": 400.0, "bias": 100.0,
                       "start_level": 0.5, "output": "outflow"}),
        ),
        "a store that runs over a weir": chain_of(
            ("store", {**EXAMPLES["store"], "gain": 400.0, "bias": 100.0,
                       "start_level": 0.5, "weir": 3.0, "output": "outflow"}),
        ),
        "a store that settles above a weir": chain_of(
            ("gain", {"value": 1.0, "offset": 3.0}),
            ("store", {**EXAMPLES["store"], "gain": 400.0, "bias": 100.0,
                       "weir": 3.0, "start": "settled"}),
        ),
        "a long delay": chain_of(("input-delay", {"delay_s": 0.03})),
        "a delay from rest": chain_of(
            ("gain", {"value": 1.0, "offset": 3.0}),
            ("input-delay", {"delay_s": 0.03, "start": "rest"}),
        ),
        "no delay": chain_of(("input-delay", {"delay_s": 0.0})),
    }  # fmt: skip


CHAINS = {**variants(), **mixed()}


def model_of(name, chain, **more):
    return Model(
        name,
        Channel("current", "A"),
        Channel("displacement", "um"),
        tuple(chain),
        **more,
    )


@pytest.fixture(scope="module")
def models():
    return {name: model_of(name, chain) for name, chain in CHAINS.items()}


@pytest.fixture(scope="module")
def described(models):
    return {name: describe(model, SAMPLING) for name, model in models.items()}


@pytest.fixture(scope="module")
def compiled(described, tmp_path_factory):
    every = Compiled(list(described.values()), tmp_path_factory.mktemp("c"))
    return every.outputs(INPUT)


def judge(y, wanted, differences):
    """Compare with the simulation: to rounding; to a millionth where steps differ."""
    assert np.isfinite(wanted).all()
    told = " ".join(differences)
    first, share = (FIRST, 1e-6) if told else (0, 1e-9)
    last = None
    if "foretells" in told:
        # Behind the last samples of a record there is none: a rate is one-sided there.
        first, last = ROUND, -2
    off = np.abs(y - wanted)[first:last].max() / np.ptp(wanted)
    assert off <= share, f"{off:.2g} of the range"


def test_every_block_is_exported_or_refused():
    covered = {block.name for chain in CHAINS.values() for block in chain}
    assert covered == set(registry()) - REFUSED


@pytest.mark.parametrize("name", CHAINS)
def test_c_is_the_simulation(name, models, described, compiled):
    wanted = models[name].simulate(INPUT, DT)
    judge(compiled[described[name].name], wanted, described[name].differences)


@pytest.mark.parametrize("name", sorted(REFUSED))
def test_somebodys_own_simulator_is_refused_in_one_line(name):
    model = model_of("own", chain_of((name, EXAMPLES[name])))
    with pytest.raises(
        InputError, match=f"^chain: block 1: {name}: .*into code"
    ) as told:
        describe(model, SAMPLING)
    assert "\n" not in str(told.value)


def test_a_frequency_is_as_near_as_the_documentation_says(tmp_path):
    """The polynomial through six samples, against the curve through all of them."""
    chain = chain_of(("drive-lag", {"time_constant_s": 1e-3, "hold": "band-limited"}))
    model = model_of("lag", chain)
    run = Compiled([describe(model, SAMPLING)], tmp_path)
    for share, allowed in ((1 / 50, 1e-7), (1 / 20, 1e-5), (1 / 10, 1e-3)):
        u = np.sin(2 * np.pi * share * np.arange(COUNT))
        off = np.abs(run.outputs(u)["lag"] - model.simulate(u, DT))[100:]
        assert allowed / 1e3 < off.max() < allowed


def test_relays_that_remember_too_much_forget_the_smallest_loop(tmp_path):
    """Loops inside loops, more than there is room for: no write beyond the arrays."""
    values = EXAMPLES["preisach"] | {"cells": 4, "limit": 1.0}
    model = model_of("relays", chain_of(("preisach", values)))
    steps = 200
    u = np.linspace(0.9, 0.0, steps) * (-1.0) ** np.arange(steps)
    flags = ("-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    y = Compiled([describe(model, SAMPLING)], tmp_path, *flags).outputs(u)["relays"]
    wanted = model.simulate(u, DT)
    off = np.abs(y - wanted) / np.ptp(wanted)
    assert off[:24].max() < 1e-9  # as many turns as there is room for
    assert off.max() < 0.1


def test_nothing_is_undefined_and_nothing_beyond_an_array(described, tmp_path):
    few = [
        model for name, model in described.items() if " 1" in name or name in mixed()
    ]
    flags = ("-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all")
    run = Compiled(few, tmp_path, *flags)
    assert all(np.isfinite(y).all() for y in run.outputs(INPUT[:200]).values())


def test_the_object_calls_mathematics_and_nothing_else(described, tmp_path):
    """Each file by itself, as a user compiles it; none allocates or prints."""
    few = [described[name] for name in mixed()]
    for model in few:
        (tmp_path / f"{model.name}.h").write_text(header(model))
        (tmp_path / f"{model.name}.c").write_text(source(model))
    files = [f"{model.name}.c" for model in few]
    strict = ["cc", *STRICT, "-O1", "-fno-stack-protector", "-c", *files]
    subprocess.run(strict, cwd=tmp_path, check=True)
    objects = sorted(map(str, tmp_path.glob("*.o")))
    told = subprocess.run(
        ["nm", "--undefined-only", *objects], capture_output=True, text=True, check=True
    )
    called = {line.split()[-1] for line in told.stdout.splitlines() if " U " in line}
    known = {
        "asinh",
        "atan",
        "atanh",
        "exp",
        "floor",
        "fmax",
        "fmin",
        "fmod",
        "log",
        "pow",
        "sin",
        "tan",
        "tanh",
        "ceil",
        "expm1",
        "log1p",
        "sinh",
    }
    assert called - {"_GLOBAL_OFFSET_TABLE_"} <= known | {"memset", "sqrt", "copysign"}
    assert {"tanh", "pow"} <= called


def test_a_path_of_drift_needs_the_length_of_its_record():
    model = model_of("wandering", chain_of(("drift", EXAMPLES["drift"])))
    with pytest.raises(InputError, match=r"chain: block 1: drift: path: .*--duration"):
        describe(model, Sampling(DT))


@pytest.mark.parametrize("dt", [0.0, -1.0, np.nan, np.inf])
def test_an_interval_that_is_none_is_refused(dt):
    with pytest.raises(InputError, match="--dt: "):
        describe(model_of("any", chain_of(("gain", {"value": 1.0}))), Sampling(dt))

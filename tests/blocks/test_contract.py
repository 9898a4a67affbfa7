"""What every block keeps to, registered or not yet written."""

import re
from dataclasses import MISSING, fields, replace

import numpy as np
import pytest

from hystbench.blocks import registry
from hystbench.blocks.attached import AttachedBlock
from hystbench.blocks.held import HeldBlock
from hystbench.errors import InputError

from .examples import EXAMPLES

DT = 1e-4
TIME = np.arange(2000) * DT
INPUT = 0.6 * np.sin(2 * np.pi * 40 * TIME)
BLOCKS = sorted(registry())
#: Blocks that add a signal whatever the input is.
UNASKED = {"drift", "mains-pickup"}
#: A stored output answers to the inputs of its records alone.
STORED = {"simulated-column"}
#: Named by a text, which may be any.
NAMED = STORED | {"fmu", "onnx", "command"}


def example(name):
    return registry()[name].from_mapping(EXAMPLES[name])


def runnable(name):
    """Return the example, attached to a block where it has to be."""
    if name in STORED:
        pytest.skip("answers to the input of a record alone; tested as such")
    if name == "fmu":
        pytest.skip("made by a compiler; tested with the simulators")
    if name == "onnx":
        pytest.importorskip("onnxruntime", reason="onnxruntime is not installed")
    block = example(name)
    if not isinstance(block, AttachedBlock):
        return block
    return block.attach(example("mechanism" if block.place == "inside" else "gpi"))


def test_every_block_has_an_example():
    assert sorted(EXAMPLES) == BLOCKS


@pytest.mark.parametrize("name", BLOCKS)
class TestContract:
    def test_it_says_what_it_is_and_where_it_comes_from(self, name):
        block = registry()[name]
        assert re.fullmatch(r"[a-z]+(-[a-z]+)*", name)
        assert "References" in block.__doc__
        assert block.place in {
            "base",
            "drive",
            "material",
            "inside",
            "mechanics",
            "sensor",
        }

    def test_parameters_have_unit_meaning_and_bounds(self, name):
        parameters = registry()[name].parameters()
        assert parameters
        for about in parameters.values():
            assert about.unit
            assert about.meaning
            if about.kind in {"number", "numbers"}:
                assert np.isfinite([about.low, about.high]).all()
                assert about.low < about.high

    def test_output_is_finite_and_as_long_as_the_input(self, name):
        z = INPUT.copy()
        y = runnable(name).simulate(z, INPUT, DT)
        assert y.shape == INPUT.shape
        assert y.dtype == np.float64
        assert np.isfinite(y).all()
        np.testing.assert_array_equal(z, INPUT)  # the input is left alone

    def test_zero_input_stays_constant(self, name):
        # From rest, without input, nothing moves: offsets show, motion does not.
        if name in UNASKED:
            pytest.skip("adds what the input does not explain; tested as such")
        zero = np.zeros(500)
        y = runnable(name).simulate(zero, zero, DT)
        np.testing.assert_allclose(y, y[0], rtol=0, atol=1e-15)

    def test_it_is_causal(self, name):
        # What comes after sample 1000 changes nothing before it; a rate may take four
        # samples on either side, so those up to 1000 are left out.
        changed = INPUT.copy()
        changed[1001:] *= -0.5
        block = runnable(name)
        if isinstance(block, HeldBlock):
            # A band-limited curve is made of all samples: it looks ahead.
            block = replace(block, hold="linear")
        np.testing.assert_allclose(
            block.simulate(changed, changed, DT)[:997],
            block.simulate(INPUT, INPUT, DT)[:997],
            rtol=0,
            atol=1e-12,
        )

    def test_mapping_round_trip(self, name):
        block = example(name)
        assert registry()[name].from_mapping(block.to_mapping()) == block

    def test_missing_and_unknown_parameters_are_named(self, name):
        values = dict(EXAMPLES[name])
        first = next(iter(values))
        with pytest.raises(InputError, match=f"unknown parameter '{first}x'.*{first}"):
            registry()[name].from_mapping({**values, f"{first}x": 1.0})
        one_of = registry()[name].one_of
        left = {key: values[key] for key in values if key not in (first, *one_of)}
        if not one_of and all(
            x.default is not MISSING for x in fields(registry()[name])
        ):
            return  # none of them need be told
        with pytest.raises(InputError, match=f"missing parameter '{first}'"):
            registry()[name].from_mapping(left)

    def test_of_some_parameters_one_is_enough(self, name):
        own = registry()[name]
        for given in own.one_of:
            others = [key for key in own.one_of if key != given]
            left = {key: EXAMPLES[name][key] for key in EXAMPLES[name]}
            block = own.from_mapping({k: left[k] for k in left if k not in others})
            assert [getattr(block, key) for key in others] == [0.0] * len(others)
            # A fit may pass zero, so that a file may hold it.
            none = own.from_mapping({given: 0.0})
            assert own.from_mapping(none.to_mapping()) == none

    def test_a_value_that_is_no_number_is_refused(self, name):
        values = dict(EXAMPLES[name])
        first = next(iter(values))
        texts = () if name in NAMED else ("0.1",)
        for wrong in (*texts, True, None, float("nan"), {}):
            with pytest.raises(InputError, match=f"{first}: expected"):
                registry()[name].from_mapping({**values, first: wrong})

    def test_a_value_out_of_bounds_is_refused(self, name):
        block = registry()[name]
        for key, about in block.parameters().items():
            if about.kind not in {"number", "numbers"}:
                continue
            beyond = 2 * about.high + 1
            old = EXAMPLES[name].get(key, 0.0)
            value = [beyond, *old[1:]] if about.kind == "numbers" else beyond
            with pytest.raises(InputError, match=rf"{key}.*out of bounds"):
                block.from_mapping({**EXAMPLES[name], key: value})


@pytest.mark.parametrize("name", sorted(UNASKED))
def test_what_the_input_does_not_explain_is_added(name):
    block = example(name)
    alone = block.simulate(np.zeros(len(INPUT)), INPUT, DT)
    assert np.ptp(alone) > 0
    added = block.simulate(INPUT, np.zeros(len(INPUT)), DT) - INPUT
    np.testing.assert_allclose(added, alone, rtol=0, atol=1e-15)


@pytest.mark.parametrize("name", BLOCKS)
def test_only_hysteresis_can_be_wrapped(name):
    own = {"bouc-wen", "gpi", "hysteresis", "jiles-atherton", "prandtl-ishlinskii"}
    assert example(name).hysteretic == (name in own | {"preisach", "rdgpi"})


def test_noise_repeats_with_its_seed():
    block = example("sensor-noise")
    first = block.draw(1000, np.random.default_rng(1))
    again = block.draw(1000, np.random.default_rng(1))
    other = block.draw(1000, np.random.default_rng(2))
    np.testing.assert_array_equal(first, again)
    assert not np.allclose(first, other)

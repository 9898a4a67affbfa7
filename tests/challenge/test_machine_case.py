"""A machine's case holds what its spec says, measured on its records alone."""

import numpy as np
import pytest

from hystbench.blocks.mechanism import Mechanism
from hystbench.challenge import drawn_machine
from hystbench.challenge.drawn_machine import draw_machine
from hystbench.challenge.make import make, write_folder
from hystbench.challenge.plant.effects import IN_MACHINE, MACHINES
from hystbench.challenge.spec import GROUPS, CaseSpec, draw_spec, effects_of, kind_of
from hystbench.dataset import load_dataset
from hystbench.errors import InputError
from hystbench.gap.records.evidence import load_evidence


def case_of(family, *effects, seed=7, **more):
    return make(CaseSpec(seed, kind_of(effects), effects, family, 20.0, **more))


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.fixture(scope="module")
def rubbing():
    return case_of("impedance", "friction")


def test_the_same_spec_gives_the_same_case(rubbing):
    again = case_of("impedance", "friction")
    for one, other in zip(rubbing.records, again.records, strict=True):
        assert (one.u == other.u).all()
        assert (one.y == other.y).all()
    assert rubbing.truth == again.truth


def test_what_no_linear_impedance_explains_is_20_db_above_the_noise(rubbing):
    """The same least squares by velocity and acceleration of the samples themselves."""
    rows, wanted = [], []
    for record in rubbing.records:
        if record.use == "fit":
            n = len(record)
            # the input ends anywhere: its mirror image makes it periodic
            whole = np.concatenate([record.u, record.u[::-1]])
            lines = 2j * np.pi * np.fft.rfftfreq(2 * n, record.dt)
            spectrum = np.fft.rfft(whole)
            v, a = (np.fft.irfft(spectrum * lines**k)[:n] for k in (1, 2))
            inner = slice(50, -50)
            ones = np.ones(n)
            rows.append(np.stack([record.u, v, a, ones], axis=1)[inner])
            wanted.append(record.y[inner])
    design, y = np.concatenate(rows), np.concatenate(wanted)
    left = rms(y - design @ np.linalg.lstsq(design, y)[0])
    noise = rubbing.truth["noise_rms"]
    effect = np.sqrt(left**2 - noise**2)
    assert 20 * np.log10(effect / noise) == pytest.approx(20.0, abs=1.0)


@pytest.mark.parametrize("seed", [1, 2, 4, 5])
def test_a_mass_with_nothing_hidden_is_the_linear_equation_but_for_noise(seed):
    """Two numerics that share no code: the plant's and that of model files.

    The latter takes a band-limited input as straight lines on a grid twice as fine,
    which is up to half a percent off at a tenth of the sampling rate.
    """
    case = case_of("mass-spring", seed=seed)
    told = case.truth["linear"]
    block = Mechanism(**told, hold="band-limited")
    for record in case.records:
        left = record.y - block.simulate(record.u, record.u, record.dt)
        least, own = 0.9 * case.truth["noise_rms"], 0.005 * case.truth["output_rms"]
        assert least < rms(left) < np.hypot(1.1 * case.truth["noise_rms"], own)


def first_to_have(name):
    """Give the first family that may have an effect, by whatever kind of case."""
    return next(
        family
        for family in MACHINES
        if name in (*effects_of("single", family), *effects_of("unlisted", family))
    )


#: Those of the vocabulary in every family; other effects, and forms of a group, which
#: are one law wherever they act, in the first family that may have them.
PAIRS = [
    (family, name, of_group)
    for family in MACHINES
    for name in (*effects_of("single", family), *effects_of("unlisted", family))
    for of_group in (False, True)
    if family == first_to_have(name)
    or (name in effects_of("single", family) and not of_group)
    # where it has no form of its own for the group, the case is the same
    if not of_group
    or GROUPS[1].allowed(IN_MACHINE[name], True)[0]
    not in GROUPS[1].allowed(IN_MACHINE[name], False)
]


@pytest.mark.parametrize(("family", "name", "of_group"), PAIRS)
def test_every_effect_shows_in_its_families(family, name, of_group):
    truth = case_of(family, name, seed=3, group=1, of_group=of_group).truth
    (effect,) = truth["effects"]
    assert (effect["name"], effect["place"]) == (name, IN_MACHINE[name].place)
    assert effect["ratio_db"] == pytest.approx(20.0, abs=0.1)
    assert 0.005 < effect["rms"] / truth["output_rms"] < 1.0


def test_all_four_quantities_are_measured_and_loops_are_open_and_closed():
    machines = [
        draw_machine(family, np.random.default_rng(seed))
        for family in MACHINES
        for seed in range(6)
    ]
    outputs = {machine.output for machine in machines}
    assert outputs == {"position", "velocity", "acceleration", "force", "level"}
    closed = {machine.gains[0] > 0 for machine in machines if machine.part}
    assert closed == {True, False}
    # nobody watches a free mass run away
    assert not any(
        machine.family == "free-mass"
        and machine.output == "position"
        and not machine.gains[0]
        for machine in machines
    )


@pytest.mark.parametrize(
    ("family", "causality"),
    [
        ("mass-spring", "force to motion"),
        ("pendulum", "force to motion"),
        ("impedance", "motion to force"),
        ("tank", "storage"),
    ],
)
def test_units_tell_the_causality(family, causality, tmp_path):
    case = case_of(family, seed=2)
    write_folder(case, tmp_path / "case")
    dataset = load_dataset(tmp_path / "case" / "dataset")
    assert dataset.quantities.causality == causality
    read = dataset.read(next(iter(dataset.record_files)))
    sent = {record.name: record for record in case.records}[read.name]
    assert read.y == pytest.approx(sent.y, rel=1e-6, abs=1e-6 * np.ptp(sent.y))
    model = tmp_path / "case" / "model.yaml"
    assert model.is_file() == (case.truth["base"] == "model-file")


def test_some_masses_are_handed_over_as_a_model_file():
    bases = [case_of("mass-spring", seed=seed).truth["base"] for seed in range(12)]
    assert set(bases) == {"linear", "model-file"}


def test_what_stands_before_a_machine_is_not_seen_in_its_recorded_input():
    plain = case_of("mass-spring", seed=6)
    limited = case_of("mass-spring", "drive-saturation", seed=6)
    assert not limited.truth["closed_loop"]
    if not plain.truth["closed_loop"]:
        assert (limited.records[1].u == plain.records[1].u).all()


def test_a_machine_has_one_set_of_records():
    with pytest.raises(InputError, match="one set of records"):
        case_of("tank", campaign="other")


def test_effects_of_actuators_are_refused_in_machines():
    with pytest.raises(InputError, match="unknown in the family 'tank'"):
        case_of("tank", "friction")
    with pytest.raises(InputError, match="of the family 'tank'"):
        draw_spec(1, "triple", "tank", 20.0)


def test_a_step_at_which_the_fit_of_a_base_runs_away_explains_nothing(monkeypatch):
    drawn = draw_machine("mass-spring", np.random.default_rng(3), closed=False)
    own, simulated = (
        np.array(drawn_machine._own_numbers(drawn)),
        drawn_machine._simulated,
    )

    def left(self, numbers, u):
        y = simulated(self, numbers, u)
        return np.full(len(y), np.nan) if np.any(numbers > 1.02 * own) else y

    rng = np.random.default_rng(4)
    inputs = [np.cumsum(rng.standard_normal(400)) for _ in range(2)]
    truth = [
        simulated(drawn, 1.1 * own, drawn_machine._between(u))[:400] for u in inputs
    ]
    monkeypatch.setattr(drawn_machine, "_simulated", left)
    found = drawn_machine.linear_parts(drawn, list(zip(inputs, truth, strict=True)))
    assert all(np.isfinite(model).all() for _, model in found)


def test_a_period_is_told_only_where_the_input_has_it(tmp_path):
    """A controller drives this mass; its force changes as a clearance wears."""
    spec = CaseSpec(
        131040002, "unlisted", ("wearing-clearance",), "mass-spring", 20.0, group=2
    )
    case = make(spec)
    assert case.truth["closed_loop"]
    write_folder(case, tmp_path)
    load_evidence(tmp_path / "dataset")  # refuses a period that is none
    told = {record.name: record.period_samples for record in case.records}
    assert told["multisine-low"] is None

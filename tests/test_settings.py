"""The config is checked before the first job, and a job gets only its own part."""

import copy

import pytest

from hystbench.errors import InputError
from hystbench.plants import packaged_models
from hystbench.settings import read_settings
from hystbench.settings_checks import config_schema
from tests.conftest import SCHEMA, own_config
from tests.messages import message

CONFIG = own_config()
SHORT = {"sine": {"frequency_hz": 10, "duration_s": 0.005}}


def changed(*path_and_value):
    """The project's config with one value changed; None takes the key away."""
    *path, key, value = path_and_value
    config = copy.deepcopy(CONFIG)
    place = config
    for step in path:
        place = place[step]
    if value is None:
        del place[key]
    else:
        place[key] = value
    return config


def read(config):
    return read_settings(config, SCHEMA)


def test_the_projects_own_config_is_valid():
    settings = read(CONFIG)
    assert settings.results == "results"
    assert len(settings.signals) == 13
    assert settings.filters[:4] == ["gpo", "backlash", "volterra", "delayed"]


def test_every_key_of_the_config_is_in_the_schema_and_the_other_way_round():
    schema = config_schema(CONFIG, SCHEMA)

    def keys(part):
        while "$ref" in part:
            part = schema["$defs"][part["$ref"].rsplit("/", 1)[1]]
        return part.get("properties", {})

    def compare(config, part):
        known = keys(part)
        if not known:
            return
        assert set(config) == set(known)
        for key, value in config.items():
            if isinstance(value, dict):
                compare(value, known[key])

    compare(CONFIG, schema)


SINE = ("excitations", "sine-010hz")
STEPS = ("filters", "convergence_factor")
GAP = {"dataset": "x", "model": "gpi"}


def limits(**given):
    return CONFIG["gap"]["twin"] | {"limits": given}


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("sorce", "twin"), "unknown key 'sorce'; did you mean 'source'?"),
        (("source", None), "config.yaml: expected the key 'source'"),
        (("source", "Twin"), "did you mean 'twin'?"),
        (("source", "nowhere/dataset.yaml"), "nowhere/dataset.yaml"),
        (("filters", "ordr", 3), "filters: unknown key 'ordr'"),
        (("filters", "order", "30"), "filters: order: '30'; expected a whole number"),
        (("filters", "order", 0), "filters: order"),
        (("filters", "order", 30.0), "order: 30.0; expected a whole number"),
        (("filters", "order", 5000), "order: 5000; expected a number of 4095"),
        (("filters", "envelopes", "publishd"), "did you mean 'published'?"),
        ((*STEPS, "gpo", "mu", 0), "convergence_factor: gpo: mu: 0"),
        ((*STEPS, "volterra", "second_order", -1e-3), "second_order: -0.001"),
        ((*STEPS, "gpo", "mu", float("nan")), "mu: nan; expected a finite number"),
        ((*STEPS, "gpo", "mu", "1e-2"), "in config.yaml 1.0e-2 for 1e-2"),
        (("gap", "twin", limits(low="1")), "low: '1'; expected a finite number or"),
        (("gap", "twin", limits(rat=1)), "key 'rat'; did you mean 'rate'?"),
        (
            ("gap", "datasets", [GAP | {"limits": {"low": 2, "high": 1}}]),
            "gap: datasets: x: limits: low 2 and high 1; expected low < high",
        ),
        (
            ("gap", "datasets", [GAP | {"without": "friction"}]),
            "without: 'friction'; expected a list",
        ),
        (("gap", "datasets", [GAP | {"witout": []}]), "did you mean 'without'?"),
        (("signals", ["sine-040h"]), "did you mean 'sine-040hz'?"),
        (("signals", "sine-040hz"), "signals: 'sine-040hz'; expected a list"),
        (("signals", []), "signals"),
        (("models", ["gpo", "voltera"]), "did you mean 'volterra'?"),
        (("identification", "signal", "sine-1hz"), "'sine-001hz'"),
        (("order_sweep", "signal", "x"), "order_sweep: signal: no signal 'x'"),
        (("rdgpi", "fit_signals", ["sine-10hz"]), "'sine-010hz'"),
        (("twin", "model", "gmaa"), "no model or file 'gmaa'; did you mean"),
        (("twin", "input_zero_error", float("inf")), "inf; expected a finite number"),
        (("twin", "input_noise", -1e-3), "input_noise: -0.001; expected"),
        (("constants", "twins", ["gmo"]), "constants: twins: no model or file 'gmo'"),
        (("measured", "fraction_of_bound", 0), "fraction_of_bound: 0"),
        (("excitation", "unit", "V"), "expected 'A', the input of"),
        ((*SINE, {"sine": {"frequency_hz": 0}}), "frequency_hz: 0; expected above 0"),
        ((*SINE, {"sine": {"frequency_hz": 5000}}), "below 5000 Hz, half the sampling"),
        ((*SINE, {"sine": {"frequency_hz": [1, 2]}}), "[1, 2]; expected a finite"),
        ((*SINE, {"sine": {"frequenzy_hz": 10}}), "did you mean 'frequency_hz'?"),
        ((*SINE, {"sine": {}, "chirp": {}}), "expected 1 key"),
        ((*SINE, SHORT), "50 samples are too few for filters of order 30"),
    ],
)
def test_a_bad_config_is_told_in_one_line(change, expected):
    assert expected in message(lambda: read(changed(*change)))


def test_a_job_gets_what_it_depends_on_and_no_more():
    base = read(CONFIG)
    louder = read(changed("filters", "convergence_factor", "gpo", "mu", 0.5))
    assert louder.filter_job("gpo") != base.filter_job("gpo")
    for name in ["backlash", "volterra", "delayed"]:
        assert louder.filter_job(name) == base.filter_job(name)
    other = read(changed("filters", "backlash_structure", "current-input"))
    assert other.filter_job("backlash") != base.filter_job("backlash")
    for name in ["gpo", "volterra", "delayed"]:
        assert other.filter_job(name) == base.filter_job(name)


def test_a_measured_dataset_has_its_own_signals_and_folder(write_dataset, loop_csv):
    path = write_dataset({"a.csv": loop_csv, "b.csv": loop_csv})
    settings = read(changed("source", str(path)))
    assert settings.results == "results/datasets/bench"
    assert settings.signals == ["a", "b"]
    assert settings.identification_signal == "a"
    assert settings.envelopes == "identified"
    job = settings.filter_job("delayed")
    assert job["fraction_of_bound"] == CONFIG["measured"]["fraction_of_bound"]
    assert "convergence_factor" not in job


def test_a_record_shorter_than_its_filter_is_refused(write_dataset, loop_csv):
    short = "\n".join(loop_csv.splitlines()[:40]) + "\n"
    path = write_dataset({"short.csv": short})
    with pytest.raises(InputError, match=r"short\.csv: 39 samples are too few"):
        read(changed("source", str(path)))


def test_a_record_that_stands_still_is_for_the_gap_alone(write_dataset, loop_csv):
    """The error of a filter is told as a share of the output."""
    header, *rows = loop_csv.splitlines()
    still = "\n".join([header, *(f"{row.rpartition(',')[0]},0" for row in rows)])
    path = write_dataset({"a.csv": loop_csv, "b.csv": still + "\n"})
    said = "file: b.csv, stands_still: [output]"
    path.write_text(path.read_text().replace("file: b.csv", said))
    with pytest.raises(InputError, match=r"b\.csv: record b: \w+ is constant"):
        read(changed("source", str(path)))


def test_signals_narrow_a_dataset_and_a_misspelt_one_is_refused(
    write_dataset, loop_csv
):
    path = write_dataset({"slow.csv": loop_csv, "fast.csv": loop_csv})
    narrowed = changed("source", str(path)) | {"signals": ["fast"]}
    assert read(narrowed).signals == ["fast"]
    misspelt = changed("source", str(path)) | {"signals": ["fas"]}
    with pytest.raises(InputError, match="no signal 'fas'; did you mean 'fast'"):
        read(misspelt)


def test_twins_are_named_packaged_or_in_a_folder(tmp_path):
    twin = read(CONFIG).model_file
    for name in ("b", "a"):
        (tmp_path / f"{name}.yaml").write_text("name: any\n")
    config = changed("pressure", "twins", [str(tmp_path), CONFIG["twin"]["model"]])
    # the twin comes first and once, a folder's files in order
    assert read(config).twin_files == [
        twin,
        str(tmp_path / "a.yaml"),
        str(tmp_path / "b.yaml"),
    ]


def test_a_folder_without_twins_is_refused(tmp_path):
    with pytest.raises(InputError, match="pressure: twins: no model file in"):
        read(changed("pressure", "twins", [str(tmp_path)]))


def test_a_signal_of_the_tables_that_is_not_defined_is_refused():
    config = changed("excitations", "sine-020hz", None)
    config["signals"].remove("sine-020hz")
    config["rdgpi"]["fit_signals"].remove("sine-020hz")
    with pytest.raises(InputError, match="excitations: no signal 'sine-020hz'"):
        read(config)


def test_a_misspelt_target_gets_the_nearest_name():
    settings = read(CONFIG)
    for target in [
        "compare",
        "results/filters/sine-040hz/gpo.json",
        "results/filters/sine-050hz/rdgpi.npz",
        "results/records/whatever.npz",
    ]:
        settings.check_target(target)
    for target, expected in [
        ("results/filters/sine-40hz/gpo.json", "did you mean 'sine-040hz'?"),
        ("results/filters/sine-040hz/gop.json", "did you mean 'gpo'?"),
    ]:
        with pytest.raises(InputError, match=r"no '.*'; ") as caught:
            settings.check_target(target)
        assert expected in str(caught.value)


def test_the_record_of_the_choice_is_no_model():
    assert "gma" in packaged_models()
    assert "choice" not in packaged_models()

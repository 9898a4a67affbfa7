"""What is said of records whose faults are known."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hystbench.dataset import load_dataset
from hystbench.inspection import screen
from hystbench.inspection.base import loop_of_plays
from hystbench.inspection.check import check
from hystbench.inspection.page import page
from tests.inspection.made import COUNT, DT, loop, sine, write

NOISE = 0.01


def noisy(y, seed=0, rms=NOISE):
    return y + rms * np.random.default_rng(seed).standard_normal(len(y))


def records(frequencies=(5, 10, 20, 40), **changes):
    made = {}
    for k, hz in enumerate(frequencies):
        u = sine(hz, 0.6 + 0.3 * (k % 2))
        made[f"sine-{hz}"] = (u, noisy(loop(u), k))
    return made | changes


HELD = {"sine-10": "hold-out"}


def of_kind(found, kind):
    return [item for item in found.findings if item.kind == kind]


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    place = write(tmp_path_factory.mktemp("plain"), records(), roles=HELD)
    return check(load_dataset(place))


def test_the_period_is_found_and_its_line_can_be_pasted(plain, tmp_path):
    (missing,) = of_kind(plain, "missing")
    assert "- {file: sine-5.csv, use: fit, period_samples: 200}" in missing.paste
    about = tmp_path / "dataset.yaml"
    place = write(tmp_path, records(), roles=HELD)
    head = place.read_text().partition("records:\n")[0]
    about.write_text(head + "records:\n" + "\n".join(missing.paste) + "\n")
    again = check(load_dataset(about), effects=False)
    assert not of_kind(again, "missing")
    assert [item.period for item in again.facts] == [200, 100, 50, 25]


def test_a_period_with_which_an_input_grows_is_doubted(tmp_path):
    growth = np.arange(COUNT) / COUNT
    made = records() | {"grow": (growth * sine(10), noisy(loop(growth * sine(10))))}
    entries = {"grow": ", period_samples: 100", "sine-5": ", period_samples: 200"}
    place = write(tmp_path, made, entries=entries, roles=HELD)
    found = check(load_dataset(place), False).findings
    (told,) = (item.text for item in found if "does not repeat" in item.text)
    assert told.startswith("grow: ")


def test_a_record_of_one_period_is_not_doubted(tmp_path):
    entries = {"sine-5": f", period_samples: {COUNT}"}
    place = write(tmp_path, records(), entries=entries, roles=HELD)
    found = check(load_dataset(place), False).findings
    assert not [item for item in found if "does not repeat" in item.text]


def test_the_noise_is_measured_by_the_repeats_that_were_found(plain):
    assert plain.floor.method == "repeats"
    assert plain.floor.rms == pytest.approx(NOISE, rel=0.15)


def test_rates_bands_and_levels(plain):
    fast = plain.facts[3]
    assert (fast.name, fast.samples) == ("sine-40", COUNT)
    assert fast.dt == pytest.approx(DT)
    assert fast.input.low_hz <= 40 <= fast.input.high_hz < 45
    assert fast.input.span == pytest.approx(1.8, rel=0.01)
    # rms rate of a sine: 2 pi f A / sqrt 2
    assert fast.input.rate == pytest.approx(2 * np.pi * 40 * 0.9 / np.sqrt(2), rel=0.02)
    assert fast.jitter == pytest.approx(0, abs=1e-6)


def test_a_late_trigger_is_told_and_no_other(tmp_path):
    shift = 6
    u, y = records()["sine-20"]
    late = np.roll(y, shift)
    made = records(frequencies=(4, 5, 8, 10, 16, 25, 32, 40))
    place = write(tmp_path, made | {"late": (u, late)}, roles=HELD)
    told = [
        f.text
        for f in check(load_dataset(place), False).findings
        if "trigger" in f.text
    ]
    assert len(told) == 1
    assert told[0].startswith("late:")


@pytest.mark.parametrize(("shift", "word"), [(6, "later"), (-6, "sooner")])
def test_it_is_told_whether_an_output_comes_late_or_early(tmp_path, shift, word):
    u, y = records()["sine-20"]
    made = records(frequencies=(4, 5, 8, 10, 16, 25, 32, 40))
    made["moved"] = u, np.roll(y, shift)
    found = check(load_dataset(write(tmp_path, made, roles=HELD)), False).findings
    (told,) = (f.text for f in found if "trigger" in f.text)
    assert told.startswith("moved:")
    samples = float(told.partition("(")[2].partition(" samples")[0])
    assert samples == pytest.approx(abs(shift), rel=0.15)  # to first order of the shift
    assert word in told


def test_a_wider_loop_of_a_triangle_is_no_late_trigger(tmp_path):
    u = np.abs((np.arange(COUNT) + 60) % 240 - 120.0) / 120 - 0.5
    wide = noisy(loop(u) - 0.1 * np.sign(np.gradient(u)))
    made = records(frequencies=(4, 5, 8, 10, 16, 25, 32, 40)) | {"wide": (u, wide)}
    found = check(load_dataset(write(tmp_path, made, roles=HELD)), False).findings
    assert not [f.text for f in found if "trigger" in f.text]


def test_a_clipped_output_is_wrong(tmp_path):
    made = records()
    u, y = made["sine-20"]
    made["sine-20"] = (u, np.minimum(y, 0.6 * y.max()))
    place = write(tmp_path, made, roles=HELD)
    (wrong,) = of_kind(check(load_dataset(place), False), "wrong")
    assert "sine-20" in wrong.text
    assert "clipped" in wrong.text
    assert wrong.paste == ("- {file: sine-20.csv, use: fit, stands_still: [output]}",)


def test_an_output_that_is_read_slowly_is_not_called_clipped(tmp_path):
    """Unless it follows an input that stands as long."""
    made = records((5, 10))
    held = {k: (u, np.repeat(y[::6], 6)[: len(y)]) for k, (u, y) in made.items()}
    found = check(load_dataset(write(tmp_path / "a", held)), effects=False)
    notes = " ".join(item.text for item in of_kind(found, "note"))
    assert "displacement changes only once in 6 samples" in notes
    assert "clipped" not in notes
    both = {k: (np.repeat(u[::6], 6)[: len(u)], y) for k, (u, y) in held.items()}
    found = check(load_dataset(write(tmp_path / "b", both)), effects=False)
    assert not [x for x in of_kind(found, "note") if "changes only once" in x.text]


def test_missing_samples_are_counted(tmp_path):
    made = records()
    made["sine-20"][1][[100, 101, 500]] = np.nan
    entries = {"sine-20": ", missing: interpolate"}
    place = write(tmp_path, made, roles=HELD, entries=entries)
    found = check(load_dataset(place), False)
    assert found.facts[2].missing == 3
    assert any("3 of 1200 samples are missing" in f.text for f in found.findings)


def test_an_uneven_clock_is_told(tmp_path):
    place = write(tmp_path, records(), roles=HELD)
    file = tmp_path / "sine-5.csv"
    head, *rows = file.read_text().splitlines()
    rng = np.random.default_rng(1)
    cells = [row.split(",") for row in rows]
    moved = [
        f"{float(t) + 0.05 * DT * rng.uniform(-1, 1):.9g},{a},{b}" for t, a, b in cells
    ]
    file.write_text("\n".join([head, *moved]) + "\n")
    text = place.read_text().replace("unit: s}", "unit: s, tolerance: 0.2}")
    place.write_text(text)
    found = check(load_dataset(place), False)
    # The difference of two uniform deviations: 0.05 / sqrt 3 * sqrt 2 of a step.
    assert found.facts[0].jitter == pytest.approx(0.05 * np.sqrt(2 / 3), rel=0.1)
    assert any("steps of time differ by" in f.text for f in found.findings)


def test_records_that_never_repeat_have_no_measured_noise(tmp_path):
    time = DT * np.arange(COUNT)
    made = {}
    for k, top in enumerate((10, 20, 30)):
        u = np.sin(2 * np.pi * (1 + top * time / 2) * time)
        made[f"chirp-{top}"] = (u, noisy(loop(u), k))
    place = write(tmp_path, made, roles={"chirp-20": "hold-out"})
    found = check(load_dataset(place), False)
    assert any("upper bound" in item.text for item in of_kind(found, "missing"))
    assert "noise_rms" in of_kind(found, "missing")[0].paste[0]


def seen(found, name):
    return next(item for item in found.effects if item.effect == name)


def test_noise_hides_effects_in_proportion(plain, tmp_path):
    about = f"noise_rms: {2 * plain.floor.rms!r}\n"
    place = write(tmp_path, records(), about, roles=HELD)
    louder = check(load_dataset(place))
    # Periods are asked for where they are to tell the noise; else they are a note.
    for found, kind in ((plain, "missing"), (louder, "note")):
        assert any("inputs repeat" in x.text for x in of_kind(found, kind))
    for name in ("creep", "asymmetry", "friction"):
        assert seen(louder, name).seen_from == pytest.approx(
            2 * seen(plain, name).seen_from, rel=1e-6
        )


def test_slow_records_hide_what_is_fast(plain, tmp_path):
    # The same loops a hundred times as slow.
    slow = write(
        tmp_path,
        {name: (u, y) for name, (u, y) in records().items()},
        roles=HELD,
        dt=100 * DT,
    )
    found = check(load_dataset(slow))
    for name in ("sensor-lag", "input-delay"):
        now, then = seen(plain, name), seen(found, name)
        assert then.value == pytest.approx(100 * now.value, rel=0.02)
    assert not seen(plain, "calibration-error").revealed
    assert "gain" in seen(plain, "calibration-error").why


def test_what_is_simulated_at_the_strength_said_is_there(plain):
    """The block at the number that is told adds the share that is told."""
    from hystbench.blocks import registry

    item = seen(plain, "sensor-nonlinearity")
    values = {"quadratic": 0.0, "cubic": 0.0, item.number: item.value}
    block = registry()["sensor-nonlinearity"].from_mapping(values)
    fit = [record for record in plain.records if record.use == "fit"]
    base = loop_of_plays(fit)
    outputs = [base.simulate(record.u, record.dt) for record in fit]
    adds = [block.simulate(y, y, DT) - y for y in outputs]
    share = np.sqrt(np.mean(np.concatenate(adds) ** 2))
    share /= np.sqrt(np.mean([np.var(record.y) for record in fit]))
    assert share == pytest.approx(item.seen_from, rel=0.05)


def test_lags_are_mistaken_for_each_other(plain):
    names = [name for name, _ in seen(plain, "sensor-lag").rivals]
    assert set(names) & {"drive-lag", "eddy-diffusion", "input-delay"}


def test_the_text_is_one_screen_and_the_page_says_the_same(plain):
    lines = screen.lines(plain)
    assert len(lines) <= 40
    assert "effects judged." in " ".join(lines[:3])
    made = page(plain)
    for item in plain.effects:
        assert item.effect in made
        assert any(item.effect in line for line in lines)
    assert "period_samples: 200" in made
    assert 'src="http' not in made


def many(names):
    """Thirty records of which many are wrong in the same few ways."""
    made, entries = {}, {}
    for k, name in enumerate(names):
        u = sine((4, 5, 8, 10, 20)[k % 5], 0.3 + 0.1 * (k % 7))
        y = noisy(loop(u), k)
        if k % 6 == 1:
            y = np.minimum(y, 0.6 * y.max())
        elif k % 6 == 2:
            y[300:303] = np.nan
            entries[name] = ", missing: interpolate"
        elif k % 6 == 3:
            u = np.minimum(u, 0.95 * u.max())
        made[name] = (u, y)
    held = dict.fromkeys(names[::7], "hold-out")
    return made, held, entries


def test_thirty_records_are_one_screen_and_the_page_has_all(
    plain, tmp_path, monkeypatch
):
    """Also where names are long."""
    monkeypatch.chdir(tmp_path)
    names = [f"a-record-with-quite-a-long-name-{k}" for k in range(30)]
    made, held, entries = many(names)
    write(Path("d"), made, roles=held, entries=entries)
    found = check(load_dataset("d/dataset.yaml"), effects=False)
    found = replace(found, effects=plain.effects)
    lines = screen.lines(found)
    assert len(lines) <= 40
    assert max(map(len, lines)) <= 100
    said = " ".join(" ".join(lines).split())
    assert "likewise" in said
    for topic in ("not clipped", "missing and interpolated", "looks clipped"):
        assert topic in said
    everything = page(found)
    for each in names:
        assert f"{each}.csv" in everything or f">{each}<" in everything


def test_a_lightly_clipped_input_is_a_note_unless_it_is_real(tmp_path):
    made = records()
    u, y = made["sine-5"]
    made["sine-5"] = (np.minimum(u, 0.98 * u.max()), y)

    def told(entries):
        place = write(tmp_path, made, roles=HELD, entries=entries)
        found = check(load_dataset(place), False)
        return [x.text for x in of_kind(found, "note") if "looks clipped" in x.text]

    (text,) = told({})
    assert text.startswith("sine-5: current is exactly 0.588 A for ")
    assert told({"sine-5": ", stands_still: [input]"}) == []


def about_levels(tmp_path, made):
    found = check(load_dataset(write(tmp_path, made, roles=HELD)), False)
    return {key: any(key in x.text for x in found.findings) for key in ONE}


ONE = ("one amplitude", "one rate")


def test_records_of_one_amplitude_or_rate_are_told(tmp_path):
    alike = {f"sine-{hz}": (u := sine(hz, 0.9), noisy(loop(u))) for hz in (5, 10, 20)}
    assert about_levels(tmp_path, alike) == dict(zip(ONE, (True, False), strict=True))
    slow = {
        name: (u := sine(10, a), noisy(loop(u)))
        for name, a in (("sine-10", 1.0), ("a", 0.9), ("b", 1.0))
    }
    assert about_levels(tmp_path / "slow", slow) == dict.fromkeys(ONE, True)


def test_amplitudes_and_rates_inside_a_record_count(tmp_path):
    u = sine(10) * np.where(np.arange(COUNT) < COUNT // 2, 0.4, 1.0)
    several = {name: (u, noisy(loop(u), k)) for k, name in enumerate(("sine-10", "a"))}
    assert about_levels(tmp_path, several) == dict.fromkeys(ONE, False) | {
        "one rate": True
    }
    mixed = {name: (sine(5) + sine(40, 0.5), noisy(u)) for name in several}
    assert not any(about_levels(tmp_path / "mixed", mixed).values())


def rounded(place, digits):
    """Round the times of records, and scatter none."""
    for file in place.parent.glob("*.csv"):
        head, *rows = file.read_text().splitlines()
        cells = [row.partition(",") for row in rows]
        made = [f"{float(time):.{digits}f},{rest}" for time, _, rest in cells]
        file.write_text("\n".join([head, *made]) + "\n")


def test_a_jitter_that_comes_of_rounding_is_called_so(tmp_path):
    dt = 1 / 12000
    made = {f"{k}": (sine(200 * k, dt=dt), sine(200 * k, dt=dt)) for k in (1, 2)}
    place = write(tmp_path, made, roles={"2": "hold-out"}, dt=dt)
    rounded(place, 6)
    found = check(load_dataset(place), effects=False)
    assert [item.tick_s for item in found.facts] == [1e-6, 1e-6]
    assert "(times are rounded to 1e-06 s)" in " ".join(screen.lines(found))


def test_a_clock_that_is_uneven_beyond_its_digits_is_no_rounded_one(tmp_path):
    place = write(tmp_path, {"a": (sine(5), sine(5)), "b": (sine(9), sine(9))})
    file = tmp_path / "a.csv"
    head, *rows = file.read_text().splitlines()
    scatter = 3e-6 * np.random.default_rng(0).uniform(-1, 1, len(rows))
    made = [
        f"{float(row.partition(',')[0]) + by:.6f},{row.partition(',')[2]}"
        for row, by in zip(rows, scatter, strict=True)
    ]
    file.write_text("\n".join([head, *made]) + "\n")
    first, second = check(load_dataset(place), effects=False).facts
    assert first.jitter > 1e-4
    assert first.tick_s is None
    assert second.jitter < 1e-6


def groups(place):
    """Give the lines of the screen that tell of several records."""
    said = screen.lines(check(load_dataset(place), effects=False))
    return [line for line in said if " samples at " in line]


def test_periods_are_told_of_records_that_have_some(tmp_path):
    noise = {
        f"noise-{k}": (np.random.default_rng(k).standard_normal(COUNT), sine(5))
        for k in range(8)
    }
    place = write(tmp_path, noise, roles={"noise-0": "hold-out"})
    told = groups(place)
    assert told
    assert not any("period" in line for line in told)
    place = write(tmp_path / "mixed", noise | records(), roles=HELD)
    told = [line for line in groups(place) if "sine" in line]
    assert told
    assert all(" periods," in line for line in told)

"""The page of a search says every number and word of gap.json, once."""

import base64
import json
import re
from dataclasses import asdict
from html.parser import HTMLParser

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox

from hystbench.errors import InputError
from hystbench.figures.style import PAGE, in_style
from hystbench.gap.locate.picture import Axis, Bars, Cells, Panel, ViewPicture, series
from hystbench.gap.report import pictures
from hystbench.gap.report.page import headline, write_report
from hystbench.gap.report.words import explained, number, sentence, with_error
from hystbench.gap.schema import LEFT_OUT, SCHEMA
from hystbench.report.markup import one_micro
from hystbench.schema import check_against_schema
from hystbench.sentences import shortly


def ranked(number, name, place="mechanics", **more):
    return {
        "round": number,
        "look": 0,
        "instead_of": None,
        "beside": ["resonance"] if number > 1 else [],
        "name": name,
        "place": place,
        "taken": "held_back" in more,
        "refitted": "score" in more,
        "held_back": None,
        **more,
    }


def looked(look, name, place="mechanics", *, taken=False, **more):
    places = [("resonance", "creep"), ("creep", "resonance")]
    instead_of, beside = places[look - 1]
    about = {"look": look, "instead_of": instead_of, "beside": [beside]}
    return ranked(2, name, place, **more) | about | {"taken": taken}


SIMULATOR = {
    "input": {"name": "coil current", "unit": "A"},
    "output": {"name": "displacement", "unit": "um"},
    "functions": [],
    "runs_again": True,
    "sampling_interval_s": 0.0005,
}
VALUE = {"value": 69.7123, "standard_error": 0.0456, "unit": "Hz"}
GAP = {
    "dataset": "bench",
    "model": "rig.yaml",
    "unit": "um",
    "verdict": "named",
    "reason": "The resonance pays on every fold, and what is left is at the floor.",
    "effects": [
        {
            "name": "resonance",
            "place": "mechanics",
            "parameters": {
                "frequency_hz": VALUE,
                "damping_ratio": {
                    "value": 0.0412,
                    "standard_error": 0.0013,
                    "unit": "-",
                },
            },
            "blocks": ["resonance"],
            "confidence": 0.97,
            "cannot_be_told_from": [],
        },
        {
            "name": "creep",
            "place": "mechanics",
            "parameters": {
                "magnitudes": {
                    "value": [0.0213, 0.0117],
                    "standard_error": [0.0011, 0.0019],
                    "unit": "-",
                }
            },
            "blocks": ["creep"],
            "confidence": 0.61,
            "cannot_be_told_from": ["thermal-drift", "drift"],
        },
    ],
    "where": [
        {
            "view": "frequency",
            "axis": "frequency",
            "from": 60.5,
            "to": 81.5,
            "unit": "Hz",
            "share_of_gap_power": 0.923,
            "p_value": 2.5e-7,
            "sentence": "Most of the gap lies between 60 and 82 Hz.",
        },
        {
            "view": "record",
            "axis": "record",
            "from": "sine-060hz",
            "to": "sine-080hz",
            "unit": "",
            "share_of_gap_power": 0.81,
            "p_value": 0.012,
            "sentence": "Two records hold it.",
        },
    ],
    "gap": {
        "before": 0.5123,
        "after": 0.1034,
        "noise_floor": 0.0911,
        "floor_method": "repeats",
        "explained": 0.9871,
        "interval": [0.9765, 0.9912],
        "before_interval": [0.4417, 0.5821],
        "after_interval": [0.0967, 0.1108],
    },
    "fit": {
        "before": 0.6123,
        "after": 0.0973,
        "explained": 0.9761,
        "new_in_every_record": 0.0312,
        "noise": 0.0911,
        "step_error": 0.0173,
        "floor": 0.0927,
        "left": 0.0239,
        "lone_share": 0.0,
        "unrepeated": 0.0213,
    },
    "ranking": [
        ranked(
            1, "resonance", held_back=288.25, form="one mode", score=-812.5, gain=301.5
        ),
        ranked(1, "creep", score=-620.1, gain=109.2),
        ranked(1, "drive-lag", place="drive", score=-500.3, gain=-10.4),
        ranked(1, "friction", declined="u does not reverse"),
        ranked(2, "creep", held_back=93.75, score=-915.5, gain=103.25),
        ranked(2, "drive-lag", place="drive", score=-810.1, gain=-2.4),
        ranked(2, "friction", declined="u does not reverse"),
        looked(1, "resonance", score=-915.25, gain=305.75, taken=True),
        looked(1, "stiffness-hardening", score=-702.5, gain=93.125),
        looked(2, "creep", declined="fits best at the end of its range"),
        looked(2, "thermal-drift", place="sensor", score=-913.5, gain=101.25),
    ],
    "taken_out": [
        {"name": "backlash", "reason": "the standard error of its size is 71% of it"}
    ],
    "next_experiment": {
        "excitation": "steps-with-holds",
        "parameters": {
            "levels": {"value": [0.0, 1.5, -1.5], "unit": "A"},
            "hold_s": {"value": 12.5, "unit": "s"},
        },
        "sampling_interval_s": 0.0005,
        "separation": 6.21,
        "existing_separation": 0.42,
        "pairs": [
            {
                "of": "creep",
                "names": ["creep", "thermal-drift"],
                "separation": 6.21,
                "existing_separation": 0.42,
                "largest_separation": 7.53,
            }
        ],
        "left_out": [{"of": "creep", "name": "drift"}],
        "sentence": "Try steps with holds: it separates creep from thermal-drift.",
    },
    "records": [
        {"name": "held-1", "before": 0.45, "after": 0.0987, "explained": 0.9931},
        {"name": "held-2", "before": 0.56, "after": 0.1078, "explained": 0.9812},
    ],
    "ladder": [
        {"name": "base", "rms": 0.5123},
        {"name": "resonance", "rms": 0.2011},
        {"name": "creep", "rms": 0.1034},
    ],
    "black_box": {
        "explained_on_folds": 0.87,
        "after": 0.213,
        "explained": 0.853,
        "after_interval": [0.1812, 0.2443],
        "interval": [0.8013, 0.8931],
        "records": [
            {
                "name": "held-1",
                "before": 0.45,
                "after": 0.123,
                "explained": 0.96,
                "named": 0.0987,
                "outside": [],
            },
            {
                "name": "held-2",
                "before": 0.56,
                "after": 0.477,
                "explained": 0.28,
                "named": 0.1078,
                "outside": ["amplitude", "rate"],
            },
        ],
        "outside": {"before": 0.5613, "after": 0.4781, "named": 0.1079},
    },
    "simulator": SIMULATOR,
}
#: What the page says in pictures and words only.
NOT_SAID = {0.96, 0.28}  # the black box's shares record by record


LINE = Axis("frequency", "Hz", logarithmic=True), Axis("residual", "um")
NAMES = ("sine-010hz", "sine-070hz")
PICTURES = (
    ViewPicture(
        "spectrum",
        "Spectrum of the residual",
        (
            Panel(
                *LINE,
                (
                    series("residual", [1.0, 70.0, 500.0], [0.1, 0.3, 0.1], "residual"),
                    series("noise", [1.0, 500.0], [0.1, 0.1], "floor", [0.01, 0.01]),
                ),
            ),
            Panel(*LINE, (series("rising", [1.0, 2.0], [np.nan, 1.0]),)),
        ),
    ),
    ViewPicture(
        "over-plane",
        "How to read it: red is above",
        (
            Panel(
                Axis("input", "A"),
                Axis("rate", "A/s"),
                cells=Cells(
                    [-1.0, 0.0, 1.0],
                    [-100.0, 0.0, 100.0],
                    [[0.1, -0.1], [None, 0.05]],
                    Axis("measured", "um"),
                ),
            ),
        ),
    ),
    ViewPicture(
        "slow",
        "Record behind record",
        (
            Panel(
                Axis("time", "s"),
                Axis("mean residual", "um"),
                tuple(
                    series("first", [k + 0.5, k + 0.9], [0.1, 0.2], name)
                    for k, name in enumerate(NAMES)
                ),
                labelled_above=True,
            ),
        ),
    ),
    ViewPicture(
        "records",
        "Share in each record",
        (Panel(LINE[0], LINE[1], bars=Bars(list(NAMES), [20.0, 80.0])),),
    ),
)


def curves(*names):
    drawn = [asdict(one) for one in PICTURES if not names or one.name in names]
    return {"pictures": drawn, "not_drawn": []}


#: What the search of the example came out with.
MODEL = """
name: rig-augmented
input: {name: current, unit: A}
output: {name: displacement, unit: um}
chain:
- gain: {value: 5.0}
- resonance: {frequency_hz: 69.7123, damping_ratio: 0.0412, participation: 0.1}
- creep: {magnitudes: [0.0213, 0.0117], time_constants_s: [0.5, 5.0]}
"""


def write_folder(folder, gap=GAP, with_curves=True, with_tables=True):
    (folder / "gap.json").write_text(json.dumps(gap))
    (folder / "model.yaml").write_text(MODEL)
    drawn = curves() if with_curves else {"pictures": [], "not_drawn": []}
    (folder / "curves.json").write_text(json.dumps(drawn))
    if with_tables:
        (folder / "holdout").mkdir()
        random = np.random.default_rng(0)
        time = np.arange(4000) * 0.0005
        for name, frequency in (("held-1", 5), ("held-2", 70)):
            clean = 5 * np.sin(2 * np.pi * frequency * time)
            ring = 0.6 * np.sin(2 * np.pi * 70 * time)
            measured = clean + ring + 0.09 * random.standard_normal(4000)
            table = np.column_stack([time, measured, clean, clean + 0.95 * ring])
            np.savetxt(
                folder / "holdout" / f"{name}.csv",
                table,
                delimiter=",",
                header="time_s,measured,before,after",
                comments="",
            )
    return folder


class Reader(HTMLParser):
    """Collect what a page says and what it asks for."""

    def __init__(self):
        super().__init__()
        self.numbers, self.sources, self.tags, self.text = [], [], [], []
        self.headlines, self.last = 0, None

    def handle_starttag(self, tag, attrs):
        about = dict(attrs)
        self.tags.append(tag)
        if tag == "data":
            self.numbers.append(float(about["value"]))
        asked = [about[key] for key in ("src", "href") if key in about]
        self.sources += [each for each in asked if not each.startswith("#")]
        if tag == "h1":
            self.headlines += 1
        if tag == "table":
            assert self.last == ("div", "scroll")
        self.last = (tag, about.get("class"))
        if tag == "img":
            assert about["alt"]

    def handle_data(self, data):
        self.text.append(data)


def read(path):
    reader = Reader()
    text = path.read_text(encoding="utf-8")
    reader.feed(text)
    reader.source = text
    reader.said = re.sub(r"\s+", " ", " ".join(reader.text))
    return reader


def numbers_in(content):
    if isinstance(content, dict):
        return {x for each in content.values() for x in numbers_in(each)}
    if isinstance(content, list):
        return {x for each in content for x in numbers_in(each)}
    return {float(content)} if isinstance(content, int | float) else set()


def words_in(content):
    if isinstance(content, dict):
        return {x for each in content.values() for x in words_in(each)}
    if isinstance(content, list):
        return {x for each in content for x in words_in(each)}
    return {content} if isinstance(content, str) else set()


def test_the_example_is_what_the_contract_says():
    check_against_schema(GAP, SCHEMA, "example")


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    return read(write_report(write_folder(tmp_path_factory.mktemp("whole"))))


def test_page_says_every_number_and_word_of_gap_json(page):
    assert numbers_in(GAP) - NOT_SAID == set(page.numbers)
    for word in words_in(GAP):
        plain = {"um": "µm", "-": "", "repeats": "repeated", "named": "lacks"}
        told = plain.get(word, word)
        assert told in page.said or told.replace("-", " ") in page.said


def test_a_reason_to_decline_is_said_once_and_what_ranks_is_said(page):
    assert page.said.count("u does not reverse") == 1
    assert page.said.count("drive-lag") == 2  # a row of each round
    assert "ranked by the score on all fit records" in page.said
    assert "judged anew on folds, parts of the fit records" in page.said


def test_pictures_of_where_the_gap_is_have_their_words(page):
    for one in PICTURES:
        assert f"{one.words}." in page.said


def test_the_model_is_drawn_as_blocks_where_its_effects_are_told(page):
    text = page.source
    (told,) = re.findall(
        r'alt="Block diagram: (.*?)"', text[text.index("<h2>Effects") :]
    )
    assert told == "current, then gain, then resonance, then creep, then displacement"


def image(text):
    """Give the text of a picture that stands inside the page."""
    return base64.b64decode(text.partition("base64,")[2]).decode()


def test_the_headline_has_before_and_after_as_a_picture(page):
    """Of the hold-out record that the simulator misses most, and of all together."""
    text = page.source
    head = text[text.index("<h1>") : text.index("<h2>")]
    glimpse, sizes = re.findall(r'<img src="(.*?)" alt="(.*?)">', head)
    # Both records ring alike: the one whose share of it is plain comes first.
    assert "measured, the simulator, and with effects" in glimpse[1]
    assert "simulator 0.512; with effects 0.103; noise floor 0.0911" in sizes[1]
    assert all(image(source).startswith("<?xml") for source, _ in (glimpse, sizes))


@pytest.mark.parametrize(
    ("gap", "expected"),
    [
        ({"verdict": "no-gap"}, "simulator 0.5; noise floor 0.0911"),
        (
            {
                "verdict": "unnamed",
                "withdrawn": {
                    "names": ["creep"],
                    "verdict": "named",
                    "before": 0.5,
                    "after": 0.9,
                },
            },
            "simulator 0.5; withdrawn 0.9; noise floor 0.0911",
        ),
    ],
)
def test_what_is_not_changed_is_drawn_once(gap, expected):
    same = {**GAP["gap"], "before": 0.5, "after": 0.5}
    told = {**LEFT_OUT, **GAP, "effects": [], **gap, "gap": same}
    (sizes,) = headline(told, ())
    assert sizes.words.endswith(expected)


@pytest.mark.usefixtures("unrendered")
def test_what_to_do_next_closes_the_page(tmp_path):
    said = read(write_report(write_folder(tmp_path, GAP, False, False))).said
    closing = said[said.index("What to do next", said.index("A black box")) :]
    assert "Try steps with holds: it separates creep" in closing
    assert 'y = load_model("model.yaml").simulate(u, dt)' in closing
    assert "hystbench simulate model.yaml input.csv --out output.csv" in closing
    assert "time_s and coil_current_A" in closing
    assert "takes coil current in A and gives displacement in µm" in closing


@pytest.mark.usefixtures("unrendered")
def test_a_stored_column_is_not_said_to_run_on_other_inputs(tmp_path):
    gap = {**GAP, "simulator": {**SIMULATOR, "runs_again": False}}
    said = read(write_report(write_folder(tmp_path, gap, False, False))).said
    assert "answers to the inputs of this dataset alone" in said
    assert "load_model" not in said


@pytest.mark.usefixtures("unrendered")
def test_a_function_must_be_importable_where_the_model_runs(tmp_path):
    gap = {**GAP, "simulator": {**SIMULATOR, "functions": ["rig.sim:move"]}}
    said = read(write_report(write_folder(tmp_path, gap, False, False))).said
    assert "where Python can import rig.sim:move" in said


@pytest.mark.usefixtures("unrendered")
def test_a_search_that_calls_ended_is_said_to_be_none_to_the_end(tmp_path):
    gap = {**GAP, "calls_used_up": {"bound": 50, "sentence": "it ended at 50 calls"}}
    check_against_schema(gap, SCHEMA, "example")
    said = read(write_report(write_folder(tmp_path, gap, False, False))).said
    assert "Not searched to the end: it ended at 50 calls." in said


def test_no_legend_lies_over_curves():
    """Its box and the axes have no area in common."""
    with in_style():
        figure = Figure(figsize=(PAGE, 2.4))
        panel = figure.subplots()
        pictures.sizes([panel], [("base", 0.5), ("resonance", 0.2)], 0.1, "um")
        figure.canvas.draw()
        (legend,) = figure.legends
        box = legend.get_window_extent()
        assert box.x0 >= 0
        assert box.x1 <= figure.bbox.x1
        shared = Bbox.intersection(box.shrunk(0.99, 0.99), panel.bbox)
        assert shared is None or shared.height < 1


def test_second_looks_are_told_in_words(page):
    assert (
        "After round 2 : resonance was tried again beside creep, with one rival in its "
        "place: it stays."
    ) in page.said
    assert (
        "creep was tried again beside resonance, with one rival in its place: it could "
        "not be judged again (fits best at the end of its range) and stays."
    ) in page.said
    assert "The picture shows the first round alone" in page.said


@pytest.mark.usefixtures("unrendered")
def test_an_effect_that_gave_way_is_told_with_what_took_its_place(tmp_path):
    rows = [
        looked(1, "stiffness-hardening", score=-917.5, gain=308.0, taken=True),
        looked(1, "resonance", score=-915.25, gain=305.75),
    ]
    rounds = [item for item in GAP["ranking"] if not item["look"]]
    gap = {**GAP, "ranking": rounds + rows}
    said = read(write_report(write_folder(tmp_path, gap, False, False))).said
    assert "in its place: it gives way to stiffness-hardening." in said
    assert said.index("308") < said.index("306")  # best first


def test_page_stands_alone(page):
    assert len(page.sources) >= 8
    assert all(source.startswith("data:image/") for source in page.sources)
    assert not {"script", "link", "iframe"} & set(page.tags)
    assert "Not drawn" not in page.said


def test_verdict_comes_first(page):
    verdict = page.said.index("The simulator lacks resonance and creep.")
    assert page.headlines == 1
    assert verdict < page.said.index("Effects")
    # The user's own name of the simulator stands above it.
    assert page.said.index("bench against the simulator rig.yaml") < verdict
    assert page.said.index(GAP["reason"]) < page.said.index("Where the gap is")


def test_same_input_same_page(tmp_path):
    folder = write_folder(tmp_path, small(), with_curves=False)
    path = write_report(folder)
    assert path == tmp_path / "report.html"
    first = path.read_bytes()
    assert write_report(folder).read_bytes() == first


def small(**change):
    """What every gap.json of ours has, and no more."""
    always = (*SCHEMA["required"], "records", "ladder", "fit", "black_box", "simulator")
    content = {key: GAP[key] for key in always}
    content |= {"effects": [], "where": [], "ranking": [], "next_experiment": None}
    return content | {"verdict": "no-gap"} | change


@pytest.mark.usefixtures("unrendered")
def test_what_is_not_there_is_said(tmp_path):
    power = GAP["gap"] | {"explained": None, "floor_method": "upper-bound"}
    folder = write_folder(
        tmp_path, small(gap=power), with_curves=False, with_tables=False
    )
    said = read(write_report(folder)).said
    assert f"There is no gap: {GAP['reason']}" in said
    assert "None is needed to tell likely effects apart" in said
    assert "the folder holds no hold-out tables" in said


@pytest.mark.usefixtures("unrendered")
@pytest.mark.parametrize("name", [one.name for one in PICTURES])
def test_each_kind_of_picture_is_drawn(tmp_path, name):
    folder = write_folder(tmp_path, small(), with_tables=False)
    (folder / "curves.json").write_text(json.dumps(curves(name)))
    page = read(write_report(folder))
    assert len(page.sources) == 4  # with the block diagram and two bars of sizes


@pytest.mark.usefixtures("unrendered")
def test_what_the_records_cannot_show_is_said_with_its_reason(tmp_path):
    folder = write_folder(tmp_path, small(), with_tables=False)
    told = curves() | {"not_drawn": ["distortion, as no record repeats"]}
    (folder / "curves.json").write_text(json.dumps(told))
    said = read(write_report(folder)).said
    assert "Not drawn: distortion, as no record repeats." in said


@pytest.mark.parametrize("broken", [{"spectrum": {}}, {"pictures": [{"words": ""}]}])
def test_curves_of_another_kind_are_one_line(tmp_path, broken):
    folder = write_folder(tmp_path, small(), with_tables=False)
    (folder / "curves.json").write_text(json.dumps({"not_drawn": []} | broken))
    with pytest.raises(InputError, match=r"curves\.json: .* expected what hystbench"):
        write_report(folder)


@pytest.mark.usefixtures("unrendered")
def test_a_reader_is_told_of_a_promise_that_was_not_kept(tmp_path):
    told = "On the fit records 90 % of the gap's power is gone, here 50 %."
    short = {"fit": 0.9, "hold_out": 0.5, "sentence": told}
    write_report(write_folder(tmp_path, {**GAP, "shortfall": short}, False, False))
    said = read(tmp_path / "report.html").said
    assert told in said
    # Above all evidence, with the verdict.
    assert said.index(told) < said.index("Effects")
    (tmp_path / "gap.json").write_text(json.dumps({**GAP, "shortfall": None}))
    write_report(tmp_path)
    assert "Less than promised" not in read(tmp_path / "report.html").said


@pytest.mark.usefixtures("unrendered")
@pytest.mark.parametrize("why", ["", "no input brings it out"])
def test_an_experiment_that_was_not_computed_is_not_called_needless(tmp_path, why):
    """The example's creep cannot be told from two others."""
    told = {"no_experiment": why} if why else {}
    gap = {**GAP, **told, "next_experiment": None}
    said = read(write_report(write_folder(tmp_path, gap, False, False))).said
    assert "None is needed" not in said
    assert (f"None was computed: {why}." if why else "None was computed.") in said


@pytest.mark.usefixtures("unrendered")
def test_a_model_that_runs_away_is_said_to_and_drawn_without_it(tmp_path):
    """Its record has no rms after and no curve; the others keep theirs."""
    told = "rig with creep diverges on held-2 from 0.3 s on."
    gap = json.loads(json.dumps(GAP))
    gap["gap"] |= {"after": None, "explained": 0.0}
    del gap["gap"]["after_interval"], gap["gap"]["interval"]
    gap["records"][1] |= {"after": None, "explained": 0.0}
    gap["black_box"]["records"][1]["named"] = None
    gap["black_box"]["outside"]["named"] = None
    gap["ladder"][2]["rms"] = None
    gap["runs_away"] = [
        {"record": "held-2", "from_s": 0.3, "refused": None, "sentence": told}
    ]
    write_folder(tmp_path, gap, with_curves=False)
    table = tmp_path / "holdout" / "held-2.csv"
    rows = [line.split(",") for line in table.read_text().splitlines()]
    kept = [row if row[0] == "time_s" else [*row[:3], "nan"] for row in rows]
    table.write_text("\n".join(map(",".join, kept)) + "\n")
    said = read(write_report(tmp_path)).said
    assert said.index(told) < said.index("Effects")
    assert "None of it counts as gone." in said
    assert said.count("unbounded") == 7  # verdict, record, all, ladder, box three times
    assert "0.0987" in said
    # A few values that are no number are a broken table still.
    kept[5][3] = "1.5"
    table.write_text("\n".join(map(",".join, kept)) + "\n")
    with pytest.raises(InputError, match=r"held-2\.csv: expected at least 2 rows"):
        write_report(tmp_path)


@pytest.mark.usefixtures("unrendered")
def test_a_range_is_printed_as_one(tmp_path):
    gap = small(gap=GAP["gap"] | {"explained": [0.61, 0.97]})
    page = read(write_report(write_folder(tmp_path, gap, False, False)))
    assert {0.61, 0.97} <= set(page.numbers)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"verdict": "nmaed"}, r"gap\.json: verdict: 'nmaed' is unknown; "),
        ({"gap": {}}, r"gap\.json: gap: expected the key 'before'"),
        (
            {"records": ["held-1"]},
            r"gap\.json: records: 0: 'held-1'; expected a mapping",
        ),
        (
            {"ladder": [{"name": "base"}]},
            r"gap\.json: ladder: 0: expected the key 'rms'",
        ),
        ({"efects": []}, r"gap\.json: unknown key 'efects'; did you mean 'effects'"),
    ],
)
def test_a_wrong_gap_json_is_one_line_and_no_page(tmp_path, change, message):
    write_folder(tmp_path, GAP | change)
    with pytest.raises(InputError, match=message) as caught:
        write_report(tmp_path)
    assert "\n" not in str(caught.value)
    assert not (tmp_path / "report.html").exists()


@pytest.mark.usefixtures("unrendered")
def test_missing_or_broken_files_are_one_line(tmp_path):
    with pytest.raises(InputError, match=r"^[^(]*gap\.json: no such file"):
        write_report(tmp_path)
    write_folder(tmp_path)
    for name in ("model.yaml", "curves.json"):
        there = (tmp_path / name).read_text()
        (tmp_path / name).unlink()
        with pytest.raises(InputError, match=rf"{name}: no such file"):
            write_report(tmp_path)
        (tmp_path / name).write_text(there)
    (tmp_path / "holdout" / "held-1.csv").write_text("time_s,measured\n0,1\n")
    with pytest.raises(InputError, match=r"held-1\.csv: no column 'before'"):
        write_report(tmp_path)
    (tmp_path / "gap.json").write_text("{")
    with pytest.raises(InputError, match=r"gap\.json: not JSON"):
        write_report(tmp_path)


@pytest.mark.usefixtures("unrendered")
def test_text_from_outside_is_text(tmp_path):
    gap = small(reason="<script>alert(1)</script>")
    page = read(write_report(write_folder(tmp_path, gap, False, False)))
    assert "script" not in page.tags


@pytest.mark.parametrize(
    ("value", "error", "shown"),
    [
        (69.7123, 0.0456, "69.712 ± 0.046"),
        (0.0412, 0.0013, "0.0412 ± 0.0013"),
        (-3.0, None, "\u22123"),
        ("slab", None, "slab"),
        ([1.0, 2.0], [0.1, 2.0], "1 ± 0.1, 2 ± 2"),
        (0.0018, 0.016, "0.0018 ± 0.016 (may be zero)"),
    ],
)
def test_values_are_rounded_to_their_errors(value, error, shown):
    assert re.sub(r"<[^>]*>", "", str(with_error(value, error))) == shown


def test_a_number_keeps_its_digits_in_the_source():
    assert 'value="0.123456789"' in number(0.123456789)
    assert "10<sup>\u22127</sup>" in number(2.5e-7)


def test_micro_is_written_one_way_in_sentences():
    """Whatever the sentence says; names of columns and files keep their letters."""
    page = "from 2 um to 0.3 um rms (um), a 4 us step of displacement_um at b.um"
    wanted = "from 2 µm to 0.3 µm rms (µm), a 4 µs step of displacement_um at b.um"
    assert one_micro(page) == wanted


def test_a_range_of_one_value_is_printed_as_that_value():
    assert explained([0.3591, 0.3592]).striptags() == "35.9 %"
    assert explained([0.3, 0.4]).striptags() == "30.0 % to 40.0 %"
    assert explained([0.0, -0.0001]).striptags() == "0.0 %"


@pytest.mark.parametrize(
    ("value", "shown"),
    [(12_130.0, "12100"), (999.6, "1000"), (2.5e6, "2.5e+06"), (1.7e-8, "1.7e-08")],
)
def test_a_number_in_a_sentence_has_no_exponent_up_to_a_million(value, shown):
    assert shortly(value) == shown


def test_a_reason_is_a_sentence():
    assert sentence("on the records all is gone") == "On the records all is gone."
    assert sentence("It is.") == "It is."

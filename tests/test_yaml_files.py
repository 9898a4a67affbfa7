"""YAML as it is read: plain data, each key once, bounded."""

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from hystbench.errors import InputError
from hystbench.yaml_files import DEEPEST, load_yaml, parse_yaml, yaml_text
from tests.messages import message

PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text() | st.floats(allow_nan=False),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner),
    max_leaves=8,
)


@settings(max_examples=25)
@given(content=PLAIN)
def test_what_is_written_comes_back(content):
    assert parse_yaml(yaml_text(content), "x.yaml") == content


@pytest.mark.parametrize("end", ["\x85", "\u2028", "\u2029"])
def test_an_unusual_end_of_a_line_comes_back(end):
    for content in ({end: 1}, {"a": f"b{end}c"}, [end]):
        assert parse_yaml(yaml_text(content), "x.yaml") == content


@pytest.mark.parametrize(
    "text", ["1e-5", "2.6e4", "+1.5E3", ".5", "-.5", "-1.e+2", "3.", "0.0", "1.0e-05"]
)
def test_floats_are_those_of_yaml_1_2(text):
    found = parse_yaml(f"[{text}]", "x.yaml")
    assert found == [float(text)]
    assert type(found[0]) is float


@pytest.mark.parametrize("text", ["e5", "1e", "1e5.0", "0x1e5", "1.2.3", ".", "-e3"])
def test_what_is_no_float_stays_what_it_was(text):
    assert parse_yaml(f"[{text}]", "x.yaml") == yaml.safe_load(f"[{text}]")


@pytest.mark.parametrize("text", ["1e-5", "2.6e4", "-.5", "1.0e+2", "1e5_"])
def test_a_text_that_looks_like_a_float_is_written_in_quotes(text):
    assert parse_yaml(yaml_text({"name": text}), "x.yaml") == {"name": text}
    assert parse_yaml(f"name: '{text}'", "x.yaml") == {"name": text}


def test_aliases_and_merged_keys_are_plain_yaml():
    text = "base: &b {unit: A, name: i}\ninput: {<<: *b, name: u}\nother: [*b, *b]\n"
    base = {"unit": "A", "name": "i"}
    wanted = {"base": base, "input": {"unit": "A", "name": "u"}, "other": [base, base]}
    assert parse_yaml(text, "x.yaml") == wanted


def test_depth_is_bounded_where_it_is_said():
    assert parse_yaml("[" * DEEPEST + "]" * DEEPEST, "x.yaml")
    deeper = "[" * (DEEPEST + 1) + "]" * (DEEPEST + 1)
    assert f"{DEEPEST} levels" in message(lambda: parse_yaml(deeper, "x.yaml"))


@pytest.mark.parametrize(
    ("text", "line", "key"),
    [
        ("a: 1\nb: 2\na: 3\n", 3, "'a'"),
        ("top:\n  inner: {x: 1, y: 2, x: 3}\n", 2, "'x'"),
        ("- {a: 1}\n- {a: 1, a: 1}\n", 2, "'a'"),
        ("a: 1\n'a': 2\n", 2, "'a'"),
        ("1: a\n0x1: b\n", 2, "1"),
    ],
)
def test_a_key_that_stands_twice(text, line, key):
    said = message(lambda: parse_yaml(text, "x.yaml"))
    assert said.startswith(f"x.yaml: line {line}: the key {key} stands in line")


def test_a_file_of_data_is_not_read_to_its_end(tmp_path):
    file = tmp_path / "data.yaml"
    with file.open("wb") as stream:
        stream.truncate(20_000_000)
    assert "20 MB; expected a YAML file of at most 10 MB" in message(
        lambda: load_yaml(file)
    )


def test_a_tag_is_not_followed(tmp_path):
    mark = tmp_path / "mark"
    text = f"!!python/object/apply:pathlib.Path.touch [!!python/name:x {mark}]"
    message(lambda: parse_yaml(text, "x.yaml"))
    assert not mark.exists()


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("unit: %", "line 1: '%' begins no text; expected text in quotes: '%'"),
        ("a: 1\n{unit: @rms, b: 2}", "line 2: '@' begins no text"),
        ("a:\n\tb: 1", "line 2: a tab begins no text; expected spaces"),
    ],
)
def test_a_sign_that_begins_no_text_is_shown(text, told):
    with pytest.raises(InputError) as error:
        parse_yaml(text, "x.yaml")
    assert told in str(error.value)


def test_a_name_that_needs_quotes_is_told_to():
    text = "a: 1\ntime: {column: time [s], unit: s}\n"
    with pytest.raises(InputError, match=r"x\.yaml: line 2: .*'time \[s\]'"):
        parse_yaml(text, "x.yaml")

"""Commands, options and targets that the pages name exist."""

from __future__ import annotations

import re
import shlex

import click
import pytest

from hystbench.cli import COMMANDS
from hystbench.errors import InputError
from hystbench.group import group
from tests.conftest import ROOT

from .pages import NAMES, PAGES, code_of

#: What a command or a target is called; files and the reader's own words are not.
NAME = re.compile(r"[a-z][a-z_-]*")
RULE = re.compile(r"^\s*rule (\w+):", re.MULTILINE)
#: These pages tell of commands that are gone.
HISTORY = ("CHANGELOG.md", "archive")


def calls(page, program):
    """Give the words behind each call of a program in the code of a page."""
    found = []
    for line in code_of(page):
        for call in re.split(r"&&|\||;|\s#\s", line):
            try:
                words = shlex.split(call)
            except ValueError:  # a part of a line
                continue
            if words and words[0].rpartition("/")[2] == program:
                found.append(words[1:])
    return found


def is_history(page):
    return page.name in HISTORY or page.parent.name in HISTORY


def command_of(words):
    """Find the command that words call; its name may be followed by a job's."""
    command, own = group(COMMANDS), words
    while isinstance(command, click.Group) and own and NAME.fullmatch(own[0]):
        command, own = command.get_command(click.Context(command), own[0]), own[1:]
    return command


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_hystbench_has_the_commands_and_their_options(page):
    if is_history(page):
        return
    unknown = []
    for words in calls(page, "hystbench"):
        asked = {word.partition("=")[0] for word in words if word.startswith("--")}
        try:
            command = command_of(words)
        except InputError as error:
            unknown.append(str(error))
            continue
        known = {"--help"}
        for option in command.params:
            known |= {*option.opts, *option.secondary_opts}
        unknown += [f"{' '.join(words)}: {name}" for name in asked - known]
    assert unknown == []


def test_a_command_and_an_option_that_are_not_there_are_found(tmp_path):
    page = tmp_path / "page.md"
    page.write_text("`hystbench show` and `hystbench gap a --models b`\n")
    with pytest.raises(AssertionError, match=r"no command 'show'"):
        test_hystbench_has_the_commands_and_their_options(page)
    with pytest.raises(AssertionError, match=r"--models"):
        test_hystbench_has_the_commands_and_their_options(page)


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_make_has_the_targets(page):
    if is_history(page):
        return
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    known = {*re.search(r"^\.PHONY: (.+)$", text, re.MULTILINE)[1].split()}
    named = {word for words in calls(page, "make") for word in words[:1]}
    assert {word for word in named if NAME.fullmatch(word)} <= known


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_snakemake_has_the_targets(page):
    if is_history(page):
        return
    files = (ROOT / "workflow").rglob("*.smk")
    known = {name for file in files for name in RULE.findall(file.read_text("utf-8"))}
    named = set()
    for words in calls(page, "snakemake"):
        # A word behind an option is its value, but behind -n, which takes none.
        before = ["", *words]
        pairs = zip(before, words, strict=False)
        named |= {word for last, word in pairs if last[:1] != "-" or last == "-n"}
    assert {word for word in named if NAME.fullmatch(word)} <= known | {"all"}

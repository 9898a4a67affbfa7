"""Where the boxes and lines of a block diagram are: told without drawing one."""

from itertools import combinations, pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hystbench.gap.report.diagram_layout import (
    RADIUS,
    Box,
    Line,
    Summation,
    layout,
    text_width,
)
from hystbench.gap.report.parts import Part, Stage

PAGE = 7.2
NEAR = pytest.approx


def drawn(*stages, page=PAGE):
    return layout(stages, "force (N)", "position (mm)", page)


def of(diagram, kind):
    return [one for one in diagram.shapes if isinstance(one, kind)]


def boxes_of(diagram):
    return [box for box in of(diagram, Box) if box.whose is not None]


def labels_of(diagram):
    return [box for box in of(diagram, Box) if box.whose is None]


def named(diagram, words):
    (box,) = [box for box in boxes_of(diagram) if " ".join(box.words) == words]
    return box


def edges(box):
    return box.x, box.y, box.x + box.width, box.y + box.height


def within(one, other):
    a, b = edges(one), edges(other)
    return b[0] <= a[0] and b[1] <= a[1] and a[2] <= b[2] and a[3] <= b[3]


def apart(one, other):
    a, b = edges(one), edges(other)
    return a[2] <= b[0] or b[2] <= a[0] or a[3] <= b[1] or b[3] <= a[1]


def crosses(line, box):
    """Tell whether a line of upright and level pieces runs through a box."""
    left, low, right, high = edges(box)
    thin = 1e-6
    for (a, b), (c, d) in pairwise(line.points):
        if (
            max(min(a, c), left + thin) < min(max(a, c), right - thin)
            and low + thin < b < high - thin
        ) or (
            max(min(b, d), low + thin) < min(max(b, d), high - thin)
            and left + thin < a < right - thin
        ):
            return True
    return False


def ends(diagram):
    return {
        (round(x, 6), round(y, 6))
        for line in of(diagram, Line)
        for x, y in (line.points[0], line.points[-1])
    }


def at(x, y):
    return round(x, 6), round(y, 6)


def test_a_chain_stands_from_left_to_right_with_an_arrow_into_each_box():
    diagram = drawn(Stage(Part("gpi")), Stage(Part("sensor lag")))
    first, second = (named(diagram, name) for name in ("gpi", "sensor lag"))
    assert first.x + first.width < second.x
    assert first.y + first.height / 2 == NEAR(second.y + second.height / 2)
    into = {line.points[-1][0] for line in of(diagram, Line) if line.arrow}
    assert {first.x, second.x} <= into
    assert [label.words for label in labels_of(diagram)] == [
        ("force (N)",),
        ("position (mm)",),
    ]


def test_a_force_is_fed_back_below_its_mechanism_and_subtracted():
    diagram = drawn(Stage(Part("mechanism"), fed_back=(Part("friction"),)))
    core, force = (named(diagram, name) for name in ("mechanism", "friction"))
    (total,) = of(diagram, Summation)
    assert force.y + force.height < core.y
    assert total.minus
    assert total.x < core.x
    # From the box's left edge round to the sum from below.
    assert any(
        at(*line.points[-1]) == at(total.x, total.y - RADIUS)
        and line.points[0][0] == NEAR(force.x)
        for line in of(diagram, Line)
    )
    # What it depends on is taken behind the mechanism.
    (back,) = [
        line
        for line in of(diagram, Line)
        if at(*line.points[-1]) == at(force.x + force.width, force.y + force.height / 2)
    ]
    assert back.points[0][0] > core.x + core.width
    assert back.points[0][1] == NEAR(total.y)


def test_a_branch_beside_stands_above_and_is_added_behind():
    diagram = drawn(Stage(Part("impedance"), beside=(Stage(Part("friction")),)))
    core, force = (named(diagram, name) for name in ("impedance", "friction"))
    (total,) = of(diagram, Summation)
    assert not total.minus
    assert total.x > core.x + core.width
    assert force.y > core.y + core.height
    assert at(total.x, total.y + RADIUS) in ends(diagram)


def test_two_forces_are_summed_on_their_way_back():
    forces = (Part("friction"), Part("stop"))
    diagram = drawn(Stage(Part("mechanism"), fed_back=forces))
    assert sorted(item.minus for item in of(diagram, Summation)) == [False, True]
    assert apart(*(named(diagram, part.words) for part in forces))


def test_other_modes_are_beside_the_loop_of_a_force():
    """Friction sees the motion of its own mode, not the sum of all."""
    diagram = drawn(
        Stage(
            Part("mechanism"),
            fed_back=(Part("friction"),),
            beside=(Stage(Part("other modes")),),
        )
    )
    loop, total = sorted(of(diagram, Summation), key=lambda item: item.x)
    assert loop.minus
    assert not total.minus
    core = named(diagram, "mechanism")
    assert loop.x < core.x < core.x + core.width < total.x


def test_what_is_around_holds_the_block():
    diagram = drawn(Stage(Part("gpi"), around=(Part("rate dependent hysteresis"),)))
    frame = next(box for box in boxes_of(diagram) if "dependent" in box.words[0])
    assert within(named(diagram, "gpi"), frame)


def test_numbers_of_a_store_stand_in_it_and_what_is_spilt_joins_its_outflow():
    spilling = Stage(
        Part("store"),
        within=(Part("outflow", ("exponent 0.5",)),),
        spilt=Part("overflow"),
        caught=True,
    )
    diagram = drawn(spilling, Stage(Part("lower store")))
    store = named(diagram, "store")
    assert within(named(diagram, "outflow"), store)
    assert named(diagram, "overflow").y > store.y + store.height
    (total,) = of(diagram, Summation)
    assert total.x > store.x + store.width
    assert at(total.x, total.y + RADIUS) in ends(diagram)


def test_what_is_spilt_and_not_caught_goes_nowhere():
    diagram = drawn(Stage(Part("store"), spilt=Part("overflow")))
    assert of(diagram, Summation) == []


def test_many_blocks_stand_in_rows_that_a_line_joins():
    names = [f"block number {k}" for k in range(12)]
    diagram = drawn(*(Stage(Part(name)) for name in names))
    rows = {round(named(diagram, name).y, 6) for name in names}
    assert len(rows) > 1
    places = [
        (-named(diagram, name).y, named(diagram, name).x) for name in names
    ]  # down, then right
    assert places == sorted(places)
    turning = [line for line in of(diagram, Line) if len(line.points) == 6]
    assert len(turning) == len(rows) - 1


WORDS = st.text("abc imw", min_size=1, max_size=40).map(
    lambda text: text.strip() or "x"
)
PARTS = st.builds(Part, WORDS, st.lists(WORDS, max_size=2).map(tuple), st.just("added"))
SOME = st.lists(PARTS, max_size=2).map(tuple)
BESIDE = st.lists(st.builds(Stage, PARTS, fed_back=SOME), max_size=2).map(tuple)
STAGES = st.builds(
    Stage, PARTS, SOME, SOME, SOME, BESIDE, st.none() | PARTS, st.booleans()
)


@given(st.lists(STAGES, min_size=1, max_size=6))
def test_nothing_is_cut_off_overlaps_or_is_crossed(stages):
    diagram = drawn(*stages)
    boxes, lines, labels = boxes_of(diagram), of(diagram, Line), labels_of(diagram)
    for box in [*boxes, *labels]:
        left, low, right, high = edges(box)
        assert 0 <= left < right <= diagram.width == PAGE
        assert 0 <= low < high <= diagram.height
    for line in lines:
        for x, y in line.points:
            assert 0 <= x <= diagram.width
            assert 0 <= y <= diagram.height
    for one, other in combinations(boxes, 2):
        assert apart(one, other) or within(one, other) or within(other, one)
    for label in labels:
        assert all(apart(label, box) for box in boxes)
    holding = [
        box for box in boxes if any(within(x, box) for x in boxes if x is not box)
    ]
    for box in boxes:
        if box not in holding:
            assert not any(crosses(line, box) for line in lines)


def test_texts_fit_their_boxes():
    words = "rate dependent hysteresis of a machine"
    diagram = drawn(Stage(Part(words, ("contact stiffness 2.03·10⁶ N/m",), "added")))
    box = boxes_of(diagram)[0]
    assert " ".join(box.words) == words
    assert all(text_width(line, 8.0) < box.width for line in box.words)
    assert all(text_width(line, 7.0) < box.width for line in box.numbers)


def test_a_mechanism_beside_has_the_loop_of_its_own_force():
    other = Stage(Part("other mechanism"), fed_back=(Part("stop"),))
    diagram = drawn(
        Stage(Part("mechanism"), fed_back=(Part("friction"),), beside=(other,))
    )
    core, beside = (named(diagram, x) for x in ("mechanism", "other mechanism"))
    friction, stop = (named(diagram, x) for x in ("friction", "stop"))
    assert friction.y < core.y < stop.y < beside.y
    every = (core, beside, friction, stop)
    assert all(apart(*pair) for pair in combinations(every, 2))
    assert sorted(item.minus for item in of(diagram, Summation)) == [False, True, True]

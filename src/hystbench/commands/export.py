"""``hystbench export``: write a model as code that runs elsewhere."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Literal

import click

from hystbench import options
from hystbench.blocks.held import Hold
from hystbench.blocks.step import LARGEST_POINTS, Sampling
from hystbench.errors import InputError, placed
from hystbench.export import code
from hystbench.export.described import describe, exact_delay
from hystbench.export.inverse import describe_inverse
from hystbench.export.on_record import begun, begun_inverse, off
from hystbench.files import atomic_path, whole_folder, write_text
from hystbench.model import Model, load_model
from hystbench.options import In, InputHigh, InputLow, OutFolder, command
from hystbench.record import Channel, FloatArray, column_name
from hystbench.samples import read_input

EXACT = "exact"
Part = Literal["before", "behind"]
"""What stands before or behind a simulator of somebody's own, which runs beside it."""


@command
def export(
    model: In,
    *,
    to: Annotated[
        Literal["c", "python", "fmu"],
        "C99 source and header, the same with a Python module that compiles and calls "
        "it, or a source FMU.",
    ],
    fmi: Annotated[
        code.Version | None,
        "Version of FMI, with --to fmu: 3 unless you say 2, which more tools read.",
    ] = None,
    dt: Annotated[float, "Sampling interval in seconds."],
    points: Annotated[
        int,
        click.IntRange(2, LARGEST_POINTS),
        "Samples through which a curve goes where the model wants its input between "
        "samples or its rate; fewer for an input with noise.",
        {"show_default": True},
    ] = 6,
    delay: Annotated[
        str,
        "Samples by which the output may be late: values between samples, and rates, "
        "are then taken with samples on both sides. 'exact': as many as make the code "
        "the simulation of a whole record.",
    ] = "0",
    duration: Annotated[
        float | None, "Length in seconds of the record of a path of drift."
    ] = None,
    past: Annotated[
        Path | None,
        options.FILE,
        "CSV file with time_s and the input, such as current_A: the code starts as the "
        "simulation of this record, where MODEL says 'start: settled', 'moving' or "
        "'repeating'.",
    ] = None,
    compare: Annotated[
        Path | None,
        options.FILE,
        "CSV file with time_s and the input: say how far the code is from the "
        "simulation of this record.",
    ] = None,
    hold: Annotated[
        Hold | None, "How the input moves between samples where MODEL does not say."
    ] = None,
    part: Annotated[
        Part | None,
        "What stands before, or behind, a simulator of your own in MODEL: that runs "
        "between the two.",
    ] = None,
    inverse: Annotated[
        bool,
        "Write code that turns a wanted output into the input; give both limits.",
    ] = False,
    limit_low: InputLow | None = None,
    limit_high: InputHigh | None = None,
    out: OutFolder,
) -> None:
    """Write MODEL as code that is called once a sample and needs no hystbench.

    The files in OUT are named after the model. What its steps do otherwise than a
    simulation of a whole record is printed, and stands in the code.
    """
    if fmi is not None and to != "fmu":
        raise InputError("--fmi: expected it with --to fmu alone")
    system = load_model(model)
    if hold is not None:
        system = system.with_hold(hold)
    if part is not None:
        system = part_of(system, part)
    limits = (limit_low, limit_high)
    if not inverse and limits != (None, None):
        raise InputError("--limit-low and --limit-high: expected them with --inverse")
    if inverse and compare is not None:
        raise InputError(
            "--compare: expected none with --inverse; 'hystbench invert --sampled' "
            "says how far the output is from what is wanted"
        )
    if delay != EXACT and not delay.isdecimal():
        raise InputError(
            f"--delay: {delay!r}; expected a number of samples, or {EXACT!r}"
        )
    if inverse and delay == EXACT:
        raise InputError(
            f"--delay: {EXACT}; expected a number with --inverse, as 'hystbench "
            "invert' looks at the whole record"
        )
    late = 0 if delay == EXACT else int(delay)
    sampling = Sampling(dt, points, duration, late)
    with options.refused_of(model):
        if inverse:
            both = options.both_limits(*limits, "--inverse")
            described = describe_inverse(system, sampling, both)
        else:
            described = describe(system, sampling)
        if delay == EXACT and exact_delay(described):
            exact = replace(sampling, delay=exact_delay(described))
            described = describe(system, exact)
    for piece in described.watching if part == "behind" else ():
        raise InputError(
            f"--part behind: {piece.label}: looks at the model's input, which does not "
            "enter there; expected blocks that take the simulator's output alone"
        )
    if past is not None:
        start = begun_inverse if inverse else begun
        described = start(described, system, _record(system, past, dt))
    told = [described.memory, *described.differences]
    if compare is not None:
        u = _record(system, compare, dt)
        with placed(f"--compare: {compare}: "):
            told.append(f"{compare}: {off(described, system, u).words}.")
    unit = f"{described.name}.fmu"
    files = {"c": code.c_files, "python": code.python_files}.get(to)
    texts = files(described) if files else {}
    names = list(texts) or [unit]
    with whole_folder(out, names) as fresh:
        for name, text in texts.items():
            write_text(fresh / name, text)
        if to == "fmu":
            with atomic_path(fresh / unit) as archive:
                code.write_fmu(described, archive, fmi or "3")
    made = ", ".join(f"{out / file}" for file in names)
    click.echo(f"{made}: {described.about}")
    for line in told:
        click.echo(line)


def part_of(model: Model, part: Part) -> Model:
    """Give what stands before a model's simulator, or behind it, as a model.

    What is before it takes the model's input and gives the simulator's, in its unit;
    what is behind takes the simulator's output, in the unit of the model's.

    Raises
    ------
    InputError
        If the model has no simulator or several, or nothing stands there.
    """
    places = [place for place, block in enumerate(model.chain) if not block.seen]
    if len(places) != 1:
        raise InputError(
            f"--part: {len(places)} simulators of somebody's own in the chain; "
            "expected one, before or behind which the part stands"
        )
    (place,) = places
    own = model.chain[place].name
    before = part == "before"
    chain = model.chain[:place] if before else model.chain[place + 1 :]
    if not chain:
        other = f"--part {'behind' if before else 'before'}"
        expected = other if len(model.chain) > 1 else "another model: that is all of it"
        raise InputError(
            f"--part {part}: no block stands {part} {own}; expected {expected}"
        )
    if before:
        sides = model.input, Channel(f"input of {own}", model.input.unit)
    else:
        sides = (
            Channel(f"{model.output.name} of {own}", model.output.unit),
            model.output,
        )
    return Model(f"{model.name} {part} {own}", *sides, chain)


def _record(system: Model, file: Path, wanted: float) -> FloatArray:
    """Read the input of a record, which has to have the code's interval."""
    dt, u = read_input(file, column_name(system.input.name, system.input.unit))
    if abs(dt - wanted) > 1e-6 * wanted:
        raise InputError(f"{file}: sampled every {dt:g} s; expected --dt, {wanted:g} s")
    return u

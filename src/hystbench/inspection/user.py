"""Who wants a dataset.yaml: what flags say, what is asked, and what is noted."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

from hystbench.device_kinds import DEVICE_KINDS, DeviceKind
from hystbench.options import ChoiceOrNone
from hystbench.yaml_files import table_of

Ask = Callable[[str, Sequence[str], str, str | None], str]
"""Asks the user: takes a question, the choices that there are, if any, the flag that
answers it, and what is taken where nobody is there; if that is None it is refused."""


@dataclass(frozen=True)
class Flags:
    """What flags say already, each with its help."""

    input: Annotated[str | None, "Column of the input."] = None
    output: Annotated[str | None, "Column of the output."] = None
    time: Annotated[str | None, "Column of time."] = None
    input_unit: Annotated[str | None, "Its unit, such as A; '-' for none."] = None
    output_unit: Annotated[str | None, "Its unit, such as um; '-' for none."] = None
    time_unit: Annotated[str | None, "Its unit; seconds where the file tells none."] = (
        None
    )
    sampling_frequency: Annotated[float | None, "In Hz, where no column is time."] = (
        None
    )
    hold_out: tuple[Annotated[str, "Name of a record to hold out."], ...] = ()
    missing: Annotated[
        Literal["interpolate", "split"] | None,
        "What to do where samples are missing.",
    ] = None
    uneven: Annotated[
        Literal["interpolate"] | None,
        "What to do where samples were taken at uneven times.",
    ] = None
    device: Annotated[
        DeviceKind | None,
        ChoiceOrNone(DEVICE_KINDS),
        "Kind of the device; leave it out where none fits.",
    ] = None
    name: Annotated[
        str | None, "Name of the dataset; by default that of its folder."
    ] = None


@dataclass(frozen=True)
class User:
    """What flags say, who is asked else, and what there is to know of the answers."""

    given: Flags
    ask: Ask
    notes: list[str] = field(default_factory=list)
    """What was found and what was taken for what, one line each."""

    def note(self, topic: str, **told: Any) -> None:
        """Note something in the words of user.yaml, filled with what is told."""
        self.notes.append(words(topic, **told))


def words(topic: str, **told: Any) -> str:
    """Give the words of user.yaml on a topic, filled with what is told."""
    return str(table_of(__file__)[topic]).format(**told)

"""``hystbench job twins``: errors and claims on several twins."""

from hystbench.signature import In, Json, Out, Settings, command
from hystbench.twins.judge import write_twins
from hystbench.twins.parts import join
from hystbench.twins.read import read_twins


@command
def twins(
    twins: tuple[In, ...],
    *,
    fits: Json,
    runs: tuple[Json, ...] = (),
    settings: Settings,
    errors: Out,
    claims: Out,
) -> None:
    """Put what was run on TWINS together: errors, and where claims hold.

    What was run is what twin-fits and twin-runs wrote.
    """
    outcomes = (
        outcome
        for place, twin in enumerate(read_twins(twins))
        for outcome in join(twin, place, settings, [fits, *runs])
    )
    write_twins(outcomes, errors, claims)

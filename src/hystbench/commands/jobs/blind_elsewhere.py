"""``hystbench job blind-elsewhere``: the score of cases that another plant made."""

from hystbench.files import atomic_path
from hystbench.signature import DatasetFile, In, Out, command


@command
def blind_elsewhere(
    cases: tuple[DatasetFile, ...], *, own: tuple[In, ...] = (), out: Out
) -> None:
    """Score CASES, folders with truth.yaml and result/gap.json, as a table.

    OWN are cases of the contest, as judged.
    """
    from hystbench.challenge.contest.elsewhere import beside, told  # late: pandas
    from hystbench.challenge.contest.frames import frame, read_rows
    from hystbench.gap.schema import SCHEMA

    mine = read_rows(own)
    table = beside(
        mine[mine["solver"] == "gap"], frame(told(case, SCHEMA) for case in cases)
    )
    with atomic_path(out) as fresh:
        table.to_csv(fresh, index=False)

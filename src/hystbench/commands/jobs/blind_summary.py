"""``hystbench job blind-summary``: the score of a solver, and its rivals'."""

from hystbench.challenge.contest.plan import DEVELOPMENT_SEEDS, RETIRED_SEEDS, plan
from hystbench.challenge.contest.summary import WRITTEN, write_score
from hystbench.challenge.contest.tables import read_rows
from hystbench.files import whole_folder
from hystbench.options import In, OutFolder, Settings, command


@command
def blind_summary(
    judged: tuple[In, ...],
    *,
    transfer: tuple[In, ...] = (),
    settings: Settings,
    out: OutFolder,
) -> None:
    """Sum up the JUDGED chunks of a set, beside those of the TRANSFER set."""
    held = settings["plan"]
    seeds = [entry.spec.seed for entry in plan(**held)]
    about = {
        "set": held["name"],
        "scale": held["scale"],
        "without": held["without"],
        "only": held["only"],
        "kept": held["group"],
        "transfer_set": settings["transfer_set"],
        "transfer_scale": settings["transfer_scale"],
        "seeds": [min(seeds), max(seeds)],
        "seeds_used_while_mending": {
            name: [used.start, used.stop - 1]
            for name, used in (
                ("development and tests", DEVELOPMENT_SEEDS),
                ("earlier scores", RETIRED_SEEDS),
            )
        },
    }
    with whole_folder(out, WRITTEN) as fresh:
        write_score(
            read_rows(judged), read_rows(transfer), settings["solver"], about, fresh
        )

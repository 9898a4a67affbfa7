"""``hystbench job gap-twin``: the worked example's records and base."""

from hystbench.files import whole_folder
from hystbench.gap.example import WRITTEN, write_example
from hystbench.options import In, Json, OutFolder, command
from hystbench.record import load_record


@command
def gap_twin(
    *,
    fit: tuple[In, ...],
    hold_out: tuple[In, ...],
    identified: Json,
    out: OutFolder,
) -> None:
    """Write records as a dataset and the identified model as the base beside them.

    Writes OUT/dataset/ and OUT/base.yaml.
    """
    fitted, held = ([*map(load_record, paths)] for paths in (fit, hold_out))
    with whole_folder(out, WRITTEN) as fresh:
        write_example(fitted, held, identified, fresh)

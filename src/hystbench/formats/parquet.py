"""Parquet files, by pyarrow or fastparquet, whichever is there."""

from importlib.util import find_spec
from pathlib import Path
from typing import Any

from hystbench.formats.table import Filling, Table, told
from hystbench.libraries import library


def read(path: Path) -> Table:
    """Read the columns that hold numbers or times."""
    frame = _frame(path)
    import pandas as pd  # late: a third of a second

    found = Filling(path, in_groups=False)
    for name in map(str, frame.columns):
        series = frame[name]
        if isinstance(series.dtype, pd.DatetimeTZDtype):
            series = series.dt.tz_localize(None)
        if pd.api.types.is_extension_array_dtype(series.dtype):
            numeric = pd.api.types.is_numeric_dtype(series.dtype)
            values = series.to_numpy(float, na_value=float("nan")) if numeric else None
        else:
            values = series.to_numpy()
        found.add(name, "" if values is None else values)
    return found.table()


def _frame(path: Path) -> Any:
    if find_spec("pyarrow") is not None:
        parquet = library("pyarrow.parquet", path, "formats")
        with told(path, "Parquet file"):
            frame = parquet.read_table(path).to_pandas()
    else:
        # A tenth of the size; pandas no longer takes it as an engine of its own.
        parquet = library("fastparquet", path, "formats")
        with told(path, "Parquet file"), path.open("rb") as stream:
            frame = parquet.ParquetFile(stream).to_pandas()
    # An index with a name is a column, as a rule the time.
    return frame.reset_index() if frame.index.name is not None else frame

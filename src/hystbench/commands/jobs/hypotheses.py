"""``hystbench job hypotheses``: what could explain the errors that stay far off."""

import math

from hystbench.files import write_csv
from hystbench.job import In, Out, Settings, job
from hystbench.published import FILTERS, load
from hystbench.twins.hypotheses import CHIRP, FAST, chirp_rows, volterra_rows
from hystbench.twins.read import read_twins


@job
def hypotheses(twin: In, *, settings: Settings, chirp: Out, volterra: Out) -> None:
    """Run the filters on TWIN with one thing changed at a time; nothing is fitted."""
    (read,) = read_twins([twin])
    printed = {(p.signal, p.model): p.mse.text for p in load()}
    lines = [["the paper's table", *(printed[CHIRP, model] for model in FILTERS)]]
    lines += [
        [changed, *(_number(mse[model]) for model in FILTERS)]
        for changed, mse in chirp_rows(read, settings)
    ]
    write_csv(chirp, ["changed", *FILTERS], lines)
    lines = [["the paper's table", "", *(printed[s, "volterra"] for s in FAST)]]
    lines += [
        [changed, part, *(_number(mse[signal]) for signal in FAST)]
        for changed, part, mse in volterra_rows(read, settings)
    ]
    write_csv(volterra, ["changed", "part", *FAST], lines)


def _number(value: float) -> str:
    return "diverged" if math.isinf(value) else f"{value:.3g}"

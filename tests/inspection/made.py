"""Datasets that are known beforehand."""

import numpy as np

HEADER = "time_s,current_A,displacement_um"
DT = 1e-3
COUNT = 1200


def sine(hz, amplitude=1.0, count=COUNT, dt=DT):
    return amplitude * np.sin(2 * np.pi * hz * dt * np.arange(count))


def loop(u, width=0.2):
    """Two play operators, by their definition, sample by sample."""
    y = np.zeros(len(u))
    for r, w in ((width, 3.0), (2 * width, 2.0)):
        state = 0.0
        for k, value in enumerate(u.tolist()):
            state = min(max(state, value - r), value + r)
            y[k] += w * state
    return 4.0 * u + y


def write(folder, records, about="", roles=None, entries=None, dt=DT):
    """Write records, a pair of input and output each, and a dataset.yaml."""
    folder.mkdir(exist_ok=True, parents=True)
    lines = []
    for name, (u, y) in records.items():
        rows = zip(dt * np.arange(len(u)), u, y, strict=True)
        text = "\n".join([HEADER, *(f"{t:.9g},{a:.12g},{b:.12g}" for t, a, b in rows)])
        (folder / f"{name}.csv").write_text(text + "\n")
        use = (roles or {}).get(name, "fit")
        more = (entries or {}).get(name, "")
        lines.append(f"  - {{file: {name}.csv, use: {use}{more}}}")
    text = (
        "name: made\ntime: {column: time_s, unit: s}\n"
        "input: {column: current_A, unit: A}\n"
        "output: {column: displacement_um, unit: um}\n"
        f"{about}records:\n" + "\n".join(lines) + "\n"
    )
    (folder / "dataset.yaml").write_text(text)
    return folder / "dataset.yaml"

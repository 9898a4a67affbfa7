"""Files of other programs, in an environment that has them all; started in this folder.

pip install fastparquet h5py hdf5storage nptdms numpy pandas pyarrow soundfile tables
"""

import hdf5storage
import numpy as np
import pandas as pd
import soundfile
import tables
from nptdms import ChannelObject, GroupObject, RootObject, TdmsWriter

k = np.arange(400)
t = k * 0.001
u = 1.5 * np.sin(2 * np.pi * 5 * t)
y = 2 * u + 0.25 * u**2

# MATLAB v7.3, as hdf5storage writes it.
column = {"t": t[:, None], "u": u[:, None], "y": y[:, None]}
hdf5storage.savemat("v73.mat", column | {"fs": 1000.0}, format="7.3", oned_as="column")
runs = {
    name: {"i": a * u[:, None], "x": a * y[:, None]}
    for name, a in (("a", 1), ("b", 0.5))
}
hdf5storage.savemat("v73-runs.mat", runs, format="7.3", oned_as="column")

# HDF5, as PyTables writes it: groups, units and a rate as attributes, a compound table.
with tables.open_file("pytables.h5", "w") as file:
    for name, a in (("slow", 1.0), ("fast", 0.5)):
        group = file.create_group("/", name)
        group._v_attrs.fs = 1000.0
        file.create_array(group, "current", a * u).attrs.units = "A"
        file.create_array(group, "stroke", a * y).attrs.units = "um"
    rows = np.rec.fromarrays([t, u, y], names=["time_s", "current_A", "stroke_um"])
    file.create_table("/", "log", obj=rows)

# Parquet, as pyarrow and as fastparquet write it.
frame = pd.DataFrame({"time_s": t, "current_A": u, "stroke_um": y, "note": ["x"] * 400})
frame.to_parquet("pyarrow.parquet", engine="pyarrow", index=False)
frame.to_parquet("fastparquet.parquet", engine="fastparquet", index=False)

# TDMS, as the writer of nptdms writes it: units and an increment as LabVIEW has them.
with TdmsWriter("rig.tdms") as writer:
    for name, a in (("slow", 1.0), ("fast", 0.5)):
        channels = [
            ChannelObject(
                name, label, a * values, {"unit_string": unit, "wf_increment": 0.001}
            )
            for label, values, unit in (("current", u, "A"), ("stroke", y, "um"))
        ]
        writer.write_segment([RootObject(), GroupObject(name), *channels])

# Sound, as libsndfile writes it.
soundfile.write("int16.wav", np.column_stack([u, y / 4]) / 2, 1000, subtype="PCM_16")
soundfile.write("int24.wav", np.column_stack([u, y / 4]) / 2, 1000, subtype="PCM_24")
soundfile.write("float.wav", np.column_stack([u, y / 4]) / 2, 1000, subtype="DOUBLE")

# CSV, as pandas writes it for a spreadsheet in German.
german = pd.DataFrame({"Zeit [s]": t, "Spulenstrom [mA]": 1000 * u, "Weg [µm]": y})
german.to_csv("german.csv", sep=";", decimal=",", index=False, encoding="utf-16")

# A rig as a stranger leaves it: MATLAB v7.3, a struct a run, a rate, no units.
rng = np.random.default_rng(7)
n = 800
tt = np.arange(n) / 1000


def rig(drive):
    """A saturating drive, play of 0.15 in the joint, noise."""
    z = 5 * np.tanh(drive / 1.2)
    out, state = np.zeros(n), 0.0
    for j, value in enumerate(z):
        state = min(max(state, value - 0.15), value + 0.15)
        out[j] = state
    return out + 0.005 * rng.standard_normal(n)


drives = {
    "run01": 1.0 * np.sin(2 * np.pi * 5 * tt),
    "run02": 0.7 * np.sin(2 * np.pi * 20 * tt),
    "run03": 1.2 * np.sin(2 * np.pi * 10 * tt),
    "run04": 0.5 * (np.sin(2 * np.pi * 5 * tt) + np.sin(2 * np.pi * 15 * tt + 1)),
}
content = {
    name: {"current": d[:, None], "position": rig(d)[:, None]}
    for name, d in drives.items()
}
hdf5storage.savemat(
    "stranger.mat", content | {"Fs": 1000.0}, format="7.3", oned_as="column"
)

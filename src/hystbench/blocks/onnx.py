"""Block ``onnx``: a neural network, or any other graph, in a file of ONNX."""

from functools import lru_cache
from typing import Any

import numpy as np

from hystbench.blocks.parameter import text
from hystbench.blocks.simulator import CallError, FileSimulator, same_file
from hystbench.errors import InputError, in_line
from hystbench.libraries import library
from hystbench.record import FloatArray

EXPECTED = "a graph of ONNX (.onnx)"
TYPES: dict[str, type[np.floating[Any]]] = {
    "tensor(float)": np.float32,
    "tensor(double)": np.float64,
    "tensor(float16)": np.float16,
}
BATCH = ("batch", "n_batch", "batch_size", "n")
"""Names of a free axis that is not time, in small letters."""


class Onnx(FileSimulator, name="onnx"):
    """A graph of ONNX that maps a sequence u to a sequence y, run by onnxruntime.

    Its first input takes all n samples at once: one axis is free and is time, the
    others have length one, such as ``(time,)``, ``(1, time)`` or ``(batch, time, 1)``.
    Of several free axes those called batch are one, and the last of the rest is time.
    An axis of the fixed length n is time before any free one.
    A second input, if there is one, is the sampling interval in seconds. The first
    output holds n numbers in any shape. Numbers may be of 16, 32 or 64 bits.

    References
    ----------
    .. [1] Open Neural Network Exchange, Intermediate Representation Specification.
    """

    expected = EXPECTED

    file: str = text(EXPECTED)

    @property
    def label(self) -> str:
        """The file."""
        return self.file

    def run(self, z: FloatArray, dt: float) -> np.ndarray:
        """Run the graph once."""
        path = self.path
        runtime = library("onnxruntime", self.label, "simulators")
        session = _session(runtime, self.label, *same_file(path))
        first, *more = session.get_inputs()
        if len(more) > 1:
            raise InputError(
                f"{self.label}: {1 + len(more)} inputs; expected the samples, and the "
                "sampling interval at most"
            )
        feed = {first.name: _shaped(self.label, first, z)}
        for item in more:
            shape = [1] * len(item.shape)
            feed[item.name] = np.full(shape, dt, dtype=_type(self.label, item))
        try:
            found = session.run([session.get_outputs()[0].name], feed)[0]
        except Exception as error:
            # The runtime raises anything of a graph that does not fit.
            raise CallError(f"failed: {in_line(error)}") from error
        given = np.asarray(found)
        return given.reshape(-1) if given.size == len(z) else given


@lru_cache(maxsize=8)
def _session(runtime: Any, label: str, path: str, changed: int, size: int) -> Any:
    """Load a graph once, for one thread: the last bits depend on their number."""
    options = runtime.SessionOptions()
    options.intra_op_num_threads = options.inter_op_num_threads = 1
    options.log_severity_level = 4
    try:
        return runtime.InferenceSession(
            path, options, providers=["CPUExecutionProvider"]
        )
    except Exception as error:
        raise InputError(
            f"{label}: cannot be read ({in_line(error)}); expected {EXPECTED}"
        ) from error


def _type(label: str, item: Any) -> type[np.floating[Any]]:
    if item.type not in TYPES:
        raise InputError(
            f"{label}: its input {item.name!r} is a {item.type}; expected numbers of "
            "floating point"
        )
    return TYPES[item.type]


def _shaped(label: str, item: Any, z: FloatArray) -> np.ndarray:
    """Give the samples in the shape that a graph's input has."""
    free = [k for k, length in enumerate(item.shape) if not isinstance(length, int)]
    time = [k for k in free if str(item.shape[k]).lower() not in BATCH] or free
    fixed = [length for length in item.shape if isinstance(length, int)]
    if len(z) in fixed:
        time = [item.shape.index(len(z))]
        fixed.remove(len(z))
    if not time or any(length != 1 for length in fixed):
        raise InputError(
            f"{label}: its input {item.name!r} has the shape {item.shape}; expected "
            f"one free axis for time (here {len(z)} samples), the others of length one"
        )
    shape = [1] * len(item.shape)
    shape[time[-1]] = len(z)
    return np.asarray(z.reshape(shape), dtype=_type(label, item))

"""A recurrent network as ONNX, by the package onnx; started in this folder.

pip install onnx numpy. ``h = tanh(0.5 u + 0.8 h)``, ``y = 3 h``: one neuron, shape
(time, batch, 1) in and out, as PyTorch exports a network of sequences. And a
polynomial of each sample, ``y = 2 u + 0.25 u^2``, of 64 bits, shape (time,).
"""

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper


def constant(name, values, kind=np.float32):
    return numpy_helper.from_array(np.array(values, dtype=kind), name)


def save(graph, path):
    model = helper.make_model(
        graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8
    )
    onnx.checker.check_model(model)
    onnx.save(model, path)


save(
    helper.make_graph(
        [
            helper.make_node("RNN", ["u", "W", "R"], ["all"], hidden_size=1),
            helper.make_node("Mul", ["all", "three"], ["scaled"]),
            helper.make_node("Squeeze", ["scaled", "axis"], ["y"]),
        ],
        "rnn",
        [helper.make_tensor_value_info("u", TensorProto.FLOAT, ["time", "batch", 1])],
        [helper.make_tensor_value_info("y", TensorProto.FLOAT, ["time", "batch", 1])],
        [
            constant("W", [[[0.5]]]),
            constant("R", [[[0.8]]]),
            constant("three", 3.0),
            constant("axis", [1], np.int64),
        ],
    ),
    "rnn.onnx",
)
save(
    helper.make_graph(
        [
            helper.make_node("Mul", ["u", "u"], ["square"]),
            helper.make_node("Mul", ["square", "quarter"], ["curved"]),
            helper.make_node("Mul", ["u", "two"], ["straight"]),
            helper.make_node("Add", ["straight", "curved"], ["y"]),
        ],
        "polynomial",
        [helper.make_tensor_value_info("u", TensorProto.DOUBLE, ["time"])],
        [helper.make_tensor_value_info("y", TensorProto.DOUBLE, ["time"])],
        [constant("quarter", 0.25, np.float64), constant("two", 2.0, np.float64)],
    ),
    "polynomial.onnx",
)

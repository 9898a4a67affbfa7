"""One example of every block, which the contract and the model tests share."""

from pathlib import Path

import yaml

from hystbench.blocks import own, registry

HERE = Path(__file__)
EXAMPLES = yaml.safe_load(HERE.with_suffix(".yaml").read_text(encoding="utf-8"))
EXAMPLES["onnx"] = {"file": str(HERE.with_name("files") / "rnn.onnx")}


def middles(block):
    """Of numbers that must be given, one within their bounds."""
    return {
        name: (max(about.low, -1.0) + min(about.high, 1.0)) / 2 or 0.5
        for name, about in block.parameters().items()
        if about.kind == "number"
    }


# A block of an installed package brings no example.
EXAMPLES |= {
    name: middles(block) for name, block in registry().items() if name not in own()
}


def twice(u, dt):
    """Stand for a simulator that a user brings."""
    return 2 * u

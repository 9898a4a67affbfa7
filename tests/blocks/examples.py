"""One example of every block, which the contract and the model tests share."""

from pathlib import Path

import yaml

HERE = Path(__file__)
EXAMPLES = yaml.safe_load(HERE.with_suffix(".yaml").read_text(encoding="utf-8"))
EXAMPLES["onnx"] = {"file": str(HERE.with_name("files") / "rnn.onnx")}


def twice(u, dt):
    """Stand for a simulator that a user brings."""
    return 2 * u

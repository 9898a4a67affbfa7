"""Cut config.yaml down to three signals and 24 blind cases: small.py CONFIG OUT."""

import sys
from pathlib import Path

import yaml

from hystbench.yaml_files import load_yaml

config = load_yaml(sys.argv[1])
config["signals"] = ["sine-040hz", "sine-100hz", "multisine-10-30-50hz"]
config["rdgpi"]["fit_signals"] = ["sine-040hz", "sine-100hz"]
config["rdgpi"]["starts"] = 2
config["order_sweep"]["orders"] = [1, 5, 10]
config["pressure"]["twins"] = ["gma-preisach"]
blind = config["blind"]
# Twice the dozen of the small set; four jobs of six cases for the one solver.
blind |= {
    "set": "small",
    "scale": 2.0,
    "transfer_scale": 0,
    "left_out_scale": 0,
    "chunk": 6,
}
blind["solvers"] = {blind["solver"]: blind["solvers"][blind["solver"]]}
Path(sys.argv[2]).write_text(yaml.safe_dump(config), encoding="utf-8")

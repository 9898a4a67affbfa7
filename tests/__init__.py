"""Tests of hystbench."""

import os

# As the command line does: beside another process the threads of small matrices wait for
# each other, and take ten times as long. Before NumPy is imported.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

"""Tests of hystbench."""

import os

# As the command line does, before NumPy is imported: beside another process the threads
# of small matrices wait for each other, and take ten times as long.
os.environ["OPENBLAS_NUM_THREADS"] = "1"

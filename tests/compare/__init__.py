"""Tests of hystbench.compare."""

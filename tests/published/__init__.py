"""Tests of hystbench.published."""

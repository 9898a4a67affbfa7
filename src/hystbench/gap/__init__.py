"""Closing the gap between a simulator and measurements: docs/gap.md."""

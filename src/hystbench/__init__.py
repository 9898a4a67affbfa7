"""Benchmark of rate-dependent hysteresis models of smart actuators."""

__version__ = "0.1.0"

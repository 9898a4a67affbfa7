"""Bases: the simulator that disagrees with the measurements, given or identified."""

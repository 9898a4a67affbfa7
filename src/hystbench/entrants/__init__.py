"""Solvers that enter the blind challenge, and what runs them.

A solver is a command that takes a dataset's folder, a model file and a folder to write
``gap.json`` into. Nothing here knows the plant or the truth, nor how hystbench's own
solver works.
"""

"""Calibration of the twin on a part of the published tables, the rest held out.

``targets`` says what is fitted to, ``twin`` what is free, ``objective`` how far a twin
is from the targets, ``fit`` finds the nearest and ``crossvalidation`` judges a choice
by leaving one signal out. Nothing here reads a held-out row.
"""

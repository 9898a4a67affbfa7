"""Twins: how they are fitted to the paper, and what the models do on them.

Fitting: ``search`` has the unknowns and the one optimiser. ``plant`` says what is free
in the twin, ``targets`` and ``constraints`` what it is fitted to, ``objective`` how far
it is from that. ``calibrate`` finds the nearest, ``ensemble`` others that are as good,
``run`` writes them; ``families`` and ``family_fit`` make twins with other hysteresis.
No held-out row of the tables is read.

Running: ``read`` reads model files and ``runs`` runs the filters on them. ``fits``,
``experiments``, ``parts`` and ``judge`` try the claims on many twins; ``constants``,
``draws``, ``edges`` and ``hypotheses`` answer one question each.
"""

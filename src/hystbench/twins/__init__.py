"""What the models do on the twin and on others like it.

``read`` reads model files and ``runs`` runs the filters on them. ``fits``,
``experiments``, ``parts`` and ``judge`` try the claims on many twins; ``constants``,
``draws`` and ``edges`` answer one question each.
"""

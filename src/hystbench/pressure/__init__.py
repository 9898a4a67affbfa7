"""The claims under pressure: on other twins, with other step sizes and seeds.

``twins`` reads the twins, ``fits`` and ``runs`` are the models on one of them,
``ensemble`` all at once and ``configured`` part by part; ``judging`` counts where each
claim holds, and ``contest`` gives each filter its own best step size.
"""

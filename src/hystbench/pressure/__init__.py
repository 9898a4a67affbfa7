"""The claims under pressure: on other twins, with other step sizes and seeds.

``twins`` reads the twins, ``ensemble`` runs the models on them, ``judging`` counts
where each claim holds, and ``contest`` gives each filter its own best step size.
"""

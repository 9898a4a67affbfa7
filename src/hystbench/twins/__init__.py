"""What the models do on the twin and on others like it.

``runs`` makes twins, simulates records of them and runs the filters on these. ``fits``
holds what no step size changes, Algorithm 1 and the RDGPI model. ``parts`` runs all
models on each twin, in parts that can be made again alone, and joins them.
"""

"""What the kernels and the pipeline cost, beside their peers: `make bench`.

Peers are measured in the same run, in turn with ours, on the same work. What is kept
are ratios: absolute times belong to the machine. Tables go to results/benchmarks.
"""

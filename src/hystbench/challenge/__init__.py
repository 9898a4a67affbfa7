"""The blind challenge: a plant that hides effects, for a solver that must name them.

What is here knows the truth. Nothing but the command ``hystbench hide`` and the judge
may import it; a solver gets a folder with records and a model file.
"""

"""Effects inside the dynamics: linear hosts, forces in them, and which one it is.

A linear model that moves is written as a mechanism, one that is moved as an impedance.
Every effect that can act inside it is put there, all numbers are
refitted together, and the score that judges effects elsewhere judges these too.
"""

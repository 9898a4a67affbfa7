"""A magnetostrictive actuator by physics, integrated far above the record's rate.

It shares no code with the blocks of a model file: other equations where there are
several, other numerics everywhere.
"""

"""Ours beside theirs: evidence, cells, claims, tables and the verdict."""

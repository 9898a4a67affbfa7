"""A chain of blocks on records, and what reshaping its hysteresis could do."""

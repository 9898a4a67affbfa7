"""The records that a search reads, what of them is scored, and their noise."""

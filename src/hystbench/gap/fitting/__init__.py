"""A model on the fit records: its numbers, its score and its fit."""

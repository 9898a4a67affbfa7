"""What the hold-out records show of a decision."""

"""Which effects are added to a model, and why."""

"""What the named effects leave, and the verdict on it."""

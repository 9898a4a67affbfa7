"""The paper's models on measured devices that it never saw."""

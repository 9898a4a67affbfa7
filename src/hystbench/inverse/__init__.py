"""The input that makes a model's output follow a reference. docs/inverse.md."""

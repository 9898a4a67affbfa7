"""What ``from hystbench import ...`` gives: records, gaps and their pictures."""

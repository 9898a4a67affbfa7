"""The next experiment: an input that tells likely effects apart."""

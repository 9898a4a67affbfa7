"""The contest: which cases are held, and how answers to them are judged."""

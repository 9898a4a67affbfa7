"""One page that an engineer reads: the verdict first, then the evidence."""

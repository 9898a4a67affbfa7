"""One command of the command line a file; each does one job of the workflow."""

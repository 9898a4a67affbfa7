"""Run the command line as ``python -m hystbench``."""

from hystbench.cli import main

main()

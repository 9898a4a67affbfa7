"""Models as code that runs elsewhere: C, a Python module, an FMU. docs/export.md."""

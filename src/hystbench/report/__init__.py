"""Pages that stand alone: the style, script, tables and pictures that they share.

A page is a Jinja template of its own package that extends ``layout.html.j2`` and takes
its tables and figures from ``parts.html.j2``; see :mod:`hystbench.report.layout`. It is
one file: nothing is fetched, and its content security policy forbids that it is.
"""

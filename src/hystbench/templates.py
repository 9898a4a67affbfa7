"""Templates of plain text: each stands beside the module that fills it."""

from functools import cache
from typing import Any

from hystbench.sentences import listed


def paragraphs(package: str, template: str, **given: Any) -> list[str]:
    """Fill a template of a package; a paragraph of it is one line.

    Parameters
    ----------
    package, template : str
        The template's file lies in the folder of the package.
    **given
        What it is filled with; an unknown name is an error.
    """
    text = templates(package).get_template(template).render(given)
    return [" ".join(part.split()) for part in text.split("\n\n") if part.strip()]


@cache
def templates(package: str) -> Any:
    """Give the Jinja environment of the templates in the folder of a package."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    words = Environment(
        loader=PackageLoader(package, ""),
        undefined=StrictUndefined,
        trim_blocks=True,
        autoescape=False,  # noqa: S701 - plain text
    )
    words.filters["listed"] = lambda names: listed(list(names))
    words.filters["told"] = lambda value, form: format(value, form)
    return words

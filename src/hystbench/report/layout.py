"""Templates of a page, with the shared style and script inside."""

from importlib import resources

from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined
from markupsafe import Markup


def page_environment(package: str) -> Environment:
    """Give the environment in which the templates of a package make pages.

    Parameters
    ----------
    package : str
        Whose templates (``*.j2`` in its folder) are found, beside ``layout.html.j2``
        and ``parts.html.j2``, which all pages share.

    Returns
    -------
    Environment
        It escapes what is not marked as HTML, and an unknown name is an error. Its
        globals ``style`` and ``script`` hold what stands in the head of every page.
    """
    environment = Environment(
        loader=ChoiceLoader(
            [PackageLoader(package, "."), PackageLoader("hystbench.report", ".")]
        ),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.globals["style"] = _asset("style.css")
    environment.globals["script"] = _asset("page.js")
    return environment


def _asset(name: str) -> Markup:
    """Read a file of this package as it is: it is ours, and holds no end tag."""
    text = resources.files("hystbench.report").joinpath(name).read_text("utf-8")
    return Markup(text)  # noqa: S704

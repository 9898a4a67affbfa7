"""Pages of gaps whose words matter: their pictures are painted, and not rendered."""

from contextlib import contextmanager

import pytest
from matplotlib.figure import Figure


@contextmanager
def without_rendering():
    """Write an empty picture for each that was painted: most of a page's time."""

    def empty(figure, out, **_):
        out.write(b'<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg"/>')

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "savefig", empty)
        yield


@pytest.fixture
def unrendered():
    with without_rendering():
        yield

"""A small twin and small settings, as for the tests of twins."""

from tests.twins.conftest import settings, two

__all__ = ["settings", "two"]

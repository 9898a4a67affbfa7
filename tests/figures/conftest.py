import pytest

from tests.figures.inputs import Inputs


@pytest.fixture(scope="session")
def inputs(tmp_path_factory):
    return Inputs(tmp_path_factory.mktemp("figures"))

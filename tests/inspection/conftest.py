"""What several tests of the inspection look at."""

import pytest

from tests.inspection.stage import write_stage


@pytest.fixture
def stage(tmp_path):
    """The folder in which the records of the stage lie."""
    write_stage(tmp_path)
    return tmp_path

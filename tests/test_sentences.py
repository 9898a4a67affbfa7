"""Words and numbers as they stand in a sentence."""

import pytest

from hystbench.sentences import finely


@pytest.mark.parametrize(
    ("share", "said"),
    [
        (0.0, "0 %"),
        (1e-5, "less than 0.1 %"),
        (0.0049, "0.5 %"),
        (0.0099, "1.0 %"),
        (0.014, "1 %"),
        (0.4, "40 %"),
    ],
)
def test_what_little_stays_is_no_round_nothing(share, said):
    assert finely(share) == said

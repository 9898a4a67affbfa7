"""What a user reads where something is refused."""

from collections.abc import Callable

import pytest

from hystbench.errors import InputError


def message(call: Callable[[], object]) -> str:
    """Give the message of a refusal, which is one line."""
    with pytest.raises(InputError) as caught:
        call()
    text = str(caught.value)
    assert "\n" not in text
    return text

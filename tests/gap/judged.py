"""The word of the verdict on findings of which only some matter."""

from hystbench.gap.judging.unowned import Unowned
from hystbench.gap.judging.verdict import GIVE, judge_names, judge_none

PLAIN = {
    "explained_by_box": None,
    "retuned": False,
    "floor_is_upper_bound": False,
    "size_follows": False,
    "mends": GIVE,
}
ALL_OWNED = Unowned(0.0)


def judge(found, named, box=None, unowned=ALL_OWNED, **more):
    """Choose the word for what is left where effects were named, or where none was."""
    if named:
        return judge_names(found, unowned)
    return judge_none(found, unowned, **PLAIN | {"explained_by_box": box} | more)

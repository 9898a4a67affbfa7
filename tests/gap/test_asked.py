"""What a user asks of a search."""

from hystbench.model import Model
from tests.gap.made import CURRENT, DISPLACEMENT
from tests.gap.searched import among, search
from tests.gap.small import block, measured


def test_to_let_more_stay_is_no_reason_to_look_for_less():
    """The lag takes nine tenths of the gap, the square the rest."""
    gain = block("gain", value=12.0)
    plant = (
        block("drive-lag", time_constant_s=0.004),
        gain,
        block("asymmetry", coefficient=0.02),
    )
    base = Model("gain", CURRENT, DISPLACEMENT, (gain,))
    names = among("drive-lag", "asymmetry", "saturation")
    found = [
        search(
            "made", measured(plant, 0.02), base, unnamed_share=share, vocabulary=names
        )
        for share in (0.01, 0.5)
    ]
    for answer in found:
        effects = [item["name"] for item in answer.content["effects"]]
        assert effects == ["drive-lag", "asymmetry"]

"""The colours that a figure may have."""

from hystbench.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILION,
)

PALETTE = {BLACK, GREY, ORANGE, GREEN, BLUE, VERMILION, PURPLE, SKY}

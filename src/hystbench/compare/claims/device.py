"""Claims on the device and on the RDGPI model that no twin can judge."""

from __future__ import annotations

from hystbench.compare.claims.claim import untestable

stroke = untestable(
    "stroke",
    "the GMA has 'a stroke of +-30 um'",
    "Section 4",
    "condition",
    "a property of the device; a twin of the printed errors does not know it",
)
sensor = untestable(
    "sensor",
    "the eddy current sensor has 'a 8 mV/um resolution'",
    "Section 4",
    "condition",
    "a property of the device; mV/um is a sensitivity, not a resolution",
)
rdgpi_parameters = untestable(
    "rdgpi-parameters",
    "identification of the RDGPI model 'results in' eleven printed parameters",
    "Section 4",
    "result",
    "the equations that take them are in the paper's reference [32], not in the paper",
)
rdgpi_inverse = untestable(
    "rdgpi-inverse",
    "'The inversion of the RDGPI can be formulated analytically'",
    "Section 4",
    "theory",
    "the model inverted is defined in the paper's reference [32]; nothing here "
    "inverts it",
)
effective = untestable(
    "effective",
    "'Experimental results showed the effectiveness' of the method",
    "Section 5",
    "result",
    "no number goes with the word; the claims on errors stand for it",
)

"""Which experiment tells two effects apart, for docs/confusions.md."""

from __future__ import annotations

BAND = "a multisine up to half the sampling rate: delay, lag and diffusion part there"
BIAS = "minor loops at several bias levels"
REPEAT = "the same record again: drift differs, what the input causes does not"
HOLD = "long holds at currents of both signs: heat goes with the square"
RATES = "one amplitude at several rates, and one rate at several amplitudes"
AMPLITUDES = "a sweep through the mode at several amplitudes"
REVERSALS = "reversals of several sizes at a slow rate"
REFERENCE = "a reference for the sensor at several levels"
UNKNOWN = "none written down"

_LAGS = ("input-delay", "drive-lag", "eddy-diffusion", "sensor-lag")
_SLOW = ("creep", "thermal-drift")
_STATIC = (
    "asymmetry",
    "saturation",
    "drive-saturation",
    "sensor-nonlinearity",
    "dead-zone",
)
_LOOPS = ("hysteresis", "hysteresis-shape", "backlash", "friction")
#: In order: the first that holds both effects counts.
_GROUPS: tuple[tuple[tuple[str, ...], tuple[str, ...], str], ...] = (
    (("drive-lag",), ("sensor-lag",), RATES),
    (_LAGS, _LAGS, BAND),
    (_LAGS, ("resonance", "stiffness-hardening", "slew-limit"), BAND),
    (("resonance",), ("stiffness-hardening",), AMPLITUDES),
    (_STATIC, _STATIC, BIAS),
    (_STATIC, ("calibration-error",), REFERENCE),
    (_STATIC, _LOOPS, BIAS),
    (_SLOW, _SLOW, HOLD),
    (_SLOW, ("drift", "mains-pickup"), REPEAT),
    (("drift",), ("mains-pickup", "calibration-error"), REPEAT),
    (_LOOPS, _LOOPS, REVERSALS),
    (("rate-dependent-hysteresis",), (*_LAGS, *_LOOPS, "slew-limit"), RATES),
)


def experiment(one: str, other: str) -> str:
    """Tell an experiment that separates two effects.

    Parameters
    ----------
    one, other : str
        Names of the vocabulary; of others nothing is known.
    """
    for here, there, told in _GROUPS:
        if (one in here and other in there) or (other in here and one in there):
            return told
    return UNKNOWN

"""Which records to hold out: of another kind than those to fit, inside their range."""

from collections.abc import Mapping

from hystbench.inspection.excitation import InputSummary


def propose(inputs: Mapping[str, InputSummary]) -> tuple[tuple[str, ...], str]:
    """Propose the records to hold out.

    Where there are several kinds of input, one kind is held out: that with the fewest
    records, so long as it does not reach beyond the others in range; of equals the one
    that reaches least beyond them in frequency. Of one kind alone the record in the
    middle of the rates is held out, of eight or more every fourth: a model is judged
    between what it was fitted to, and not beyond.

    Parameters
    ----------
    inputs : mapping of str to InputSummary
        Two records or more.

    Returns
    -------
    tuple of str
        Names of those to hold out; at least one record is left to fit.
    str
        Why these.
    """
    kinds: dict[str, list[str]] = {}
    for name, item in inputs.items():
        kinds.setdefault(item.kind, []).append(name)
    tried = [
        (len(names) > len(inputs) // 2, *_beyond(inputs, names), len(names), kind)
        for kind, names in kinds.items()
    ]
    if len(kinds) > 1:
        *_, kind = min(tried)
        others = " and ".join(sorted(set(kinds) - {kind}))
        return (
            tuple(kinds[kind]),
            f"the inputs held out are of another kind ({kind}) than those to fit "
            f"({others})",
        )
    by_rate = sorted(inputs, key=lambda name: inputs[name].rate)
    count = max(1, len(by_rate) // 4)
    step = len(by_rate) / count
    chosen = {by_rate[int((k + 0.5) * step - 0.5)] for k in range(count)}
    kind = next(iter(kinds))
    return (
        tuple(name for name in inputs if name in chosen),
        f"all inputs are of one kind ({kind}); of these one in the middle of the rates "
        "is held out, and a record of another kind would prove more",
    )


def _beyond(inputs: Mapping[str, InputSummary], names: list[str]) -> tuple[bool, float]:
    """Tell whether records reach beyond the range of the others, and their band."""
    own = [inputs[name] for name in names]
    rest = [item for name, item in inputs.items() if name not in names]
    if not rest:
        return True, 0.0
    span = max(item.high for item in rest) - min(item.low for item in rest)
    over = max(
        max(item.high for item in own) - max(item.high for item in rest),
        min(item.low for item in rest) - min(item.low for item in own),
    )
    faster = max(i.high_hz for i in own) / max(i.high_hz for i in rest)
    return over > 0.1 * span, max(faster, 1.0)

# What the rules of gap.smk look up for a case.


def of_case(key):
    """Files of a case, by its name."""
    return lambda wildcards: GAP_CASES[wildcards.case][key]


def model_of_case(wildcards):
    """The model file of a case, or the module of a function that lies here.

    A base that is identified has none.
    """
    return model_files(GAP_CASES[wildcards.case]["model"])


def model_files(model):
    """Files of a base: a model file, a simulator's, or a function's module here."""
    if model.startswith("command:"):
        words = shlex.split(model.removeprefix("command:"))
        return [word for word in words if Path(word).is_file()]
    if model.endswith((".yaml", ".yml", ".fmu", ".onnx")):
        return [model]
    dotted, function, _ = model.partition(":")
    place = Path(*dotted.split("."))
    sources = [place.with_suffix(".py"), place / "__init__.py"]
    return [str(path) for path in sources if function and path.is_file()]


def effects_of_case(wildcards):
    """Effects that the search of a case leaves out and puts in, as options."""
    case = GAP_CASES[wildcards.case]
    return " ".join(
        options(f"--{key}", case.get(key, [])) for key in ("without", "with")
    ).strip()


def limits_of_case(wildcards):
    """What the next experiment of a case may ask of the actuator, as options."""
    limits = GAP_CASES[wildcards.case]["limits"]
    return " ".join(
        f"--limit-{name}={value}" for name, value in limits.items() if value is not None
    )

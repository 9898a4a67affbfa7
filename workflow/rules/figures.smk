# What each figure is drawn from: files by the option that takes them. Where the
# settings leave out a signal or a model, the figures that need it are left out too.
FIGURE_INPUTS = {
    "identification": {
        "record": [record(SETTINGS.identification_signal)],
        "identified": rules.identify.output,
    }
}

# The front page shows a few loops of one filter. Of the paper's signals the sines that
# the twin was not fitted to go first: their loops are plain, and nothing was fitted there.
HEADLINE = sorted(
    SETTINGS.signals,
    key=lambda name: (
        not name.startswith("sine-"),
        name in SETTINGS.compare_job["calibrated"],
    ),
)[:3]

if SETTINGS.filters:
    FIGURE_INPUTS |= {
        "headline": {
            "record": [record(signal) for signal in HEADLINE],
            "run": [run(signal, SETTINGS.filters[0]) for signal in HEADLINE],
            "arrays": [run(signal, SETTINGS.filters[0], "npz") for signal in HEADLINE],
        },
        "figure-07-order": {
            "record": [record(SETTINGS.order_sweep_signal)],
            "table": [rules.order_sweep.output.configured],
        },
        "learning-curves": {
            "run": [
                run(signal, model)
                for signal in SETTINGS.signals
                for model in SETTINGS.filters
            ],
        },
    }

if TWIN:
    FIGURE_INPUTS |= {
        "figure-03-play": {},
        "figure-04-generalized-play": {},
        "errors-heat-map": {"table": [rules.tables.output.cells]},
        "step-edges": {"table": [rules.step_sweep.output.edges]},
    }
    # The paper's figures of the GPO filter, and their signals.
    FIGURE_INPUTS |= {
        name: {
            "record": [record(signal) for signal in signals],
            "run": [run(signal, "gpo") for signal in signals],
            "arrays": [run(signal, "gpo", "npz") for signal in signals],
        }
        for name, signals in {
            "figure-08-loops": [s for s in SETTINGS.signals if s.startswith("sine-")],
            "figure-09-chirp": ["chirp-1-100hz"],
            "figure-10-sum": ["multisine-10-30-50hz"],
            "figure-11-sum": ["multisine-5-25-50-75-100hz"],
            "figure-12-random-sum": ["multisine-random-0-100hz"],
        }.items()
        if "gpo" in SETTINGS.models and signals and {*signals} <= {*SETTINGS.signals}
    }
else:
    FIGURE_INPUTS |= {
        "loops": {
            "record": [record(signal) for signal in SETTINGS.signals],
            "run": runs(),
            "arrays": runs("npz"),
        },
        "errors-by-record": {"run": runs()},
    }

for NAME, GIVEN in FIGURE_INPUTS.items():

    rule:
        name:
            f"draw_{NAME.replace('-', '_')}"
        input:
            **GIVEN,
            published=PUBLISHED,
            code=code(
                "hystbench.commands.jobs.figure",
                module_of(NAME),
            ),
            style=PACKAGE / "figures" / "hystbench.mplstyle",
        output:
            png=report(
                figure(NAME, "png"),
                caption=f"../report/{NAME}.rst",
                category="Figures",
            ),
            svg=figure(NAME, "svg"),
        log:
            f"{RESULTS}/logs/figures/{NAME}.log",
        benchmark:
            f"{RESULTS}/logs/benchmarks/draw/{NAME}.tsv"
        params:
            name=NAME,
            given=" ".join(
                options(f"--{key}", GIVEN[key]) for key in GIVEN if key != "arrays"
            ),
        message:
            f"figure {NAME}"
        shell:
            "hystbench job figure {params.name:q} {params.given}"
            " --out {output.png:q} --out {output.svg:q} 2> {log:q}"


FIGURES = [figure(name, suffix) for name in FIGURE_INPUTS for suffix in ("png", "svg")]

"""config.yaml: checked as a whole, handed out job by job.

Each job gets the settings that it depends on and no others, so that Snakemake
reruns what a changed setting changes and nothing else.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hystbench.dataset import Dataset
from hystbench.errors import refuse_unknown
from hystbench.filters import filter_class, registry
from hystbench.filters.keys import keys_of
from hystbench.plants import model_files
from hystbench.published import FILTERS, load_errors, signals
from hystbench.published.split import CALIBRATION_SIGNALS
from hystbench.settings_checks import checked


@dataclass(frozen=True)
class Settings:
    """A checked config.yaml."""

    config: Mapping[str, Any]
    """The content, as the schema has it."""
    dataset: Dataset | None
    """The measured dataset, or None where the twin is the source."""
    warnings: tuple[str, ...] = ()
    """What of its records is hardly meant, one line each."""

    @property
    def results(self) -> str:
        """Folder of the results: a dataset's never overwrite the reproduction's."""
        if self.dataset is None:
            return "results"
        return f"results/datasets/{self.dataset.name}"

    @property
    def name(self) -> str:
        """Name of what is measured: ``twin`` or that of the dataset."""
        return "twin" if self.dataset is None else self.dataset.name

    @property
    def signals(self) -> list[str]:
        """Names of the signals to run; a dataset's are its records."""
        named = list(self.config["signals"])
        if self.dataset is None:
            return named
        records = self.dataset.record_files
        # The signals of the paper say nothing of a dataset: then all its records run.
        return [name for name in named if name in records] or list(records)

    @property
    def models(self) -> list[str]:
        """Names of the models to run."""
        return list(self.config["models"])

    @property
    def filters(self) -> list[str]:
        """Names of the LMS filters to run: the paper's first, as it lists them."""
        return [name for name in registry() if name in self.models]

    @property
    def paper_filters(self) -> list[str]:
        """Those of them that are the paper's: its claims are of no other."""
        return [name for name in FILTERS if name in self.models]

    @property
    def added(self) -> list[str]:
        """Filters and signals to run that the paper's tables do not have."""
        known = {*FILTERS, *signals(load_errors())}
        return [name for name in (*self.filters, *self.signals) if name not in known]

    @property
    def identification_signal(self) -> str:
        """Name of the record on which Algorithm 1 runs."""
        if self.dataset is None:
            return str(self.config["identification"]["signal"])
        return self.dataset.identification

    @property
    def rdgpi_fit_signals(self) -> list[str]:
        """Names of the records to which the RDGPI model is fitted."""
        if self.dataset is None:
            return list(self.config["rdgpi"]["fit_signals"])
        return [name for name in self.signals if self.dataset.use(name) == "fit"]

    @property
    def order_sweep_signal(self) -> str:
        """Name of the record of Figure 7; of a dataset, the identification's."""
        if self.dataset is None:
            return str(self.config["order_sweep"]["signal"])
        return self.identification_signal

    @property
    def all_records(self) -> list[str]:
        """Names of all records that some job reads."""
        extra = [self.identification_signal, self.order_sweep_signal]
        extra += self.rdgpi_fit_signals if "rdgpi" in self.models else []
        return list(dict.fromkeys([*self.signals, *extra]))

    @property
    def envelopes(self) -> str:
        """Which envelope functions the GPO filter uses."""
        section = "filters" if self.dataset is None else "measured"
        return str(self.config[section]["envelopes"])

    def check_target(self, target: str) -> None:
        """Refuse a run's file that no rule makes, with the nearest name.

        Parameters
        ----------
        target : str
            What is asked of Snakemake: a rule or a file.

        Raises
        ------
        InputError
            If it is ``results/filters/<signal>/<model>`` of an unknown name.
        """
        path = Path(target)
        if path.parent.parent != Path(self.results, "filters"):
            return
        signals = self.all_records
        if self.dataset is None:
            signals = [*signals, *self.config["excitations"]]
        models = [*registry(), "rdgpi"]
        for name, known in ((path.parent.name, signals), (path.stem, models)):
            refuse_unknown(name, known, f"{target}: no {name!r}")

    @property
    def model_file(self) -> str:
        """File of the twin's model: one of the package's by name, or a path."""
        return model_files(str(self.config["twin"]["model"]))[0]

    @property
    def twin_files(self) -> list[str]:
        """Model files of all twins on which claims are judged, the twin's first."""
        return self._files_of(self.config["pressure"]["twins"])

    @property
    def constants_files(self) -> list[str]:
        """Model files of the twins on which constants are varied, the twin's first."""
        return self._files_of(self.config["constants"]["twins"])

    def _files_of(self, names: Iterable[str]) -> list[str]:
        files = [file for name in names for file in model_files(name)]
        return list(dict.fromkeys([self.model_file, *files]))

    def _of(self, section: str, *keys: str) -> dict[str, Any]:
        """Give some keys of a section."""
        return {key: self.config[section][key] for key in keys}

    def signal_job(self, name: str) -> dict[str, Any]:
        """Give a signal's definition and the common values that it takes."""
        return {
            "definition": self.config["excitations"][name],
            "common": dict(self.config["excitation"]),
        }

    @property
    def measure_job(self) -> dict[str, Any]:
        """Settings of the twin's measurement."""
        return self._of("twin", "seed", "input_zero_error", "input_noise")

    @property
    def identification_job(self) -> dict[str, Any]:
        """Settings of Algorithm 1, for as many operators as the filter has."""
        job = {**self.config["identification"], **self._of("filters", "order")}
        del job["signal"]
        return job

    def _twin_job(self, *more: str) -> dict[str, Any]:
        names = dict.fromkeys([*self.signals, *more])
        return {
            "signals": {name: self.signal_job(name) for name in names},
            "asked": self.signals,
            "measure": self.measure_job,
        }

    @property
    def twin_fits_job(self) -> dict[str, Any]:
        """Settings of what no step size changes, on all twins."""
        slow = self.identification_signal
        fitted = self.rdgpi_fit_signals if "rdgpi" in self.models else []
        return self._twin_job(slow, *fitted) | {
            "identification": self.identification_job | {"signal": slow},
            "rdgpi": self.rdgpi_job | {"fit_signals": fitted} if fitted else None,
        }

    def twin_runs_job(self, model: str) -> dict[str, Any]:
        """Give the settings of one filter on all twins."""
        sweep = self._of("order_sweep", "signal", "orders", "convergence_factor")
        return self._twin_job(sweep["signal"]) | {
            "filters": {model: self.filter_job(model)},
            "order_sweep": sweep,
            "experiments": self._experiments,
            **self.compare_job,
        }

    @property
    def _experiments(self) -> dict[str, Any]:
        """Design of the experiments in which claims are judged on each twin."""
        keys = ("members", "step_factors", "zero_factors", "noise_factors")
        return self._of("pressure", *keys)

    @property
    def twins_job(self) -> dict[str, Any]:
        """Settings of the claims on all twins."""
        return self._twin_job() | {"experiments": self._experiments}

    @property
    def random_sum_job(self) -> dict[str, Any]:
        """Settings of the draws of the random sum."""
        section = self.config["random_sum"]
        return {
            **section,
            **self.signal_job(section["signal"]),
            "measure": self.measure_job,
            "filters": self._paper_filter_jobs,
        }

    @property
    def _filter_jobs(self) -> dict[str, Any]:
        return {name: self.filter_job(name) for name in self.filters}

    @property
    def _paper_filter_jobs(self) -> dict[str, Any]:
        return {name: self.filter_job(name) for name in self.paper_filters}

    @property
    def step_sweep_job(self) -> dict[str, Any]:
        """Settings of the sweep of step sizes."""
        return {
            "filters": self._filter_jobs,
            "sweep": self.config["step_sweep"],
        }

    @property
    def constants_job(self) -> dict[str, Any]:
        """Settings of the ranking with other constants."""
        return {
            "signals": {name: self.signal_job(name) for name in self.signals},
            "measure": self.measure_job,
            "filters": self._paper_filter_jobs,
            **self._of("constants", "zero_errors", "constant_taps"),
            **self.compare_job,
        }

    @property
    def compare_job(self) -> dict[str, Any]:
        """Settings of the comparison: which signals the calibration saw."""
        return {"calibrated": list(CALIBRATION_SIGNALS)}

    @property
    def error_job(self) -> dict[str, Any]:
        """Settings of the errors of any model."""
        return self._of("filters", "transient_fraction", "smoothing_fraction")

    @property
    def rdgpi_job(self) -> dict[str, Any]:
        """Settings of the identification of the RDGPI model."""
        return self._of("rdgpi", "starts", "seed")

    @property
    def order_sweep_job(self) -> dict[str, Any]:
        """Settings of Figure 7: its orders and each filter's settings."""
        sweep = self._of("order_sweep", "orders", "convergence_factor")
        return sweep | {"filters": self._filter_jobs}

    @property
    def page_job(self) -> dict[str, Any]:
        """Settings of the front page: what its words depend on."""
        factor = self.config["order_sweep"]["convergence_factor"]
        return {
            "dataset": None if self.dataset is None else self.dataset.name,
            "order_sweep": {
                "signal": self.order_sweep_signal,
                "convergence_factor": factor,
            },
        }

    def filter_job(self, model: str) -> dict[str, Any]:
        """Give the settings on which one filter's run depends."""
        filters = self.config["filters"]
        chosen = filter_class(model)
        keys = keys_of(chosen).items()
        job = {name: filters.get(name, key.default) for name, key in keys}
        job |= self._of("filters", "order", "input_before", "constant_tap")
        job |= self.error_job
        if chosen.takes_envelopes:
            job["envelopes"] = self.envelopes
        if self.dataset is None:
            job["amplitude"] = self.config["excitation"]["amplitude"]
            job["convergence_factor"] = filters["convergence_factor"][model]
        else:
            job["fraction_of_bound"] = self.config["measured"]["fraction_of_bound"]
        return job


def read_settings(
    config: Mapping[str, Any], schema_file: str | Path, place: str = "config.yaml"
) -> Settings:
    """Check a config as a whole.

    Parameters
    ----------
    config : mapping
        What Snakemake read from config.yaml, further files and ``--config``.
    schema_file : str or Path
        The JSON Schema, as YAML.
    place : str
        Where the config comes from, for messages.

    Returns
    -------
    Settings

    Raises
    ------
    InputError
        With the first mistake found.
    """
    return Settings(config, *checked(config, schema_file, place))

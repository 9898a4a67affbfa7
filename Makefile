# Two commands do everything: `make reproduce` and `make test`.
# Both make the environment .venv first, when it is not there or is out of date.

PYTHON ?= python3.11
ifeq ($(origin CC),default)
CC := gcc
endif
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready
SOURCES := $(wildcard src/hystbench/kernels/*.c src/hystbench/kernels/*.h)

.PHONY: help reproduce test lint docs clean requirements
help:
	@echo "make reproduce  set up, run the whole pipeline, write results/report.html"
	@echo "make test       set up, check style and types, run the tests"
	@echo "make docs       fill the tables of README.md and docs/ from results/"
	@echo "make clean      remove .venv and results"

# Look first, so that what is missing is said in one line and not by a compiler.
$(READY): requirements.txt pyproject.toml setup.py $(SOURCES)
	@command -v $(PYTHON) >/dev/null || { echo "hystbench needs Python 3.11 ('$(PYTHON)' was not found; name another with PYTHON=...)" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "hystbench needs Python 3.11 or newer; '$(PYTHON)' is older" >&2; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || { echo "hystbench needs Python's venv module (on Debian: the package python3.11-venv)" >&2; exit 1; }
	@command -v $(firstword $(CC)) >/dev/null || { echo "hystbench needs a C compiler ('$(CC)' was not found; name another with CC=...)" >&2; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes -r requirements.txt
	CC="$(CC)" $(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation -e .
	touch $@

reproduce: $(READY)
	$(BIN)/snakemake --cores all
	$(BIN)/snakemake --report results/report.html

lint: $(READY)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/snakefmt --check Snakefile workflow

test: lint
	$(BIN)/pytest -n 2

docs: $(READY)
	$(BIN)/snakemake --cores all all pressure structures held_out gap
	$(BIN)/hystbench docs

# Needs pip-tools; the file names no index, so pip's own setting decides.
requirements:
	pip-compile --quiet --extra dev --generate-hashes --allow-unsafe --strip-extras \
	  --no-emit-index-url --no-emit-trusted-host --no-emit-find-links --no-header --output-file requirements.txt pyproject.toml

clean:
	rm -rf $(VENV) results .snakemake

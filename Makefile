# Two commands do everything: `make reproduce` and `make test`.
# Both make the environment .venv first, when it is not there or is out of date.

PYTHON ?= python3.11
ifeq ($(origin CC),default)
CC := gcc
endif
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/ready
PIP_INSTALL := -m pip install --quiet --disable-pip-version-check
INSTALL := $(BIN)/python $(PIP_INSTALL)
SOURCES := $(wildcard src/hystbench/kernels/*.c src/hystbench/kernels/*.h \
  src/hystbench/challenge/kernels/*.c src/hystbench/challenge/kernels/*.h)

.PHONY: help reproduce test lint style types suite docs site bench slurm test-slurm clean requirements
help:
	@echo "make reproduce  set up, run the whole pipeline, write results/report.html"
	@echo "make test       set up, check style and types, run the tests"
	@echo "make docs       fill the tables of README.md and docs/ from results/ (after test-slurm)"
	@echo "make site       set up .venv-site, write docs/ as web pages into build/site"
	@echo "make bench      measure kernels and pipeline beside their peers, fill docs/speed.md"
	@echo "make slurm      set up .venv-slurm, from which the pipeline runs on a cluster"
	@echo "make test-slurm run the pipeline through a real Slurm on this machine (Debian, root)"
	@echo "make clean      remove .venv, .venv-slurm, .venv-site, build/site and what was written to results"

# Each of hundreds of jobs would compile the package anew.
unexport PYTHONDONTWRITEBYTECODE

# Look first, so that what is missing is said in one line and not by a compiler.
$(READY): requirements.txt pyproject.toml setup.py $(SOURCES)
	@command -v $(PYTHON) >/dev/null || { echo "hystbench needs Python 3.11 ('$(PYTHON)' was not found; name another with PYTHON=...)" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "hystbench needs Python 3.11 or newer; '$(PYTHON)' is older" >&2; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || { echo "hystbench needs Python's venv module (on Debian: the package python3.11-venv)" >&2; exit 1; }
	@command -v $(firstword $(CC)) >/dev/null || { echo "hystbench needs a C compiler ('$(CC)' was not found; name another with CC=...)" >&2; exit 1; }
	test -x $(BIN)/python || $(PYTHON) -m venv $(VENV)
# Without bytecode: Python writes that of the modules that it imports, a fraction.
	$(INSTALL) --no-compile --require-hashes -r requirements.txt
	CC="$(CC)" $(INSTALL) --no-deps --no-build-isolation -e .
	touch $@

# What a benchmark needs beside that: an optional group of pyproject.toml.
$(VENV)/ready-%: requirements-%.txt $(READY)
	$(INSTALL) --require-hashes -r $<
	touch $@

# An environment of its own: Snakemake imports the cluster's plugin wherever it is
# installed, which makes every start longer.
# After .venv, which looks first and builds the kernels that all use.
.venv-%/ready: requirements-%.txt $(READY)
	test -x $(@D)/bin/python || $(PYTHON) -m venv $(@D)
	$(@D)/bin/python $(PIP_INSTALL) --require-hashes -r $<
	CC="$(CC)" $(@D)/bin/python $(PIP_INSTALL) --no-deps --no-build-isolation -e .
	touch $@

slurm: .venv-slurm/ready

# The site needs nothing of hystbench, so its environment is made without it.
.venv-site/ready: requirements-site.txt
	test -x $(@D)/bin/python || $(PYTHON) -m venv $(@D)
	$(@D)/bin/python $(PIP_INSTALL) --require-hashes -r $<
	touch $@

# Strict: a link to a page or a heading that is not there is an error.
site: .venv-site/ready
	.venv-site/bin/mkdocs build --quiet --strict

reproduce: $(READY)
	$(BIN)/snakemake --cores all

lint: style types

style: $(READY)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/lint-imports
	$(BIN)/snakefmt --check Snakefile workflow

types: $(READY)
	$(BIN)/mypy

# The longest files first; a third process runs while one waits for Snakemake.
suite: $(READY)
	$(BIN)/pytest -n 3 --dist loadfile --no-loadscope-reorder tests/pipeline tests

# A mistake of style ends it at once. Types are checked beside the tests: for most of a
# minute, on one core.
test: style
	$(MAKE) --no-print-directory -j 2 types suite

docs: $(READY)
	$(BIN)/snakemake --cores all all gap blind
# The picture is the last that the bench writes.
	test -f results/benchmarks/growth.png || $(MAKE) bench
	$(BIN)/hystbench docs

# Writes results/benchmarks/*.csv, and docs/speed.md from all of them; a quiet machine
# makes the figures worth keeping. One part alone: make bench BENCH=kernels
BENCH ?= all
bench: $(VENV)/ready-bench
	CC="$(CC)" $(BIN)/python -m benchmarks $(BENCH)
	$(if $(filter all,$(BENCH)),$(BIN)/hystbench docs docs/speed.md)

# Installs Slurm and starts its daemons for the time of the test.
test-slurm: .venv-slurm/ready
	bash profiles/slurm/test/run .venv-slurm/bin

# Needs pip-tools; the files name no index, so pip's own setting decides.
COMPILE := pip-compile --quiet --generate-hashes --allow-unsafe --strip-extras \
  --no-emit-index-url --no-emit-trusted-host --no-emit-find-links --no-header
requirements:
	$(COMPILE) --extra dev --output-file requirements.txt pyproject.toml
	for group in bench crate slurm; do $(COMPILE) --extra $$group \
	  --constraint requirements.txt --output-file requirements-$$group.txt pyproject.toml || exit 1; done
	echo 'mkdocs>=1.6,<2' | $(COMPILE) --output-file requirements-site.txt -

# Of results only what is on the lists of what hystbench wrote.
clean:
	@test ! -e results || test -x $(BIN)/hystbench || { echo "results: stays, as without $(VENV) nobody tells what hystbench wrote there; run 'make $(READY)' first, or remove it by hand" >&2; exit 1; }
	test ! -e results || $(BIN)/hystbench clean results
	rm -rf $(VENV) .venv-slurm .venv-site build/site .snakemake

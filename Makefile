# Two commands from nothing: `make demo` and `make test`. Each sets up its own environment first.

VENV ?= .venv
DEMO ?= demo
DEMO_SEED ?= 1
FAULTS ?= 200
BIN := $(VENV)/bin
READY := $(VENV)/.ready

.DEFAULT_GOAL := help
.PHONY: help setup demo reproduce test docs mutants lint audit format bench clean

help:  ## what there is to make
	@grep -hE '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

$(READY): pyproject.toml constraints.txt scripts/setup.sh
	@sh scripts/setup.sh $(VENV)
	@touch $@

setup: $(READY)  ## the virtual environment, with what the system lacks

demo: $(READY)  ## evolve a run of each condition, evaluate the champions and show them on the iCub
	@PATH="$(abspath $(BIN)):$$PATH" sh scripts/demo.sh $(DEMO) $(DEMO_SEED)

reproduce: $(READY)  ## the whole paper, from random genotypes to the report in runs/paper
	$(BIN)/wordarm reproduce

test: $(READY)  ## all tests, on all cores
	@sh scripts/browser.sh
	$(BIN)/python -m pytest -n auto --dist worksteal

docs: $(READY)  ## the documentation as a site, to be opened from disk: site/index.html
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict --quiet
	@echo "open site/index.html"

mutants: $(READY)  ## small faults put into a copy of the sources: which does no test notice?
	$(BIN)/python -m scripts.mutants --number $(FAULTS) --output mutants.csv

lint: $(READY)  ## style, types, and who imports whom
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/pyright --pythonpath $(BIN)/python
	$(BIN)/lint-imports --no-logo

audit: $(READY)  ## known vulnerabilities of the pinned packages; asks the internet
	$(BIN)/python -m venv $(VENV)/audit
	$(VENV)/audit/bin/pip install -q pip-audit
	$(VENV)/audit/bin/pip-audit --strict -r constraints.txt --no-deps --disable-pip

format: $(READY)  ## rewrite the sources in the project's style
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: $(READY)  ## what is fast, measured on this machine
	$(BIN)/python -m benchmarks.kernel
	$(BIN)/python -m benchmarks.run
	$(BIN)/python -m benchmarks.experiment
	$(BIN)/python -m benchmarks.ik
	$(BIN)/python -m benchmarks.physics
	$(BIN)/python -m benchmarks.video
	$(BIN)/python -m benchmarks.live

clean:  ## remove the environment and what the demo made
	rm -rf $(VENV) $(DEMO) site .pytest_cache .ruff_cache

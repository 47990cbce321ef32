# `make demo` shows a robot in the browser, `make test` runs all tests. Both set themselves up.
#
#   make demo ARGS='--port 9000 --no-browser'     arguments for `studio demo`
#   make test ARGS='tests/packages -k zip'        arguments for pytest
#   make demo PYTHON=python3.12                   the interpreter that .venv is made of

PYTHON ?= python3
ARGS ?=
VENV := .venv
BIN := $(VENV)/bin
PIP := $(BIN)/python -m pip --disable-pip-version-check --no-input install --quiet
TOOLS := frontend_assets/tools
PYTEST := $(BIN)/python -m pytest -n auto --maxprocesses 8 --dist loadfile --no-loadscope-reorder
# Every process of the tests would compile all modules anew.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: help demo test sweep lint style types imports spelling page bench constraints clean
.DELETE_ON_ERROR:

help:
	@sed -n 's/^\([a-z]*\):.*## /make \1	/p' Makefile

demo: $(VENV)/.runs ## open the demo rover in the browser
	@exec $(BIN)/studio demo $(ARGS)

test: $(VENV)/.tests ## run the tests
	@$(BIN)/python -m tests.support.browser || true
	@exec $(PYTEST) -m "not sweep" $(ARGS)

lint: style types imports spelling page ## check style, types, rooms and spelling

style: $(VENV)/.lints
	$(BIN)/ruff check
	$(BIN)/ruff format --check

types: $(VENV)/.lints
	$(BIN)/pyright

imports: $(VENV)/.lints
	$(BIN)/lint-imports

spelling: $(VENV)/.lints
	$(BIN)/codespell

page: $(TOOLS)/node_modules/.installed
	npm --prefix $(TOOLS) run --silent types
	npm --prefix $(TOOLS) run --silent lint
	npm --prefix $(TOOLS) run --silent test

bench: $(VENV)/.tests ## measure beside the peers
	@exec $(BIN)/python -m tests.benchmarks $(ARGS)

sweep: $(VENV)/.tests ## run the tests that repeat others over many, and 20,000 random commands
	@$(BIN)/python -m tests.support.browser || true
	@$(PYTEST) -m sweep
	@exec $(BIN)/python -m tests.support.command_sweep $(ARGS)

constraints: ## pin what a fresh environment resolves to now
	@sh -c 'set -e; fresh=$$(mktemp -d); trap "rm -rf $$fresh" EXIT; \
	  "$(PYTHON)" -m venv $$fresh/venv; \
	  $$fresh/venv/bin/python -m pip --disable-pip-version-check install --quiet -e ".[test,lint]"; \
	  $$fresh/venv/bin/python -m pip --disable-pip-version-check freeze --exclude-editable > constraints.txt'

clean: ## remove everything that was made
	rm -rf $(VENV) $(TOOLS)/node_modules dist build .pytest_cache .ruff_cache .hypothesis .import_linter_cache
	find studio tests models -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/.made:
	@command -v "$(PYTHON)" >/dev/null || { \
	  echo "There is no $(PYTHON) here: install Python 3.11 or newer, or name one with PYTHON=..." >&2; exit 1; }
	@"$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { \
	  echo "The studio needs Python 3.11 or newer and $(PYTHON) is $$("$(PYTHON)" -V 2>&1): name a newer one with PYTHON=..." >&2; exit 1; }
	@"$(PYTHON)" -c 'import ensurepip, venv' 2>/dev/null || { \
	  echo "$(PYTHON) comes without venv: install it (Debian and Ubuntu: apt install python3-venv) or name another with PYTHON=..." >&2; exit 1; }
	@$(BIN)/python -c 'import pip, sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || \
	  "$(PYTHON)" -m venv --clear $(VENV)
	@touch $@

# Each stamp is newer than what it was installed from; an editable install sees changed sources.
$(VENV)/.runs: $(VENV)/.made pyproject.toml constraints.txt
	@echo "Installing the studio into $(VENV) (the first time takes about a minute) ..." >&2
	@$(PIP) -c constraints.txt -e . >&2
	@touch $@

$(VENV)/.tests: $(VENV)/.made pyproject.toml constraints.txt
	@echo "Installing the studio and what its tests need into $(VENV) ..." >&2
	@$(PIP) -c constraints.txt -e '.[test]' >&2
	@touch $@ $(VENV)/.runs

$(VENV)/.lints: $(VENV)/.made pyproject.toml constraints.txt
	@echo "Installing the studio, its tests and its linters into $(VENV) ..." >&2
	@$(PIP) -c constraints.txt -e '.[test,lint]' >&2
	@touch $@ $(VENV)/.tests $(VENV)/.runs

$(TOOLS)/node_modules/.installed: $(TOOLS)/package.json $(TOOLS)/package-lock.json
	@command -v npm >/dev/null || { \
	  echo "Only make lint needs Node and npm, and npm is not here: install Node 20 or newer." >&2; exit 1; }
	npm --prefix $(TOOLS) ci --no-audit --no-fund --loglevel=error
	@touch $@

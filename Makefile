# Two commands set everything up on a fresh Debian or Ubuntu machine:
#   make run    render what is missing of the paper's study, then serve it
#   make test   lint, types, import rules and the whole test suite
PYTHON ?= python3
BIN := .venv/bin
STUDY ?= protocols/hielscher2025

.DEFAULT_GOAL := help
.PHONY: help setup run test lint bench lock clean

help:
	@sed -n '2,3s/^# *//p' Makefile

setup: .venv/ready

.venv/ready: requirements.lock pyproject.toml .ci/system_packages
	@.ci/system_packages runtime
	@test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-compile --require-hashes --requirement requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	@touch .venv/ready

run: setup
	@$(BIN)/study run $(STUDY)

lint: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

test: setup
	@.ci/system_packages test
	@$(MAKE) --no-print-directory lint
	$(BIN)/python -m pytest -n auto --dist loadgroup

bench: setup
	$(BIN)/python -m pip install --quiet --disable-pip-version-check -r tests/benchmarks/requirements.txt
	$(BIN)/python -m tests.benchmarks

lock:
	uv pip compile pyproject.toml --extra test --universal --python-version 3.11 --generate-hashes \
	    --no-header --no-emit-index-url --no-annotate --quiet --output-file requirements.lock

clean:
	rm -rf .venv .mypy_cache .ruff_cache .pytest_cache .import_linter_cache

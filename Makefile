# Two commands do all on a fresh machine with Python 3.11 or newer: `make demo` and `make test`.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
# Without --no-compile pip would compile every module of torch and its like, of which most are never imported: half a minute.
INSTALL := $(BIN)/python -m pip install --quiet --quiet --no-compile --disable-pip-version-check --constraint constraints.txt

# Tests start hundreds of processes. What Python compiles for them is kept, beside the libraries and not in the tree, even
# where a shell asks for none to be kept.
KEEP_BYTECODE := env -u PYTHONDONTWRITEBYTECODE PYTHONPYCACHEPREFIX=$(CURDIR)/$(VENV)/bytecode

.PHONY: demo test lint docs interop policies clean help

help:  ## list the commands
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed 's/:.*## /\t/'

demo: $(VENV)/.demo  ## fly three tasks by their controllers and one by a policy; write replays side by side, and a plot
	@$(BIN)/dq-marine demo --out demo

test: $(VENV)/.test  ## run every test; installs Chromium where it may, else skips what needs it
	@.ci/browser.sh $(BIN)/python
	@$(KEEP_BYTECODE) $(BIN)/python -m pytest --numprocesses 3 --dist loadfile --no-loadscope-reorder

lint: $(VENV)/.test  ## check style, types and the direction of imports
	@$(BIN)/ruff check .
	@$(BIN)/ruff format --check .
	@$(BIN)/mypy
	@$(BIN)/lint-imports

docs: $(VENV)/.docs  ## build the documentation site, build/site/index.html; a warning is an error
	@NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict --config-file docs/site/mkdocs.yml

interop: $(VENV)/.test  ## install what CI tests besides: TorchRL, Minari, the documentation site
	@$(INSTALL) --editable ".[render,agents,bem,dev,interop,docs]"
	@touch $(VENV)/.docs

policies: $(VENV)/.test  ## train the policies that come with the package anew, as their presets say (about an hour)
	@for name in $(notdir $(basename $(wildcard agents/presets/[A-Z]*.toml))); do \
		$(BIN)/dq-marine train --preset $$name --run runs/$$name --force && \
		$(BIN)/dq-marine export runs/$$name --out agents/shipped/$$name/$$name.onnx --episodes 200 --seed 5000000 --force \
		|| exit 1; \
	done

clean:  ## remove the virtual environment and what the commands wrote
	rm -rf $(VENV) build dist demo *.egg-info .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis

$(BIN)/python:
	@echo "dq-marine: making a virtual environment in $(VENV)"
	@$(PYTHON) -m venv $(VENV)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade "pip>=25" || true  # half the time of 23's; if need be that will do

$(VENV)/.demo: pyproject.toml constraints.txt | $(BIN)/python
	@echo "dq-marine: installing the simulator and its viewer (about a minute)"
	@$(INSTALL) --editable ".[render,deploy]"
	@touch $@

$(VENV)/.test: pyproject.toml constraints.txt | $(BIN)/python
	@echo "dq-marine: installing everything, torch included (one to three minutes)"
	@$(INSTALL) --editable ".[render,agents,bem,dev]"
	@touch $@ $(VENV)/.demo

$(VENV)/.docs: pyproject.toml constraints.txt | $(BIN)/python
	@echo "dq-marine: installing the simulator, its viewer and MkDocs (about a minute)"
	@$(INSTALL) --editable ".[docs]"
	@touch $@ $(VENV)/.demo

# make train    half-cheetah by settings=light, with its curve; make train ARGS="task=cartpole": whatever ARGS says
# make test [ARGS="-k sac"]     the library
# make test-thesis              the thesis' studies, experiments and pages
# Needs python3 >= 3.11; another one: make PYTHON=python3.12 ...

PYTHON ?= python3
WORKERS ?= 2
RUN := .venv/bin/python -m

.PHONY: setup train test test-thesis lint format pages docs lock dist clean

setup: .venv/.installed

.venv/.installed: requirements.lock pyproject.toml scripts/bootstrap.py
	@command -v $(PYTHON) >/dev/null || { echo "make: $(PYTHON) not found; Python 3.11, 3.12 or 3.13 is needed (make PYTHON=...)" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' || { echo "make: $$($(PYTHON) -V 2>&1) found; Python 3.11, 3.12 or 3.13 is needed (make PYTHON=...)" >&2; exit 1; }
	@$(PYTHON) scripts/bootstrap.py

train: setup
	$(RUN) hybrid_rl.train $(or $(ARGS),settings=light)

test: setup
	$(RUN) pytest -n $(WORKERS) --dist loadgroup tests $(ARGS)

test-thesis: setup
	$(RUN) pytest -n $(WORKERS) --dist loadgroup thesis/tests $(ARGS)

lint: setup
	$(RUN) ruff check
	$(RUN) ruff format --check
	$(RUN) pyright

format: setup
	$(RUN) ruff check --fix
	$(RUN) ruff format

# The numbers of README.md, docs and paper from the JSON of docs/results, and docs/atlas.md.
pages: setup
	$(RUN) scripts.pages

# The site in build/docs/html; make docs ARGS=fast does not run the notebooks, ARGS=links requests the external links instead.
# Sphinx is in .venv-docs; everything else is imported from .venv.
docs: setup .venv-docs/.installed
	PYTHONPATH=$(CURDIR):$$(.venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))') \
	  .venv-docs/bin/python scripts/docs.py $(ARGS)

.venv-docs/.installed: docs/requirements.lock
	$(RUN) uv venv --quiet --clear --python .venv/bin/python .venv-docs
	$(RUN) uv pip install --quiet --python .venv-docs --no-build --require-hashes -r docs/requirements.lock
	touch $@

# One lock for Python 3.11 to 3.13, Linux and macOS; JAX for the CPU. The extra docs has its own.
LOCK := $(RUN) uv pip compile --universal --python-version 3.11 --fork-strategy fewest \
  --generate-hashes --default-index https://pypi.org/simple --upgrade --custom-compile-command "make lock" --quiet
DOCS := import tomllib; print(*tomllib.load(open("pyproject.toml", "rb"))["project"]["optional-dependencies"]["docs"], sep="\n")

lock: setup
	$(LOCK) --extra dev --output-file requirements.lock pyproject.toml
	.venv/bin/python -c '$(DOCS)' | $(LOCK) --constraint requirements.lock --output-file docs/requirements.lock -

# The sdist, and the wheel that is built from it, in dist/.
dist: setup
	rm -rf dist
	$(RUN) build --no-isolation --outdir dist

clean:
	rm -rf .venv .venv-docs .cache build dist .pytest_cache .ruff_cache
	find . -name __pycache__ -prune -exec rm -rf {} +

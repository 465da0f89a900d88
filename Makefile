# make train    half-cheetah by settings=light, with its curve; make train ARGS="task=cartpole": whatever ARGS says
# make test [ARGS="-k sac"]
# Needs python3 >= 3.11; another one: make PYTHON=python3.12 ...

PYTHON ?= python3
WORKERS ?= 2
RUN := .venv/bin/python -m

.PHONY: setup train test lint format lock dist clean

setup: .venv/.installed

.venv/.installed: requirements.lock pyproject.toml scripts/bootstrap.py
	@command -v $(PYTHON) >/dev/null || { echo "make: $(PYTHON) not found; Python 3.11, 3.12 or 3.13 is needed (make PYTHON=...)" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(not (3, 11) <= sys.version_info < (3, 14))' || { echo "make: $$($(PYTHON) -V 2>&1) found; Python 3.11, 3.12 or 3.13 is needed (make PYTHON=...)" >&2; exit 1; }
	@$(PYTHON) scripts/bootstrap.py

train: setup
	$(RUN) hybrid_rl.train $(or $(ARGS),settings=light)

test: setup
	$(RUN) pytest -n $(WORKERS) --dist loadgroup $(ARGS)

lint: setup
	$(RUN) ruff check
	$(RUN) ruff format --check
	$(RUN) pyright

format: setup
	$(RUN) ruff check --fix
	$(RUN) ruff format

# One lock for Python 3.11 to 3.13, Linux and macOS; JAX for the CPU.
lock: setup
	$(RUN) uv pip compile --universal --python-version 3.11 --fork-strategy fewest \
	  --generate-hashes --extra dev --default-index https://pypi.org/simple --upgrade \
	  --custom-compile-command "make lock" --quiet --output-file requirements.lock pyproject.toml

# The sdist, and the wheel that is built from it, in dist/.
dist: setup
	rm -rf dist
	$(RUN) build --no-isolation --outdir dist

clean:
	rm -rf .venv .cache build dist .pytest_cache .ruff_cache
	find . -name __pycache__ -prune -exec rm -rf {} +

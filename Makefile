# Each target sets up .venv from the lock file by itself. PYTHON chooses the interpreter (3.11+).
PYTHON ?= python3
CORES ?= 2
DATA ?=
BIN := .venv/bin

.PHONY: run test check bench figures clean

run: .venv/ready
	$(BIN)/snakemake --cores $(CORES)

test: .venv/ready
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest

check: .venv/ready
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/snakefmt --check Snakefile workflow
	$(BIN)/snakemake --lint
	$(BIN)/codespell

bench: .venv/ready
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m bench $(if $(DATA),--data $(DATA))

figures: .venv/ready
	OPENBLAS_NUM_THREADS=1 $(BIN)/python -m bench.figures --show . --figures results/figures

clean:
	rm -rf results logs .snakemake

.venv/ready: requirements.lock pyproject.toml
	$(PYTHON) -m venv --clear .venv
	$(BIN)/pip install --quiet --require-hashes --requirement requirements.lock
	$(BIN)/pip install --quiet --no-deps --no-build-isolation --editable .
	touch $@

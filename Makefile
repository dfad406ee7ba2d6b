# rockwear: how a rock-cutting tool heats up, wears and changes its shape.
PYTHON   := /usr/bin/python3
PACKAGES := yade python3-numpy python3-scipy python3-matplotlib python3-pil python3-stl python3-pytest python3-pytest-xdist python3-pyflakes
OUT      := out
SUDO     := $(if $(filter 0,$(shell id -u)),,sudo)
TOOTH    := yade -n -x -j1 yade_scripts/tooth_cycles.py

.DEFAULT_GOAL := help
.PHONY: help setup run test validate bench campaigns campaign-wear campaign-uniaxial lint clean

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "make %-18s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

setup: ## install what is missing (Debian packages), check that YADE runs
	@if command -v dpkg-query >/dev/null && command -v apt-get >/dev/null; then \
	  missing=$$(for p in $(PACKAGES); do \
	    dpkg-query -W -f='$${db:Status-Status}' $$p 2>/dev/null | grep -qx installed || echo $$p; done); \
	  if [ -n "$$missing" ]; then \
	    if [ -n "$(SUDO)" ] && ! command -v sudo >/dev/null; then \
	      echo "setup: not root and no sudo; missing packages:" $$missing >&2; exit 1; fi; \
	    $(SUDO) apt-get update -qq && \
	    $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $$missing >/dev/null \
	      || { echo "setup: apt-get could not install:" $$missing >&2; exit 1; }; \
	  fi; \
	fi
	@command -v yade >/dev/null || { echo "setup: YADE is missing, and there is no apt-get to install it (Debian package yade)" >&2; exit 1; }
	@$(PYTHON) -c 'import numpy, scipy, matplotlib, PIL, stl, pytest, xdist' 2>/dev/null || { \
	  echo "setup: $(PYTHON) lacks one of numpy, scipy, matplotlib, PIL, stl, pytest, xdist (Debian packages python3-...)" >&2; exit 1; }
	@yade --version >/dev/null 2>&1 || { echo "setup: YADE is installed but does not start (try: yade --version)" >&2; exit 1; }

# Rock graded threefold below the cut, and wear fifteen times faster than M's factor of 7000, so that the tip goes in minutes.
run: setup ## the main job: the test tooth of M 9.2; report in out/tooth_cycles/report.html
	$(TOOTH) --grading_factor 3 --wear_acceleration 1e5 --out $(OUT)/tooth_cycles

test: setup ## all tests
	$(PYTHON) -m pytest -n 2 --dist loadscope tests

validate: setup ## long validations
	$(PYTHON) -m calibration.validation $(OUT)/validate

bench: setup ## speed against error; figures and numbers in out/bench
	$(PYTHON) -m calibration.benchmarks $(OUT)/bench

campaigns: setup ## a sweep of the test tooth over seeds, two jobs at a time
	mkdir -p $(OUT)/campaign
	yade-batch -j2 --job-threads=1 --log=$(OUT)/campaign/@.log yade_scripts/tooth_cycles.seeds.table yade_scripts/tooth_cycles.py

campaign-wear: setup ## test tooth and ripper worn over many cycles, sharp and worn compared (four hours; goes on when stopped)
	$(PYTHON) -m calibration.campaigns.wear $(OUT)/campaign-wear

campaign-uniaxial: setup ## the laboratory's laws, slopes of softening and micro-parameters (hours; goes on when stopped)
	$(PYTHON) -m calibration.campaigns.uniaxial $(OUT)/campaign-uniaxial

lint: setup ## unused names and the like
	$(PYTHON) -m pyflakes rockwear calibration yade_scripts tests

clean: ## remove results
	rm -rf $(OUT)

# rockwear: how a rock-cutting tool heats up, wears and changes its shape.
PYTHON  := /usr/bin/python3
OUT     := out
SUDO    := $(if $(filter 0,$(shell id -u)),,sudo)

TO_READ := python3-numpy python3-scipy python3-numba python3-matplotlib python3-pil python3-stl
TO_RUN  := yade
TO_SWEEP := python3-distributed
TO_TEST := python3-pytest python3-pytest-xdist $(TO_SWEEP)
TO_LINT := python3-flake8

.DEFAULT_GOAL := help
.PHONY: help setup-python setup setup-sweep setup-test run test test-kernels validate bench fidelity campaigns \
        campaign-wear campaign-uniaxial campaign-grains campaign-rocks campaign-steady campaign-worn campaign-granular \
        campaign-slow campaign-toughness campaign-groove campaign-dredging lint clean

# $(call install,packages,modules): the missing packages, where there is apt-get; then each module must be found.
define install
@if command -v apt-get >/dev/null && command -v dpkg-query >/dev/null; then \
  missing=$$(for p in $(1); do \
    dpkg-query -W -f='$${db:Status-Status}' $$p 2>/dev/null | grep -qx installed || echo $$p; done); \
  if [ -n "$$missing" ]; then \
    [ -z "$(SUDO)" ] || command -v sudo >/dev/null || \
      { echo "setup: not root and no sudo; missing packages:" $$missing >&2; exit 1; }; \
    $(SUDO) apt-get update -qq && \
    $(SUDO) env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $$missing >/dev/null || \
      { echo "setup: apt-get could not install:" $$missing >&2; exit 1; }; \
  fi; \
fi
@for module in $(2); do $(PYTHON) -c "import $$module" 2>/dev/null || \
  { echo "setup: $(PYTHON) cannot import $$module; the Debian packages are: $(1)" >&2; exit 1; }; done
endef

help: ## list the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / {printf "make %-18s %s\n", $$1, $$2}' $(MAKEFILE_LIST)

setup-python:
	$(call install,$(TO_READ),numpy scipy numba matplotlib PIL stl)

setup: setup-python ## install what a run needs (Debian packages) and check that YADE starts
	$(call install,$(TO_RUN),numpy)
	@yade --version >/dev/null 2>&1 || \
	  { echo "setup: YADE is missing or does not start (try: yade --version)" >&2; exit 1; }

setup-sweep: setup ## what many runs at once need too: fits, campaigns and sweeps, here or on a cluster
	$(call install,$(TO_SWEEP),distributed)

setup-test: setup
	$(call install,$(TO_TEST),pytest xdist distributed)

# Wear is accelerated so that the tip wears away within a cut of 50 mm instead of tens of metres.
run: setup ## cut a sandstone steadily, the tip wearing; report in out/steady_cut/report.html
	yade -n -x -j1 yade_scripts/steady_cut.py --depth_of_cut 2e-3 --tip_radius 2e-4 --cut_length 0.05 --velocity 8 \
	  --heat true --wear_acceleration 200 --out "$(OUT)/steady_cut"

test: setup-test ## all tests
	$(PYTHON) -m pytest -n 2 --dist loadscope tests

test-kernels: setup-python ## the tests of the physics without YADE
	$(call install,$(TO_TEST),pytest xdist)
	$(PYTHON) -m pytest -n 2 tests/kernels

validate: setup-sweep ## compare with exact solutions and the sources' numbers; page in out/validate
	$(PYTHON) -m calibration.validation "$(OUT)/validate"

bench: setup-sweep ## speed against error; figures and numbers in out/bench
	$(PYTHON) -m calibration.benchmarks "$(OUT)/bench"

fidelity: setup-python ## every published number beside ours, from stored results; page calibration/results/fidelity.md
	$(PYTHON) -m calibration.fidelity

# Each of these runs on a cluster, too: make campaign-steady SCHEDULER=tcp://HOST:PORT
WHERE := $(if $(SCHEDULER),--scheduler $(SCHEDULER))

campaigns: setup-sweep ## the test tooth in four packings, two runs at a time; page in out/campaign/sweep.html
	$(PYTHON) -m calibration.sweep yade_scripts/tooth_cycles.seeds.table yade_scripts/tooth_cycles.py \
	  --out "$(OUT)/campaign" $(WHERE)

campaign-wear: setup-sweep ## test tooth and ripper worn over many cycles (hours; resumes)
	$(PYTHON) -m calibration.campaigns.wear "$(OUT)/campaign-wear" $(WHERE)

campaign-uniaxial: setup-sweep ## the laboratory: bond laws, softening slopes, micro-parameters (hours; resumes)
	$(PYTHON) -m calibration.campaigns.uniaxial "$(OUT)/campaign-uniaxial" $(WHERE)

campaign-grains: setup-sweep ## the Hawkesbury sandstone of grains, and what its strength depends on (hours; resumes)
	$(PYTHON) -m calibration.campaigns.grains "$(OUT)/campaign-grains" $(WHERE)

campaign-rocks: setup-sweep ## what bond laws and rock properties do to a rock, at three resolutions (hours; resumes)
	$(PYTHON) -m calibration.campaigns.rock_laws "$(OUT)/campaign-rocks" $(WHERE)

campaign-steady: setup-sweep ## what makes a steady cut what it is, one cause at a time (hours; resumes)
	$(PYTHON) -m calibration.campaigns.steady_cut "$(OUT)/campaign-steady" $(WHERE)

campaign-worn: setup-sweep ## a tool worn by its own cut, and how it cuts then (an hour and a half; resumes)
	$(PYTHON) -m calibration.campaigns.sharp_and_worn "$(OUT)/campaign-worn" $(WHERE)

campaign-granular: setup-sweep ## angle of repose and vibrated tube (an hour; resumes)
	$(PYTHON) -m calibration.campaigns.granular "$(OUT)/campaign-granular" $(WHERE)

campaign-slow: setup-sweep ## cuts at 8 m/s down to the 0.04 of their source (hours; resumes); FULL=--full: all 40 mm slowly
	$(PYTHON) -m calibration.campaigns.slow "$(OUT)/campaign-slow" $(FULL) $(WHERE)

campaign-toughness: setup-sweep ## toughness of four rocks over the size of the specimen (an hour; resumes)
	$(PYTHON) -m calibration.campaigns.toughness_size "$(OUT)/campaign-toughness" $(WHERE)

campaign-groove: setup-sweep ## cuts in space by tools of three breadths: what their sides add (three hours; resumes)
	$(PYTHON) -m calibration.campaigns.groove "$(OUT)/campaign-groove" $(WHERE)

campaign-dredging: setup-sweep ## three turns of a dredge pick at the sources' discs, and their errors (hours; resumes)
	$(PYTHON) -m calibration.campaigns.dredging "$(OUT)/campaign-dredging" $(WHERE)

lint: ## check the code with flake8
	$(call install,$(TO_LINT),flake8)
	$(PYTHON) -m flake8

clean: ## remove results
	rm -rf -- "$(OUT)"

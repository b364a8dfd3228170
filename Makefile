# Set-up, build and checks in one place; everything it makes is under build/ in the checkout.
SHELL := bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
.DELETE_ON_ERROR:
.NOTPARALLEL:

VENV := build/venv
BIN := $(VENV)/bin
JOBS := $(shell nproc 2>/dev/null || echo 2)

export PIP_CACHE_DIR := $(CURDIR)/build/cache/pip
export PIP_DISABLE_PIP_VERSION_CHECK := 1
export PIP_REQUIRE_VIRTUALENV := 1
# empty: Python keeps what it compiles, for the many processes that the tests start
export PYTHONDONTWRITEBYTECODE :=
export CMAKE_BUILD_PARALLEL_LEVEL := $(JOBS)
export CTEST_PARALLEL_LEVEL := $(JOBS)
# the transforms of the Python package: eigen, or fftw, which puts it under the GPL
FFT ?= eigen
export RAILPATCH_FFT := $(FFT)
# of what pip says, what it does
NEWS := sed -u '/^Requirement already satisfied/d'
export NINJA_STATUS := [%f/%t, %e s] # files done of how many
# a cmake from the virtual environment, where the system's is too old, comes first
export PATH := $(CURDIR)/$(BIN):$(PATH)
# what was compiled before is taken from here, where there is ccache
ifneq ($(shell command -v ccache),)
export CCACHE_DIR ?= $(CURDIR)/build/cache/ccache
export CMAKE_C_COMPILER_LAUNCHER ?= ccache
export CMAKE_CXX_COMPILER_LAUNCHER ?= ccache
# it keeps what was compiled with precompiled headers too
export CCACHE_SLOPPINESS ?= pch_defines,time_macros
endif

# the FMU's functions are among the C++ tests; the FMI headers come with fmpy in this environment
FMU := -DRAILPATCH_FMU=ON -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python
# where the FMU's library with FFTW is put, which is under the GPL and in no package
FMU_FFTW := build/fmu_fftw
# one build has the C++ tests, the program of `make pruning` and what the Python package is made of,
# whose transforms may be others
RELEASE := $(FMU) -DRAILPATCH_CONTACT_ADDON=ON -DRAILPATCH_TESTS=ON -DRAILPATCH_PRUNING=ON -DRAILPATCH_PCH=ON -DRAILPATCH_UNITY=ON
PACKAGE := --config-settings=build-dir=build/release $(addprefix --config-settings=cmake.define., \
	RAILPATCH_PYTHON=ON RAILPATCH_FMU=ON RAILPATCH_WERROR=ON RAILPATCH_PCH=ON RAILPATCH_UNITY=ON)
CXX_FILES = $(shell find core plugins tests -name '*.[ch]' -o -name '*.[ch]pp')
# what the installed package is made from
SOURCES := $(shell find core plugins rig_model wheelset_demo -type f -not -name '*.pyc' 2>/dev/null) \
	CMakeLists.txt README.md

.PHONY: help tools asan-core build-asan demo docs book pages viewer fmu fmu-clients fmu-fftw contact-addon wheels smoke release test test-long bits lint format clean setup \
	system test-cpp test-python test-asan pruning mutants bits-steps

help: ## this list
	@echo "make targets:"
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  \1\t\2/p' $(MAKEFILE_LIST) | expand -t 16

demo: setup ## set-up, roller-rig replay, wheelset on track, an FMU; a page with links to all
	@mkdir -p build/demo
	$(BIN)/railpatch rig -o build/demo/run.mcap
	$(BIN)/railpatch report build/demo/run.mcap -o build/demo/report.html
	$(BIN)/railpatch wheelset -o build/demo/wheelset.mcap
	$(BIN)/railpatch report build/demo/wheelset.mcap -o build/demo/wheelset.html
	$(BIN)/railpatch fmu -o build/demo/railpatch.fmu
	$(BIN)/python -m railpatch.fmu.try_out build/demo/railpatch.fmu
	@$(BIN)/python -m railpatch.fmu.demo_page build/demo docs/frontier.svg >/dev/null
	@printf '\nOpen this page: pictures of all of it, with links to the reports:\n  %s\n' \
		"file://$(CURDIR)/build/demo/index.html"

fmu: setup fmu-fftw ## FMUs (FMI 2, 3) of the default scene and each kind for Linux, ARM, Windows; one with FFTW (GPL)
	@mkdir -p build/fmu
	$(BIN)/python -m pip install --quiet --group cross
	$(BIN)/python plugins/fmu/cross/build.py build/fmu
	$(BIN)/railpatch fmu --libraries build/fmu/lib -o build/fmu/railpatch.fmu
	$(BIN)/railpatch fmu --fft fftw --libraries $(FMU_FFTW)/railpatch/fmu/lib -o build/fmu/railpatch_fftw_gpl.fmu
	$(BIN)/python plugins/fmu/cross/check.py build/fmu/railpatch.fmu build/fmu/check --compile
	@kinds="$$($(BIN)/python -c 'from railpatch.fmu.scenes import kinds; print(*kinds())')"; \
	for kind in $$kinds; do \
		$(BIN)/railpatch fmu --scene $$kind --libraries build/fmu/lib -o build/fmu/$$kind.fmu; \
		$(BIN)/railpatch fmu --scene $$kind --fmi 3 --libraries build/fmu/lib -o build/fmu/$${kind}_fmi3.fmu; \
		$(BIN)/python plugins/fmu/cross/check.py build/fmu/$$kind.fmu build/fmu/check; \
		$(BIN)/python plugins/fmu/cross/check.py build/fmu/$${kind}_fmi3.fmu build/fmu/check; \
	done
	$(BIN)/python tests/bits/systems.py build/fmu

fmu-fftw: setup ## the FMU's library with FFTW, for `railpatch fmu --fft fftw --libraries`
	cmake --preset release $(RELEASE)
	cmake --build --preset release --target railpatch_fmu
	cmake --install build/release --component fmu --prefix $(FMU_FFTW)
	$(BIN)/python -c 'from railpatch.fmu.libraries import stamp; print(stamp())' \
		> $(FMU_FFTW)/railpatch/fmu/lib/stamp.txt

fmu-clients: fmu ## the same in clients that others wrote: fmpy, fmuloader, libcosimpy, ecospy, FMI4j, VDMCheck2
	plugins/fmu/clients/run build/fmu/clients $$(ls build/fmu/*.fmu | grep -v gpl)

contact-addon: setup ## the library with the calls of the program CONTACT, for Linux and Windows, in build/contact_addon
	@mkdir -p build/contact_addon
	$(BIN)/python -m pip install --quiet --group cross
	$(BIN)/python plugins/contact_addon/build.py build/fmu build/contact_addon
	$(BIN)/python tests/contact_addon/systems.py build/contact_addon

wheels: fmu ## wheels for Linux and Windows, their checks, and a first hour's work in a clean environment
	@.ci/system-packages mvn:maven readelf:binutils
	$(BIN)/python -m pip install --quiet --group wheels
	$(BIN)/python plugins/python_mbs/wheels/make_wheels.py build/fmu build/wheels
	$(BIN)/python plugins/python_mbs/wheels/check_wheels.py build/wheels
	$(BIN)/python plugins/python_mbs/wheels/smoke.py build/wheels build/wheels/tried

# NAMES: of the environments that plugins/python_mbs/wheels/environments.py lists; all that can be made
NAMES ?=
smoke: ## the wheels of `make wheels` in many environments; Debian's need root and debootstrap, Windows' Wine
	$(BIN)/python plugins/python_mbs/wheels/environments.py build/wheels build/smoke $(NAMES)

release: wheels ## build/release-files: wheels, source archive, FMUs, checksums, bill of materials
	rm -rf build/release-files && mkdir -p build/release-files
	@# of the files that git knows: not of what lies below build/, which takes minutes to walk through
	rm -rf build/source && mkdir -p build/source
	git ls-files -z | tar -c --null -T - | tar -x -C build/source
	$(BIN)/python -m build --sdist --outdir build/release-files build/source
	cp build/wheels/*.whl build/release-files
	cp $$(ls build/fmu/*.fmu | grep -v gpl) build/release-files
	$(BIN)/python plugins/python_mbs/wheels/bill.py build/release-files
	cd build/release-files && sha256sum $$(ls | grep -v SHA256SUMS) > SHA256SUMS

docs: setup ## the documentation's site in build/site: tutorials, guides, reference, book; readable without a network
	$(BIN)/python -m pip install --quiet --group docs
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict --quiet
	@echo "build/site/index.html"

book: setup ## runs the claims of the book that are quick and shows them in build/site/book.html
	@mkdir -p build
	cd docs && ../$(BIN)/python -m making.book ../build/book.json
	@$(MAKE) --no-print-directory docs

# every kind of page in a browser: no error, no text over text, light, dark, phone, print
pages: setup ## pages in Chromium: layout, colours, errors, pictures, PDF; some minutes
	@.ci/system-packages chromium
	@mkdir -p build/pages build/junit
	$(BIN)/python tests/pages/make.py build/pages
	$(PYTEST) tests/pages -m browser --junit-xml=build/junit/pages.xml

viewer: demo ## the demo's logs in a viewer that others wrote, a picture of each; 250 MB of npm packages
	@.ci/system-packages npm chromium
	@mkdir -p build/viewer
	$(BIN)/railpatch vehicle --method fastsim --duration 4 -o build/viewer/vehicle.mcap
	tests/viewer/run build/viewer $(BIN)/railpatch build/demo/run.mcap 90 build/demo/wheelset.mcap 1.5 \
		build/viewer/vehicle.mcap 3

PARTS := system tools setup lint test-python test-cpp test-asan pruning
test: ## set-up and every check; what each part and the slowest tests took
	@rm -f build/junit/parts
	@# what the sanitizers run on is compiled beside, where a processor would wait: first the core,
	@# which needs nothing of the virtual environment; the objects of the C++ tests serve both builds
	@core=; beside=; trap 'kill -- -$$core -$$beside 2>/dev/null || true' EXIT; \
	for part in $(PARTS); do \
		if [ $$part = tools ]; then \
			set -m; \
			nice -n 19 .ci/part build/junit/parts 'asan core, beside' \
				$(MAKE) --no-print-directory asan-core >build/asan.log 2>&1 & core=$$!; \
			set +m; \
		fi; \
		if [ $$part = setup ]; then \
			set -m; \
			{ tail --pid=$$core -f /dev/null; \
				exec nice -n 19 .ci/part build/junit/parts 'asan build, beside' \
				$(MAKE) --no-print-directory build-asan; } >>build/asan.log 2>&1 & beside=$$!; \
			set +m; \
		fi; \
		if [ $$part = test-cpp ]; then \
			.ci/part build/junit/parts 'waiting for it' tail --pid=$$beside -f /dev/null; core=; beside=; \
		fi; \
		.ci/part build/junit/parts $$part $(MAKE) --no-print-directory $$part \
			OBJECTS=$(CURDIR)/build/asan; \
	done
	@printf '\nall checks passed:\n'
	@$(BIN)/python .ci/summary.py build/junit/parts $(addprefix build/junit/,cpp.xml python.xml asan.xml)

# solves cases by the C interface: tests/bits; the library that tests/contact_addon links with
bits-steps: $(VENV)/tools
	cmake --preset release $(RELEASE)
	cmake --build --preset release --target bits_steps contact_addon

bits: setup bits-steps ## the same bits on three emulated processors, of which `make test` runs none
	@.ci/system-packages qemu-x86_64:qemu-user
	$(BIN)/python -m pytest -q -m long tests/bits

test-long: setup bits-steps ## what is slow by nature, before a release: hours
	@.ci/system-packages qemu-x86_64:qemu-user gfortran
	@mkdir -p build/junit
	$(PYTEST) -m long --junit-xml=build/junit/long.xml
	@$(MAKE) --no-print-directory mutants

tools: $(VENV)/tools

setup: $(VENV)/installed ## system packages, virtual environment, package; FFT=fftw: with FFTW, under the GPL

lint: $(VENV)/tools ## ruff and clang-format, nothing is changed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	@echo clang-format; $(BIN)/clang-format --dry-run --Werror $(CXX_FILES)

format: $(VENV)/tools ## ruff and clang-format, files are changed
	$(BIN)/ruff check --fix-only .
	$(BIN)/ruff format .
	@echo clang-format; $(BIN)/clang-format -i $(CXX_FILES)

# the build whose objects of the tests are linked, which `make test` has compiled for the sanitizers
OBJECTS ?=
test-cpp: $(VENV)/tools $(if $(OBJECTS),build-asan) ## C and C++ tests, release build
	cmake --preset release $(RELEASE) -DRAILPATCH_TEST_OBJECTS=$(OBJECTS)
	cmake --build --preset release
	@mkdir -p build/junit
	ctest --preset release --output-junit "$(CURDIR)/build/junit/cpp.xml"

# a cmake that is too old for it is left to build-asan, for which there is another by then
asan-core:
	cmake --preset asan -DRAILPATCH_FMU=OFF && cmake --build --preset asan --target railpatch_static || true

build-asan: $(VENV)/tools
	cmake --preset asan $(FMU)
	cmake --build --preset asan

test-asan: build-asan ## the same with Eigen's transforms, address and undefined-behaviour sanitizers
	@mkdir -p build/junit
	ctest --preset asan --output-junit "$(CURDIR)/build/junit/asan.xml"

# each process has a half of the tests, in their order; the first at its end takes from the other
PYTEST := $(BIN)/python -m pytest --numprocesses=$(JOBS) --dist=worksteal
test-python: setup fmu-fftw bits-steps ## pytest, against the installed package
	@.ci/system-packages gfortran readelf:binutils
	@mkdir -p build/junit
	$(PYTEST) --junit-xml=build/junit/python.xml

pruning: $(VENV)/tools ## what plain cases pay for physics that they leave out, and for the FMU
	@.ci/system-packages valgrind
	cmake --preset release $(RELEASE)
	cmake --build --preset release --target pruning_steps fmu_overhead contact_addon_cost
	cmake -S . -B build/pruning -G Ninja -DCMAKE_BUILD_TYPE=Release -DRAILPATCH_TESTS=OFF \
		-DRAILPATCH_PRUNING=ON -DRAILPATCH_PHYSICS=OFF -DRAILPATCH_PCH=ON -DRAILPATCH_UNITY=ON
	cmake --build build/pruning --target pruning_steps
	$(BIN)/python tests/pruning/compare.py build/{release,pruning}/tests/pruning/pruning_steps
	$(BIN)/python tests/fmu/overhead.py build/release/tests/fmu_overhead
	$(BIN)/python tests/contact_addon/cost.py build/release/tests/contact_addon_cost

SEEDS ?= 1 2
COUNT ?= 300
mutants: setup ## do the tests bite? COUNT one-token changes of the core for each of SEEDS; takes hours
	$(BIN)/python tests/mutants/run.py --seeds $(SEEDS) --count $(COUNT) --jobs $(JOBS)

clean: ## removes build/
	rm -rf build

system:
	@.ci/system-packages

# pip 25.1 is the first that reads [dependency-groups]
$(VENV)/tools: pyproject.toml | system
	@if ! $(BIN)/python -c '' 2>/dev/null; then \
		echo "virtual environment in $(VENV)"; \
		rm -rf $(VENV) build/release; \
		"$$(.ci/python)" -m venv $(VENV); \
	fi
	$(BIN)/python -m pip install --quiet --upgrade 'pip>=25.1'
	@echo "tools of the build and of the checks"
	$(BIN)/python -m pip install --group dev | $(NEWS)
	@if ! cmake --version | awk 'NR == 1 { split($$3, v, "."); exit !(v[1] * 100 + v[2] >= 325) }'; then \
		$(BIN)/python -m pip install --quiet 'cmake>=3.25'; \
	fi
	@touch $@

# another FFT library is another package
$(VENV)/fft-$(FFT): | $(VENV)/tools
	@rm -f $(VENV)/fft-*
	@touch $@

# C++ parts are rebuilt incrementally in build/release; verbose: pip shows what cmake and ninja say;
# Python compiles what it imports, at the first time, which of all these packages is a small part
$(VENV)/installed: $(VENV)/tools $(VENV)/fft-$(FFT) $(SOURCES)
	$(BIN)/python -m pip install --verbose --no-compile --no-build-isolation $(PACKAGE) '.[test]' | $(NEWS)
	@touch $@

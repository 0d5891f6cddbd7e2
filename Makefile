# What people and CI run. Each target installs the Debian packages it needs, if any is missing.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help
JOBS ?= $(shell nproc)
# Clones of the project in different folders share what ccache keeps.
export CCACHE_BASEDIR := $(CURDIR)
export CCACHE_NOHASHDIR := true
KICAD ?=  # make bench: folder with the models of Debian's kicad-packages3d
CMAKE_ARGS ?=  # more arguments for CMake, such as -DINSYM_WARNINGS_AS_ERRORS=OFF

.PHONY: help
help: ## List the targets
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "make %-14s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

.PHONY: packages-build packages-test packages-bench packages-docs packages-lint
packages-build:
	@scripts/install_packages.sh build
packages-test:
	@scripts/install_packages.sh build test docs
packages-bench:
	@scripts/install_packages.sh build test bench
packages-docs:
	@scripts/install_packages.sh build docs
packages-lint:
	@scripts/install_packages.sh build lint

# $(call build,PRESET,TARGET)
build = cmake --preset $(1) $(CMAKE_ARGS) >/dev/null && cmake --build --preset $(1) --parallel $(JOBS) --target $(2)

.PHONY: build
build: packages-build ## Build the program build/insym
	@$(call build,release,insym_app)

.PHONY: demo
demo: build ## Find the symmetries of examples/flange.step
	@mkdir -p build/demo
	build/insym detect examples/flange.step --json build/demo/flange.json --html build/demo/flange.html \
	  --png build/demo/flange.png | tee build/demo/flange.txt
	@echo; echo "Files written:"; ls build/demo/* | sed 's/^/  /'

.PHONY: test
test: packages-test ## Build and run all tests
	@$(call build,release,all)
	@ctest --preset release --parallel $(JOBS)

.PHONY: package-test
package-test: packages-test ## Install into a scratch folder and build programs that use the package
	@$(call build,release,all)
	@ctest --preset release --parallel $(JOBS) --label-regex '^package$$'

.PHONY: sanitize
sanitize: sanitize-asan sanitize-tsan ## Run all tests with the address, undefined-behaviour and thread sanitizers

.PHONY: sanitize-asan sanitize-tsan
sanitize-asan sanitize-tsan: sanitize-%: packages-test
	@$(call build,$*,all)
	@ctest --preset $* --parallel $(JOBS)

.PHONY: sanitize-memory
sanitize-memory: packages-test ## Run tests of the core with the address and undefined-behaviour sanitizers: a part of sanitize-asan, for CI
	@$(call build,asan,insym_unit_tests insym_property_errors insym_property_groups insym_property_robust)
	build-asan/tests/unit/insym_unit_tests
	@for name in errors groups robust; do build-asan/tests/property/insym_property_$$name || exit 1; done

.PHONY: sanitize-threads
sanitize-threads: packages-test ## Run the tests of what runs in parallel with the thread sanitizer: a part of sanitize-tsan, for CI
	@$(call build,tsan,insym_property_run insym_property_pairs)
	TSAN_OPTIONS=suppressions=$(CURDIR)/cmake/tsan_suppressions.txt build-tsan/tests/property/insym_property_run
	TSAN_OPTIONS=suppressions=$(CURDIR)/cmake/tsan_suppressions.txt build-tsan/tests/property/insym_property_pairs

.PHONY: bench
bench: packages-bench ## Time the stages, and the program against its targets; write docs/performance.md
	@$(call build,release,insym_app insym_bench)
	build/bench/insym_bench
	/usr/bin/python3 bench/run_bench.py
	/usr/bin/python3 bench/run_performance.py $(if $(KICAD),--kicad $(KICAD))

.PHONY: page
page: packages-test ## Build the page of --html anew, after a change in viewer/
	@tests/browser/modules.py viewer build/viewer
	@tests/browser/bundle_is_current.py viewer build/viewer --update

.PHONY: pictures
pictures: build packages-test ## Make the pictures of the documentation anew
	@tests/browser/modules.py viewer build/viewer
	@scripts/make_pictures.sh build/insym build/viewer

.PHONY: docs
docs: packages-docs ## Build the documentation in build/docs
	@mkdocs build --quiet --strict --site-dir $(CURDIR)/build/docs

.PHONY: format
format: packages-lint ## Format the C++ sources
	@scripts/lint.sh --fix

.PHONY: lint
lint: packages-lint ## Check format, clang-tidy, compiler warnings and shell scripts
	@$(call build,release,all)
	@scripts/lint.sh

.PHONY: clean
clean: ## Remove everything that was built
	rm -rf build build-debug build-asan build-tsan

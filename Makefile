# The commands that people type. The build itself is CMake's: cmake --preset release && cmake --build --preset release

.PHONY: run build test test-all bench docs format clean
JOBS ?= $(shell nproc)
OUT ?= out
CTEST = ctest --no-tests=error --output-on-failure -j $(JOBS)

## Installs what is missing, builds, runs the thesis's experiments at the smallest scale.
run:
	@scripts/install_packages.sh build
	@$(MAKE) --no-print-directory build
	@build/runner configs/thesis/*.xml scale:=ci --out $(OUT)

## The runner alone, in build/.
build:
	@scripts/build.sh release $(JOBS) runner

## Installs what is missing, builds, runs all tests that need only the core packages.
test:
	@scripts/install_packages.sh test
	@scripts/build.sh release $(JOBS)
	@$(CTEST) --test-dir build -LE slow

## Everything else: formatting, the second compiler with sanitizers, clang-tidy, long tests.
test-all:
	@scripts/install_packages.sh test-all
	@scripts/check_format.sh
	@scripts/build.sh release $(JOBS)
	@scripts/test_sanitizers.sh $(JOBS)
	@scripts/check_tidy.sh $(JOBS)
	@$(CTEST) --test-dir build -L slow

## Benchmarks (Google Benchmark).
bench:
	@scripts/install_packages.sh bench
	@scripts/build.sh bench $(JOBS) benchmarks
	@build/benchmarks

## Rewrites what is generated from the components' declarations: docs/manual.
docs: build
	@build/runner manual docs/manual

format:
	@git ls-files '*.cpp' '*.h' | xargs clang-format -i

clean:
	@rm -rf build build-asan build-tsan build-dev build-tidy

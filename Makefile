# The commands that people type. The build itself is CMake's: cmake --preset release && cmake --build --preset release

.PHONY: run build test test-all bench docs format clean
JOBS ?= $(shell nproc)
OUT ?= out
CTEST = ctest --output-on-failure -j $(JOBS)

## Installs what is missing, builds, runs the thesis's experiments at the smallest scale.
run:
	@scripts/install_packages.sh build
	@$(MAKE) --no-print-directory build
	@build/runner configs/thesis/*.xml scale:=ci --out $(OUT)

## The runner alone, in build/.
build:
	@cmake --preset release --log-level=WARNING
	@cmake --build build -j $(JOBS) --target runner

## Installs what is missing, builds, runs all tests that need only the core packages.
test:
	@scripts/install_packages.sh test
	@cmake --preset release --log-level=WARNING
	@cmake --build build -j $(JOBS)
	@$(CTEST) --test-dir build -LE slow

## Everything else: formatting, sanitizers, warnings of the second compiler, long tests.
test-all:
	@scripts/install_packages.sh test-all
	@scripts/check_format.sh
	@cmake --preset release --log-level=WARNING
	@cmake --build build -j $(JOBS)
	@$(CTEST) --test-dir build -L slow
	@scripts/test_sanitizers.sh $(JOBS)
	@scripts/test_clang.sh $(JOBS)

## Benchmarks (Google Benchmark).
bench:
	@scripts/install_packages.sh bench
	@cmake --preset release -DCOPPICE_BENCHMARKS=ON --log-level=WARNING
	@cmake --build build -j $(JOBS) --target benchmarks
	@build/benchmarks

## Rewrites what is generated from the components' declarations: docs/manual.
docs: build
	@build/runner manual docs/manual

format:
	@git ls-files '*.cpp' '*.h' | xargs clang-format -i

clean:
	@rm -rf build build-asan build-tsan build-clang build-dev

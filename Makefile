# The commands. Each installs the packages it needs (Debian, Ubuntu) and builds what has changed.
#
#   make                          build, and render the first picture
#   make render SCENE=file.pbrt   render another scene; OUT=picture.png, ARGS="--spp 16" if wanted
#   make test                     build, and run every test
#   make check                    format, layers, style
#   make install PREFIX=/usr/local

SCENE ?= scenes/whitted-spheres.pbrt
OUT ?= $(patsubst %.pbrt,%,$(patsubst %.gz,%,$(notdir $(SCENE)))).png
ARGS ?=
PREFIX ?= /usr/local
# For make sanitize, tsan: which tests, as ctest takes it (TESTS="-LE slow").
TESTS ?=

.PHONY: all render program build test check format sanitize tsan coverage tidy clang bench performance performance-page validate ablations install clean
.NOTPARALLEL:

all: render

render: program
	@echo "Rendering $(SCENE)"
	@build/bin/alhazen render "$(SCENE)" -o "$(OUT)" --show $(ARGS)
	@echo "The picture is $(abspath $(OUT))"

# The program without the tests, which need more packages.
program:
	@tools/install_packages build
	@test -f build/build.ninja || cmake --preset release -DALHAZEN_TESTS=OFF
	@cmake --build --preset release --target alhazen

build:
	@tools/install_packages build test
	@grep -qs ALHAZEN_TESTS:BOOL=ON build/CMakeCache.txt && test -f build/build.ninja || \
		cmake --preset release -DALHAZEN_TESTS=ON
	@cmake --build --preset release

test: build
	ctest --preset release

check:
	@tools/install_packages test format
	tools/check_format
	tools/check_layers
	tools/check_style

format:
	@tools/install_packages format
	tools/check_format --fix

# $(call with_preset,NAME): builds and tests in a folder of its own.
define with_preset
	@test -f build-$(1)/build.ninja || cmake --preset $(1)
	@cmake --build --preset $(1)
	ctest --preset $(1) $(TESTS)
endef

sanitize:
	@tools/install_packages build test
	$(call with_preset,sanitize)

tsan:
	@tools/install_packages build test
	$(call with_preset,tsan)

clang:
	@tools/install_packages build test clang
	$(call with_preset,clang)

coverage:
	@tools/install_packages build test coverage
	@find build-coverage -name '*.gcda' -delete 2>/dev/null || true
	$(call with_preset,coverage)
	gcovr --root . --object-directory build-coverage --filter src/ --sort-percentage --print-summary

tidy:
	@tools/install_packages build clang tidy
	@test -f build-tidy/build.ninja || cmake --preset tidy
	# Not the two files that are another project's headers, mostly.
	run-clang-tidy-16 -quiet -p build-tidy '/src/(?!image/stb\.cpp|formats/grids/nanovdb\.cpp).*\.cpp$$'

# A short set; see benchmarks/accel. BENCH="--mesh hair --repeat 9" for others.
BENCH ?= --short --rays 50000 --repeat 3 scenes/materials.pbrt --json bench.json
bench:
	@tools/install_packages build bench
	@test -f build/build.ninja || cmake --preset release -DALHAZEN_TESTS=OFF
	@cmake -S . -B build >/dev/null
	@cmake --build --preset release --target bench_accel
	build/bin/bench_accel $(BENCH)

# All of it, with the records and figures of docs/performance.md; and the figures alone, from the records.
performance: BENCH = --json docs/performance.json --repeat 5 $(wildcard scenes/*.pbrt)
performance: bench performance-page

performance-page:
	@test -x build/bin/bench_accel || $(MAKE) bench BENCH=--help
	build/bin/bench_accel --from docs/performance.json --page docs/performance.md

# Renders the scenes beside the checkout that have reference images and compares. VALIDATE="--only coffee --minutes 2"
VALIDATE ?=
validate:
	@tools/install_packages build
	@test -f build/build.ninja || cmake --preset release -DALHAZEN_TESTS=OFF
	@cmake -S . -B build >/dev/null
	@cmake --build --preset release --target validate
	build/bin/validate --page docs/validation.md $(VALIDATE)

# What each choice of the path tracer is worth at equal time, for docs/performance.md. ABLATIONS="--only coffee"
ablations:
	@tools/install_packages build
	@test -f build/build.ninja || cmake --preset release -DALHAZEN_TESTS=OFF
	@cmake -S . -B build >/dev/null
	@cmake --build --preset release --target ablations
	build/bin/ablations --page docs/performance.md $(ABLATIONS)

install: program
	@cmake --build --preset release --target alhazen_library
	cmake --install build --prefix "$(PREFIX)"

clean:
	rm -rf build build-debug build-sanitize build-tsan build-coverage build-clang build-tidy

# The two commands of the README, and what they are made of.
#
#   make demo    sets up, builds, and runs the main job; ARGS="..." are handed on
#   make test    sets up, builds and runs every test
#   make build   sets up and builds the program: build/release/hapticgiant
#   make bench   measures solver, cycle and laws beside the paper's solver into $(RESULTS); minutes;
#                ARGS="door --quick" for a first look
#   make bench-instructions
#                counts their instructions (callgrind), into the same folder
#   make sanitize
#                builds and runs the tests that pay off under sanitizers: address and undefined
#                behaviour for the control cycle and what it calls, threads for what has threads
#   make fuzz    feeds problem reader and solver with FUZZ_SECONDS=600 of random bytes each, under
#                sanitizers; needs clang. What it finds is in build/fuzz/

ARGS ?=
PRESET ?= release
BUILD := build/$(PRESET)
RESULTS ?= bench/results/$(shell date -u +%F)-$(shell sed -n 's/^model name.*: //p' /proc/cpuinfo | \
  head -1 | tr -cs 'A-Za-z0-9\n' - | tr A-Z a-z)
ASAN_TESTS := $(addsuffix _test, core limits hqp estimation rendering prepositioning control safety \
  cycle user simulation remote identification evaluation fuzz_replay)
TSAN_TESTS := $(addsuffix _test, core runtime viewer_server)
FUZZ_SECONDS ?= 600
FUZZ_CXX ?= $(firstword $(foreach name,clang++ clang++-19 clang++-16 clang++-14,$(shell command -v $(name))) clang++)
empty :=
space := $(empty) $(empty)
# run_tests,PRESET,NAMES: builds these tests and runs them
define run_tests
@tools/configure.sh $(1) test
@cmake --build build/$(1) --target $(2)
@ctest --test-dir build/$(1) --output-on-failure --no-tests=error \
  --tests-regex '^($(subst $(space),|,$(strip $(2))))$$'
endef

.PHONY: demo build test bench bench-instructions sanitize fuzz format check clean

demo: build
	@$(BUILD)/hapticgiant run $(ARGS)

build:
	@tools/setup.sh build
	@tools/configure.sh $(PRESET) build
	@cmake --build $(BUILD) --target hapticgiant

test:
	@tools/setup.sh test
	@tools/configure.sh $(PRESET) test
	@cmake --build $(BUILD)
	@PATH="$(CURDIR)/.venv/bin:$$PATH" ctest --test-dir $(BUILD) --output-on-failure --no-tests=error

bench:
	@tools/setup.sh bench
	@tools/configure.sh $(PRESET) build
	@cmake --log-level=ERROR $(BUILD) >/dev/null  # finds what set-up has just fetched
	@cmake --build $(BUILD) --target hapticgiant
	@$(BUILD)/hapticgiant bench --out $(RESULTS) $(ARGS)

bench-instructions:
	@tools/setup.sh count
	@tools/configure.sh $(PRESET) build
	@cmake --build $(BUILD) --target bench_instructions
	@mkdir -p $(RESULTS)
	@.venv/bin/python tools/count_instructions.py $(BUILD)/bench_instructions $(RESULTS)/instructions.csv

sanitize:
	@tools/setup.sh test
	$(call run_tests,asan,$(ASAN_TESTS))
	$(call run_tests,tsan,$(TSAN_TESTS))

fuzz:
	@cmake -S tests/fuzz -B build/fuzz -G Ninja -DCMAKE_CXX_COMPILER=$(FUZZ_CXX)
	@cmake --build build/fuzz
	@set -e; for name in reader solver; do \
	  mkdir -p build/fuzz/inputs/$$name; \
	  build/fuzz/fuzz_hqp_$$name -max_total_time=$(FUZZ_SECONDS) -timeout=10 -max_len=2048 \
	    -print_final_stats=1 -artifact_prefix=build/fuzz/$$name- \
	    build/fuzz/inputs/$$name tests/fuzz/corpus/$$name; \
	done

format:
	@git ls-files '*.h' '*.cpp' | xargs clang-format -i

check:
	@git ls-files '*.h' '*.cpp' | xargs clang-format --dry-run --Werror
	@.venv/bin/python tools/check_modules.py

clean:
	rm -rf build viewer/dist
